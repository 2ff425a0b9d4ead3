# SPDX-License-Identifier: BSD-3-Clause
"""Examples of models as a case file has them: a whole table that is accepted as it stands."""

from __future__ import annotations

from typing import Any

from mpm3dpp.base.units import DIMENSIONS

from .catalogue import catalogue

# By parameter, or by model and parameter where a name has several meanings; what is not here has
# the example of its unit. The numbers are those of a metal, TNT, copper (shock), rubber and sand.
# fmt: off
_EXAMPLES = {
    "E": '"70 GPa"', "nu": "0.33", "Y0": '"250 MPa"', "Q": '"100 MPa"', "b": "10",
    "e0": "0.01", "n": "0.2", "A": '"90 MPa"', "B": '"292 MPa"', "C": "0.025", "m": "1.09",
    "T_melt": '"1356 K"', "cp": '"383 J/kg/K"', "c0": '"3940 m/s"', "s": "1.49",
    "gamma0": "1.96", "K": '"2.2 GPa"', "K0": '"2.2 GPa"', "viscosity": '"1 mPa*s"',
    "johnson_cook.E": '"129.8 GPa"', "johnson_cook.nu": "0.343", "johnson_cook.n": "0.31",
    "neo_hookean.K": '"121.7 MPa"', "neo_hookean.G": '"26.1 MPa"', "murnaghan.n": "7.15",
    "drucker_prager.E": '"10 MPa"', "drucker_prager.nu": "0.3", "q_phi": "0.3",
    "k_phi": '"1 kPa"', "mohr_coulomb.E": '"10 MPa"', "mohr_coulomb.nu": "0.3",
    "cohesion": '"1 kPa"', "friction_angle": '"33 deg"', "D": '"6930 m/s"',
    "jwl.A": '"371.2 GPa"', "jwl.B": '"3.21 GPa"', "R1": "4.15", "R2": "0.95", "omega": "0.3",
    "jwl.E0": '"7 GPa"', "gamma": "1.4", "ideal_gas.E0": '"253.3 kPa"', "tait.c0": '"1482 m/s"',
    "tillotson.a": "0.5", "tillotson.b": "1.63", "tillotson.A": '"75.2 GPa"',
    "tillotson.B": '"65 GPa"', "tillotson.e0": '"5 MJ/kg"', "e_iv": '"3 MJ/kg"',
    "e_cv": '"13.9 MJ/kg"', "c1": '"2.2 GPa"', "D1": "0.05", "D2": "3.44", "D3": "-2.12",
    "limit": "0.5",
    "principal_stress.limit": '"300 MPa"', "maximum_shear.limit": '"200 MPa"',
    "hydrostatic_tension.limit": '"1.2 GPa"', "energy_limit.limit": '"7 GJ/m^3"',
}
# fmt: on
# Parameters with a default without which the model says little or is not accepted.
_SHOWN = {"polynomial.c1", "fluid.viscosity"}


def example(kind: str, model: str) -> str:
    """Return a model with an example of each parameter: `{ E = "70 GPa", nu = 0.33 }`.

    Those that have a default are left out.
    """
    pairs = [
        f"{p.name} = {_example(model, p)}"
        for p in catalogue(kind)[model].parameters
        if p.default is None or f"{model}.{p.name}" in _SHOWN
    ]
    return f"{{ {', '.join(pairs)} }}" if pairs else "{}"


def _example(model: str, parameter: Any) -> str:
    of_unit = DIMENSIONS.get(parameter.unit, ("", "1.0"))[1]
    return _EXAMPLES.get(f"{model}.{parameter.name}", _EXAMPLES.get(parameter.name, of_unit))
