# SPDX-License-Identifier: BSD-3-Clause
"""Ranks: processes that work on one case, each on its own part of the grid, by MPI."""
