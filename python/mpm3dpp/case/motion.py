# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed motions of bodies: fixed, or a velocity and a spin as functions of time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BeforeValidator, WithJsonSchema
from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import Path, nearest, violation
from mpm3dpp.base.mean import mass_centre
from mpm3dpp.base.model import CaseModel
from mpm3dpp.base.time_functions import TimedSpin, TimedVelocity, at, bound
from mpm3dpp.base.units import Point

if TYPE_CHECKING:
    from .body import Body
    from .case import Case

Array = NDArray[np.float64]


class Motion(CaseModel):
    """A motion that a body has whatever acts on it; `motion = "fixed"` is none at all.

    The body does not deform. It pushes others and is not pushed; gravity does not act on it, and
    bodies that do not deform do not act on each other.

    Attributes:
        velocity: of the centre [m/s], D numbers or functions of time; default zero.
        angular_velocity: spin about the centre [rad/s]: one number or function of time in 2D,
            three in 3D; default zero. Stored as a tuple.
        centre: where the axis of the spin passes at the start [m], D numbers; it moves with
            `velocity`; default: the body's mass centre.
    """

    velocity: TimedVelocity = ()
    angular_velocity: TimedSpin = ()
    centre: Point | None = None

    @property
    def moves(self) -> bool:
        """Whether it is not at rest at all times."""
        return any(bound(f) for f in (*self.velocity, *self.angular_velocity))

    def middle(self, positions: Array, volumes: Array, world: Any = None) -> Array:
        """Return the centre at the start [m], shape (D,).

        Args:
            positions: of the body's particles [m], shape (n, D).
            volumes: [m^3; in 2D m^2], shape (n,).
            world: see `mass_centre`.
        """
        return np.array(self.centre) if self.centre else mass_centre(positions, volumes, world)

    def velocities(self, time: float, positions: Array, centre: Array) -> Array:
        """Return the velocities [m/s] at a time [s], shape (1, D) without spin, else (n, D).

        Args:
            time: [s].
            positions: at that time [m], shape (n, D).
            centre: at that time [m], shape (D,).
        """
        velocity = np.array([at(f, time) for f in self.velocity])
        spin = np.array([at(f, time) for f in self.angular_velocity])
        if not spin.any():
            return velocity.reshape(1, -1)
        arm = positions - centre
        if len(velocity) == 2:
            return velocity + spin[0] * np.column_stack([-arm[:, 1], arm[:, 0]])
        return velocity + np.cross(spin, arm)


def _parse(value: Any) -> Any:
    if isinstance(value, str):
        if value != "fixed":
            remedy = f"{nearest(value, ['fixed'])}, or a table {{ velocity = [...] }}"
            raise violation("is not a known motion", remedy, value=value)
        return {}
    if value is not None and not isinstance(value, dict | Motion):
        remedy = 'give "fixed" or a table such as { velocity = ["1 m/s", 0] }'
        raise violation('must be "fixed" or a table', remedy, value=value)
    return value


MaybeMotion = Annotated[
    Motion | None,
    BeforeValidator(_parse),
    WithJsonSchema({"anyOf": [{"type": "object"}, {"type": "string", "enum": ["fixed"]}]}),
]


def check_motion(case: Case, body: Body, path: Path) -> Iterator[PydanticCustomError]:
    """Check a body's motion against the rest of the case, and fill in its defaults.

    Yields:
        The violations, with their paths in the case.
    """
    motion, dimension = body.motion, case.grid.dimension
    assert motion is not None
    for name in ("velocity", "angular_velocity"):
        if any(getattr(body, name)):
            rule = "must not be given together with motion"
            yield violation(rule, f"write motion = {{ {name} = ... }}", path=(*path, name))
    if case.contact.bonded:
        rule = "must not be given where contact.bonded = true: all bodies move as one there"
        yield violation(rule, "remove one of the two", path=(*path, "motion"))
    wanted = {"velocity": dimension, "angular_velocity": 1 if dimension == 2 else 3}
    for name, count in {**wanted, "centre": dimension}.items():
        given = getattr(motion, name)
        if given and len(given) != count:
            numbers = "one number" if count == 1 else f"{count} numbers"
            rule = f"must have {numbers}, as grid.dimension = {dimension}"
            yield violation(rule, f"it has {len(given)}", path=(*path, "motion", name))
        if not given and name in wanted:
            motion.__dict__[name] = (0.0,) * count
    if motion.centre and not any(bound(f) for f in motion.angular_velocity):
        rule = "must not be given without angular_velocity"
        yield violation(rule, "remove it", path=(*path, "motion", "centre"))
