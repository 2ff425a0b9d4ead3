# SPDX-License-Identifier: BSD-3-Clause
"""The named sides of shapes, as points with area vectors.

Box: `x_min` to `z_max`. Disc, sphere: `outer`. Ring: `inner`, `outer`. Cylinder, tube: `outer`,
`lower`, `upper` (the ends, along the axis), and `inner` of a tube. All of them: `all`. A shape that
is moved or turned keeps the names of its sides.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .base import Shape
from .primitives import AXES, Box, Cylinder, Disc, Ring, Sphere, Tube
from .transforms import Rotate, Translate

Array = NDArray[np.float64]
AXIS_NAMES = "xyz"


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


def sides(shape: Shape, dimension: int) -> list[str]:
    """Return the names of a shape's sides; none if it is combined of others."""
    if isinstance(shape, Translate | Rotate):
        return sides(shape.shape, dimension)
    if isinstance(shape, Box):
        return [f"{a}_{end}" for a in AXIS_NAMES[:dimension] for end in ("min", "max")] + ["all"]
    if isinstance(shape, Tube):
        return ["outer", "inner", "lower", "upper", "all"]
    if isinstance(shape, Cylinder):
        return ["outer", "lower", "upper", "all"]
    if isinstance(shape, Ring):
        return ["outer", "inner", "all"]
    return ["outer", "all"] if isinstance(shape, Disc) else []


def surface(shape: Shape, side: str, step: float) -> Surface:
    """Return a side of a shape as points about `step` [m] apart.

    Args:
        shape: one that has sides.
        side: one of `sides(shape, D)`.
        step: [m].
    """
    if side == "all":
        names = sides(shape, len(shape.bounds()[0]))[:-1]
        parts = [surface(shape, name, step) for name in names]
        return Surface(
            np.concatenate([p.points for p in parts]), np.concatenate([p.areas for p in parts])
        )
    if isinstance(shape, Translate):
        own = surface(shape.shape, side, step)
        return Surface(own.points + np.array(shape.by), own.areas)
    if isinstance(shape, Rotate):
        own = surface(shape.shape, side, step)
        back, about = shape.matrix().T, shape.centre()
        return Surface((own.points - about) @ back + about, own.areas @ back)
    if isinstance(shape, Box):
        return _box(shape, side, step)
    if isinstance(shape, Cylinder | Tube):
        return _cylinder(shape, side, step)
    radius, sign = _radius(shape, side)
    centre = np.array(shape.centre)  # type: ignore[attr-defined]
    ball = _sphere(radius, step) if isinstance(shape, Sphere) else _circle(radius, step)
    return Surface(centre + ball.points, sign * ball.areas)


def _radius(shape: Shape, side: str) -> tuple[float, float]:
    """Return the radius of a round side and the sign of its normal."""
    if isinstance(shape, Ring | Tube):
        return (shape.inner_radius, -1.0) if side == "inner" else (shape.outer_radius, 1.0)
    return shape.radius, 1.0  # type: ignore[attr-defined]


def _count(length: float, step: float) -> int:
    """Return how many parts about as long as `step` a length has; exact for whole numbers."""
    return max(1, math.ceil(length / step - 1e-6))


def _middles(lower: float, upper: float, step: float) -> Array:
    count = _count(upper - lower, step)
    return np.asarray(lower + (np.arange(count) + 0.5) * ((upper - lower) / count))


def _box(shape: Box, side: str, step: float) -> Surface:
    lower, upper = shape.bounds()
    normal, end = AXIS_NAMES.index(side[0]), side[2:]
    axes = [_middles(low, up, step) for low, up in zip(lower, upper, strict=True)]
    axes[normal] = np.array([lower[normal] if end == "min" else upper[normal]])
    points = np.stack([x.ravel() for x in np.meshgrid(*axes, indexing="ij")], axis=1)
    edges = np.delete(upper - lower, normal)
    areas = np.zeros_like(points)
    areas[:, normal] = (-1.0 if end == "min" else 1.0) * np.prod(edges) / len(points)
    return Surface(points, areas)


def _circle(radius: float, step: float) -> Surface:
    """Return a circle about zero; a multiple of 8 points, so that it is as symmetric as a grid."""
    count = 8 * _count(2 * math.pi * radius / 8, step)
    angle = (np.arange(count) + 0.5) * (2 * math.pi / count)
    normals = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Surface(radius * normals, (2 * math.pi * radius / count) * normals)


def _sphere(radius: float, step: float) -> Surface:
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


def _cylinder(shape: Cylinder | Tube, side: str, step: float) -> Surface:
    axis, centre = AXES[shape.axis], np.array(shape.centre)
    if side in ("outer", "inner"):
        radius, sign = _radius(shape, side)
        ring = _circle(radius, step)
        along = _middles(-shape.height / 2, shape.height / 2, step)
        points = np.repeat(ring.points, len(along), axis=0)
        areas = np.repeat(ring.areas, len(along), axis=0) * (sign * shape.height / len(along))
        places = np.tile(along, len(ring.points))
        rises = np.zeros(len(points))
    else:
        inner, outer = (
            (shape.inner_radius, shape.outer_radius)
            if isinstance(shape, Tube)
            else (
                0.0,
                shape.radius,
            )
        )
        count = _count(outer - inner, step)
        width = (outer - inner) / count
        rings = [_circle(inner + (k + 0.5) * width, step) for k in range(count)]
        points = np.concatenate([ring.points for ring in rings])
        areas = np.zeros_like(points)
        sizes = [np.linalg.norm(ring.areas, axis=1) * width for ring in rings]
        sign = 1.0 if side == "upper" else -1.0
        places = np.full(len(points), sign * shape.height / 2)
        rises = sign * np.concatenate(sizes)
    return Surface(
        centre + np.insert(points, axis, places, axis=1), np.insert(areas, axis, rises, axis=1)
    )
