# SPDX-License-Identifier: BSD-3-Clause
"""The cloud of the benchmark `debris`: sparse, fast and in no order. SI units.

Particles lie at random, two in a cell in the mean, some cells with none and some with six. They
are soft, so that the time step is that of their speed, and they cross a cell every few steps: what
it costs beyond `elastic3d` is finding and sorting particles, and lanes and nodes that stay empty.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

SPREAD = 1.6  # Edge of the cloud over that of a cube of as many particles, eight a cell.
# Growth of the cloud over its edge while a particle flies as far as this edge.
EXPANSION = 0.1


def positions(count: int, edge: float) -> Array:
    """Return particles at random in a cube, shape (count, 3) [m]; the same ones each time."""
    return np.random.default_rng(1).random((count, 3)) * edge


def velocities(places: Array, edge: float, translation: Array) -> Array:
    """Return translation + even expansion [m/s], shape (n, 3).

    Args:
        places: of the particles [m].
        edge: of the cloud [m].
        translation: velocity of its middle [m/s].
    """
    growth = EXPANSION * float(np.linalg.norm(translation))
    return np.asarray(translation + (places - 0.5 * edge) * (growth / edge))
