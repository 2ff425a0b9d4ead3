# SPDX-License-Identifier: BSD-3-Clause
"""Whether a launcher has started this process; each start of the command asks, so it is quick."""

from __future__ import annotations

import contextlib
import os

# How many processes a launcher has started and which of them this is: Open MPI; MPICH, Intel MPI
# and others that speak PMI; Slurm's srun.
_LAUNCHERS = (
    ("OMPI_COMM_WORLD_SIZE", "OMPI_COMM_WORLD_RANK"),
    ("PMI_SIZE", "PMI_RANK"),
    ("SLURM_STEP_NUM_TASKS", "SLURM_PROCID"),
)


def started() -> tuple[int, int] | None:
    """Return how many processes a launcher has started, and which this is, if more than one."""
    for size, rank in _LAUNCHERS:
        with contextlib.suppress(KeyError, ValueError):
            count, number = int(os.environ[size]), int(os.environ[rank])
            if count > 1:
                return count, number
    return None
