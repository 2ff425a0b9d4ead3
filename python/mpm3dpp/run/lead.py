# SPDX-License-Identifier: BSD-3-Clause
"""A run of several processes: the first leads, the others do with their parts what it does.

So all that a run writes, prints and decides is done once, by the same program as for one process.
"""

from __future__ import annotations

import contextlib
import signal
from collections.abc import Callable
from typing import Any

from mpm3dpp.case.case import Case
from mpm3dpp.ranks.world import World, world

from .simulation import Simulation

_OWN = frozenset(
    {
        *("time", "dt", "step", "failure", "body_count", "body_particle_count", "columns"),
        *("history_columns", "history_capacity", "timers"),
    }
)
"""What the first process knows without the others."""


_PATIENCE = 60.0  # s, for ranks that are slower to fill bodies that cannot be filled


class _Leading:
    """The core's `Simulation` of the first process; what it is asked, the others are asked too."""

    def __init__(self, core: Any, ranks: World) -> None:
        self._core, self._ranks = core, ranks

    def __getattr__(self, name: str) -> Any:
        if name in _OWN or name.startswith("__"):
            return getattr(self._core, name)
        if isinstance(getattr(type(self._core), name, None), property):
            self._ranks.tell("get", name)
            return self._alike(lambda: getattr(self._core, name))
        return lambda *values, **named: self._call(name, values, named)

    def _call(self, name: str, values: tuple[Any, ...], named: dict[str, Any]) -> Any:
        # What only the first process calls, as to read a file, the others need not have.
        told = tuple(len if callable(value) else value for value in values)
        self._ranks.tell("call", name, told, named)
        return self._alike(lambda: getattr(self._core, name)(*values, **named))

    def _alike(self, act: Callable[[], Any]) -> Any:
        try:
            return act()
        except Exception as error:
            self._ranks.fail(str(error))  # Returns if it is a mistake that all have made.
            raise


def make_simulation(case: Case, threads: int | None) -> Simulation:
    """Return the simulation of a case: of this process, or led by it if there are others."""
    ranks = world()
    if ranks is None:
        return Simulation(case, threads)
    ranks.tell("make", case, threads)
    simulation = _make(case, threads, ranks)
    simulation.core = _Leading(simulation.core, ranks)
    return simulation


def _make(case: Case, threads: int | None, ranks: World) -> Simulation:
    try:
        return Simulation(case, threads, world=ranks)
    except Exception as error:
        ranks.fail(str(error), _PATIENCE)
        raise


def release(what: Any = None) -> None:
    """Tell the others that a run has ended, and what has come of it."""
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
    with _deaf():
        while True:
            what, *about = ranks.hear()
            if what == "end":
                return about[0]
            if what == "quit":
                raise SystemExit(0)
            if what == "make":
                simulation = None
                with contextlib.suppress(Exception):  # The first process has met the same.
                    simulation = _make(about[0], about[1], ranks)
                continue
            try:
                if what == "get":
                    getattr(simulation.core, about[0])
                else:
                    name, values, named = about
                    getattr(simulation.core, name)(*values, **named)
            except Exception as error:
                ranks.fail(str(error))


@contextlib.contextmanager
def _deaf() -> Any:
    """Leave Ctrl-C and SIGTERM to the first process."""
    kinds = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(kind, signal.SIG_IGN) for kind in kinds]
    try:
        yield
    finally:
        for kind, handler in zip(kinds, before, strict=True):
            signal.signal(kind, handler)
