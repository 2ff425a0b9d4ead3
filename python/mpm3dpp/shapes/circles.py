# SPDX-License-Identifier: BSD-3-Clause
"""Discs and rings filled by points on concentric circles, and cylinders by layers of these.

All points of a body have the same volume, its share of the shape's. A ring between two radii a and
b with n points, evenly spread on a circle, has its exact area and its exact polar second moment if
the circle's radius is sqrt((a^2 + b^2) / 2). Radii between rings are such that the areas are as the
numbers of points; these are multiples of four, so that the axes and the diagonals are axes of
symmetry and both second moments are equal. So area, centre and second moments are exact.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from .turns import cos_sin

Array = NDArray[np.float64]
_SLACK = 1e-9  # A number so little below the half of two whole ones is rounded up too.


def nearest_count(size: float) -> int:
    """Return the nearest whole number, the upper one for halves; the same however it is rounded."""
    return math.floor(size + 0.5 + _SLACK)


def circle_counts(inner: float, outer: float, spacing: float) -> Array:
    """Return how many points the circles up to each hold, from 0 on, shape (circles + 1,).

    Each ring is about `spacing` thick, and there is about a point for each square of the spacing.

    Args:
        inner, outer: radii [m]; inner is 0 for a disc.
        spacing: [m].

    Returns:
        Multiples of 4; [0] if the ring is thinner than half a spacing.
    """
    rings = nearest_count((outer - inner) / spacing)
    counts = np.zeros(rings + 1)
    for k in range(1, rings + 1):
        bound = inner + (outer - inner) * k / rings
        area = math.pi * (bound - inner) * (bound + inner) / (spacing * spacing)
        counts[k] = max(counts[k - 1] + 4, 4 * nearest_count(area / 4))
    return counts


def circles(inner: float, outer: float, spacing: float, off_axes: bool = False) -> Array:
    """Return points of equal area that fill a ring about zero [m], shape (n, 2).

    The points of the outermost circle lie half a step beside the axes, those of the next on them,
    and so on in turn.

    Args:
        inner, outer: radii [m]; inner is 0 for a disc.
        spacing: about the distance of the points [m].
        off_axes: whether all lie half a step beside the axes, none on them.
    """
    shells = len(circle_counts(inner, outer, spacing)) - 1
    found = [circle(inner, outer, spacing, k, off_axes) for k in range(shells)]
    return np.concatenate([np.zeros((0, 2)), *found])


def circle(
    inner: float, outer: float, spacing: float, number: int, off_axes: bool = False
) -> Array:
    """Return the points of one of the circles of `circles`, from the inside, shape (n, 2)."""
    counts = circle_counts(inner, outer, spacing)
    k = number + 1
    share = (counts[k] + counts[k - 1]) / (2.0 * counts[-1])
    radius = math.sqrt(inner * inner + (outer - inner) * (outer + inner) * share)
    offset = 0.5 if off_axes or (len(counts) - 1 - k) % 2 == 0 else 0.0
    return radius * _circle(int(counts[k] - counts[k - 1]), offset)


def _circle(count: int, offset: float) -> Array:
    """Return a multiple of four directions, an `offset` of a step from the axes, shape (n, 2)."""
    cos, sin = cos_sin((np.arange(count // 4) + offset) / count)
    parts = [(cos, sin), (-sin, cos), (-cos, -sin), (sin, -cos)]
    return np.concatenate([np.stack(part, axis=1) for part in parts])


def layer_places(height: float, spacing: float) -> Array:
    """Return where layers of equal thickness stand along an axis, about zero [m], shape (m,).

    Their middles are moved apart, all in proportion, so that their second moment is that of the
    whole height; so there are two layers at least.

    Args:
        height: [m].
        spacing: about the thickness of a layer [m].

    Returns:
        None at all if the height is less than half a spacing.
    """
    if nearest_count(height / spacing) == 0:
        return np.zeros(0)
    layers = max(2, nearest_count(height / spacing))
    # Middles (l + 1/2 - m / 2) height / m have the second moment height^2 (1 - 1 / m^2) / 12.
    apart = height / math.sqrt(layers * layers - 1.0)
    return np.asarray((np.arange(layers) + 0.5 - 0.5 * layers) * apart, dtype=np.float64)
