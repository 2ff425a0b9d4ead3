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


def ball(centre: Sequence[float], radius: float, spacing: float) -> tuple[Array, Array]:
    """Fill a disc with rings of points, a sphere with shells; the volumes make up the exact volume.

    A lattice has steps of half a spacing on the surface: a disc of it rolls like a gear wheel.
    """
    dimension = len(centre)
    shells = round(radius / spacing)
    step = radius / shells
    points, volumes = [], []
    for k in range(shells):
        middle, inner, outer = (k + 0.5) * step, k * step, (k + 1) * step
        if dimension == 2:
            volume = math.pi * (outer**2 - inner**2)
            count = max(round(volume / step**2), 3)
            turn = 2 * math.pi * (np.arange(count) + 0.5 * (k % 2)) / count
            directions = np.stack([np.cos(turn), np.sin(turn)], 1)
        else:
            volume = 4 / 3 * math.pi * (outer**3 - inner**3)
            count = max(round(volume / step**3), 4)
            z = 1 - (2 * np.arange(count) + 1) / count  # A spiral: Vogel 1979.
            turn = math.pi * (1 + math.sqrt(5)) * np.arange(count)
            across = np.sqrt(1 - z * z)
            directions = np.stack([across * np.cos(turn), across * np.sin(turn), z], 1)
        points.append(middle * directions)
        volumes.append(np.full(count, volume / count))
    return np.concatenate(points) + np.asarray(centre), np.concatenate(volumes)


def annulus(
    centre: Sequence[float], inner: float, outer: float, spacing: float
) -> tuple[Array, float]:
    """Fill a ring (with inner = 0 a disc) with the lattice of the grid, as a case file does."""
    low = np.floor((np.asarray(centre) - outer) / spacing) * spacing
    n = math.ceil(2 * outer / spacing) + 1
    x, volume = block(low, low + n * spacing, spacing)
    r = np.hypot(*(x - np.asarray(centre)).T)
    return x[(r >= inner - 1e-9) & (r <= outer + 1e-9)], volume
