# SPDX-License-Identifier: BSD-3-Clause
"""A run: the simulation, its steps, checkpoints, progress and reports."""
