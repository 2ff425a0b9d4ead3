# SPDX-License-Identifier: BSD-3-Clause
"""Probes of a run: each looks when its time has come, and writes a row of its table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mpm3dpp.base.disk import make_folder
from mpm3dpp.base.outputs import DERIVED
from mpm3dpp.case.probe import SAMPLES, Probe
from mpm3dpp.io.fields import column_components
from mpm3dpp.io.probe_tables import FIRST_COLUMNS, PROBES, probe_path
from mpm3dpp.io.rows import component_words
from mpm3dpp.io.table import Table

from .simulation import Simulation

_MOST_OPEN = 64  # tables; those of more probes are opened for each row


class Probes:
    """The probes of a run.

    Args:
        simulation: of the run, ready to step.
        folder: of the run; the tables are in its folder `probes`.
        state: of a run that goes on, `state()` then.

    Attributes:
        lost: names of the probes whose tables are gone, and begin anew.

    Raises:
        CaseError: a probe finds no particle, or a table cannot be written.
    """

    def __init__(
        self, simulation: Simulation, folder: Path, state: Mapping[str, Any] | None = None
    ) -> None:
        case = simulation.case
        if case.probe:
            make_folder(folder / PROBES)
        known = state or {}
        self.lost = [name for name in known if not probe_path(folder, name).exists()]
        self._probes: list[_Probe] = []
        try:
            for name, probe in case.probe.items():
                saved, few = known.get(name), len(case.probe) <= _MOST_OPEN
                self._probes.append(_Probe(name, probe, simulation, folder, saved, few))
        except BaseException:
            self.close()
            raise

    @property
    def next(self) -> float:
        """The time at which one looks next [s]; infinite if there is none."""
        return min((probe.next for probe in self._probes), default=math.inf)

    def look(self, core: Any) -> None:
        """Look where the time has come."""
        for probe in self._probes:
            if core.time >= probe.next:
                probe.look(core)

    def state(self) -> dict[str, Any]:
        """Return what the probes need to go on from here, for JSON; it is on the disk then."""
        return {probe.name: probe.state() for probe in self._probes}

    def close(self) -> None:
        """Close the tables."""
        for probe in self._probes:
            probe.table.close()

    def __enter__(self) -> Probes:
        return self

    def __exit__(self, *about: object) -> None:
        self.close()


class _Probe:
    """One of them; see `Probes`."""

    def __init__(
        self,
        name: str,
        probe: Probe,
        simulation: Simulation,
        folder: Path,
        state: Mapping[str, Any] | None,
        keep_open: bool,
    ) -> None:
        self.name, self._case = name, simulation.case
        self._probe = probe
        core = simulation.core
        self._bodies = [k for k, part in enumerate(simulation.parts) if probe.body in ("", part)]
        self._particle = state["particle"] if state else self._find(core)
        if self._particle is not None:
            self._bodies = self._particle[:1]
        self.next = state["next"] if state else 0.0
        # Stress has six components in 2D too.
        derived = {name: int(field["components"]) for name, field in DERIVED.items()}
        known = column_components(core) | derived | {"stress": 6}
        widths = [known.get(field, 1) for field in probe.fields]
        path = probe_path(folder, name)
        saved = state["table"] if state and path.exists() else None
        self.table = Table(path, header_of(probe, widths), saved, keep_open)

    def look(self, core: Any) -> None:
        """Write a row."""
        probe = self._probe
        box = probe.region
        lower, upper = (box.lower, box.upper) if box is not None else (probe.point, probe.point)
        number = self._particle[1] if self._particle is not None else 0
        count, mass, *seen = core.probe(
            probe.kind, self._bodies, list(lower), list(upper), number, probe.fields
        )
        if probe.kind in ("point", "particle"):
            seen = seen[::3]  # Of what there is one of, the mean is all.
        cells = [*map(repr, (float(core.time), int(core.step), int(count), mass)), *map(repr, seen)]
        self.table.append([cells])
        self.next = next_look(probe, self._case.run.end_time, core.time)

    def state(self) -> dict[str, Any]:
        return {"table": self.table.saved(), "next": self.next, "particle": self._particle}

    def _find(self, core: Any) -> list[int] | None:
        """Return body and number of the particle to follow; None if it is not one."""
        if self._probe.kind != "particle":
            return None
        found = core.nearest_particle(self._bodies, list(self._probe.particle))
        if found is None:
            raise self._case.error(("probe", self.name), "finds no particle", "name another body")
        return list(map(int, found))


def next_multiple(every: float, time: float) -> float:
    """Return the first multiple of `every` after a time [s]."""
    return every * (math.floor(time / every + 1e-9) + 1)


def next_look(probe: Probe, end_time: float, time: float) -> float:
    """Return the first time after `time` at which a probe of a run to `end_time` looks [s]."""
    then = next_multiple(probe.every or end_time / SAMPLES, time)
    return end_time if abs(then - end_time) < 1e-9 * end_time else then  # Where it rounds.


def header_of(probe: Probe, widths: list[int]) -> list[str]:
    """Return the columns of a probe's table, whose fields have so many components each."""
    several = probe.kind not in ("point", "particle")
    names = [*FIRST_COLUMNS]
    for field, width in zip(probe.fields, widths, strict=True):
        words = [f"_{word}" for word in component_words(width)] if width > 1 else [""]
        for word in words:
            names += [f"{field}{word}{end}" for end in (("", "_min", "_max") if several else ("",))]
    return names
