# SPDX-License-Identifier: BSD-3-Clause
"""A rod with an ogive nose, as penetrators have."""

from __future__ import annotations

import math
from typing import Annotated, Any, ClassVar

import numpy as np
from pydantic import model_validator

from mpm3dpp.base.errors import violation
from mpm3dpp.base.model import Choice
from mpm3dpp.base.units import Number, Point, PositiveLength

from .base import Bounds, Mask, Points, Shape, register

Towards = Annotated[str, Choice(("x", "y", "z", "-x", "-y", "-z"))]


@register
class OgiveRod(Shape):
    """A round rod (3D) whose nose is a tangent ogive; turn it with `rotate`.

    Attributes:
        tip: the point of the nose [m], three numbers.
        radius: of the rod [m].
        length: from the tip to the flat end [m].
        crh: caliber radius head, the radius of the nose's arc in diameters of the rod, >= 0.5.
        towards: where the nose points: x, y, z, -x, -y or -z.
    """

    kind: ClassVar[str] = "ogive_rod"
    dimensions: ClassVar[tuple[int, ...]] = (3,)
    other: ClassVar[str] = "box"
    tip: Point
    radius: PositiveLength
    length: PositiveLength
    crh: Number
    towards: Towards = "-z"

    @model_validator(mode="after")
    def _nose_fits(self) -> Any:
        if not self.crh >= 0.5:
            rule = "must be >= 0.5: a nose of 0.5 is half a sphere"
            raise violation(rule, "give a larger crh", value=self.crh, path=("crh",))
        if self.length < self.nose_length:
            rule = f"must be >= {self.nose_length:g} m, the length of the nose"
            raise violation(rule, "give a longer rod", value=self.length, path=("length",))
        return self

    @property
    def arc_radius(self) -> float:
        """Radius of the nose's arc [m]: 2 crh radius."""
        return 2.0 * self.crh * self.radius

    @property
    def nose_length(self) -> float:
        """Length of the nose [m]: radius sqrt(4 crh - 1), where the arc is tangent to the rod."""
        return self.radius * math.sqrt(4.0 * self.crh - 1.0)

    def axis(self) -> tuple[int, float]:
        """Return the axis's number and the sign of the way from the tip to the flat end."""
        return "xyz".index(self.towards[-1]), 1.0 if self.towards[0] == "-" else -1.0

    def bounds(self) -> Bounds:
        axis, sign = self.axis()
        lower, upper = np.array(self.tip) - self.radius, np.array(self.tip) + self.radius
        ends = sorted((self.tip[axis], self.tip[axis] + sign * self.length))
        lower[axis], upper[axis] = ends
        return lower, upper

    def inside(self, points: Points, grow: float) -> Mask:
        axis, sign = self.axis()
        along = sign * (points[:, axis] - self.tip[axis])
        off = points - np.array(self.tip)
        off[:, axis] = 0.0
        around = np.sqrt((off**2).sum(axis=1))
        # The arc's centre lies opposite, arc_radius - radius beyond the axis, where the nose ends.
        ahead = np.minimum(along - self.nose_length, 0.0)
        arc = np.sqrt(ahead**2 + (around + self.arc_radius - self.radius) ** 2)
        return (arc < self.arc_radius + grow) & (along > -grow) & (along < self.length + grow)

    def volume(self) -> float:
        """Return the volume [m^3]: of the rod, and of the arc turned about the axis."""
        arc, nose = self.arc_radius, self.nose_length
        turned = nose * arc**2 - nose**3 / 3 - (arc - self.radius) * arc**2 * math.asin(nose / arc)
        return math.pi * (turned + self.radius**2 * (self.length - nose))
