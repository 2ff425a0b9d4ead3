# SPDX-License-Identifier: BSD-3-Clause
"""The columns of `history.csv` for each body and wall, and for the balance of angular momentum."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from mpm3dpp import _core
from mpm3dpp.base.errors import CaseError

PART_COLUMNS: dict[str, tuple[str, str]] = _core.part_columns
"""Unit and meaning of the core's `part_sums` of each body: columns `body_A_mass`, ..."""

TOTALS: dict[str, tuple[str, str]] = _core.total_columns
"""Unit and meaning of the columns before those of bodies."""

WALL_COLUMNS: dict[str, tuple[str, str]] = {
    "force_x": ("N", "force of the last step of the bodies on this face of the box"),
    "force_y": ("N", "likewise"),
    "force_z": ("N", "likewise; 0 in 2D"),
    "impulse_x": ("N s", "its impulse so far, that of settling among it"),
    "impulse_y": ("N s", "likewise"),
    "impulse_z": ("N s", "likewise; 0 in 2D"),
    "pressure": ("Pa", "the force out of the box over the area of the whole face"),
}
"""Unit and meaning of the columns of each face of the box that is not free: `wall_x_min_force_x`,
..."""

Sums = tuple[list[float], np.ndarray, list[Any]]
"""TOTALS; PART_COLUMNS of each body, shape (bodies, columns); and the core's faces of the box."""

PART_LIMIT = 12
"""Most bodies, all grains of an entry being one, that get columns of their own."""


def sums_of(core: Any) -> Sums:
    """Return what the core's `Simulation` tells of bodies and walls now."""
    totals, bodies = core.part_sums()
    return totals, bodies, core.walls()


def wall_pressure(face: Any) -> float:
    """Return the mean pressure on a face of the box [Pa]: positive if bodies push out of it."""
    axis, outward = "xyz".index(face.name[0]), 1.0 if face.name.endswith("max") else -1.0
    return float(outward * face.force[axis] / face.area + 0.0)


def of_body(history: Mapping[str, np.ndarray], body: str) -> dict[str, np.ndarray]:
    """Return `time` and PART_COLUMNS of a body where the history has them.

    Those of earlier versions have fewer. Raises `CaseError` if there is none.
    """
    names = [name for name in PART_COLUMNS if f"body_{body}_{name}" in history]
    if "mass" not in names:
        raise CaseError(f"the history has no columns of {body}", "run the case again")
    columns = {name: history[f"body_{body}_{name}"] for name in names}
    told = ~np.isnan(columns["mass"])
    return {"time": history["time"][told]} | {k: v[told] for k, v in columns.items()}


class PartCells:
    """What the history holds of the bodies and of the walls.

    Args:
        names: of the bodies, all grains of an entry being one.
        walls: names of the faces of the box that are not free.
        first, last: rows of the first and last sums of a run that goes on; none if it begins.
    """

    def __init__(
        self,
        names: Sequence[str],
        walls: Sequence[str] = (),
        first: Sequence[Sequence[float]] = (),
        last: Sequence[Sequence[float]] = (),
    ) -> None:
        self._names, self._walls = list(names), list(walls)
        self._told = self._names if len(names) <= PART_LIMIT else []
        self.first = np.array(first) if len(first) else None
        self.last = np.array(last) if len(last) else self.first

    @property
    def header(self) -> list[str]:
        """Names of the columns."""
        told = [f"body_{name}_{column}" for name in self._told for column in PART_COLUMNS]
        walls = [f"wall_{name}_{column}" for name in self._walls for column in WALL_COLUMNS]
        return [*TOTALS, *told, *walls]

    def note(self, sums: Sums) -> None:
        """Keep the sums of the bodies if they are the first, and as the last."""
        self.last = sums[1]
        if self.first is None:
            self.first = sums[1]

    def cells(self, sums: Sums) -> list[str]:
        """Return the cells of a row."""
        totals, parts, faces = sums
        told = parts.ravel().tolist() if self._told else []
        walls = [v for face in faces for v in (*face.force, *face.impulse, wall_pressure(face))]
        return [repr(value) for value in [*totals, *told, *walls]]

    def records(self) -> dict[str, dict[str, dict[str, float]]]:
        """Return of each body what PART_COLUMNS were, `initial` and `final`."""
        found = {}
        for which, rows in (("initial", self.first), ("final", self.last)):
            if rows is not None:
                found[which] = [dict(zip(PART_COLUMNS, row, strict=True)) for row in rows.tolist()]
        return {
            name: {which: rows[k] for which, rows in found.items()}
            for k, name in enumerate(self._names)
        }
