# SPDX-License-Identifier: BSD-3-Clause
"""Benchmarks as data: a case, what is taken from its run, answers with tolerances and sources."""
