# SPDX-License-Identifier: BSD-3-Clause
"""What this machine has: its memory, and the threads of a run when the user does not say."""

from __future__ import annotations

import contextlib
import os
import platform
import resource
import shlex
import sys
from collections.abc import Iterator
from pathlib import Path, PurePosixPath

from .arguments import whole_number
from .errors import CaseError

# Where Linux tells the limits of control groups, which containers and batch jobs have: those of
# version 2, and of version 1, where memory has a tree of its own.
_GROUPS = Path("/sys/fs/cgroup")
_LIMITS = {"": (_GROUPS, "memory.max"), "memory": (_GROUPS / "memory", "memory.limit_in_bytes")}


def group_limits(groups: str) -> Iterator[Path]:
    """Yield the files that may tell a limit: of the process's control group and those around it.

    Args:
        groups: content of /proc/self/cgroup, a line for each tree: number:controllers:path.
    """
    for line in groups.splitlines():
        _, _, rest = line.partition(":")
        controllers, _, path = rest.partition(":")
        for controller in controllers.split(","):
            if controller in _LIMITS:
                root, name = _LIMITS[controller]
                yield root.joinpath(path.strip("/"), name)
                for group in PurePosixPath(path.strip("/")).parents:
                    yield root.joinpath(group, name)


def _memories() -> Iterator[int]:
    """Yield what bounds the memory of this process [bytes]: the machine, and limits set for it."""
    yield os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    with contextlib.suppress(OSError):  # Another system.
        for path in group_limits(Path("/proc/self/cgroup").read_text()):
            with contextlib.suppress(OSError, ValueError):  # None, or it is the word "max".
                yield int(path.read_text())
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if limit != resource.RLIM_INFINITY:
        yield limit


MEMORY = min(_memories())
"""That a process may have on this machine [bytes]."""
PARTICLE_BYTES_WITH_GRID = 150
"""That a particle needs about, its share of the grid included, before there is a case to count the
nodes of; `run.memory.memory_bytes` does so, and counts particles without them."""
BODY_BYTES = 4000
"""That a body of a particle or two needs at least, with its columns, lists and blocks of nodes."""
MOST_PARTICLES = MEMORY / PARTICLE_BYTES_WITH_GRID
"""What the memory of this machine holds of them."""
MOST_THREADS = 4096
"""So that a slip of the keyboard is no lack of memory."""


def memory_text(count: float) -> str:
    """Return a number of bytes in words: `1.2e+03 GiB`."""
    return f"{count / 2**30:.2g} GiB"


def thread_count(wanted: int | None, cores: int | None = None) -> int:
    """Return the number of threads: what is wanted, else OMP_NUM_THREADS, else all cores.

    Args:
        wanted: by the user.          cores: that there are for it; by default all.

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
    if cores is not None:
        return cores
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def processor_name() -> str:
    """Return the processor's name as the system gives it, else its architecture."""
    try:
        text = Path("/proc/cpuinfo").read_text()
    except OSError:
        text = ""
    names = [line.partition(":")[2].strip() for line in text.splitlines() if "model name" in line]
    return names[0] if names else platform.machine()


TYPED = "MPM3DPP_TYPED"
"""In the environment: the command of the process that has started the ranks."""


def command_line() -> str:
    """Return the command that started this process, or that of the ranks, as one would type it."""
    if typed := os.environ.get(TYPED):
        return typed
    program, *words = sys.argv or [""]
    path = Path(program)
    name = path.parent.name if path.name == "__main__.py" else path.name
    return shlex.join([name, *words])
