# SPDX-License-Identifier: BSD-3-Clause
"""Damping: of materials in proportion to stiffness; of motions in proportion to mass, and local."""

from __future__ import annotations

from typing import Annotated

from pydantic import model_validator

from .errors import violation
from .model import CaseModel
from .time_functions import Timed, TimeFunction, highest, lowest
from .units import Quantity


class MaterialDamping(CaseModel):
    """Damping of a material: a viscous stress beside that of its models, and no part of it.

    Equations: docs/theory/damping.md.

    Attributes:
        stiffness: beta of the damping in proportion to the stiffness [s], Rayleigh's: the viscous
            stress is beta times what the elastic moduli of the start make of the rate of strain,
            and a mode of the angular frequency w decays as exp(-beta w^2 t / 2). With
            `volume_averaging`, but for bodies with `frame = "material"`, it is of changes of shape
            alone. It makes the time step shorter; default zero.
    """

    stiffness: Annotated[float, Quantity("s", ">= 0")] = 0.0

    @model_validator(mode="after")
    def _not_empty(self) -> MaterialDamping:
        if "stiffness" not in self.model_fields_set:
            raise violation("must have stiffness", 'for example { stiffness = "1 us" }')
        return self


class Damping(CaseModel):
    """What damps the motion of a body, beside its material: artificial forces on its nodes.

    Equations: docs/theory/damping.md.

    Attributes:
        mass: rate alpha of the damping in proportion to the mass [1/s], >= 0, a number or a
            function of time: a mode decays as exp(-alpha t / 2), whatever its frequency, and a
            body that falls tends to the speed g / alpha; default zero.
        local: local damping (Cundall 1987), the share of the force out of balance that is set
            against the motion, 0 <= local < 1, a number or a function of time: a mode loses the
            share 4 local of its energy in a period, and a body at a steady speed nothing; default
            zero. Quasi-static problems take 0.5 to 0.8.
    """

    mass: Annotated[float | TimeFunction, Timed("1/s")] = 0.0
    local: Annotated[float | TimeFunction, Timed("")] = 0.0

    @model_validator(mode="after")
    def _within_bounds(self) -> Damping:
        if not self.model_fields_set & {"mass", "local"}:
            raise violation("must have mass or local", 'for example { mass = "10 1/s" }')
        for name in ("mass", "local"):
            value = getattr(self, name)
            if not lowest(value) >= 0.0:
                raise violation("must be >= 0 at all times", "give larger values", path=(name,))
        if not highest(self.local) < 1.0:
            rule = "must be < 1 at all times, as a body at rest would stay there"
            raise violation(rule, "give smaller values, for example 0.7", path=("local",))
        return self
