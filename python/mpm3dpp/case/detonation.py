# SPDX-License-Identifier: BSD-3-Clause
"""Where and when explosives are lit, and when the detonation reaches each particle."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field
from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import nearest, violation
from mpm3dpp.base.model import CaseModel, Text
from mpm3dpp.base.units import Point, Quantity

if TYPE_CHECKING:
    from .case import Case

Array = NDArray[np.float64]
EXPLOSIVE = "high_explosive"


class Detonation(CaseModel):
    """A point from which a detonation runs spherically through explosives, at their own speed.

    Attributes:
        point: where [m], D numbers.
        time: when [s].
        bodies: names of the bodies or entries of `grains` that it lights; empty for all explosives.
    """

    point: Point
    time: Annotated[float, Quantity("s", ">= 0")] = 0.0
    bodies: list[Text] = Field(default_factory=list)


def lighting_times(case: Case, part: str, positions: Array) -> Array | None:
    """Return when the detonation arrives at each particle of a body [s], shape (n,).

    It is the earliest of all points' time + distance / D (Huygens, one medium).

    Args:
        case: gives the points and the speed D.
        part: name of the body, or of the entry of grains that it belongs to.
        positions: of its particles at the start [m], shape (n, D).

    Returns:
        None if the body is no explosive or nothing lights it.
    """
    strength = case.material[case.parts()[part].material].strength
    points = [d for d in case.detonation if not d.bodies or part in d.bodies]
    if strength.model != EXPLOSIVE or not points:
        return None
    speed = strength.parameters["D"]
    arrivals = [
        d.time + np.linalg.norm(positions - np.asarray(d.point), axis=1) / speed for d in points
    ]
    return np.ascontiguousarray(np.min(arrivals, axis=0))


def check_detonations(case: Case) -> Iterator[PydanticCustomError]:
    """Yield a violation for each point of the wrong dimension, or one that has nothing to light."""
    dimension = case.grid.dimension
    strengths = [case.material[name].strength.model for name in case.materials_used]
    parts = case.parts()
    for index, detonation in enumerate(case.detonation):
        if EXPLOSIVE not in strengths:
            rule = f"has nothing to light: no body is of an explosive (strength {EXPLOSIVE})"
            remedy = "give a body such a material, or remove the detonation"
            yield violation(rule, remedy, path=("detonation", index))
            continue
        if len(detonation.point) != dimension:
            rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
            remedy = f"it has {len(detonation.point)}, give {dimension}"
            path = ("detonation", index, "point")
            yield violation(rule, remedy, value=list(detonation.point), path=path)
        for place, name in enumerate(detonation.bodies):
            where = ("detonation", index, "bodies", place)
            if name not in parts:
                remedy = nearest(name, parts)
                yield violation("is not a body of this case", remedy, value=name, path=where)
            elif case.material[parts[name].material].strength.model != EXPLOSIVE:
                rule = f"is not of an explosive (strength {EXPLOSIVE})"
                yield violation(rule, "name a body that is", value=name, path=where)
