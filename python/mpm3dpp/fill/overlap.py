# SPDX-License-Identifier: BSD-3-Clause
"""Which points of two sets stand in the same place."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray


def close_particles(
    first: NDArray[np.float64], second: NDArray[np.float64], distance: float
) -> int:
    """Count the points of one set that have a point of another closer than a distance.

    The first set is sorted into cells four distances wide, so that a point of the second has to
    look into the cells that it nearly touches only.

    Args:
        first: positions [m], shape (n, D).
        second: positions [m], shape (m, D).
        distance: [m], > 0.

    Returns:
        Number of points of `second` that are closer than `distance` to a point of `first`.
    """
    first, second = _common(first, second, distance), _common(second, first, distance)
    if len(first) == 0 or len(second) == 0:
        return 0
    width = 4 * distance
    lower = np.minimum(first.min(axis=0), second.min(axis=0)) - width
    upper = np.maximum(first.max(axis=0), second.max(axis=0)) + width
    extent = np.floor((upper - lower) / width).astype(np.int64) + 1
    # The last axis counts fastest, as in a filling: then both sets are nearly sorted already.
    strides = np.cumprod([1, *extent[:0:-1]])[::-1]

    keys = np.floor((first - lower) / width).astype(np.int64) @ strides
    order = np.argsort(keys, kind="stable")
    keys, first = keys[order], first[order]

    close = np.zeros(len(second), dtype=bool)
    low = np.floor((second - distance - lower) / width).astype(np.int64)
    high = np.floor((second + distance - lower) / width).astype(np.int64)
    for corner in itertools.product((0, 1), repeat=second.shape[1]):
        # A cell is looked into once: the upper choice only along axes where it is another cell.
        chosen = np.flatnonzero(~close & np.all((high > low) | (np.array(corner) == 0), axis=1))
        cells = np.where(np.array(corner) == 1, high[chosen], low[chosen]) @ strides
        start = np.searchsorted(keys, cells, "left")
        end = np.searchsorted(keys, cells, "right")
        for step in range(int((end - start).max(initial=0))):
            has = start + step < end
            gaps = first[(start + step)[has]] - second[chosen[has]]
            close[chosen[has]] |= np.einsum("ij,ij->i", gaps, gaps) < distance**2
    return int(close.sum())


def _common(
    points: NDArray[np.float64], others: NDArray[np.float64], distance: float
) -> NDArray[np.float64]:
    """Return the points within the bounds of the others, which are widened by a distance."""
    lower, upper = others.min(axis=0) - distance, others.max(axis=0) + distance
    return points[np.all((points >= lower) & (points <= upper), axis=1)]
