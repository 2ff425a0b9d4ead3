# SPDX-License-Identifier: BSD-3-Clause
"""Which test makes sense for which material, each reason a sentence."""

from __future__ import annotations

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.case import Material

from .options import Options

ROUNDING = 1e-9
"""A stress below this share of stiffness x strain is none: sides are free to 1e-11 of it."""

OTHERS = "test the other materials of your case"
ANOTHER = "choose another --test"


def check_before(name: str, material: Material, options: Options) -> None:
    """Refuse a test that no material of this kind can do.

    Raises:
        CaseError: says why, and what to do.
    """
    model = material.strength.model
    if model == "rigid":
        raise CaseError("is rigid: it does not deform and has no stress", OTHERS, value=name)
    if model == "high_explosive":
        rule = "is a high explosive, which burns in a run only, not in a material test"
        raise CaseError(rule, OTHERS, value=name)
    if model == "fluid" and options.test in ("uniaxial-stress", "triaxial"):
        raise CaseError("is a fluid, which bears no uniaxial stress", ANOTHER, value=name)


def check_after(
    name: str, material: Material, options: Options, stress: np.ndarray, stiffness: float
) -> None:
    """Refuse a test in which a soil has no stress but roundings, instead of drawing them.

    Args:
        name: of the material, for messages.
        material: what was tested.
        options: completed.
        stress: of the test [Pa], of any shape.
        stiffness: rho c^2 at rest [Pa].

    Raises:
        CaseError: says why the material bears nothing here, and what to do.
    """
    p, model = material.strength.parameters, material.strength.model
    cohesion = {"mohr_coulomb": "cohesion", "drucker_prager": "k_phi"}.get(model)
    none = ROUNDING * stiffness * abs(float(options.to or 0.0))
    if cohesion is None or np.abs(stress).max() > none:
        return
    if p[cohesion] == 0.0:
        rule = f"has no cohesion ({model}.{cohesion} = 0) and bears nothing without pressure"
        remedy = "choose --test triaxial, with a --pressure such as 100e3, or compress it with its"
        raise CaseError(rule, f"{remedy} sides held", value=name)
    rule = f"bears no tension ({model}.tension = {p['tension']:g})"
    raise CaseError(rule, "compress it, --to -0.1, or choose --test triaxial", value=name)
