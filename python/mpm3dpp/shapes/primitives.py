# SPDX-License-Identifier: BSD-3-Clause
"""The simple shapes: box, disc, ring (2D), sphere, cylinder, tube (3D)."""

from __future__ import annotations

import math
from abc import abstractmethod
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import model_validator

from mpm3dpp.base.errors import violation
from mpm3dpp.base.model import Choice
from mpm3dpp.base.units import Point, PositiveLength

from .base import Bounds, Mask, Points, Shape, register

AxisName = Annotated[str, Choice(("x", "y", "z"))]
AXES = {"x": 0, "y": 1, "z": 2}


@register
class Box(Shape):
    """A rectangle (2D) or box (3D) along the axes, by `lower`, `upper` or by `centre`, `size`.

    Attributes:
        lower, upper: opposite corners [m], D numbers.
        centre, size: middle and edge lengths [m], D numbers.
    """

    kind: ClassVar[str] = "box"
    lower: Point | None = None
    upper: Point | None = None
    centre: Point | None = None
    size: Point | None = None

    @model_validator(mode="after")
    def _corners(self) -> Box:
        given = {name for name in ("lower", "upper", "centre", "size") if getattr(self, name)}
        if given not in ({"lower", "upper"}, {"centre", "size"}):
            remedy = "give lower and upper, or centre and size"
            raise violation("must be given by two of its four keys", remedy)
        first, second = ("lower", "upper") if "lower" in given else ("centre", "size")
        if len(getattr(self, first)) != len(getattr(self, second)):
            remedy = "give two numbers each in 2D and three in 3D"
            raise violation(f"must have as many numbers as {first}", remedy, path=(second,))
        lower, upper = self.bounds()
        if not np.all(upper > lower):
            rule = "must be > 0 in every direction" if "size" in given else "must be > lower"
            value = list(getattr(self, second))
            raise violation(rule, f"give a larger {second}", value=value, path=(second,))
        return self

    def bounds(self) -> Bounds:
        if self.lower is not None and self.upper is not None:
            return np.array(self.lower), np.array(self.upper)
        centre, half = np.array(self.centre), np.array(self.size) / 2
        return centre - half, centre + half

    def inside(self, points: Points, grow: float) -> Mask:
        lower, upper = self.bounds()
        mask = np.ones(len(points), dtype=bool)
        for axis in range(len(lower)):
            x = points[:, axis]
            mask &= (x > lower[axis] - grow) & (x < upper[axis] + grow)
        return mask

    def volume(self) -> float:
        lower, upper = self.bounds()
        return float(np.prod(upper - lower))


class _Round(Shape):
    """A shape about a centre: what discs, spheres and rings share."""

    centre: Point

    @model_validator(mode="after")
    def _ordered_radii(self) -> Any:
        inner, outer = getattr(self, "inner_radius", None), getattr(self, "outer_radius", None)
        if inner is not None and outer is not None and inner >= outer:
            rule = f"must be < outer_radius = {outer:g} m"
            raise violation(rule, "swap or change the radii", value=inner, path=("inner_radius",))
        return self

    @abstractmethod
    def _half(self) -> Points:
        """Return half the edges of the bounds, shape (D,) [m]."""

    def bounds(self) -> Bounds:
        centre = np.array(self.centre)
        return centre - self._half(), centre + self._half()

    def _distance_squared(self, points: Points, without: int = -1) -> Points:
        """Return the squared distance to the centre, or to the axis `without` through it."""
        total = np.zeros(len(points))
        for axis, middle in enumerate(self.centre):
            if axis != without:
                total += (points[:, axis] - middle) ** 2
        return total


def _within(squared: Points, radius: float) -> Mask:
    """Return where a squared distance is below a radius, which may be negative."""
    return squared < max(radius, 0.0) ** 2


@register
class Disc(_Round):
    """A disc (2D). `centre`: two numbers [m]; `radius` [m]."""

    kind: ClassVar[str] = "disc"
    dimensions: ClassVar[tuple[int, ...]] = (2,)
    other: ClassVar[str] = "sphere or cylinder"
    radius: PositiveLength

    def _half(self) -> Points:
        return np.full(len(self.centre), self.radius)

    def inside(self, points: Points, grow: float) -> Mask:
        return _within(self._distance_squared(points), self.radius + grow)

    def volume(self) -> float:
        return math.pi * self.radius**2


@register
class Sphere(Disc):
    """A sphere (3D). `centre`: three numbers [m]; `radius` [m]."""

    kind: ClassVar[str] = "sphere"
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    other: ClassVar[str] = "disc"

    def volume(self) -> float:
        return 4 / 3 * math.pi * self.radius**3


@register
class Ring(_Round):
    """A ring (2D). `centre`: two numbers [m]; `inner_radius` < `outer_radius` [m]."""

    kind: ClassVar[str] = "ring"
    dimensions: ClassVar[tuple[int, ...]] = (2,)
    other: ClassVar[str] = "tube"
    inner_radius: PositiveLength
    outer_radius: PositiveLength

    def _half(self) -> Points:
        return np.full(len(self.centre), self.outer_radius)

    def inside(self, points: Points, grow: float) -> Mask:
        squared = self._distance_squared(points)
        inner = max(self.inner_radius - grow, 0.0)
        return _within(squared, self.outer_radius + grow) & (squared > inner**2)

    def volume(self) -> float:
        return math.pi * (self.outer_radius**2 - self.inner_radius**2)


class _Along(_Round):
    """A round shape along an axis: what cylinders and tubes share."""

    dimensions: ClassVar[tuple[int, ...]] = (3,)
    height: PositiveLength
    axis: AxisName = "z"

    def _half_around(self, radius: float) -> Points:
        half = np.full(len(self.centre), radius)
        half[min(AXES[self.axis], len(half) - 1)] = self.height / 2
        return half

    def _between_ends(self, points: Points, grow: float) -> Mask:
        axis = AXES[self.axis]
        return np.abs(points[:, axis] - self.centre[axis]) < self.height / 2 + grow


@register
class Cylinder(_Along):
    """A cylinder (3D) about `axis` (x, y, z). `centre`: its middle [m]; `radius`, `height` [m]."""

    kind: ClassVar[str] = "cylinder"
    other: ClassVar[str] = "disc"
    radius: PositiveLength

    def _half(self) -> Points:
        return self._half_around(self.radius)

    def inside(self, points: Points, grow: float) -> Mask:
        squared = self._distance_squared(points, AXES[self.axis])
        return _within(squared, self.radius + grow) & self._between_ends(points, grow)

    def volume(self) -> float:
        return math.pi * self.radius**2 * self.height


@register
class Tube(_Along):
    """A hollow cylinder (3D) about `axis`; `inner_radius` < `outer_radius`, `height` [m]."""

    kind: ClassVar[str] = "tube"
    other: ClassVar[str] = "ring"
    inner_radius: PositiveLength
    outer_radius: PositiveLength

    def _half(self) -> Points:
        return self._half_around(self.outer_radius)

    def inside(self, points: Points, grow: float) -> Mask:
        squared = self._distance_squared(points, AXES[self.axis])
        inner = max(self.inner_radius - grow, 0.0)
        hollow = _within(squared, self.outer_radius + grow) & (squared > inner**2)
        return hollow & self._between_ends(points, grow)

    def volume(self) -> float:
        return math.pi * (self.outer_radius**2 - self.inner_radius**2) * self.height
