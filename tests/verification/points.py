# SPDX-License-Identifier: BSD-3-Clause
"""Bodies as points: blocks, balls and rings, with the volume of each point."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

Array = np.ndarray


def block(lower: Sequence[float], upper: Sequence[float], spacing: float) -> tuple[Array, float]:
    """Fill a box with points `spacing` apart [m]; return them (n, D) and the volume of each."""
    axes = []
    for low, high in zip(lower, upper, strict=True):
        count = max(1, round((high - low) / spacing))
        axes.append(low + (np.arange(count) + 0.5) * spacing)
    grid = np.meshgrid(*axes, indexing="ij")
    return np.stack([a.ravel() for a in grid], axis=1), spacing ** len(axes)


def ball(centre: Sequence[float], radius: float, spacing: float) -> tuple[Array, float]:
    """Fill a disc or sphere with a lattice centred on it; the volumes make up the exact volume."""
    n = math.ceil(radius / spacing)
    x, _ = block([-n * spacing] * len(centre), [n * spacing] * len(centre), spacing)
    x = x[(x * x).sum(1) <= radius * radius]
    volume = math.pi * radius**2 if len(centre) == 2 else 4.0 / 3.0 * math.pi * radius**3
    return x + np.asarray(centre), volume / len(x)


def annulus(
    centre: Sequence[float], inner: float, outer: float, spacing: float
) -> tuple[Array, float]:
    """Fill a ring (with inner = 0 a disc) with the lattice of the grid, as a case file does."""
    low = np.floor((np.asarray(centre) - outer) / spacing) * spacing
    n = math.ceil(2 * outer / spacing) + 1
    x, volume = block(low, low + n * spacing, spacing)
    r = np.hypot(*(x - np.asarray(centre)).T)
    return x[(r >= inner - 1e-9) & (r <= outer + 1e-9)], volume
