# SPDX-License-Identifier: BSD-3-Clause
"""Shapes made of shapes: union, difference, intersection."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar

import numpy as np
from pydantic import model_validator

from mpm3dpp.base.errors import Path, violation

from .base import AnyShape, Bounds, Mask, Points, Shape, register


class _Combined(Shape):
    """A list of shapes, at least two: `union = [{ disc = {...} }, { box = {...} }]`.

    In Python `Union([a, b])`, `Union(a, b)` and `Union(shapes=[a, b])` are the same.
    """

    shapes: list[AnyShape]
    by_position: ClassVar[str] = "shapes"

    @model_validator(mode="after")
    def _at_least_two(self) -> Any:
        if len(self.shapes) < 2:
            raise violation("must combine at least two shapes", "add a shape to the list")
        return self

    def children(self) -> Iterator[tuple[Path, Shape]]:
        for index, shape in enumerate(self.shapes):
            yield (index,), shape

    def table(self) -> dict[str, Any]:
        return {self.kind: [shape.table() for shape in self.shapes]}

    def _disjoint(self, first: Shape, second: Shape) -> bool:
        """Return whether the bounds of two shapes do not overlap."""
        (low_a, high_a), (low_b, high_b) = first.bounds(), second.bounds()
        return bool(np.any(high_a <= low_b) or np.any(high_b <= low_a))


@register
class Union(_Combined):
    """All that is in at least one of the shapes; the volume is exact if their bounds are apart."""

    kind: ClassVar[str] = "union"

    def inside(self, points: Points, grow: float) -> Mask:
        return np.logical_or.reduce([shape.inside(points, grow) for shape in self.shapes])

    def bounds(self) -> Bounds:
        corners = [shape.bounds() for shape in self.shapes]
        return np.min([c[0] for c in corners], axis=0), np.max([c[1] for c in corners], axis=0)

    def volume(self) -> float | None:
        volumes = [shape.volume() for shape in self.shapes]
        pairs = ((a, b) for i, a in enumerate(self.shapes) for b in self.shapes[:i])
        known = [volume for volume in volumes if volume is not None]
        if len(known) < len(volumes) or not all(self._disjoint(a, b) for a, b in pairs):
            return None
        return sum(known)


@register
class Difference(_Combined):
    """The first shape without all the others."""

    kind: ClassVar[str] = "difference"

    def inside(self, points: Points, grow: float) -> Mask:
        mask = self.shapes[0].inside(points, grow)
        for shape in self.shapes[1:]:
            mask &= ~shape.inside(points, -grow)
        return mask

    def bounds(self) -> Bounds:
        return self.shapes[0].bounds()


@register
class Intersection(_Combined):
    """All that is in every one of the shapes."""

    kind: ClassVar[str] = "intersection"

    def inside(self, points: Points, grow: float) -> Mask:
        return np.logical_and.reduce([shape.inside(points, grow) for shape in self.shapes])

    def bounds(self) -> Bounds:
        corners = [shape.bounds() for shape in self.shapes]
        lower = np.max([c[0] for c in corners], axis=0)
        return lower, np.maximum(lower, np.min([c[1] for c in corners], axis=0))
