# SPDX-License-Identifier: BSD-3-Clause
"""What stands beside an explosive without an equation of state that could bear its pressure."""

from __future__ import annotations

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case
from mpm3dpp.case.detonation import EXPLOSIVE

_RIGID = "rigid"


def explosive_notes(case: Case) -> list[str]:
    """Return a sentence for each material that products of an explosive press to nothing.

    The pressure of Chapman and Jouguet is rho D^2 / (gamma + 1), with gamma near 3 (Fickett & Davis
    1979, chapter 2). A linear elastic material bears about rho c^2 ln(V0 / V): beyond rho c^2 it is
    pressed to less than 37 % of its volume.
    """
    materials = {name: case.material[name] for name in case.materials_used}
    pressures = [
        m.density * m.strength.parameters["D"] ** 2 / 4.0
        for m in materials.values()
        if m.strength.model == EXPLOSIVE
    ]
    found = []
    for name, m in materials.items():
        if not pressures or m.eos is not None or m.strength.model == _RIGID:
            continue
        modulus = m.density * m.sound_speed() ** 2
        if modulus < max(pressures):
            found.append(
                f"{key_text(('material', name))} has no eos, and a modulus of {modulus:.2g} Pa "
                f"against the {max(pressures):.2g} Pa of a detonation, which presses it to less "
                "than 37 % of its volume where they meet: give it an equation of state and a "
                "strength that takes one, for a wet soil strength = { j2 = ... } with eos = "
                '{ mie_gruneisen = { c0 = "1650 m/s", s = 1.5, gamma0 = 0.1 } }'
            )
    return found
