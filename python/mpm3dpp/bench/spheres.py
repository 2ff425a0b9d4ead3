# SPDX-License-Identifier: BSD-3-Clause
"""The grains of the benchmark `spheres`: equal balls that touch and are pressed together. SI units.

Per particle every grain is the same work, so that time per particle-step must not depend on how
many there are: what does, grows faster than the number of bodies.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.grains import GrainCentres

from .numerics import CELL

Array = NDArray[np.float64]

RADIUS = 2.5 * CELL
PARTICLES = 552  # Points of the lattice in such a ball, whose centre lies between them.
# Speed at which neighbours come together [m/s]: they stay pressed through all steps that are timed.
APPROACH = 5.0


def tables(count: int, translation: Array) -> dict[str, Any]:
    """Return the grains of the case, with translation + even compression towards the middle."""
    places = centres(count)
    rate = APPROACH / (2 * RADIUS)
    velocity = [
        {"expression": f"{v:.17g} - {rate:.17g} * ({x} - {middle:.17g})"}
        for v, x, middle in zip(translation, "xyz", places.mean(axis=0), strict=True)
    ]
    balls = GrainCentres(places, np.full(count, RADIUS))
    grains = {"material": "its", "file": balls, "fill": "lattice", "velocity": velocity}
    return {"grains": {"balls": grains}}


def centres(count: int) -> Array:
    """Return where the grains stand [m], shape (count, 3): the first places of a cubic lattice."""
    edge = math.ceil(round(count ** (1 / 3), 9))
    places = np.stack(np.unravel_index(np.arange(count), (edge, edge, edge)), axis=1)
    return np.asarray((places + 0.5) * (2 * RADIUS), dtype=np.float64)
