# SPDX-License-Identifier: BSD-3-Clause
"""Parts of surfaces as points with area vectors: lines, circles, spheres, cones, arcs that turn.

What is round about an axis lies about z and zero; `placed` brings it to its axis and centre.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Surface:
    """Points of a surface, evenly spread.

    Attributes:
        points: [m], shape (n, D).
        areas: outward area vectors [m^2; in 2D m times 1 m], shape (n, D); their lengths add up to
            the area of the surface.
    """

    points: Array
    areas: Array


def joined(parts: Iterable[Surface]) -> Surface:
    """Return surfaces as one."""
    found = list(parts)
    points = np.concatenate([part.points for part in found])
    return Surface(points, np.concatenate([part.areas for part in found]))


def reverse(surface: Surface) -> Surface:
    """Return a surface seen from its other side."""
    return Surface(surface.points, -surface.areas)


def _count(length: float, step: float) -> int:
    """Return how many parts about as long as `step` a length has; exact for whole numbers."""
    return max(1, math.ceil(length / step - 1e-6))


def middles(lower: float, upper: float, step: float) -> Array:
    """Return the middles of equal parts of a length, about as long as `step` [m]."""
    count = _count(upper - lower, step)
    return np.asarray(lower + (np.arange(count) + 0.5) * ((upper - lower) / count))


def line(start: Array, end: Array, step: float) -> Surface:
    """Return a straight line in the plane; its normal points to the right of the way along it."""
    way = end - start
    length = float(np.hypot(*way))
    along = middles(0.0, length, step)
    points = start + np.multiply.outer(along / length, way)
    return Surface(points, np.tile(np.array([way[1], -way[0]]) / len(along), (len(along), 1)))


def circle(radius: float, step: float) -> Surface:
    """Return a circle about zero; a multiple of 8 points, so that it is as symmetric as a grid."""
    count = 8 * _count(2 * math.pi * radius / 8, step)
    angle = (np.arange(count) + 0.5) * (2 * math.pi / count)
    normals = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Surface(radius * normals, (2 * math.pi * radius / count) * normals)


def sphere(radius: float, step: float) -> Surface:
    """Return a sphere about zero: six faces of a cube with equal angles, as symmetric as a grid."""
    count = 2 * _count(math.pi * radius / 4, step)
    angle = (np.arange(count) + 0.5) * (math.pi / 2 / count) - math.pi / 4
    u, v = (np.tan(x).ravel() for x in np.meshgrid(angle, angle, indexing="ij"))
    # The solid angle of a cell with equal angles: (1 + u^2)(1 + v^2) / (1 + u^2 + v^2)^(3/2).
    weight = (1 + u**2) * (1 + v**2) / (1 + u**2 + v**2) ** 1.5
    face = np.stack([np.ones_like(u), u, v], axis=1) / np.sqrt(1 + u**2 + v**2)[:, None]
    normals = np.concatenate(
        [sign * np.roll(face, k, axis=1) for k in range(3) for sign in (1, -1)]
    )
    weights = np.tile(weight * (4 * math.pi * radius**2 / (6 * weight.sum())), 6)
    return Surface(radius * normals, weights[:, None] * normals)


def wall(radius: float, lower: float, upper: float, step: float) -> Surface:
    """Return the curved side of a cylinder between two heights, seen from outside."""
    ring, along = circle(radius, step), middles(lower, upper, step)
    points = np.repeat(ring.points, len(along), axis=0)
    areas = np.repeat(ring.areas, len(along), axis=0) * ((upper - lower) / len(along))
    places = np.tile(along, len(ring.points))
    return Surface(
        np.column_stack([points, places]), np.column_stack([areas, np.zeros_like(places)])
    )


def annulus(inner: float, outer: float, height: float, step: float) -> Surface:
    """Return a plane ring at a height, or a disc where the inner radius is 0, seen from above."""
    count = _count(outer - inner, step)
    width = (outer - inner) / count
    rings = [circle(inner + (k + 0.5) * width, step) for k in range(count)]
    points = np.concatenate([ring.points for ring in rings])
    sizes = np.concatenate([np.linalg.norm(ring.areas, axis=1) * width for ring in rings])
    places, level = np.full(len(points), height), np.zeros_like(points)
    return Surface(np.column_stack([points, places]), np.column_stack([level, sizes]))


def _turned_band(radius: float, height: float, across: float, along: float, step: float) -> Surface:
    """Return a narrow band about z with sums of its areas, across the axis and along it [m^2]."""
    ring = circle(radius, step)
    share = ring.areas / (2 * math.pi * radius)  # of the whole circle
    places = np.full(len(share), height)
    rises = np.full(len(share), along / len(share))
    return Surface(np.column_stack([ring.points, places]), np.column_stack([across * share, rises]))


def cone(lower_radius: float, upper_radius: float, height: float, step: float) -> Surface:
    """Return the inclined side of a frustum that stands on z = 0, seen from outside."""
    widening = upper_radius - lower_radius
    count = _count(math.hypot(widening, height), step)
    bands = []
    for share in (np.arange(count) + 0.5) / count:
        radius = lower_radius + share * widening
        around = 2 * math.pi * radius / count
        # A line that turns about the axis: the area is exact with the radius of its middle.
        bands.append(
            _turned_band(radius, share * height, around * height, -around * widening, step)
        )
    return joined(bands)


def ogive(radius: float, arc: float, length: float, step: float) -> Surface:
    """Return a tangent ogive of a base radius that stands on z = 0, its tip above, from outside.

    Args:
        radius: of the base [m].
        arc: radius of the arc that turns about the axis [m].
        length: from the base to the tip [m].
        step: [m].
    """
    last = math.asin(min(1.0, length / arc))
    edges = np.linspace(0.0, last, _count(arc * last, step) + 1)
    bands = []
    for low, high in itertools.pairwise(edges):
        radii = [arc * math.cos(angle) - (arc - radius) for angle in (low, high)]
        # Pappus: 2 pi times the integral of the radius over the arc.
        area = arc * (math.sin(high) - math.sin(low)) - (arc - radius) * (high - low)
        area *= 2 * math.pi * arc
        along = math.pi * (radii[0] ** 2 - radii[1] ** 2)
        middle = (low + high) / 2
        at, height = arc * math.cos(middle) - (arc - radius), arc * math.sin(middle)
        across = math.sqrt(area**2 - along**2)
        bands.append(_turned_band(at, height, across, along, step))
    return joined(bands)


def placed(surface: Surface, axis: int, centre: Iterable[float], sign: float = 1.0) -> Surface:
    """Return a surface about z as one about another axis through a centre.

    Args:
        surface: about z.
        axis: 0 to 2.
        centre: [m].
        sign: -1 if what is up looks against the axis.
    """

    def at_axis(vectors: Array) -> Array:
        return np.insert(vectors[:, :2], axis, sign * vectors[:, 2], axis=1)

    return Surface(np.array(centre) + at_axis(surface.points), at_axis(surface.areas))
