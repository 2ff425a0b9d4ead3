# SPDX-License-Identifier: BSD-3-Clause
"""Shapes with inclined sides: polygon (2D), frustum (3D), funnel (both)."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import Field, model_validator

from mpm3dpp.base.errors import violation
from mpm3dpp.base.units import Point, PositiveLength, Quantity

from .base import Bounds, Mask, Points, Shape, register
from .primitives import AXES, AxisName

Radius = Annotated[float, Quantity("m", ">= 0")]


@register
class Polygon(Shape):
    """A polygon (2D): a wedge, a trapezoid, any outline that does not cross itself.

    Attributes:
        points: the corners in order, at least three [m]; the last is joined to the first.
    """

    kind: ClassVar[str] = "polygon"
    dimensions: ClassVar[tuple[int, ...]] = (2,)
    other: ClassVar[str] = "frustum or box"
    points: Annotated[list[Point], Field()]

    @model_validator(mode="after")
    def _simple(self) -> Any:
        if len(self.points) < 3:
            raise violation("must have at least three points", "add a corner", path=("points",))
        for k, point in enumerate(self.points):
            if len(point) != 2:
                rule = "must have two numbers: a polygon is a 2D shape"
                raise violation(rule, "remove the third", value=list(point), path=("points", k))
        crossing = self._crossing()
        if crossing is not None:
            rule = f"must not cross itself: its sides {crossing[0]} and {crossing[1]} meet"
            raise violation(rule, "give the corners in order along the outline", path=("points",))
        if abs(self._signed()) <= 1e-12 * float(np.prod(np.ptp(self._corners(), axis=0))):
            raise violation("must enclose an area", "move a corner", path=("points",))
        return self

    def _corners(self) -> Points:
        return np.array(self.points, dtype=float)

    def _signed(self) -> float:
        """Return the area, positive if the corners run anticlockwise (the shoelace formula)."""
        a = self._corners()
        b = np.roll(a, -1, axis=0)
        return float(0.5 * np.sum(a[:, 0] * b[:, 1] - b[:, 0] * a[:, 1]))

    def is_anticlockwise(self) -> bool:
        """Return in which sense the corners run."""
        return self._signed() > 0.0

    def _crossing(self) -> tuple[int, int] | None:
        """Return the numbers of two sides, not neighbours, that meet; side k starts at point k."""
        a = self._corners()
        b, n = np.roll(a, -1, axis=0), len(a)

        def side(p: Points, q: Points, r: Points) -> float:
            return float((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]))

        for i in range(n):
            for j in range(i + 2, n - (i == 0)):
                one = side(a[i], b[i], a[j]) * side(a[i], b[i], b[j])
                other = side(a[j], b[j], a[i]) * side(a[j], b[j], b[i])
                if one < 0 and other < 0:
                    return i, j
        return None

    def bounds(self) -> Bounds:
        corners = self._corners()
        return corners.min(axis=0), corners.max(axis=0)

    def inside(self, points: Points, grow: float) -> Mask:
        starts = self._corners()
        within = np.zeros(len(points), dtype=bool)
        nearest = np.full(len(points), np.inf)
        for a, b in zip(starts, np.roll(starts, -1, axis=0), strict=True):
            edge, arm = b - a, points - a
            # A ray to the right crosses the side.
            above = (points[:, 1] >= min(a[1], b[1])) & (points[:, 1] < max(a[1], b[1]))
            turn = edge[0] * arm[:, 1] - edge[1] * arm[:, 0]
            within ^= above & (turn * (1.0 if b[1] > a[1] else -1.0) > 0.0)
            share = np.clip(arm @ edge / (edge @ edge), 0.0, 1.0) if edge.any() else 0.0
            gap = arm - np.multiply.outer(share, edge)
            nearest = np.minimum(nearest, np.einsum("ij,ij->i", gap, gap))
        distance = np.sqrt(nearest)
        return np.where(within, distance > -grow, distance < grow)

    def volume(self) -> float:
        return abs(self._signed())


def _arm(points: Points, centre: tuple[float, ...], axis: int) -> tuple[Points, Points]:
    """Return the height above a centre along an axis, and the distance from the axis [m]."""
    arm = points - np.array(centre)
    height = arm[:, axis].copy()
    arm[:, axis] = 0.0
    return height, np.sqrt(np.einsum("ij,ij->i", arm, arm))


@register
class Frustum(Shape):
    """A frustum of a cone (3D), or a cone where one radius is 0.

    Attributes:
        centre: of its lower face [m].
        height: [m].
        axis: x, y or z: from the lower face to the upper one.
        lower_radius, upper_radius: of the faces [m].
    """

    kind: ClassVar[str] = "frustum"
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    other: ClassVar[str] = "polygon"
    centre: Point
    height: PositiveLength
    axis: AxisName = "z"
    lower_radius: Radius
    upper_radius: Radius

    @model_validator(mode="after")
    def _some_radius(self) -> Any:
        if self.lower_radius == 0.0 and self.upper_radius == 0.0:
            rule = "must be > 0 where lower_radius = 0"
            raise violation(rule, "give one of the two a size", path=("upper_radius",))
        return self

    def bounds(self) -> Bounds:
        half = np.full(len(self.centre), max(self.lower_radius, self.upper_radius))
        axis = min(AXES[self.axis], len(half) - 1)
        lower, upper = np.array(self.centre) - half, np.array(self.centre) + half
        lower[axis], upper[axis] = self.centre[axis], self.centre[axis] + self.height
        return lower, upper

    def inside(self, points: Points, grow: float) -> Mask:
        height, distance = _arm(points, self.centre, AXES[self.axis])
        slope = (self.upper_radius - self.lower_radius) / self.height
        radius = self.lower_radius + slope * height + grow * math.hypot(1.0, slope)
        return (height > -grow) & (height < self.height + grow) & (distance < radius)

    def volume(self) -> float:
        a, b = self.lower_radius, self.upper_radius
        return math.pi / 3 * self.height * (a * a + a * b + b * b)


@register
class Funnel(Shape):
    """A funnel or hopper, open above and below: a hollow frustum (3D), two inclined plates (2D).

    Attributes:
        centre: the middle of its outlet [m], D numbers.
        outlet_radius: of the opening below [m]; in 2D half its width.
        inlet_radius: of the opening above [m], larger than that of the outlet.
        height: from the outlet to the opening above [m].
        thickness: of the wall, across it [m].
        stem: length of a straight pipe below the outlet [m], as thick as the wall is seen along
            the radius; default none.
        axis: x, y or z, upwards; default z in 3D, y in 2D.
    """

    kind: ClassVar[str] = "funnel"
    centre: Point
    outlet_radius: PositiveLength
    inlet_radius: PositiveLength
    height: PositiveLength
    thickness: PositiveLength
    stem: Radius = 0.0
    axis: AxisName | None = None

    @model_validator(mode="after")
    def _opens(self) -> Any:
        if self.inlet_radius <= self.outlet_radius:
            rule = f"must be > outlet_radius = {self.outlet_radius:g} m"
            value = self.inlet_radius
            raise violation(rule, "swap the two", value=value, path=("inlet_radius",))
        if self.axis == "z" and len(self.centre) == 2:
            raise violation("must be x or y in 2D", "leave it out for y", path=("axis",))
        return self

    def up(self) -> int:
        """Return the number of its axis."""
        return AXES[self.axis] if self.axis is not None else len(self.centre) - 1

    def across(self) -> float:
        """Return the thickness of the wall of the cone, measured away from the axis [m]."""
        slope = (self.inlet_radius - self.outlet_radius) / self.height
        return self.thickness * math.hypot(1.0, slope)

    def bounds(self) -> Bounds:
        half = np.full(len(self.centre), self.inlet_radius + self.across())
        lower, upper = np.array(self.centre) - half, np.array(self.centre) + half
        up = self.up()
        lower[up], upper[up] = self.centre[up] - self.stem, self.centre[up] + self.height
        return lower, upper

    def inside(self, points: Points, grow: float) -> Mask:
        height, distance = _arm(points, self.centre, self.up())
        slope = (self.inlet_radius - self.outlet_radius) / self.height
        radius = self.outlet_radius + slope * np.maximum(height, 0.0)
        wide = grow * math.hypot(1.0, slope)
        between = (distance > radius - wide) & (distance < radius + self.across() + wide)
        return between & (height > -self.stem - grow) & (height < self.height + grow)

    def volume(self) -> float:
        across, a, b = self.across(), self.outlet_radius, self.inlet_radius
        if len(self.centre) == 2:
            return 2.0 * across * (self.height + self.stem)
        cone = math.pi * across * (a + b + across) * self.height
        return cone + math.pi * across * (2.0 * a + across) * self.stem
