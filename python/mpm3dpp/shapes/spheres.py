# SPDX-License-Identifier: BSD-3-Clause
"""Spheres filled by points on concentric shells.

All points have the same volume. A shell between radii a and b with its points at the radius rho has
its exact volume and polar second moment if rho^2 = 3 (b^5 - a^5) / (5 (b^3 - a^3)). The points of a
shell are mapped onto one another by all turns and reflections of a cube, so that the centre is
exact and the inertia tensor isotropic. They stand on the six faces of a cube that is blown up to
the sphere by a map that keeps areas (Rosca & Plonka 2011, "Uniform spherical grids via equal area
projection from the cube to the sphere"), in square rings: with m^2 points on a face those are the
points of a square lattice.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from .circles import nearest_count
from .turns import cos_sin, cube_root

Array = NDArray[np.float64]

# Shells of few points, the corners of known bodies, each up to so many points that are wanted.
_FEW = ((7.0, 6), (10.0, 8), (13.0, 12), (19.0, 14))


def shell_counts(radius: float, spacing: float, off_planes: bool = False) -> list[int]:
    """Return how many points each shell has, from the inside; none below half a spacing.

    Each shell is about `spacing` thick, and there is about a point for each cube of the spacing.

    Args:
        radius, spacing: [m].
        off_planes: whether none is to lie on the planes between two axes.
    """
    shells, possible = nearest_count(radius / spacing), _off_planes if off_planes else _possible
    size = radius / spacing
    points = 4.0 / 3.0 * math.pi * size * size * size
    counts: list[int] = []
    total = 0
    for k in range(1, shells + 1):
        counts.append(possible(points * (k / shells) * (k / shells) * (k / shells) - total))
        total += counts[-1]
    return counts


def _possible(wanted: float) -> int:
    """Return the nearest number of points that a shell can have."""
    for most, count in _FEW:
        if wanted < most:
            return count
    even, odd = 24 * nearest_count(wanted / 24), 24 * nearest_count((wanted - 6) / 24) + 6
    nearest = even if abs(even - wanted) <= abs(odd - wanted) else odd
    return 54 if nearest == 48 else nearest  # Eight points spread badly over a face.


def _off_planes(wanted: float) -> int:
    """Return the nearest number of points that a shell can have beside the planes of the axes."""
    return 8 if wanted < 16.0 else 24 * nearest_count(wanted / 24)


def ball_shell(radius: float, spacing: float, shell: int, off_planes: bool = False) -> Array:
    """Return the points of a shell, of the same volume in all, about zero [m], shape (n, 3).

    Args:
        radius: of the sphere [m].
        spacing: about the distance of the points [m].
        shell: its number, from the inside.
        off_planes: whether none is to lie on the planes between two axes.
    """
    counts = shell_counts(radius, spacing, off_planes)
    inner, total = sum(counts[:shell]), sum(counts)
    b = float(cube_root(np.array([(inner + counts[shell]) / total]))[0])
    a = float(cube_root(np.array([inner / total]))[0]) if inner else 0.0
    above, below = b * b * (b * b + a * b + a * a) + a * a * a * (a + b), b * b + a * b + a * a
    return radius * math.sqrt(0.6 * above / below) * directions(counts[shell], off_planes)


def directions(count: int, off_planes: bool = False) -> Array:
    """Return unit vectors evenly spread over the sphere, as symmetric as a cube, shape (n, 3).

    Args:
        count: 6, 8, 12, 14, or a multiple of 24 or 6 more than one.
        off_planes: whether none is to lie on the planes between two axes; for 8 and multiples of
            24.
    """
    units = np.eye(3)
    if count == 6:
        return np.concatenate([units, -units])
    if count in (8, 14):
        corners = np.array(list(itertools.product((1.0, -1.0), repeat=3))) * math.sqrt(1 / 3)
        return corners if count == 8 else np.concatenate([directions(6), corners])
    if count == 12:
        pairs = [(units[k], units[k - 1]) for k in range(3)]
        ends = [s * u + t * v for u, v in pairs for s in (1, -1) for t in (1, -1)]
        return np.array(ends) * math.sqrt(0.5)
    face = _face(count // 6, off_planes)
    return np.concatenate([sign * np.roll(face, k, axis=1) for k in range(3) for sign in (1, -1)])


def _face(count: int, off_planes: bool) -> Array:
    """Return the points of the face x = 1, shape (n, 3); one is in its middle if n is odd."""
    middle = count % 4
    rings = math.ceil((math.sqrt(count) - middle) / 2 - 1e-9)
    sides = [np.zeros((0, 2))]
    before = middle
    for j in range(1, rings + 1):
        edge = (2 * j + middle) / (2 * rings + middle)
        upto = middle + 4 * nearest_count((edge * edge * count - middle) / 4)
        place = 0.5 * (math.sqrt(before / count) + math.sqrt(upto / count))
        each = (upto - before) // 4
        # Of an even number beginning at a corner one is in the middle of the side.
        begin = 0.5 if off_planes and each % 2 == 0 else 0.0
        along = (np.arange(each) + begin) * (2.0 / max(each, 1)) - 1.0
        sides.append(place * np.stack([np.ones(each), along], axis=1))
        before = upto
    x, y = _equal_area(np.concatenate(sides)).T
    quarters = [(x, y), (-y, x), (-x, -y), (y, -x)]
    points = np.concatenate([np.zeros((middle, 2)), *(np.stack(q, axis=1) for q in quarters)])
    square = (points * points).sum(axis=1)
    rise = np.sqrt(1.0 - square / 4.0)
    return np.column_stack([1.0 - square / 2.0, rise * points[:, 0], rise * points[:, 1]])


def _equal_area(points: Array) -> Array:
    """Map points (u, v) with |v| <= u <= 1 of a face to Lambert's equal-area plane, shape (n, 2).

    Rosca & Plonka 2011, eq. (9), with u over the half edge of the face.
    """
    u, v = points.T
    cos, sin = cos_sin(v / u / 24.0)
    root = math.sqrt(2.0)
    scale = math.sqrt(root) * u / np.sqrt(root - cos)
    return np.stack([scale * (root * cos - 1.0), scale * root * sin], axis=1)
