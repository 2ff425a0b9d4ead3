# SPDX-License-Identifier: BSD-3-Clause
"""Forces on bodies beside gravity and loads: by mass, or all of a body's."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mpm3dpp import _core
from mpm3dpp.base.errors import violation
from mpm3dpp.base.expression import Expression, program_of
from mpm3dpp.base.model import plain
from mpm3dpp.base.time_functions import at

if TYPE_CHECKING:
    from mpm3dpp.grains import Grains

    from .body import Body
    from .case import Case

KEYS = ("body_force", "force")
Program = list[tuple[str, float]]


def force_values(part: Body | Grains) -> list[float | Expression]:
    """Return what the forces of a body or of grains are given by; none if it has none."""
    return [value for key in KEYS for value in getattr(part, key) or ()]


def force_programs(part: Body | Grains, mass: float) -> list[Program]:
    """Return the force per mass along each axis as a program for the core; none for no force.

    Args:
        part: of a case.
        mass: of all of it at the start [kg; in 2D per metre of thickness].
    """
    by_mass = list(map(program_of, part.body_force or ()))
    shared: list[Program] = [
        [*program_of(value), ("number", mass), ("divide", 0.0)] for value in part.force or ()
    ]
    if not by_mass or not shared:
        return by_mass or shared
    return [[*a, *b, ("add", 0.0)] for a, b in zip(by_mass, shared, strict=True)]


def acts_at_first(case: Case, on: Collection[str] | None = None) -> bool:
    """Return whether any force may act at the time 0, formulas by place among them.

    Args:
        case: of the forces.
        on: names of the bodies and entries of grains that are meant; None for all.
    """
    names = case.parts() if on is None else on
    acting = [load for load in case.load.values() if load.body in names]
    loads = (getattr(load, kind) for load in acting for kind in _core.load_kinds)
    values = [v for load in loads for v in (load if isinstance(load, tuple) else [load])]
    known = [v for v in [*case.run.gravity, *values] if v is not None]
    forces = any(force_values(case.parts()[name]) for name in names)
    return forces or any(at(value, 0.0) for value in known)


def check_forces(case: Case) -> Iterator[PydanticCustomError]:
    """Yield the forces with too few or too many numbers, or on bodies that do not deform."""
    dimension = case.grid.dimension
    for name, part in case.parts().items():
        for key in KEYS:
            path, value = (*case.part_path(name), key), getattr(part, key)
            if value is None:
                continue
            if len(value) != dimension:
                rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
                remedy = f"it has {len(value)}, give {dimension}"
                yield violation(rule, remedy, value=plain(value), path=path)
            if case.is_rigid(name):
                rule = "is of a body that does not deform, and acts on bodies that do"
                remedy = "remove it, or give the body another material and no motion"
                yield violation(rule, remedy, path=path)
