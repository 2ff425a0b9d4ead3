# SPDX-License-Identifier: BSD-3-Clause
"""What every shape can do: tell which points are inside, its bounds and its exact volume."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator
from typing import Annotated, Any, ClassVar

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, SkipValidation, ValidationError, WithJsonSchema
from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import Path, nearest, report, show, violation, violations_of
from mpm3dpp.base.model import CaseModel

Points = NDArray[np.float64]
Mask = NDArray[np.bool_]
Bounds = tuple[Points, Points]

# Points closer to a surface than this share of the shape's size count as on it, that is outside.
SURFACE_TOLERANCE = 1e-9


class Shape(CaseModel):
    """A region of the plane (2D) or of space (3D). Lengths in metres or text with a unit.

    Shapes combine as `a | b` (union), `a - b` (difference) and `a & b` (intersection).
    """

    kind: ClassVar[str] = ""
    dimensions: ClassVar[tuple[int, ...]] = (2, 3)
    other: ClassVar[str] = ""  # What to use instead in the other dimension.

    @abstractmethod
    def inside(self, points: Points, grow: float) -> Mask:
        """Return which points lie strictly inside the shape grown by a small distance.

        Args:
            points: shape (n, D) [m].
            grow: how far surfaces are moved outwards [m]; negative shrinks. Meant for tolerances.

        Returns:
            Booleans, shape (n,).
        """

    @abstractmethod
    def bounds(self) -> Bounds:
        """Return the lower and upper corner of a box around the shape, shape (D,) each [m]."""

    def volume(self) -> float | None:
        """Return the exact volume [m^3] (2D: area [m^2]), or None if it has no closed form."""
        return None

    def contains(self, points: Points) -> Mask:
        """Return which points lie inside; points on the surface, to 1e-9 of the size, do not.

        So bodies that touch never hold the same point, and mirror images are treated alike.

        Args:
            points: shape (n, D) [m].

        Returns:
            Booleans, shape (n,).
        """
        lower, upper = self.bounds()
        size = float(np.max(upper - lower)) if np.all(upper > lower) else 0.0
        reach = max(float(np.max(np.abs(upper))), float(np.max(np.abs(lower))))
        grow = -max(SURFACE_TOLERANCE * size, 8 * np.finfo(float).eps * reach)
        return self.inside(np.asarray(points, dtype=np.float64), grow)

    def children(self) -> Iterator[tuple[Path, Shape]]:
        """Yield (path below this shape's table, shape) of the shapes that this one combines."""
        yield from ()

    def walk(self, path: Path = ()) -> Iterator[tuple[Path, Shape]]:
        """Yield (path of its table, shape) of this shape and of all below it."""
        here = (*path, self.kind)
        yield here, self
        for below, child in self.children():
            yield from child.walk((*here, *below))

    def wrong_dimension(self, dimension: int, path: Path = ()) -> tuple[Path, str, str] | None:
        """Return (path, rule, remedy) of the first part that does not suit 2D or 3D."""
        for here, shape in self.walk(path):
            if dimension not in shape.dimensions:
                only = f"is a {shape.dimensions[0]}D shape but grid.dimension = {dimension}"
                return here, only, f"use {shape.other} in {dimension}D"
            for name in type(shape).model_fields:
                value = getattr(shape, name)
                wrong = isinstance(value, tuple) and value and isinstance(value[0], float)
                if wrong and len(value) != dimension:
                    rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
                    return (*here, name), rule, f"it has {len(value)}, give {dimension}"
        return None

    def table(self) -> dict[str, Any]:
        """Return the shape as a table of a case file: `{"disc": {...}}`, in SI units."""
        return {self.kind: super().table()}

    # What combines shapes stands in a file of its own, which has told KINDS of it.
    def __or__(self, other: Shape) -> Shape:
        return KINDS["union"](shapes=[self, other])

    def __sub__(self, other: Shape) -> Shape:
        return KINDS["difference"](shapes=[self, other])

    def __and__(self, other: Shape) -> Shape:
        return KINDS["intersection"](shapes=[self, other])


KINDS: dict[str, type[Shape]] = {}


def parse_shape(value: Any) -> Shape:
    """Return the shape of a table such as `{"disc": {"centre": ..., "radius": ...}}`."""
    if isinstance(value, Shape):
        return value
    if not isinstance(value, dict) or len(value) != 1:
        remedy = f"write {{ disc = {{ ... }} }}; the shapes are {', '.join(KINDS)}"
        given = f" but has {len(value)}" if isinstance(value, dict) else ""
        raise violation(f"must be a table with exactly one shape{given}", remedy, value=value)
    [(kind, fields)] = value.items()
    if kind not in KINDS:
        raise violation("is not a known shape", nearest(str(kind), KINDS), path=(str(kind),))
    is_list = "shapes" in KINDS[kind].model_fields
    if is_list and not isinstance(fields, list):
        remedy = f"write {kind} = [{{ first shape }}, {{ second shape }}]"
        raise violation("must be a list of shapes", remedy, value=fields, path=(kind,))
    try:
        return KINDS[kind].model_validate({"shapes": fields} if is_list else fields)
    except ValidationError as error:
        report(_below(error, (kind,), is_list))
        raise


def _below(error: ValidationError, path: Path, is_list: bool) -> list[PydanticCustomError]:
    """Return a shape's violations with their paths written as in the file."""
    found = []
    for one in violations_of(error):
        tail = one["path"][1:] if is_list and one["path"][:1] == ("shapes",) else one["path"]
        found.append(violation(one["rule"], one["remedy"], value=one["value"], path=path + tail))
    return found


def register(shape: type[Shape]) -> type[Shape]:
    """Make a class available in case files under its `kind`."""
    KINDS[shape.kind] = shape
    return shape


def _parse_optional(value: Any) -> Shape | None:
    return None if value is None else parse_shape(value)


MaybeShape = Annotated[
    SkipValidation[Shape | None],
    BeforeValidator(_parse_optional),
    WithJsonSchema({"type": "object", "minProperties": 1, "maxProperties": 1}),
]
AnyShape = Annotated[
    SkipValidation[Shape],
    BeforeValidator(parse_shape),
    WithJsonSchema({"type": "object", "minProperties": 1, "maxProperties": 1}),
]


def size_text(shape: Shape) -> str:
    """Return the edges of a shape's bounds, for messages: `0.01 x 0.02 m`."""
    lower, upper = shape.bounds()
    return " x ".join(show(float(f"{edge:.4g}")) for edge in upper - lower) + " m"
