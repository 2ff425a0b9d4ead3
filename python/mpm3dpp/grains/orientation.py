# SPDX-License-Identifier: BSD-3-Clause
"""How the particles of each grain are turned, so that a packing has no direction of its own.

With X the place of a grain from the mean centre of its entry, in radii of the grain, and r = |X|,
its particles are turned about the vector

    t = c (y z (y^2 - z^2), z x (z^2 - x^2), x y (x^2 - y^2)) / r^3

by |t| turns; in 2D z = 0. Under every turn and reflection that maps axes onto axes t goes over into
itself as an axial vector, which a rotation is, and the particles of a grain that is not turned go
over into themselves. So a case that is mirrored or turned has the mirrored or turned particles;
numbers of grains and the place of the whole do not matter. From one grain to its neighbour t
changes by some tenths of a turn. It is zero where symmetry wants it: on the axes through the mean
centre and on the diagonals between them.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.shapes.turns import cos_sin

Array = NDArray[np.float64]

_TURNS = 0.5 * (math.sqrt(5.0) - 1.0)  # c: no fraction, so that rows of grains do not repeat.


def orientations(centres: Array, radii: Array) -> Array:
    """Return the rotation of each grain of an entry, shape (n, D, D).

    Args:
        centres: [m], shape (n, D).
        radii: [m], shape (n,).
    """
    count, dimension = centres.shape
    mean = np.array([math.fsum(column) / count for column in centres.T])  # In any order the same.
    place = np.zeros((count, 3))
    place[:, :dimension] = (centres - mean) / radii[:, None]
    x, y, z = place.T
    distance = np.sqrt(x * x + y * y + z * z)
    cube = distance * distance * distance
    cube[cube == 0.0] = 1.0
    vector = np.stack(
        [y * z * (y - z) * (y + z), z * x * (z - x) * (z + x), x * y * (x - y) * (x + y)], axis=1
    )
    turns = vector * (_TURNS / cube)[:, None]
    return _rotations(turns)[:, :dimension, :dimension]


def _rotations(turns: Array) -> Array:
    """Return the rotations about vectors by their lengths in turns (Rodrigues 1840), (n, 3, 3)."""
    angle = np.sqrt((turns * turns).sum(axis=1))
    axis = turns / np.where(angle == 0.0, 1.0, angle)[:, None]
    cos, sin = cos_sin(angle)
    x, y, z = axis.T
    zero = np.zeros_like(x)
    cross = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    along = axis[:, :, None] * axis[:, None, :]
    cos, sin = cos[:, None, None], sin[:, None, None]
    rotations: Array = cos * np.eye(3) + sin * cross + (1.0 - cos) * along
    return rotations
