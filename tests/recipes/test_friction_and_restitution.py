# SPDX-License-Identifier: BSD-3-Clause
"""Coulomb's friction beside a restitution: mu times the normal force that the bodies feel."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from in_body import part
from mpm3dpp import Case, Simulation

CELL, RADIUS, MU = 1e-3, 4e-3, 0.2
SOFT = {"density": 1200.0, "strength": {"elastic": {"E": 10e6, "nu": 0.3}}}


def hit(dimension: int, restitution: float, on: str) -> Simulation:
    """A disc or ball comes down obliquely, on a wall or on a body that is held."""
    low, high = [-0.008] * dimension, [0.02, 0.02, 0.008][:dimension]
    low[1] = 0.0
    grid: dict[str, Any] = {"dimension": dimension, "cell_size": CELL}
    under = {
        "box": {"lower": [*low[:1], -3 * CELL, *low[2:]], "upper": [*high[:1], 0.0, *high[2:]]}
    }
    bodies: dict[str, Any] = {
        "ball": {
            "material": "soft",
            "frame": "material",
            "velocity": [1.5, -0.6, 0.4][:dimension],
            "shape": {
                "sphere" if dimension == 3 else "disc": {
                    "centre": [0.0, RADIUS + 0.2 * CELL, 0.0][:dimension],
                    "radius": RADIUS,
                }
            },
        }
    }
    if on == "wall":
        room = {"lower": low, "upper": high}
        grid["box"] = {**room, "walls": {"y_min": "contact"}}
    else:
        bodies["slab"] = {"material": "soft", "shape": under, "motion": "fixed"}
    case = Case.model_validate(
        {
            "grid": grid,
            "run": {"end_time": 1.0},
            "contact": {"friction": MU, "restitution": restitution},
            "material": {"soft": SOFT},
            "body": bodies,
        }
    )
    return Simulation(case)


def impulse_on_ball(simulation: Simulation) -> np.ndarray:
    return np.array([part(simulation, f"momentum_{x}") for x in "xyz"])


@pytest.mark.parametrize(
    ("dimension", "on", "restitution"),
    [
        *((2, "wall", e) for e in (1.0, 0.7, 0.0)),
        *((2, "held", e) for e in (0.7, 0.2)),
        (3, "wall", 0.4),
        (3, "held", 0.6),
    ],
)
def test_what_slides_in_a_hit_has_mu(dimension: int, on: str, restitution: float) -> None:
    """Of walls to .1 %, as what parts slowly may stick at last, of bodies, which have dents, to
    .3 %. It was mu / e: friction was bounded by the whole force of springs as bodies part too."""
    simulation = hit(dimension, restitution, on)
    before = impulse_on_ball(simulation)
    simulation.advance(10**7, 5e-3)
    assert part(simulation, "velocity_y") > -1e-3
    given = impulse_on_ball(simulation) - before
    ratio = np.hypot(given[0], given[2]) / given[1]
    assert ratio == pytest.approx(MU, rel=1e-3 if on == "wall" else 3e-3)


@pytest.mark.parametrize("restitution", [0.9, 0.5])
def test_a_block_slides_as_far_as_without(restitution: float) -> None:
    """v^2 / 2 mu g = 25.5 mm, of a wall; it went four fifths of it with a restitution of .7."""
    block = {"box": {"lower": [0.0, 0.0], "upper": [8e-3, 4e-3]}}
    box = {"lower": [-0.02, 0.0], "upper": [0.1, 0.03], "walls": {"y_min": "contact"}}
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": CELL, "box": box},
            "run": {"end_time": 0.2, "gravity": [0.0, -9.81]},
            "contact": {"friction": MU, "restitution": restitution},
            "material": {"soft": {**SOFT, "strength": {"elastic": {"E": 1e6, "nu": 0.4}}}},
            "body": {
                "block": {
                    "material": "soft",
                    "frame": "material",
                    "velocity": [0.316386, 0.0],
                    "shape": block,
                }
            },
        }
    )
    simulation = Simulation(case)
    start = part(simulation, "centre_x")
    simulation.advance(10**7, 0.2)
    assert part(simulation, "centre_x") - start == pytest.approx(25.51e-3, rel=0.01)
    assert abs(part(simulation, "velocity_x")) < 1e-3
