# SPDX-License-Identifier: BSD-3-Clause
"""The grains of the benchmark `spheres`: equal balls that touch and are pressed together. SI units.

Per particle every grain is the same work, so that time per particle-step must not depend on how
many there are: what does, grows faster than the number of bodies.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

RADIUS = 5  # In particle spacings.
PARTICLES = 552  # Points of the shifted lattice in such a ball.
# Speed at which neighbours come together [m/s]: they stay pressed through all steps that are timed.
APPROACH = 1.0


def ball(spacing: float) -> Array:
    """Return the particles of a grain about its centre, which lies between them; shape (552, 3)."""
    axis = np.arange(-RADIUS, RADIUS) + 0.5
    lattice = np.stack(np.meshgrid(axis, axis, axis, indexing="ij"), axis=-1).reshape(-1, 3)
    return spacing * lattice[(lattice**2).sum(axis=1) < RADIUS**2]


def centres(count: int, spacing: float) -> Array:
    """Return where the grains stand [m], shape (count, 3): the first places of a cubic lattice."""
    edge = math.ceil(round(count ** (1 / 3), 9))
    places = np.stack(np.unravel_index(np.arange(count), (edge, edge, edge)), axis=1)
    return np.asarray((places + 0.5) * (2 * RADIUS * spacing), dtype=np.float64)


def velocities(positions: Array, middle: Array, spacing: float, translation: Array) -> Array:
    """Return translation + even compression towards the middle [m/s], shape (n, 3)."""
    compression: Array = (positions - middle) * (APPROACH / (2 * RADIUS * spacing))
    return translation - compression
