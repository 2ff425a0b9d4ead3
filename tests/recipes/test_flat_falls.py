# SPDX-License-Identifier: BSD-3-Clause
"""Soft blocks that fall flat from rest on a wall and bounce, and hits of bodies that fly: springs
of contact begin as the surfaces meet, whatever the bodies did at the start. By default settings."""

from __future__ import annotations

from typing import Any

import pytest

from in_body import part, run_and_look
from mpm3dpp import Case, Simulation

RUBBER = {"neo_hookean": {"K": 20e6, "G": 1e6}}
FOAM = {"elastic": {"E": 2.8e6, "nu": 0.3}}


def fall(strength: dict[str, Any], cell_mm: float, friction: float) -> dict[str, float]:
    """What becomes of the work of gravity on a block 80 mm long that falls by 60 mm, in .3 s."""
    box = {
        "lower": [-0.2, 0.0],
        "upper": [0.2, 0.3],
        "walls": {"y_min": "contact"},
        "friction": friction,
    }
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": cell_mm * 1e-3, "box": box},
            "run": {"end_time": 0.3, "gravity": [0.0, -9.81]},
            "material": {"m": {"density": 1100.0, "strength": strength}},
            "body": {
                "block": {
                    "material": "m",
                    "frame": "material",
                    "shape": {"box": {"centre": [0.0, 0.08], "size": [0.08, 0.04]}},
                }
            },
        }
    )
    columns, _ = run_and_look(Simulation(case), 10**6)
    return {name: float(columns[name][-1] / abs(columns["external"][-1])) for name in columns}


@pytest.mark.parametrize("friction", [0.0, 0.1, 0.5])
@pytest.mark.parametrize(
    ("strength", "cell_mm"), [(RUBBER, 10.0), (RUBBER, 5.0), (FOAM, 5.0)], ids=str
)
def test_a_block_falls_flat_from_rest(strength, cell_mm, friction):
    """No energy is made; without friction 3 % at most is lost in three to five hits, 1 % of what is
    not nearly incompressible; the dashpot of what slides takes no more of a hit."""
    shares = fall(strength, cell_mm, friction)
    assert shares["contact"] > -0.002
    lost = shares["contact"] + shares["numerical"]
    most = 0.01 if strength is FOAM else 0.03
    assert -0.005 < lost < most
    kept = shares["kinetic"] + shares["internal"] + shares["springs"]
    assert kept + shares["friction"] == pytest.approx(1.0 - lost, abs=1e-3)


def hit(speed: float) -> list[float]:
    """Two discs that meet at .002 of the speed of waves and fly at `speed` along each axis: the
    largest force, and how fast they part."""
    R, closing = 0.01, 0.1
    discs = {
        name: {
            "material": "m",
            "frame": "material",
            "shape": {"disc": {"centre": [side * 1.005 * R, 0.0], "radius": R}},
            "velocity": [speed - 0.5 * side * closing, speed],
        }
        for name, side in (("left", -1.0), ("right", 1.0))
    }
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": R / 4},
            "run": {"end_time": 0.004},
            "material": {"m": {"density": 1000.0, "strength": {"elastic": {"E": 2e6, "nu": 0.3}}}},
            "body": discs,
        }
    )
    simulation = Simulation(case)
    _, forces = run_and_look(simulation, 1, lambda s: part(s, "contact_force_x", 1))
    left, right = (part(simulation, "velocity_x", body) for body in (0, 1))
    return [max(force for _, force in forces), right - left]


def test_how_fast_bodies_fly_does_not_matter():
    at_rest = hit(0.0)
    assert at_rest[1] > 0.09
    assert hit(3.0) == pytest.approx(at_rest, rel=1e-8)
    assert hit(300.0) == pytest.approx(at_rest, rel=1e-6)  # of the rounding of places
