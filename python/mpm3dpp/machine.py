# SPDX-License-Identifier: BSD-3-Clause
"""What this machine has: its memory, and the threads of a run when the user does not say."""

from __future__ import annotations

import os

from .arguments import whole_number
from .errors import CaseError

MEMORY = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
"""Of this machine [bytes]."""
MOST_THREADS = 4096
"""So that a slip of the keyboard is no lack of memory."""


def thread_count(wanted: int | None) -> int:
    """Return the number of threads: what is wanted, else OMP_NUM_THREADS, else all cores.

    Raises:
        CaseError: the number wanted, or OMP_NUM_THREADS, is no number of threads.
    """
    if wanted is not None:
        return whole_number("threads", wanted, 1, MOST_THREADS)
    setting = os.environ.get("OMP_NUM_THREADS", "").split(",")[0].strip()
    if setting:
        try:
            number = int(setting)
        except ValueError:
            number = 0
        if not 1 <= number <= MOST_THREADS:
            rule = f"must be a whole number from 1 to {MOST_THREADS}"
            raise CaseError(rule, "unset it or give one", key="OMP_NUM_THREADS", value=setting)
        return number
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
