# SPDX-License-Identifier: BSD-3-Clause
"""What bodies are made of: density, strength, equation of state, failure."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import ConfigDict, Field

from mpm3dpp import _core
from mpm3dpp.base.damping import MaterialDamping
from mpm3dpp.base.model import CaseModel, Flag, Text
from mpm3dpp.base.units import Density
from mpm3dpp.materials.chosen import AnyEos, AnyFailure, AnyStrength
from mpm3dpp.materials.library import either_library_or_own, fill_in
from mpm3dpp.materials.point import drive_point

from .parts import Viscosity


class Material(CaseModel):
    """What bodies are made of.

    Attributes:
        library: name of a material of the library, which gives the keys below; those that stand
            beside it replace the library's, a parameter of the library's own model that number
            alone. Without it, density and strength are required.
        without: parts of the library's material that are left out: "eos".
        density: initial density [kg/m^3].
        strength: one strength model with its parameters, `{"elastic": {"E": ..., "nu": ...}}`.
        eos: at most one equation of state, `{"tait": {"c0": ...}}`; it gives the pressure.
        failure: any number of failure models, `{"plastic_strain": {"limit": ...}}`; `action`
            beside a model's parameters says what failing does: "no_tension" (the default; only
            compression is left), "no_shear" (the whole pressure is) or "erode" (the particle
            takes no part any more). With `library` also "library", which takes the library's
            models with "no_tension", or `{"library": {"action": "erode"}}`.
        artificial_viscosity: bulk viscosity of this material in place of `run.viscosity`, with the
            same keys; both 0 for none. A gas and an explosive have it where neither is given.
        volume_averaging: whether all particles of a body in a cell take the mean of the changes of
            their volumes, and the nodes the mean of their pressures, so that nearly incompressible
            matter, also that which flows plastically, does not lock (Coombs et al. 2018). With
            `frame = "material"` nodes get the pressure that they can tell, without its noise: there
            it is the default for plastic matter once one particle in a hundred of a body has flowed
            by 0.2 %.
        damping: in proportion to the stiffness; None for none.
    """

    model_config = ConfigDict(json_schema_extra=either_library_or_own)

    library: Text | None = None
    without: list[Text] = Field(default_factory=list)
    density: Density
    strength: AnyStrength
    eos: AnyEos = None
    failure: AnyFailure = Field(default_factory=list)
    artificial_viscosity: Viscosity | None = None
    volume_averaging: Flag | None = None
    damping: MaterialDamping | None = None

    @classmethod
    def complete(cls, data: Any) -> Any:
        """Return the table with what its key `library` gives."""
        return fill_in(data) if isinstance(data, dict) else data

    def table(self) -> dict[str, Any]:
        """Return the material as a table of a case file, in SI units.

        It holds the numbers, not the name of a material of the library, so that it stays true
        when the library changes.
        """
        table: dict[str, Any] = {"density": self.density, "strength": self.strength.table()}
        if self.eos is not None:
            table["eos"] = self.eos.table()
        if self.failure:
            table["failure"] = {k: v for f in self.failure for k, v in f.table().items()}
        if self.artificial_viscosity is not None:
            table["artificial_viscosity"] = self.artificial_viscosity.table()
        if self.volume_averaging is not None:
            table["volume_averaging"] = self.volume_averaging
        if self.damping is not None:
            table["damping"] = self.damping.table()
        return table

    @property
    def models(self) -> set[str]:
        """Names of all models of the material."""
        names = {self.strength.model, *(f.model for f in self.failure)}
        return names if self.eos is None else {*names, self.eos.model}

    def sound_speed(self) -> float:
        """Return the speed of pressure waves at rest [m/s].

        Raises:
            ValueError: the core refuses parameters or models that do not go together.
        """
        return _sound_speed(**self.for_core())

    def matter(self) -> str:
        """Return what it is to others that touch it: "solid", "liquid" or "gas".

        Products of an explosive are a gas.
        """
        of_core = self.for_core()
        named = ("density", "strength", "parameters", "eos")
        matter: str = _core.matter(**{name: of_core[name] for name in named})
        return matter

    def viscosity_in(self, run: Viscosity | None) -> tuple[float, float]:
        """Return the quadratic and linear factor of its artificial viscosity; 0, 0: none.

        A gas for which nothing is said has the usual ones: it has nothing else that ends a shock.

        Args:
            run: `run.viscosity`, that of materials without their own.
        """
        found = run if self.artificial_viscosity is None else self.artificial_viscosity
        if found is None and self.matter() == "gas":
            found = Viscosity()
        return (0.0, 0.0) if found is None else (found.quadratic, found.linear)

    def eos_sound_speed(self) -> float | None:
        """Return what the equation of state alone gives for it [m/s]: 0 without stiffness.

        None without an equation of state.
        """
        if self.eos is None:
            return None
        alone = {"strength": "fluid", "parameters": {}, "failures": []}
        return _sound_speed(**{**self.for_core(), **alone})

    @property
    def beta(self) -> float:
        """Rayleigh's beta of its damping [s]."""
        return 0.0 if self.damping is None else self.damping.stiffness

    def for_core(self) -> dict[str, Any]:
        """Return the keyword arguments with which the core makes the material."""
        return {
            "density": self.density,
            "strength": self.strength.model,
            "parameters": self.strength.parameters,
            "eos": None if self.eos is None else (self.eos.model, self.eos.parameters),
            "failures": [(f.model, f.parameters, f.action) for f in self.failure],
            "volume_averaging": self.volume_averaging,
        }


def _sound_speed(**material: Any) -> float:
    rows, names, _ = drive_point(**material, increments=np.zeros((0, 3, 3)))
    return float(rows[0][names.index("sound_speed")])
