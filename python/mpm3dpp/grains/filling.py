# SPDX-License-Identifier: BSD-3-Clause
"""The particles of grains: made once per radius about zero, then only turned and moved."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.shapes import Disc, Sphere
from mpm3dpp.shapes.filling import fill_round
from mpm3dpp.shapes.lattice import fill_shape
from mpm3dpp.shapes.shells import SHELLS

from .orientation import orientations

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

_KEPT = (
    64  # Radii whose particles are kept; where there are more, most grains have one of their own.
)


class GrainFilling:
    """What fills the grains of an entry; those of a grain have equal volumes.

    Args:
        centres: of the grains [m], shape (grains, D).
        radii: [m], shape (grains,).
        spacing: distance of the particles [m].
        grid: a `case.Grid`.
        way: "shells" or "lattice". In shells, grains are turned, see `orientation`.
        align: of a lattice: "between" (the centre is the middle of a square or cube of particles),
            "particle" (a particle stands at the centre) or "grid" (on the lattice of the grid, as
            bodies).
    """

    def __init__(
        self, centres: Array, radii: Array, spacing: float, grid: Any, way: str, align: str
    ) -> None:
        self._centres, self._radii, self._spacing = centres, radii, spacing
        self._grid, self._way, self._align = grid, way, align
        self._turns = orientations(centres, radii) if way == SHELLS else None
        self._made: dict[float, Array] = {}

    def fill(self, first: int, last: int) -> tuple[Array, Counts]:
        """Return the particles of the grains from one to the one before another.

        Returns:
            Positions [m], shape (n, D), one grain after another, and how many each has.

        Raises:
            CaseError: a grain holds no particle.
        """
        if first == last:
            return np.zeros((0, self._centres.shape[1])), np.zeros(0, dtype=np.int64)
        if self._way != SHELLS and self._align == "grid":
            on_grid = [self._on_grid(k) for k in range(first, last)]
            return np.concatenate(on_grid), np.array([len(x) for x in on_grid], dtype=np.int64)
        radii, kind = np.unique(self._radii[first:last], return_inverse=True)
        templates = [self._about_zero(radius) for radius in radii.tolist()]
        if len(self._made) > _KEPT:
            self._made.clear()
        counts = np.array([len(points) for points in templates], dtype=np.int64)[kind]
        for k in np.flatnonzero(counts == 0)[:1]:
            raise self._empty(float(self._radii[first + k]))
        ends = np.cumsum(counts)
        positions = np.empty((int(ends[-1]), self._centres.shape[1]))
        by_kind = np.argsort(kind, kind="stable")
        groups = np.split(by_kind, np.cumsum(np.bincount(kind))[:-1])
        for points, grains in zip(templates, groups, strict=True):
            rows = (ends[grains] - len(points))[:, None] + np.arange(len(points))
            positions[rows] = self._turned(points, first + grains)
        return positions, counts

    def _turned(self, points: Array, grains: Counts) -> Array:
        """Return particles about zero as they are in some grains, shape (grains, n, D)."""
        centres = self._centres[grains, None, :]
        if self._turns is None:
            return points + centres
        matrix = self._turns[grains]
        found = points[:, 0, None] * matrix[:, None, :, 0]
        for axis in range(1, points.shape[1]):
            found = found + points[:, axis, None] * matrix[:, None, :, axis]
        return np.asarray(found + centres)

    def _about_zero(self, radius: float) -> Array:
        """Return the particles of a grain about zero [m], shape (n, D), before it is turned."""
        if radius not in self._made:
            zero = np.zeros(self._centres.shape[1])
            ball = _ball(zero, radius)
            if self._way == SHELLS:
                found = fill_round(ball, self._spacing)
            else:
                corner = zero if self._align == "between" else zero - 0.5 * self._spacing
                found = fill_shape(ball, corner, self._spacing)
            self._made[radius] = found
        return self._made[radius]

    def _on_grid(self, k: int) -> Array:
        radius = float(self._radii[k])
        found = fill_shape(_ball(self._centres[k], radius), self._grid.origin, self._spacing)
        if len(found) == 0:
            raise self._empty(radius)
        return found

    def _empty(self, radius: float) -> CaseError:
        rule = (
            f"has a grain of radius {radius:.4g} m that holds no particle: they are "
            f"{self._spacing:.4g} m apart"
        )
        remedy = "give a smaller grid.cell_size, more particles_per_cell, or larger grains"
        return CaseError(rule, remedy)


def _ball(centre: Array, radius: float) -> Disc:
    kind = Disc if len(centre) == 2 else Sphere
    return kind(centre=tuple(centre.tolist()), radius=radius)
