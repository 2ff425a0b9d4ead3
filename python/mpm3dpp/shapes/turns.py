# SPDX-License-Identifier: BSD-3-Clause
"""Cosines, sines and cube roots by sums and products alone: the same bits on every processor.

Those of libraries differ in their last bits from one processor to another, and a run's bits are to
depend on its case alone.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_TERMS = 9  # Of each series: what is left out is below (pi / 4)^18 / 18! = 2e-18.


def cos_sin(turns: Array) -> tuple[Array, Array]:
    """Return cosine and sine of angles given in whole turns, by their series about quarter turns.

    Args:
        turns: any shape; 1 is 360 degrees.
    """
    quarters = np.rint(4.0 * turns)
    x = (turns - 0.25 * quarters) * (2.0 * math.pi)  # From -pi / 4 to pi / 4.
    square = x * x
    cos, sin = np.ones_like(x), np.ones_like(x)
    for k in range(_TERMS, 0, -1):
        cos = 1.0 - cos * square / ((2 * k - 1) * 2 * k)
        sin = 1.0 - sin * square / (2 * k * (2 * k + 1))
    sin = sin * x
    quarter = quarters % 4
    odd = quarter % 2 == 1
    first, second = np.where(odd, sin, cos), np.where(odd, cos, sin)
    return (
        np.where((quarter == 1) | (quarter == 2), -first, first),
        np.where(quarter >= 2, -second, second),
    )


def cube_root(values: Array) -> Array:
    """Return the cube roots of numbers > 0 and <= 1, by Newton's method."""
    root = np.ones_like(values)
    for _ in range(120):  # From far above each step takes a third off; the last ones double digits.
        root = (2.0 * root + values / (root * root)) / 3.0
    return root


def turned(points: Array, matrix: Array) -> Array:
    """Return points times the transpose of a matrix, shape (n, D): each point is turned by it."""
    columns = [sum(points[:, j] * row[j] for j in range(len(row))) for row in matrix]
    return np.stack(columns, axis=1)
