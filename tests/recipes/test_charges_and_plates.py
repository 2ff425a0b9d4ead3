# SPDX-License-Identifier: BSD-3-Clause
"""What a charge throws, against Gurney's formula, and soil that cannot bear a charge."""

from __future__ import annotations

import math
from typing import Any

import pytest

from mpm3dpp import Case, Simulation
from mpm3dpp.fill.explosive_notes import explosive_notes

H, WIDTH, CHARGE = 0.005, 0.02, 0.04  # [m]
STEEL = {"density": 7850.0, "strength": {"j2": {"E": 210e9, "nu": 0.3, "Y0": 5e8}}}
WET_SOIL = {
    "density": 1900.0,
    "strength": {"j2": {"E": 100e6, "nu": 0.3, "Y0": 1e5}},
    "eos": {"mie_gruneisen": {"c0": 1650.0, "s": 1.5, "gamma0": 0.1}},
    "failure": {"hydrostatic_tension": {"limit": 1e5}},
}


def slab(from_x: float, to_x: float, material: str) -> dict[str, Any]:
    return {
        "material": material,
        "shape": {"box": {"lower": [from_x, 0.0], "upper": [to_x, WIDTH]}},
    }


def layers(soil: dict[str, Any] | None, bonded: bool) -> Case:
    """TNT on a rigid wall, under a layer of soil if there is one, and a plate of steel."""
    over = CHARGE + (0.1 if soil else 0.0)
    body = {"charge": slab(0.0, CHARGE, "tnt"), "plate": slab(over, over + 0.02, "steel")}
    material: dict[str, Any] = {"tnt": {"library": "tnt"}, "steel": STEEL}
    if soil:
        body["soil"] = slab(CHARGE, over, "soil")
        material["soil"] = soil
    walls = {"x_min": "slip", "y_min": "slip", "y_max": "slip"}
    return Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": H,
                "box": {"lower": [0.0, 0.0], "upper": [2.0, WIDTH], "walls": walls},
            },
            "run": {"end_time": 0.6e-3, "viscosity": {}},
            "material": material,
            "body": body,
            "contact": {"bonded": True} if bonded else {},
            "detonation": [{"point": [0.0, 0.5 * WIDTH]}],
        }
    )


def over_gurney(case: Case) -> float:
    """Return the mean speed of what is thrown over sqrt(2E) (M / C + 1 / 3)^-1/2 (Gurney 1943).

    2.44 km/s are those of TNT (Dobratz & Crawford 1985), its products between a wall and M.
    """
    simulation = Simulation(case, threads=1)
    simulation.advance(10**9, case.run.end_time)
    mass, momentum = {}, {}
    for name in simulation.bodies:
        m = simulation.column(name, "mass")[:, 0]
        mass[name] = m.sum()
        momentum[name] = (m * simulation.column(name, "velocity")[:, 0]).sum()
    charge = mass.pop("charge")
    momentum.pop("charge")
    thrown = sum(mass.values())
    gurney = 2440.0 / math.sqrt(thrown / charge + 1.0 / 3.0)
    return float(sum(momentum.values()) / thrown / gurney)


@pytest.mark.parametrize("bonded", [False, True])
def test_a_charge_throws_a_plate_as_gurney_says(bonded: bool) -> None:
    # His constant is fitted to tests, whose scatter is 3 to 5 %.
    assert over_gurney(layers(None, bonded)) == pytest.approx(1.0, abs=0.03)


def test_soil_with_an_equation_of_state_is_thrown_alike_in_contact_and_bonded() -> None:
    """Below the formula, which has neither heat of the shock nor layers of different speeds."""
    apart, bonded = (over_gurney(layers(WET_SOIL, bonded)) for bonded in (False, True))
    assert 0.8 < apart < 1.0
    assert bonded == pytest.approx(apart, abs=0.02)


def test_soil_that_a_charge_presses_to_nothing_is_told() -> None:
    told = explosive_notes(layers({"library": "sand_dry"}, False))
    assert len(told) == 1
    assert told[0].startswith("material.soil has no eos")
    for fine in (layers(WET_SOIL, False), layers(None, False)):
        assert not explosive_notes(fine)
