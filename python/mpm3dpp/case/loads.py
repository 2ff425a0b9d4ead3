# SPDX-License-Identifier: BSD-3-Clause
"""Pressures and tractions on the surfaces of bodies, and forces at points: they follow the body."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from mpm3dpp import _core
from mpm3dpp.base.errors import nearest, violation
from mpm3dpp.base.model import Text, plain
from mpm3dpp.base.settings import table_of_rows
from mpm3dpp.base.time_functions import Timed, TimedVector, TimeFunction
from mpm3dpp.base.units import Point
from mpm3dpp.shapes.shells import unmoved
from mpm3dpp.shapes.surfaces import AXIS_NAMES, sides

if TYPE_CHECKING:
    from .body import Body
    from .case import Case


def _kind_field(row: dict[str, Any]) -> tuple[Any, Any]:
    """Return type and default of the key of a kind of loads, a row of the core."""
    unit = row["unit"]
    if row["vector"]:
        return Annotated[tuple[float | TimeFunction, ...], TimedVector(unit)], ()
    return Annotated[float | TimeFunction | None, Timed(unit)], None


KINDS: dict[str, dict[str, Any]] = _core.load_kinds
"""Of each kind of load: `meaning`, `unit`, and whether it is a `vector` and acts `at_point`."""

_LoadValues: Any = table_of_rows("load", KINDS, _kind_field)


class Load(_LoadValues):
    """A load on a side of a body that deforms, or at a point of it; it follows the body's motion.

    One of the kinds of loads must be given: a force with a point, the others with a side.

    Attributes:
        body: its name.
        side: of the body's shape: `x_min` to `z_max` of a box, or of a body that is given by its
            particles; `outer` of what is round, `inner` of a ring, tube or funnel, `lower` and
            `upper` of a cylinder, tube, frustum or funnel; `nose`, `outer`, `end` of an ogive rod;
            `side_0`, from the first corner to the second, and so on of a polygon; `1.outer`, side
            `outer` of the shape with the number 1, from 0, of a union, difference or intersection,
            as far as it is on the surface of all; `all`.
        point: where a force acts [m], D numbers: carried by the particle nearest to it at the
            start, one and a half spacings away at most, or shared by those that are as near.
    """

    body: Text
    side: Text = ""
    point: Point = ()

    @model_validator(mode="after")
    def _one_kind(self) -> Load:
        first, *others = KINDS
        given = self.given()
        if len(given) > 1:
            rule = f"must not be given together with {given[0]}"
            raise violation(rule, "keep one of the two", path=(given[1],))
        if not given:
            remedy = f"add this key, or {' or '.join(others)}"
            raise violation("is missing", remedy, path=(first,))
        [kind] = given
        where, other = ("point", "side") if self.at_point else ("side", "point")
        if not getattr(self, where):
            raise violation("is missing", f"{kind} acts at a {where}: give it", path=(where,))
        if getattr(self, other):
            rule = f"does not go with {kind}, which acts at a {where}"
            raise violation(rule, f"remove {other}", path=(other,))
        return self

    def given(self) -> list[str]:
        """Return the kinds of loads that have a value."""
        return [kind for kind in KINDS if getattr(self, kind) not in (None, ())]

    @property
    def at_point(self) -> bool:
        """Whether it is a force at a point."""
        return any(KINDS[kind]["at_point"] for kind in self.given())

    def value(self) -> tuple[str, tuple[float | TimeFunction, ...]]:
        """Return the kind and its value, one number or D."""
        [kind] = self.given()
        found = getattr(self, kind)
        return kind, found if KINDS[kind]["vector"] else (found,)


def check_loads(case: Case) -> Iterator[PydanticCustomError]:
    """Yield the violations of loads against the bodies of a case, with their paths in it."""
    dimension = case.grid.dimension
    for name, load in case.load.items():
        path = ("load", name)
        if load.body not in case.body:
            rule, remedy = "is not a body of this case", nearest(load.body, case.body)
            yield violation(rule, remedy, value=load.body, path=(*path, "body"))
            continue
        body = case.body[load.body]
        if case.is_rigid(load.body):
            rule = "does not deform, and a load acts on bodies that do"
            remedy = "give its material another strength, remove its motion, or load another body"
            yield violation(rule, remedy, value=load.body, path=(*path, "body"))
        known = sides_of(body, dimension)
        if load.at_point:
            if len(load.point) != dimension:
                rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
                remedy = f"it has {len(load.point)}, give {dimension}"
                yield violation(rule, remedy, value=plain(load.point), path=(*path, "point"))
        elif load.side not in known:
            rule = f"is not a side of the {_kind(body)} body.{load.body}"
            yield violation(rule, nearest(load.side, known), value=load.side, path=(*path, "side"))
        kind, value = load.value()
        if KINDS[kind]["vector"] and len(value) != dimension:
            rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
            remedy = f"it has {len(value)}, give {dimension}"
            yield violation(rule, remedy, path=(*path, kind))


def sides_of(body: Body, dimension: int) -> list[str]:
    """Return the names of the sides of a body that can be loaded."""
    if body.shape is not None:
        return sides(body.shape)
    return [f"{a}_{end}" for a in AXIS_NAMES[:dimension] for end in ("min", "max")] + ["all"]


def _kind(body: Body) -> str:
    return unmoved(body.shape).kind if body.shape is not None else "set of particles"
