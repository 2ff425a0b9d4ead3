# SPDX-License-Identifier: BSD-3-Clause
"""Shapes moved and turned: translate, rotate."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
from pydantic import model_validator

from mpm3dpp.base.errors import Path, violation
from mpm3dpp.base.units import Angle, Direction, Point

from .base import AnyShape, Bounds, Mask, Points, Shape, register


class _Moved(Shape):
    """One shape in another place; the volume does not change."""

    shape: AnyShape

    def children(self) -> Iterator[tuple[Path, Shape]]:
        yield ("shape",), self.shape

    def volume(self) -> float | None:
        return self.shape.volume()


@register
class Translate(_Moved):
    """A shape moved `by` a vector of D numbers [m]."""

    kind: ClassVar[str] = "translate"
    by: Point

    def inside(self, points: Points, grow: float) -> Mask:
        return self.shape.inside(points - np.array(self.by), grow)

    def bounds(self) -> Bounds:
        lower, upper = self.shape.bounds()
        return lower + np.array(self.by), upper + np.array(self.by)


@register
class Rotate(_Moved):
    """A shape turned by an angle, anticlockwise seen against the axis.

    Attributes:
        shape: what is turned.
        angle: [rad], or text such as "30 deg".
        axis: direction of the axis, three numbers of any length; needed in 3D, absent in 2D.
        about: a point that stays, D numbers [m]; default: the middle of the shape's bounds.
    """

    kind: ClassVar[str] = "rotate"
    angle: Angle
    axis: Direction | None = None
    about: Point | None = None

    @model_validator(mode="after")
    def _axis_and_angle(self) -> Any:
        if self.axis is not None and not any(self.axis):
            raise violation(
                "must not be zero", "give a direction such as [0, 0, 1]", path=("axis",)
            )
        if abs(self.angle) > 2.0 * math.pi:
            rule = f"is {self.angle:g} rad, more than a whole turn"
            remedy = 'write its unit, "30 deg"; a plain number is in radians'
            raise violation(rule, remedy, path=("angle",))
        return self

    def wrong_dimension(self, dimension: int, path: Path = ()) -> tuple[Path, str, str] | None:
        if dimension == 2 and self.axis is not None:
            return (*path, "rotate", "axis"), "must be absent in 2D", "remove it"
        if dimension == 3 and self.axis is None:
            return (*path, "rotate", "axis"), "is missing", "in 3D add axis = [0, 0, 1]"
        return super().wrong_dimension(dimension, path)

    def matrix(self) -> Points:
        """Return the rotation, shape (D, D), by the formula of Rodrigues (1840) in 3D."""
        cos, sin = math.cos(self.angle), math.sin(self.angle)
        if self.axis is None:
            return np.array([[cos, -sin], [sin, cos]])
        x, y, z = np.array(self.axis) / np.linalg.norm(self.axis)
        cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        return np.eye(3) + sin * cross + (1 - cos) * (cross @ cross)

    def centre(self) -> Points:
        """Return the point that stays [m], shape (D,)."""
        if self.about is not None:
            return np.array(self.about)
        lower, upper = self.shape.bounds()
        return (lower + upper) / 2

    def inside(self, points: Points, grow: float) -> Mask:
        # Rows times R are R transposed times the points: the points turned back.
        return self.shape.inside((points - self.centre()) @ self.matrix() + self.centre(), grow)

    def bounds(self) -> Bounds:
        corners = np.array(list(itertools.product(*zip(*self.shape.bounds(), strict=True))))
        turned = (corners - self.centre()) @ self.matrix().T + self.centre()
        return turned.min(axis=0), turned.max(axis=0)
