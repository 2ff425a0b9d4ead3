# SPDX-License-Identifier: BSD-3-Clause
"""A nearly incompressible block on friction: it sticks with what check advises."""

from __future__ import annotations

import math
from typing import Any

import pytest

from in_body import part
from mpm3dpp import Case, Simulation
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build

SLOPE = math.radians(20.0)


def block(friction: float, **material: Any) -> Case:
    """40 x 20 mm of rubber on a slope of 20 degrees, by a case file."""

    def turned(lower: list[float], upper: list[float]) -> dict[str, Any]:
        return {
            "rotate": {
                "shape": {"box": {"lower": lower, "upper": upper}},
                "angle": -SLOPE,
                "about": [0.0, 0.0],
            }
        }

    rubber = {"density": 1100.0, "strength": {"neo_hookean": {"K": 10e6, "G": 1e6}}, **material}
    return Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": 5e-3},
            "run": {"end_time": 0.15, "gravity": [0.0, -9.81]},
            "contact": {"friction": friction},
            "material": {"rubber": rubber},
            "body": {
                "block": {
                    "material": "rubber",
                    "frame": "material",
                    "shape": turned([0.0, 0.0], [0.04, 0.02]),
                },
                "slope": {
                    "material": "rubber",
                    "motion": "fixed",
                    "shape": turned([-0.02, -0.02], [0.1, 0.0]),
                },
            },
        }
    )


def changed(case: Case, more: dict[str, Any]) -> Case:
    """Return a case with other values in its tables."""

    def merged(old: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
        both = {**old}
        for key, value in new.items():
            inner = isinstance(value, dict) and key not in ("shape", "strength", "box")
            both[key] = merged(both.get(key) or {}, value) if inner else value
        return both

    return Case.model_validate(merged(case.table(), more))


def is_told(case: Case) -> bool:
    """Return whether friction is the one thing that is told of a case."""
    found = notes(case, build(case))
    wanted = "material.rubber: what is elastic and loses nothing may tremble on friction"
    assert len(found) <= 1 and all(wanted in note for note in found)
    return bool(found)


def down(simulation: Simulation, end: float) -> float:
    """Return how far down the slope the block lies at a time [m]."""
    simulation.advance(10**7, end)
    x, y = part(simulation, "centre_x"), part(simulation, "centre_y")
    return x * math.cos(SLOPE) - y * math.sin(SLOPE)


REMEDIES: dict[str, dict[str, Any]] = {
    "restitution": {"contact": {"restitution": 0.9}},
    "damping": {"material": {"rubber": {"damping": {"stiffness": 10e-6}}}},
    "damping of the shape": {
        "material": {"rubber": {"damping": {"stiffness": 10e-6}, "volume_averaging": True}}
    },
}


@pytest.mark.parametrize("remedy", REMEDIES)
def test_a_block_sticks_with_what_is_advised(remedy: str) -> None:
    """.002 to .003 mm in .15 s, which its weight shears it by; 2.2 mm without, hopping."""
    assert is_told(block(0.5))
    simulation = Simulation(changed(block(0.5), REMEDIES[remedy]))
    ways = [down(simulation, end) for end in (0.0, 0.1, 0.15)]
    assert abs(ways[2] - ways[0]) < 1e-5
    assert abs(ways[2] - ways[1]) < 1e-7


@pytest.mark.parametrize("remedy", REMEDIES)
def test_a_block_slides_as_far_as_friction_lets_it(remedy: str) -> None:
    """By Coulomb's law g (sin - mu cos), once its weight has come on."""
    simulation = Simulation(changed(block(0.3), REMEDIES[remedy]))
    x = [down(simulation, end) for end in (0.05, 0.1, 0.15)]
    law = 9.81 * (math.sin(SLOPE) - 0.3 * math.cos(SLOPE))
    assert x[2] - 2.0 * x[1] + x[0] == pytest.approx(law * 0.05**2, rel=0.01)


@pytest.mark.parametrize(
    "loss",
    [
        {"material": {"rubber": {"damping": {"stiffness": 1e-6}}}},
        {"material": {"rubber": {"strength": {"j2": {"E": 3e6, "nu": 0.3, "Y0": 1e6}}}}},
        {"body": {"block": {"damping": {"mass": 10.0}}}},
        {"contact": {"restitution": 0.9}},
        {"contact": {"friction": 0.0}},
        {"run": {"settle": {"longest": 1.0}}},
        {"run": {"gravity": [0.0, 0.0]}},
    ],
    ids=str,
)
def test_whose_loss_is_known_is_not_told(loss: dict[str, Any]) -> None:
    assert not is_told(changed(block(0.5), loss))


def test_short_waves_are_not_what_trembles() -> None:
    """With a damping of .01 the block goes 1.8 mm, without 2.4."""
    assert is_told(changed(block(0.5), {"run": {"short_wave_damping": 0.01}}))


@pytest.mark.parametrize(("of_contact", "of_box"), [(0.5, None), (0.0, 0.5)])
def test_a_body_alone_on_a_wall_is_told(of_contact: float, of_box: float | None) -> None:
    box: dict[str, Any] = {
        "lower": [-0.1, -0.1],
        "upper": [0.1, 0.1],
        "walls": {"y_min": "contact"},
    }
    if of_box is not None:
        box["friction"] = of_box
    tables = changed(block(of_contact), {"grid": {"box": box}}).table()
    del tables["body"]["slope"]
    assert is_told(Case.model_validate(tables))


def test_a_fluid_has_no_loss_of_shape() -> None:
    liquid = {
        "density": 1000.0,
        "strength": {"fluid": {}},
        "eos": {"tait": {"c0": 100.0}},
        "volume_averaging": True,
        "damping": {"stiffness": 1e-6},
    }
    tables = block(0.0).table()
    tables["material"]["rubber"] = liquid
    del tables["body"]["block"]["frame"]
    with pytest.raises(ValueError, match="is of the shape alone with volume_averaging"):
        Case.model_validate(tables)
