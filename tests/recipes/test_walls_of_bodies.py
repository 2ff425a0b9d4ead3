# SPDX-License-Identifier: BSD-3-Clause
"""Slip and fixed walls hold bodies on nodes of their own that lie on them, and push back others."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from in_body import CELL, SPEED, part, run_and_look
from mpm3dpp import Case, Simulation
from same_bits import check_same_bits
from worlds import check_worlds

SIZE = 8 * CELL
BLOCK = {"box": {"lower": [0.0, 0.0, 0.0], "upper": [SIZE] * 3}}


def boxed(
    dimension: int,
    shape: dict[str, Any],
    walls: dict[str, str],
    gap: float = 0.0,
    friction: float | None = None,
    contact: dict[str, Any] | None = None,
    lower: float = 0.0,
    upper: float = 40 * CELL,
    **body: Any,
) -> Case:
    """Return a body in a box, moved up by a gap along y."""
    kind, keys = next(iter(shape.items()))
    moved = {
        key: [x + (gap if k == 1 else 0.0) for k, x in enumerate(value)][:dimension]
        if isinstance(value, list)
        else value
        for key, value in keys.items()
    }
    box: dict[str, Any] = {
        "lower": [lower, *[0.0] * (dimension - 1)],
        "upper": [upper, *[40 * CELL] * (dimension - 1)],
        "walls": walls,
    }
    if friction is not None:
        box["friction"] = friction
    return Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": CELL, "box": box},
            "run": {"end_time": 40 * SIZE / SPEED},
            "contact": contact or {},
            "material": {"m": {"density": 1000.0, "strength": {"elastic": {"E": 1e7, "nu": 0.3}}}},
            "body": {"a": {"material": "m", "frame": "material", "shape": {kind: moved}, **body}},
        }
    )


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(("wall", "friction"), [("slip", 0.0), ("fixed", 1e6)])
def test_what_does_not_lie_on_a_wall_is_pushed_back(
    dimension: int, wall: str, friction: float
) -> None:
    """As by a face that is contact, smooth or so rough that nothing slides: the same bits."""
    falls = {"velocity": [1.0, -2.0, 0.0][:dimension]}
    rows = []
    for word, mu in ((wall, None), ("contact", friction)):
        walls = {"y_min": word, "x_max": "free"}
        simulation = Simulation(boxed(dimension, BLOCK, walls, 0.3 * CELL, mu, **falls))
        columns, _ = run_and_look(simulation, 10**5)
        rows.append(np.array(list(columns.values())))
        assert part(simulation, "velocity_y") > 0.0
        assert simulation.column("a", "position")[:, 1].min() > 0.3 * CELL
        total = columns["kinetic"] + columns["internal"]
        # A flat hit costs some tenths of a per cent, friction what it takes.
        assert wall == "fixed" or total[-1] == pytest.approx(total[0], rel=5e-3)
    assert np.array_equal(*rows)


@pytest.mark.parametrize("contact", [{}, {"enabled": False}])
def test_a_ball_that_touches_a_wall_in_a_point_leaves_it(contact: dict[str, Any]) -> None:
    """It does not lie on it: what holds it as a plane of symmetry is a face that is flat there."""
    radius = 4 * CELL
    ball = {"disc": {"centre": [20 * CELL, radius], "radius": radius}}
    case = boxed(2, ball, {"y_min": "slip"}, contact=contact, velocity=[0.0, 1.0])
    simulation = Simulation(case)
    run_and_look(simulation, 10**5)
    assert part(simulation, "centre_y") == pytest.approx(radius + case.run.end_time, rel=1e-9)
    assert part(simulation, "velocity_y") == pytest.approx(1.0, rel=1e-9)


def test_what_lies_on_a_wall_is_held() -> None:
    """As before: half of a body that is thrown off a plane of symmetry stays on it."""
    case = boxed(2, BLOCK, {"x_min": "slip", "y_max": "slip"}, velocity=[1.0, 0.0])
    simulation = Simulation(case)
    run_and_look(simulation, 10**5)
    x = simulation.column("a", "position")[:, 0]
    assert x.min() < 0.4 * CELL


def test_half_of_a_body_hits_a_wall_as_the_whole_does() -> None:
    """It spreads, and is pushed back by the far wall while a plane of symmetry holds it."""
    far = SIZE + CELL
    kinetic = []
    for whole in (True, False):
        lower = -SIZE if whole else 0.0
        shape = {"box": {"lower": [lower, 2 * CELL], "upper": [SIZE, 8 * CELL]}}
        case = boxed(
            2,
            shape,
            {"x_min": "slip", "x_max": "slip"},
            velocity=[{"expression": "500 * x"}, 0.0],
            lower=-far if whole else 0.0,
            upper=far,
        )
        simulation = Simulation(case)
        columns, _ = run_and_look(simulation, 10**5)
        x = simulation.column("a", "position")[:, 0]
        assert x.max() < far
        kinetic.append(columns["kinetic"])
    whole, half = kinetic
    assert len(whole) == len(half)
    # Nodes are given their velocities to 1e-6 (start_in_body.cpp).
    assert np.abs(whole - 2.0 * half).max() < 1e-5 * whole[0]


def test_the_same_bits(tmp_path: Path) -> None:
    """With any number of threads and ranks, and after a restart amid it."""
    check_same_bits(corner(2), tmp_path)


def corner(dimension: int) -> Case:
    """Return a block on a plane of symmetry, along which it flies into a corner of walls."""
    walls = {"x_min": "slip", "y_min": "slip"} | ({"z_min": "fixed"} if dimension == 3 else {})
    shape = {"box": {"lower": [0.5 * CELL, 0.0, 0.5 * CELL], "upper": [SIZE, 6 * CELL, SIZE]}}
    return boxed(dimension, shape, walls, velocity=[-5.0, 0.0, -4.0][:dimension])


@pytest.mark.parametrize("dimension", [2, 3])
def test_in_other_worlds(dimension: int) -> None:
    check_worlds(corner(dimension), 60, "", meet=False)
