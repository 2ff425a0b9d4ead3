# SPDX-License-Identifier: BSD-3-Clause
"""Which test makes sense for which material, each reason a sentence."""

from __future__ import annotations

from mpm3dpp.case import Material
from mpm3dpp.errors import CaseError

from .options import Options

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
    if model == "fluid" and options.test == "uniaxial-stress":
        raise CaseError("is a fluid, which bears no uniaxial stress", ANOTHER, value=name)
