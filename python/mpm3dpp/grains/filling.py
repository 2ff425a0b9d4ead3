# SPDX-License-Identifier: BSD-3-Clause
"""The particles of a grain about its own centre: made once per radius, then only moved."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.shapes import Disc, Sphere
from mpm3dpp.shapes.filling import fill_shape

Array = NDArray[np.float64]


def fill_grain(
    centre: Array, radius: float, spacing: float, align: str, grid: Any, made: dict[float, Array]
) -> Array:
    """Return the particles of one grain [m], shape (n, D).

    Args:
        centre: [m], shape (D,).
        radius: [m].
        spacing: distance of the particles [m].
        align: "between" (the centre is the middle of a square or cube of particles), "particle"
            (a particle stands at the centre) or "grid" (on the lattice of the grid, as bodies).
        grid: a `case.Grid`.
        made: the particles about zero of the radii seen so far, for these settings; it grows.

    Raises:
        CaseError: the grain holds no particle.
    """
    if align == "grid":
        positions = fill_shape(_ball(centre, radius), grid.origin, spacing)
    else:
        if radius not in made:
            zero = np.zeros(len(centre))
            origin = zero if align == "between" else zero - 0.5 * spacing
            made[radius] = fill_shape(_ball(zero, radius), origin, spacing)
        positions = made[radius] + centre
    if len(positions) == 0:
        rule = (
            f"has a grain of radius {radius:.4g} m that holds no particle: they are "
            f"{spacing:.4g} m apart"
        )
        remedy = "give a smaller grid.cell_size, more particles_per_cell, or larger grains"
        raise CaseError(rule, remedy)
    return positions


def _ball(centre: Array, radius: float) -> Disc:
    kind = Disc if len(centre) == 2 else Sphere
    return kind(centre=tuple(centre.tolist()), radius=radius)
