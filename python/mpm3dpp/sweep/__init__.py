# SPDX-License-Identifier: BSD-3-Clause
"""Runs of a case with several values of some keys, a table and a picture of what came out."""
