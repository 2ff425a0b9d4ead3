# SPDX-License-Identifier: BSD-3-Clause
"""What looks at a run on its way: probes, conditions that end it, and a function of the user's."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.names import numbered
from mpm3dpp.case.stop import Stop
from mpm3dpp.io.part_cells import PART_COLUMNS, Sums

from .probes import Probes, next_multiple
from .simulation import Simulation

Call = Callable[[Simulation], bool | None]
"""A function of the user's; the run ends when it returns False."""

_WORDS = {
    "speed_below": "is slower than {:.6g} m/s",
    "speed_above": "is faster than {:.6g} m/s",
    "moved": "has moved by more than {:.6g} m",
    "kinetic_below": "has a kinetic energy below {:.6g} J",
}
_COLUMN = {name: k for k, name in enumerate(PART_COLUMNS)}


def interval_of(every: float | str | None, call: Call | None) -> float:
    """Return the time between two calls [s], infinite without a function. Raises `CaseError`."""
    if (every is None) != (call is None):
        missing = "call" if call is None else "every"
        raise CaseError("is missing", "every and call go together: give both", key=missing)
    interval = math.inf if every is None else arguments.quantity("every", every, "s")
    if not interval > 0.0:
        raise CaseError("must be > 0", "give a time such as '1 us'", key="every", value=every)
    return interval


class Watch:
    """Looks at a run on its way.

    Args:
        simulation: of the run, ready to step.
        folder: of the run.
        state: of a run that goes on, `state()` then.
        call: a function of the user's, if there is one.
        every: time between two calls of it [s].

    Raises:
        CaseError: see `Probes`.
    """

    def __init__(
        self,
        simulation: Simulation,
        folder: Path,
        state: Mapping[str, Any] | None = None,
        call: Call | None = None,
        every: float = math.inf,
    ) -> None:
        self._simulation, self._call, self._every = simulation, call, every
        self._probes = Probes(simulation, folder, state["probes"] if state else None)
        self._stops = simulation.case.run.stop
        # A condition counts once it has been seen not to hold.
        before: Mapping[str, bool] = state["stops"] if state else {}
        self._counting = {word for word, counts in before.items() if counts}
        self._names = numbered(simulation.parts)[0]
        self._next_call = math.inf
        if call is not None:
            self._next_call = every * math.ceil(max(simulation.time, 0.0) / every)

    @property
    def lost(self) -> list[str]:
        """Names of the probes whose tables are gone, and begin anew."""
        return self._probes.lost

    @property
    def next(self) -> float:
        """The time of the next look [s]; infinite if there is none."""
        return min(self._probes.next, self._next_call)

    def look(self) -> str | None:
        """Look with what has its time now; return why the run is to end, if it is."""
        core = self._simulation.core
        self._probes.look(core)
        if self._call is None or core.time < self._next_call:
            return None
        self._next_call = next_multiple(self._every, core.time)
        if self._call(self._simulation) is False:
            return f"stopped by the function that was called at t = {core.time:.6g} s"
        return None

    def end_of(self, sums: Sums, first: np.ndarray) -> str | None:
        """Return why the run is to end by a condition, if it is.

        Args:
            sums: of the bodies now.
            first: rows of them when the run began.
        """
        core = self._simulation.core
        if core.time < 0.0:  # It settles.
            return None
        for stop in self._stops:
            if not _holds(stop, sums[1], first, self._names):
                self._counting.add(str(stop))
            elif str(stop) in self._counting:
                name, limit = stop.condition
                words = _WORDS[name].format(limit)
                return f"stopped at t = {core.time:.6g} s: {stop.body or 'all'} {words} (run.stop)"
        return None

    def state(self) -> dict[str, Any]:
        """Return what is needed to go on from here, for JSON; it is on the disk then."""
        stops = {str(stop): str(stop) in self._counting for stop in self._stops}
        return {"probes": self._probes.state(), "stops": stops}

    def __enter__(self) -> Watch:
        return self

    def __exit__(self, *about: object) -> None:
        self._probes.close()


def _holds(stop: Stop, rows: np.ndarray, first: np.ndarray, names: Sequence[str]) -> bool:
    """Return whether a condition is true of what bodies have."""
    name, limit = stop.condition
    if name == "kinetic_below":
        of = rows[names.index(stop.body)] if stop.body else rows.sum(axis=0)
        return bool(of[_COLUMN["kinetic"]] < limit)
    number = names.index(stop.body)
    row = rows[number]
    if row[_COLUMN["mass"]] == 0.0:  # Nothing of it is left.
        return False
    if name == "moved":
        way = _vector(row, "centre") - _vector(first[number], "centre")
        return bool(np.linalg.norm(way) > limit)
    speed = float(np.linalg.norm(_vector(row, "velocity")))
    return speed < limit if name == "speed_below" else speed > limit


def _vector(row: np.ndarray, name: str) -> np.ndarray:
    return row[[_COLUMN[f"{name}_{axis}"] for axis in "xyz"]]
