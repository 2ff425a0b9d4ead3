# SPDX-License-Identifier: BSD-3-Clause
"""The table `[grains.NAME.packing]` of a case: grains at random places in a box or a shape."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from mpm3dpp.base.errors import CaseError, Path, violation
from mpm3dpp.base.model import MOST, CaseModel, Count, Exactly
from mpm3dpp.base.units import Point, Quantity, Vector
from mpm3dpp.shapes.base import MaybeShape

from .packing import draw_radii, fitting, pack

Array = NDArray[np.float64]
Wrong = tuple[Path, str, str]
Lengths = Annotated[tuple[float, ...], Vector("m", scalar=True)]


def needs(name: str, given: int, dimension: int) -> Wrong:
    """Return (path, rule, remedy) of a key with too few or too many numbers."""
    rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
    return (name,), rule, f"it has {given}, give {dimension}"


class GrainPacking(CaseModel):
    """Grains at random places in a box, none overlapping; the same for the same seed.

    Attributes:
        lower, upper: corners of the box that holds them [m], D numbers; with `inside` by default
            those around its shape.
        inside: any shape of `mpm3dpp.shapes`: of the grains of the box those are kept that lie in
            it as a whole.
        radius: one number [m], or the least and the most, drawn evenly between.
        count: how many; not with `inside`.
        fraction: in place of `count`, the share of the box that they fill. Up to about 0.55 in 3D
            and 0.75 in 2D a place is found for all.
        gap: least distance of two surfaces [m].
        seed: of the random numbers, a whole number >= 0.
    """

    lower: Point = ()
    upper: Point = ()
    inside: MaybeShape = None
    radius: Lengths
    count: Count | None = None
    fraction: Annotated[float, Quantity("", "0 < f < 1")] | None = None
    gap: Annotated[float, Quantity("m", ">= 0")] = 0.0
    seed: Annotated[int, Exactly(int, 0, MOST)] = 0

    @model_validator(mode="after")
    def _consistent(self) -> GrainPacking:
        if len(self.radius) not in (1, 2) or not 0 < self.radius[0] <= self.radius[-1]:
            rule = "must be one length > 0, or two, the smaller first"
            remedy = 'for example ["1 mm", "2 mm"]'
            raise violation(rule, remedy, value=list(self.radius), path=("radius",))
        if self.inside is not None and self.count is not None:
            rule = "must not be given together with inside, which tells how many there are"
            raise violation(rule, "give fraction", value=self.count, path=("count",))
        if (self.count is None) == (self.fraction is None):
            raise violation("must have either count or fraction", "give one of them")
        if self.inside is None:
            for name in ("lower", "upper"):
                if not getattr(self, name):
                    raise violation("is missing", "add this key, or inside", path=(name,))
        lower, upper = self.corners()
        if len(lower) != len(upper):
            rule, remedy = "must have as many numbers as lower", "give two in 2D and three in 3D"
            raise violation(rule, remedy, value=list(upper), path=("upper",))
        for d, (low, high) in enumerate(zip(lower, upper, strict=True)):
            if high - low < 2 * self.radius[-1]:
                rule = f"is {high - low:g} m from lower, less than the largest grain's diameter"
                remedy = "give a larger box or smaller grains"
                raise violation(rule, remedy, value=high, path=("upper", d))
        if len(self.drawn()) == 0:
            rule = "is less than one grain fills"
            remedy = "give a larger fraction or smaller grains"
            raise violation(rule, remedy, value=self.fraction, path=("fraction",))
        return self

    def corners(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return lower and upper corner of the box [m]."""
        if self.inside is None or (self.lower and self.upper):
            return self.lower, self.upper
        lower, upper = (tuple(map(float, corner)) for corner in self.inside.bounds())
        return self.lower or lower, self.upper or upper

    def wrong_dimension(self, dimension: int) -> Wrong | None:
        """Return (path, rule, remedy) if the corners have too few or too many numbers."""
        if self.inside is not None and (
            wrong := self.inside.wrong_dimension(dimension, ("inside",))
        ):
            return wrong
        lower, _ = self.corners()
        return needs("lower", len(lower), dimension) if len(lower) != dimension else None

    def _numbers(self) -> tuple[float, float, int | None, float]:
        lower, upper = self.corners()
        volume = float(np.prod(np.subtract(upper, lower))) * (self.fraction or 0.0)
        return self.radius[0], self.radius[-1], self.count, volume

    def drawn(self) -> Array:
        """Return the radii of all grains of the box [m], shape (n,)."""
        return draw_radii(*self._numbers(), len(self.corners()[0]), self.seed)

    def radii(self) -> Array:
        """Return the radii [m], shape (n,): without placing the grains, unless a shape holds them.

        Raises:
            CaseError: they cannot be placed.
        """
        return self.drawn() if self.inside is None else self.place(len(self.corners()[0]))[1]

    def place(self, dimension: int) -> tuple[Array, Array]:
        """Return centres [m], shape (n, D), and radii [m], shape (n,).

        Raises:
            CaseError: they cannot be placed, or none lies in the shape.
        """
        centres, radii = pack(*self.corners(), *self._numbers(), self.gap, self.seed)
        if self.inside is None:
            return centres, radii
        kept = fitting(self.inside, centres, radii)
        if not kept.any():
            rule = "holds no whole grain"
            raise CaseError(rule, "give a larger shape or smaller grains", key="inside")
        return centres[kept], radii[kept]
