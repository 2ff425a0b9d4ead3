# SPDX-License-Identifier: BSD-3-Clause
"""The particles of grains: made once per radius about zero, then only turned and moved."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.shapes import Disc, Sphere
from mpm3dpp.shapes.filling import fill_round, fill_shape
from mpm3dpp.shapes.shells import SHELLS
from mpm3dpp.shapes.turns import turned

from .orientation import orientations

Array = NDArray[np.float64]


def fill_grains(
    centres: Array, radii: Array, spacing: float, grid: Any, way: str, align: str
) -> Iterator[Array]:
    """Yield the particles of each grain [m], shape (n, D); those of a grain have equal volumes.

    Args:
        centres: of the grains [m], shape (grains, D).
        radii: [m], shape (grains,).
        spacing: distance of the particles [m].
        grid: a `case.Grid`.
        way: "shells" or "lattice". In shells, grains are turned, see `orientation`.
        align: of a lattice: "between" (the centre is the middle of a square or cube of particles),
            "particle" (a particle stands at the centre) or "grid" (on the lattice of the grid, as
            bodies).

    Raises:
        CaseError: a grain holds no particle.
    """
    turns = orientations(centres, radii) if way == SHELLS else None
    made: dict[float, Array] = {}
    for k, (centre, radius) in enumerate(zip(centres, radii.tolist(), strict=True)):
        if turns is None and align == "grid":
            positions = fill_shape(_ball(centre, radius), grid.origin, spacing)
        else:
            if radius not in made:
                made[radius] = _about_zero(len(centre), radius, spacing, way, align)
            points = made[radius] if turns is None else turned(made[radius], turns[k])
            positions = points + centre
        if len(positions) == 0:
            rule = (
                f"has a grain of radius {radius:.4g} m that holds no particle: they are "
                f"{spacing:.4g} m apart"
            )
            remedy = "give a smaller grid.cell_size, more particles_per_cell, or larger grains"
            raise CaseError(rule, remedy)
        yield positions


def _about_zero(dimension: int, radius: float, spacing: float, way: str, align: str) -> Array:
    """Return the particles of a grain about zero [m], shape (n, D), before it is turned."""
    zero = np.zeros(dimension)
    ball = _ball(zero, radius)
    if way == SHELLS:
        return fill_round(ball, spacing)
    return fill_shape(ball, zero if align == "between" else zero - 0.5 * spacing, spacing)


def _ball(centre: Array, radius: float) -> Disc:
    kind = Disc if len(centre) == 2 else Sphere
    return kind(centre=tuple(centre.tolist()), radius=radius)
