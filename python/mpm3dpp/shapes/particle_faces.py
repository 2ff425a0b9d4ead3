# SPDX-License-Identifier: BSD-3-Clause
"""The surface of a body that is known by its particles alone: the free faces of their cubes."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from .surface_parts import Surface

Array = NDArray[np.float64]
Cubes = NDArray[np.int64]
_OFF_LATTICE = 0.05
"""Spacings by which a particle on a lattice may be off it: numbers in files are short."""


def faces(positions: Array, spacing: float, side: str) -> Surface:
    """Return the free faces of the particles' cubes.

    Particles on a lattice along the axes have its cubes, any others the cubes of a lattice in
    which they lie, with the gaps between these. So what is oblique or round has steps: its area
    vectors add up to those of the surface, their lengths to more. `all` is closed.

    Args:
        positions: of the particles [m], shape (n, D).
        spacing: edge of the cubes [m].
        side: `x_min` to `z_max`, the faces that look that way; or `all`.
    """
    dimension = positions.shape[1]
    lowest = positions.min(axis=0)
    places = (positions - lowest) / spacing
    cubes = np.unique(np.rint(places).astype(np.int64), axis=0)
    if np.abs(places - np.rint(places)).max() > _OFF_LATTICE:
        cubes = _closed(cubes)
    points, areas = [], []
    for axis, sign in itertools.product(range(dimension), (-1, 1)):
        if side not in (f"{'xyz'[axis]}_{'min' if sign < 0 else 'max'}", "all"):
            continue
        way = sign * np.eye(dimension, dtype=np.int64)[axis]
        free = cubes[~_among(cubes + way, cubes)]
        points.append(lowest + spacing * (free + 0.5 * way))
        areas.append(np.tile(spacing ** (dimension - 1) * way, (len(free), 1)))
    return Surface(np.concatenate(points), np.concatenate(areas))


def _among(wanted: Cubes, cubes: Cubes) -> NDArray[np.bool_]:
    """Return which of some cubes are among others."""
    both = np.concatenate([cubes, wanted])
    _, number = np.unique(both, axis=0, return_inverse=True)
    number = number.ravel()
    return np.isin(number[len(cubes) :], number[: len(cubes)])


def _closed(cubes: Cubes) -> Cubes:
    """Return the cubes with those between them that no particle happens to lie in.

    A closing by the cube of 3^D cubes, Serra (1982): gaps of a cube or two are filled, a plane
    surface stays where it is.
    """
    around = list(itertools.product((-1, 0, 1), repeat=cubes.shape[1]))
    grown = np.unique(np.concatenate([cubes + np.array(way) for way in around]), axis=0)
    kept = np.ones(len(grown), dtype=np.bool_)
    for way in around:
        kept &= _among(grown + np.array(way), grown)
    return grown[kept]
