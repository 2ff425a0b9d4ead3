# SPDX-License-Identifier: BSD-3-Clause
"""The middle of points, of which several processes may have some each."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
_BITS, _HALF = 52, 26


def middle(points: Array, world: Any = None) -> Array:
    """Return the mean of points, shape (D,): the same bits however they are ordered and shared out.

    Coordinates are counted in parts of 2^-52 of the largest one, and these added as integers.

    Args:
        points: shape (n, D), those that this process has.
        world: `mpm3dpp.ranks.world.World` if others have others; they call this at once.
    """
    reach = np.array([np.abs(points).max(initial=0.0)])
    if world is not None:
        world.all_max(reach)
    unit = 2.0 ** (math.frexp(reach[0])[1] - _BITS)
    units = np.rint(points / unit).astype(np.int64)
    sums = np.array(
        [*(units >> _HALF).sum(axis=0), *(units & (2**_HALF - 1)).sum(axis=0), len(points)]
    )
    if world is not None:
        world.all_sum(sums)
    *halves, count = (int(number) for number in sums)
    dimension = points.shape[1]
    wholes = [(halves[d] << _HALF) + halves[dimension + d] for d in range(dimension)]
    return np.array([whole / count * unit for whole in wholes])


def mass_centre(points: Array, volumes: Array, world: Any = None) -> Array:
    """Return the mean of points, weighted by their volumes, shape (D,).

    Args:
        points: shape (n, D).
        volumes: shape (n,); all are equal if others have others.
        world: see `middle`.
    """
    if world is not None or bool(np.all(volumes == volumes[0])):
        return middle(points, world)
    return np.asarray(np.average(points, axis=0, weights=volumes))
