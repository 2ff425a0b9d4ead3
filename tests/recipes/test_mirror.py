# SPDX-License-Identifier: BSD-3-Clause
"""A slip wall is a plane of symmetry: half a problem at a wall moves as the half of a whole one."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES
from mpm3dpp import Body, Case, Contact, Grid, GridBox, Material, Run, Simulation, Walls

CELL = 0.1


def block(lower: list[float], upper: list[float], velocity: list[float]) -> Body:
    return Body(
        material="solid", shape={"box": {"lower": lower, "upper": upper}}, velocity=velocity
    )


def run(
    bodies: dict[str, Body], low: float, basis: str, scheme: str, gravity: float,
    steps: int = 20, factor: float = 0.25, transfer: Any = "flip",
) -> Simulation:  # fmt: skip
    """Run bodies in a box from x = `low`, a slip wall there if it is zero."""
    walls = Walls(x_min="slip" if low == 0.0 else "free", y_min="slip")
    case = Case(
        grid=Grid(
            dimension=2,
            cell_size=CELL,
            basis=basis,
            box=GridBox(lower=[low, 0.0], upper=[2.0, 2.0], walls=walls),
        ),
        run=Run(end_time=1.0, scheme=scheme, gravity=[0.0, gravity], cfl=factor, transfer=transfer),
        contact=Contact(bonded=True),
        material={
            "solid": Material(density=1000.0, strength={"neo_hookean": {"K": 1e6, "G": 5e5}})
        },
        body=bodies,
    )
    simulation = Simulation(case, threads=1)
    simulation.advance(steps)
    return simulation


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize(
    ("scheme", "transfer"), [("musl", "flip"), ("usf", "flip"), ("musl", "xpic")]
)
def test_half_a_body_at_a_wall_is_half_of_a_whole_one(
    basis: str, scheme: str, transfer: str
) -> None:
    """Thrown at the wall fast enough that particles come within half a particle of it."""
    right = block([0.0, 0.3], [0.5, 0.9], [-12.0, -3.0])
    left = block([-0.5, 0.3], [0.0, 0.9], [12.0, -3.0])
    half = run({"right": right}, 0.0, basis, scheme, -10.0, transfer=transfer)
    whole = run({"left": left, "right": right}, -2.0, basis, scheme, -10.0, transfer=transfer)
    assert half.step == whole.step == 20
    here, there = half.column("right", "position"), whole.column("right", "position")
    assert here[:, 0].min() < 0.25 * CELL  # a particle's reach is beyond the wall
    assert np.abs(here - there).max() < 1e-12
    assert half.column("right", "stress") == pytest.approx(
        whole.column("right", "stress"), abs=1e-9 * 1e6
    )


def test_the_ledger_closes_at_a_wall_that_gravity_presses_on() -> None:
    """The work of gravity is that of the fall of the mass centre, to first order of the step."""
    errors = []
    for factor in (0.2, 0.1, 0.05):
        body = block([0.0, 0.0], [0.5, 0.6], [-4.0, -6.0])
        steps = round(12 / factor)
        simulation = run({"right": body}, 0.0, "gimp", "musl", -200.0, steps, factor)
        core = simulation.core
        history = dict(zip(core.history_columns, core.history().T, strict=True))
        assert np.abs(history["residual"]).max() < 1e-12 * history["kinetic"][0]
        fallen = np.mean(simulation.column("right", "position")[:, 1]) - 0.3
        error = history["external"][-1] + 200.0 * core.total_mass * fallen
        errors.append(error / history["kinetic"][0])
    assert abs(errors[0]) < 0.02
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(2.0, rel=0.1)


@pytest.mark.parametrize("scheme", ["musl", "usf"])
def test_tiles_do_not_matter_at_a_wall_that_gravity_presses_on(scheme: str) -> None:
    """A mushroom on the floor, cut into other tiles by where another body begins, moves the same.

    The blocks of its cap beside the stem do not reach the node beyond the wall.
    """
    corners = [[0.9, 0.0], [1.5, 0.0], [1.5, 0.1], [1.9, 0.1], [1.9, 0.4], [0.5, 0.4], [0.5, 0.1]]
    mushroom = {"polygon": {"points": [*corners, [0.9, 0.1]]}}
    motions = []
    for k in range(8):  # the edge of a tile in cells
        bodies = {
            "post": block([0.1 * k, 1.5], [0.1 * k + 0.2, 1.7], [0.0, 0.0]),
            "mushroom": Body(material="solid", shape=mushroom, velocity=[0.0, -5.0]),
        }
        simulation = run(bodies, -1.0, "gimp", scheme, gravity=-500.0, steps=30)
        motions.append(simulation.column("mushroom", "velocity"))
    assert motions[0][:, 1].max() - motions[0][:, 1].min() > 1.0  # the floor has stopped a part
    for motion in motions[1:]:  # sums in another order: roundings of speeds of some m/s
        assert np.abs(motion - motions[0]).max() < 1e-10
