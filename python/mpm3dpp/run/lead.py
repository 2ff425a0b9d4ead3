# SPDX-License-Identifier: BSD-3-Clause
"""A run of several processes: the first leads, the others do with their parts what it does.

So all is decided and printed once, by the same program as for one process, and all is written by it
but the slices of frames that others have.
"""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from mpm3dpp.base import signals
from mpm3dpp.case.case import Case
from mpm3dpp.io.background import FRAME_SHARE, BackgroundWriter
from mpm3dpp.io.result_hash import Parts
from mpm3dpp.io.vtkhdf import ResultsWriter
from mpm3dpp.ranks.world import World, world

from .device import CPU
from .simulation import Simulation
from .sliced_frames import SlicedFrames

_OWN = frozenset(
    {
        *("time", "dt", "step", "failure", "body_count", "body_particle_count", "columns"),
        *("history_columns", "history_capacity", "timers"),
    }
)
"""What the first process knows without the others."""


class _Own(NamedTuple):
    """What each process has its own of: "core", the core's `Simulation`, or "frames"."""

    name: str


class _Leading:
    """What the first process has of its own; what it is asked, those of the others are asked too.

    Args:
        own: this process's.
        name: see `_Own`.
        ranks: all processes.
    """

    def __init__(self, own: Any, name: str, ranks: World) -> None:
        self._own, self._name, self._ranks = own, name, ranks

    def __getattr__(self, name: str) -> Any:
        if name in _OWN or name.startswith("__"):
            return getattr(self._own, name)
        if isinstance(getattr(type(self._own), name, None), property):
            self._ranks.tell("get", self._name, name)
            return self._alike(lambda: getattr(self._own, name))
        return lambda *values, **named: self._call(name, values, named)

    def _call(self, name: str, values: tuple[Any, ...], named: dict[str, Any]) -> Any:
        own = [value._own if isinstance(value, _Leading) else value for value in values]
        told = [_told(value) for value in values], {k: _told(value) for k, value in named.items()}
        self._ranks.tell("call", self._name, name, *told)
        return self._alike(lambda: getattr(self._own, name)(*own, **named))

    def _alike(self, act: Callable[[], Any]) -> Any:
        try:
            return act()
        except Exception as error:
            self._ranks.fail(str(error))  # Returns if it is a mistake that all have made.
            raise


def make_simulation(case: Case, threads: int | None, device: str = CPU) -> Simulation:
    """Return the simulation of a case: of this process, or led by it if there are others."""
    ranks = world()
    if ranks is None:
        return Simulation(case, threads, device=device)
    ranks.tell("make", case, threads, device)
    simulation = _make(case, threads, device, ranks)
    simulation.core = _Leading(simulation.core, "core", ranks)
    return simulation


def background_writer(simulation: Simulation, file: ResultsWriter) -> BackgroundWriter:
    """Return what writes the frames of a run, of which other processes may write slices.

    Args:
        simulation: as `make_simulation` returns it.
        file: the writer of the first process.
    """
    ranks = world()
    if ranks is None:
        return BackgroundWriter(file, FRAME_SHARE * sum(simulation.core.bytes().values()))
    ranks.tell("frames", file.path, file.infos)
    parts = SlicedFrames(simulation, simulation.core._own, file.path, file.infos, ranks, file)
    return BackgroundWriter(file, parts=_Leading(parts, "frames", ranks))


def column_parts(simulation: Simulation) -> Parts | None:
    """Return what gives columns in parts if other processes have some of the particles."""
    ranks = world()
    if ranks is None:
        return None
    core = simulation.core._own

    def parts(body: int, name: str) -> Iterator[np.ndarray]:
        ranks.tell("slice", body, name)
        left = iter(range(1, ranks.size))
        try:
            own: np.ndarray = core.column_slice(body, name)
            yield own
            for rank in left:
                yield ranks.receive(rank)
        finally:  # They wait until they are asked.
            for rank in left:
                ranks.receive(rank)

    return parts


def _told(value: Any) -> Any:
    """Return an argument as the others are told it."""
    if isinstance(value, _Leading):
        return _Own(value._name)
    return _not_here if callable(value) else value


def _not_here(*_values: Any) -> Any:
    """Stand for what only the first process calls, as to read a file."""
    raise RuntimeError("this is called in the first rank only")


def _make(case: Case, threads: int | None, device: str, ranks: World) -> Simulation:
    try:
        return Simulation(case, threads, world=ranks, device=device)
    except Exception as error:
        ranks.fail(str(error))
        raise


class Mistake(NamedTuple):
    """What has come of a run that had to stop: what the first process raises, and its sentence."""

    kind: type[Exception]
    sentence: str


def release(what: Any = None) -> None:
    """Tell the others that a run has ended, and what has come of it: a manifest or a `Mistake`."""
    ranks = world()
    if ranks is not None:
        ranks.tell("end", what)


def dismiss() -> None:
    """Tell the others that there is nothing to do for them any more."""
    ranks = world()
    if ranks is not None:
        ranks.tell("quit")


def serve(ranks: World) -> None:
    """Follow the first process in all of its runs, until it dismisses this one."""
    with contextlib.suppress(SystemExit):
        while True:
            follow(ranks)


def follow(ranks: World) -> Any:
    """Do what the first process does with its part, to the end of a run; return what came of it.

    Raises:
        SystemExit: there are no more runs.
    """
    simulation: Any = None
    own: dict[str, Any] = {}
    with _deaf():
        while True:
            what, *about = ranks.hear()
            if what == "end":
                return about[0]
            if what == "quit":
                raise SystemExit(0)
            if what == "make":
                simulation, own = None, {}
                with contextlib.suppress(Exception):  # The first process has met the same.
                    simulation = _make(about[0], about[1], about[2], ranks)
                    own["core"] = simulation.core
                continue
            try:
                if what == "slice":
                    ranks.send(own["core"].column_slice(*about))
                elif what == "frames":
                    own["frames"] = SlicedFrames(simulation, own["core"], about[0], about[1], ranks)
                elif what == "get":
                    getattr(own[about[0]], about[1])
                else:
                    name, function, values, named = about
                    values = [own[v.name] if isinstance(v, _Own) else v for v in values]
                    getattr(own[name], function)(*values, **named)
            except Exception as error:
                ranks.fail(str(error))


@contextlib.contextmanager
def _deaf() -> Any:
    """Leave Ctrl-C, SIGTERM and their like to the first process."""
    kinds = signals.heeded()
    before = [signal.signal(kind, signal.SIG_IGN) for kind in kinds]
    try:
        yield
    finally:
        for kind, handler in zip(kinds, before, strict=True):
            signal.signal(kind, handler)
