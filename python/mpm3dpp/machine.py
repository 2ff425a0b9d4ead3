# SPDX-License-Identifier: BSD-3-Clause
"""What this machine has: its memory, and the threads of a run when the user does not say."""

from __future__ import annotations

import contextlib
import os
import resource
from collections.abc import Iterator
from pathlib import Path

from .arguments import whole_number
from .errors import CaseError

# Where Linux tells a container's or a batch job's limit, of control groups of version 2 and 1.
_LIMITS = (
    Path("/sys/fs/cgroup/memory.max"),
    Path("/sys/fs/cgroup/memory/memory.limit_in_bytes"),
)


def _memories() -> Iterator[int]:
    """Yield what bounds the memory of this process [bytes]: the machine, and limits set for it."""
    yield os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    for path in _LIMITS:
        with contextlib.suppress(OSError, ValueError):  # There is none, or it is the word "max".
            yield int(path.read_text())
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit != resource.RLIM_INFINITY:
        yield limit


MEMORY = min(_memories())
"""That a process may have on this machine [bytes]."""
PARTICLE_BYTES_WITH_GRID = 150
"""That a particle needs about, its share of the grid included, before there is a case to count the
nodes of; `echo.memory_bytes` does so, and counts particles without them."""
BODY_BYTES = 4000
"""That a body of a particle or two needs at least, with its columns, lists and blocks of nodes."""
MOST_PARTICLES = MEMORY / PARTICLE_BYTES_WITH_GRID
"""What the memory of this machine holds of them."""
MOST_THREADS = 4096
"""So that a slip of the keyboard is no lack of memory."""


def memory_text(count: float) -> str:
    """Return a number of bytes in words: `1.2e+03 GiB`."""
    return f"{count / 2**30:.2g} GiB"


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
