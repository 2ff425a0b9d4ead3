# SPDX-License-Identifier: BSD-3-Clause
"""Which of many points or boxes are near each other, without looking at all pairs."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Pairs = tuple[NDArray[np.int64], NDArray[np.int64]]

_BLOCK = 1 << 21  # Pairs looked at together: some 100 MB of temporary arrays.
_LARGE = 4.0  # A box longer than so many median boxes is compared with all others.


def near_pairs(points: Array, reach: float) -> Pairs:
    """Return the pairs of points that may be closer than a distance, each pair once.

    The points are sorted into cells as wide as the distance; pairs of neighbouring cells are
    returned, so that some of them are farther apart.

    Args:
        points: [m], shape (n, D).
        reach: [m], > 0.

    Returns:
        Two arrays of numbers of points; in the same order for the same points.
    """
    found = list(_near_blocks(points, reach))
    return (
        np.concatenate([a for a, _ in found] or [np.zeros(0, np.int64)]),
        np.concatenate([b for _, b in found] or [np.zeros(0, np.int64)]),
    )


def _near_blocks(points: Array, reach: float) -> Iterator[Pairs]:
    if len(points) < 2:
        return
    cells = np.floor((points - points.min(axis=0)) / reach).astype(np.int64) + 1
    # The last axis counts fastest: three cells in a row are one range of keys.
    strides = np.cumprod([1, *(cells.max(axis=0) + 2)[:0:-1]])[::-1]
    keys = cells @ strides
    order = np.argsort(keys, kind="stable")
    keys = keys[order]
    own = np.arange(len(keys))
    for offset in itertools.product((-1, 0, 1), repeat=points.shape[1] - 1):
        shift = int(np.dot(offset, strides[:-1])) if offset else 0
        if shift < 0:
            continue  # Seen from the other side.
        first = np.maximum(np.searchsorted(keys, keys + shift - 1, "left"), own + 1)
        counts = np.maximum(np.searchsorted(keys, keys + shift + 1, "right") - first, 0)
        ends = np.cumsum(counts)
        start = 0
        while start < len(own):
            before = ends[start - 1] if start else 0
            stop = max(start + 1, int(np.searchsorted(ends, before + _BLOCK, "right")))
            some = counts[start:stop]
            a = np.repeat(own[start:stop], some)
            b = np.arange(len(a)) - np.repeat(np.cumsum(some) - some, some)
            b += np.repeat(first[start:stop], some)
            yield order[a], order[b]
            start = stop


def overlapping_boxes(lower: Array, upper: Array) -> Pairs:
    """Return the pairs a < b of boxes that overlap, sorted by b, then a.

    Args:
        lower, upper: corners of the boxes, shape (n, D).
    """
    edges = (upper - lower).max(axis=1)
    width = _LARGE * float(np.median(edges))
    small = np.flatnonzero(edges <= width)
    reach = max(float(edges[small].max(initial=0.0)), 1e-300)
    first: list[NDArray[np.int64]] = []
    second: list[NDArray[np.int64]] = []
    for a, b in _near_blocks(0.5 * (lower + upper)[small], reach):
        a, b = small[a], small[b]
        meet = np.all((lower[a] < upper[b]) & (upper[a] > lower[b]), axis=1)
        first.append(np.minimum(a, b)[meet])
        second.append(np.maximum(a, b)[meet])
    large = edges > width
    for k in np.flatnonzero(large):
        meet = np.all((lower < upper[k]) & (upper > lower[k]), axis=1)
        others = np.flatnonzero(meet & ~(large & (np.arange(len(edges)) <= k)))
        first.append(np.minimum(others, k))
        second.append(np.maximum(others, k))
    a = np.concatenate(first or [np.zeros(0, np.int64)])
    b = np.concatenate(second or [np.zeros(0, np.int64)])
    order = np.lexsort((a, b))
    return a[order], b[order]
