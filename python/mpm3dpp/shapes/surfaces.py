# SPDX-License-Identifier: BSD-3-Clause
"""The named sides of shapes, as points with area vectors.

A shape that is moved or turned keeps the names of its sides. Of a union, difference or intersection
the side `1.outer` is what is left on its surface of the side `outer` of the shape with the number
1, counted from 0. `all` is the whole surface of any shape.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .base import Shape
from .booleans import Difference, Intersection, Union
from .inclined import Frustum, Funnel, Polygon
from .ogive import OgiveRod
from .primitives import AXES, Box, Cylinder, Disc, Ring, Sphere, Tube
from .surface_parts import (
    Surface,
    annulus,
    circle,
    cone,
    joined,
    line,
    middles,
    ogive,
    placed,
    reverse,
    sphere,
    wall,
)
from .transforms import Rotate, Translate

Array = NDArray[np.float64]
Sides = dict[str, Callable[[float], Surface]]
"""Names, and what draws each with points a step [m] apart."""
Combined = Union | Difference | Intersection
AXIS_NAMES = "xyz"
_CUT = {2: 16, 3: 2}
"""How much finer a side is drawn of which another shape has cut a part off, in 2D and 3D."""


def sides(shape: Shape) -> list[str]:
    """Return the names of a shape's sides; the last is `all`."""
    if isinstance(shape, Translate | Rotate):
        return sides(shape.shape)
    if isinstance(shape, Combined):
        return [f"{k}.{side}" for k, one in enumerate(shape.shapes) for side in sides(one)] + [
            "all"
        ]
    return [*_DRAWN[type(shape)](shape), "all"]


def surface(shape: Shape, side: str, step: float) -> Surface:
    """Return a side of a shape as points about `step` [m] apart.

    Args:
        shape: any.
        side: one of `sides(shape)`.
        step: [m].

    Returns:
        The area of a side is exact, but where another shape cuts a part off. `all` is closed, its
        area vectors add up to zero: what cuts leave open is spread over it.
    """
    found = _drawn(shape, side, step)
    inner = shape
    while isinstance(inner, Translate | Rotate):
        inner = inner.shape
    if side != "all" or not isinstance(inner, Combined) or not len(found.points):
        return found
    sizes = np.linalg.norm(found.areas, axis=1, keepdims=True)
    left_open = found.areas.sum(axis=0)
    return Surface(found.points, found.areas - sizes / sizes.sum() * left_open)


def _drawn(shape: Shape, side: str, step: float) -> Surface:
    if isinstance(shape, Translate):
        own = _drawn(shape.shape, side, step)
        return Surface(own.points + np.array(shape.by), own.areas)
    if isinstance(shape, Rotate):
        own = _drawn(shape.shape, side, step)
        back, about = shape.matrix().T, shape.centre()
        return Surface((own.points - about) @ back + about, own.areas @ back)
    if isinstance(shape, Combined):
        numbers = range(len(shape.shapes)) if side == "all" else [int(side.split(".")[0])]
        below = "all" if side == "all" else side.split(".", 1)[1]
        return joined(_left_of(shape, number, below, step) for number in numbers)
    known = _DRAWN[type(shape)](shape)
    if side == "all":
        return joined(draw(step) for draw in known.values())
    return known[side](step)


def _left_of(shape: Combined, number: int, side: str, step: float) -> Surface:
    """Return what is left of a side of one of the shapes on the surface of all."""

    def keep(drawn: Surface, reach: float) -> NDArray[np.bool_]:
        outwards = drawn.areas * (reach / np.linalg.norm(drawn.areas, axis=1, keepdims=True))
        behind, before = drawn.points - outwards, drawn.points + outwards
        kept = shape.contains(behind) & ~shape.contains(before)
        for earlier in shape.shapes[:number]:
            # Where the surfaces of two lie in one another the first of them counts.
            kept &= earlier.contains(behind) == earlier.contains(before)
        return kept

    def draw(width: float) -> Surface:
        own = _drawn(shape.shapes[number], side, width)
        return reverse(own) if isinstance(shape, Difference) and number > 0 else own

    drawn = draw(step)
    kept = keep(drawn, 0.01 * step)
    if kept.any() and not kept.all():
        finer = step / _CUT[drawn.points.shape[1]]
        drawn = draw(finer)
        kept = keep(drawn, 0.01 * finer)
    return Surface(drawn.points[kept], drawn.areas[kept])


def _box(shape: Box) -> Sides:
    lower, upper = shape.bounds()

    def draw(normal: int, end: int, step: float) -> Surface:
        axes = [middles(low, up, step) for low, up in zip(lower, upper, strict=True)]
        axes[normal] = np.array([(lower, upper)[end][normal]])
        points = np.stack([x.ravel() for x in np.meshgrid(*axes, indexing="ij")], axis=1)
        edges = np.delete(upper - lower, normal)
        areas = np.zeros_like(points)
        areas[:, normal] = (-1.0, 1.0)[end] * np.prod(edges) / len(points)
        return Surface(points, areas)

    return {
        f"{AXIS_NAMES[normal]}_{name}": partial(draw, normal, end)
        for normal in range(len(lower))
        for end, name in enumerate(("min", "max"))
    }


def _moved(drawn: Surface, shape: Any) -> Surface:
    return Surface(np.array(shape.centre) + drawn.points, drawn.areas)


def _disc(shape: Disc) -> Sides:
    return {"outer": lambda step: _moved(circle(shape.radius, step), shape)}


def _sphere(shape: Sphere) -> Sides:
    return {"outer": lambda step: _moved(sphere(shape.radius, step), shape)}


def _ring(shape: Ring) -> Sides:
    return {
        "outer": lambda step: _moved(circle(shape.outer_radius, step), shape),
        "inner": lambda step: _moved(reverse(circle(shape.inner_radius, step)), shape),
    }


def _cylinder(shape: Cylinder | Tube) -> Sides:
    half = shape.height / 2
    inner = shape.inner_radius if isinstance(shape, Tube) else 0.0
    outer = shape.outer_radius if isinstance(shape, Tube) else shape.radius

    def at(drawn: Surface) -> Surface:
        return placed(drawn, AXES[shape.axis], shape.centre)

    found: Sides = {"outer": lambda step: at(wall(outer, -half, half, step))}
    if isinstance(shape, Tube):
        found["inner"] = lambda step: at(reverse(wall(inner, -half, half, step)))
    return found | {
        "lower": lambda step: at(reverse(annulus(inner, outer, -half, step))),
        "upper": lambda step: at(annulus(inner, outer, half, step)),
    }


def _polygon(shape: Polygon) -> Sides:
    corners = [np.array(point) for point in shape.points]
    ends = [*corners[1:], corners[0]]

    def draw(start: Array, end: Array, step: float) -> Surface:
        drawn = line(start, end, step)
        return drawn if shape.is_anticlockwise() else reverse(drawn)

    return {
        f"side_{k}": partial(draw, start, end)
        for k, (start, end) in enumerate(zip(corners, ends, strict=True))
        if (start != end).any()
    }


def _frustum(shape: Frustum) -> Sides:
    low, high = shape.lower_radius, shape.upper_radius

    def at(drawn: Surface) -> Surface:
        return placed(drawn, AXES[shape.axis], shape.centre)

    found: Sides = {"outer": lambda step: at(cone(low, high, shape.height, step))}
    if low > 0.0:
        found["lower"] = lambda step: at(reverse(annulus(0.0, low, 0.0, step)))
    if high > 0.0:
        found["upper"] = lambda step: at(annulus(0.0, high, shape.height, step))
    return found


def _funnel(shape: Funnel) -> Sides:
    if len(shape.centre) == 2:
        return _two_plates(shape)
    across, up = shape.across(), shape.up()
    outlet, inlet = shape.outlet_radius, shape.inlet_radius

    def at(drawn: Surface) -> Surface:
        return placed(drawn, up, shape.centre)

    def side(thick: float, step: float) -> Surface:
        parts = [cone(outlet + thick, inlet + thick, shape.height, step)]
        if shape.stem > 0.0:
            parts.append(wall(outlet + thick, -shape.stem, 0.0, step))
        return at(joined(parts))

    return {
        "outer": lambda step: side(across, step),
        "inner": lambda step: reverse(side(0.0, step)),
        "lower": lambda step: at(reverse(annulus(outlet, outlet + across, -shape.stem, step))),
        "upper": lambda step: at(annulus(inlet, inlet + across, shape.height, step)),
    }


def _two_plates(shape: Funnel) -> Sides:
    """Return the sides of a funnel in 2D, those of both plates together."""
    across, up, centre = shape.across(), shape.up(), np.array(shape.centre)
    bottom, outlet = np.array([shape.outlet_radius, -shape.stem]), (shape.outlet_radius, 0.0)
    corners = [bottom, np.array(outlet), np.array([shape.inlet_radius, shape.height])]
    thick = np.array([across, 0.0])

    def both(way: list[Array], step: float) -> Surface:
        pairs = [(a, b) for a, b in itertools.pairwise(way) if (a != b).any()]
        right = joined(line(a, b, step) for a, b in pairs)
        mirror = np.array([-1.0, 1.0])
        drawn = joined([right, Surface(mirror * right.points, mirror * right.areas)])
        turned = slice(None, None, 1 if up == 1 else -1)
        return Surface(centre + drawn.points[:, turned], drawn.areas[:, turned])

    return {
        "outer": lambda step: both([corner + thick for corner in corners], step),
        "inner": lambda step: both(corners[::-1], step),
        "lower": lambda step: both([bottom, bottom + thick], step),
        "upper": lambda step: both([corners[-1] + thick, corners[-1]], step),
    }


def _ogive_rod(shape: OgiveRod) -> Sides:
    axis, sign = shape.axis()
    shaft = shape.length - shape.nose_length

    def at(drawn: Surface) -> Surface:
        # From the tip backwards: what is drawn has its tip up.
        base = np.array(shape.tip)
        base[axis] += sign * shape.nose_length
        return placed(drawn, axis, base, -sign)

    found: Sides = {
        "nose": lambda step: at(ogive(shape.radius, shape.arc_radius, shape.nose_length, step)),
        "end": lambda step: at(reverse(annulus(0.0, shape.radius, -shaft, step))),
    }
    if shaft > 0.0:
        found["outer"] = lambda step: at(wall(shape.radius, -shaft, 0.0, step))
    return found


_DRAWN: dict[type[Shape], Callable[[Any], Sides]] = {
    Box: _box,
    Disc: _disc,
    Ring: _ring,
    Sphere: _sphere,
    Cylinder: _cylinder,
    Tube: _cylinder,
    Polygon: _polygon,
    Frustum: _frustum,
    Funnel: _funnel,
    OgiveRod: _ogive_rod,
}
