# SPDX-License-Identifier: BSD-3-Clause
"""The cloud of the benchmark `debris`: sparse, fast and in no order. SI units.

Particles lie at random, two in a cell in the mean, some cells with none and some with six. They
are soft, so that the time step is that of their speed, and they cross a cell every few steps: what
it costs beyond `elastic3d` is finding and sorting particles, and lanes and nodes that stay empty.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.case.particles import Particles

from .numerics import CELL, PER_AXIS

Array = NDArray[np.float64]

SPREAD = 1.6  # Edge of the cloud over that of a cube of as many particles, eight a cell.
# Growth of the cloud over its edge while a particle flies as far as this edge.
EXPANSION = 0.1


def tables(size: int, translation: Array) -> dict[str, Any]:
    """Return the cloud of the case, with as many particles as a cube of `size` cells along an edge.

    They lie at random, the same each time, and fly with translation + even expansion.
    """
    edge = SPREAD * size * CELL
    places = np.random.default_rng(1).random(((PER_AXIS * size) ** 3, 3)) * edge
    rate = EXPANSION * float(np.linalg.norm(translation)) / edge
    velocity = [
        {"expression": f"{v:.17g} + {rate:.17g} * ({x} - {0.5 * edge:.17g})"}
        for v, x in zip(translation, "xyz", strict=True)
    ]
    cloud = {"material": "its", "particles": Particles(places), "velocity": velocity}
    return {"body": {"debris": cloud}}
