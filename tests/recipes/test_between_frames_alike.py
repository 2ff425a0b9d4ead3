# SPDX-License-Identifier: BSD-3-Clause
"""Particles of what flows press surfaces: the same however the world is turned and run.

What they come to in closed forms: test_between_frames.py.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mpm3dpp import Case, Simulation
from same_bits import check_same_bits
from worlds import World, check_worlds

HEAP = """
[grid]
dimension = DIMENSION
cell_size = "2 mm"
box = { lower = LOW, upper = HIGH, walls = "contact" }
[run]
end_time = "1 s"
gravity = GRAVITY
[contact]
friction = 0.3
[material.rubber]
density = "1000 kg/m^3"
strength = { neo_hookean = { K = "1.5 MPa", G = "0.4 MPa" } }
[material.sand]
density = "1600 kg/m^3"
[material.sand.strength.mohr_coulomb]
E = "1 MPa"
nu = 0.3
cohesion = 0
friction_angle = "33 deg"
[material.steel]
density = "7800 kg/m^3"
strength = { rigid = {} }
[body.block]
material = "rubber"
shape = { box = { lower = BLOCK_LOW, upper = BLOCK_HIGH } }
[body.ball]
material = "rubber"
velocity = BALL_VELOCITY
shape = { SPHERE = { centre = BALL, radius = "5 mm" } }
[body.drop]
material = "sand"
velocity = VELOCITY
shape = { SPHERE = { centre = DROP, radius = "7 mm" } }
[body.soil]
material = "sand"
velocity = VELOCITY
shape = { SPHERE = { centre = SOIL, radius = "6 mm" } }
[body.weight]
material = "steel"
velocity = VELOCITY
shape = { box = { lower = WEIGHT_LOW, upper = WEIGHT_HIGH } }
"""

ERODED = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "0.6 ms"
[material.hard]
density = "5000 kg/m^3"
strength = { elastic = { E = "1 GPa", nu = 0.3 } }
[material.soft]
density = "1000 kg/m^3"
strength = { j2 = { E = "100 MPa", nu = 0.3, Y0 = "1 MPa", H = 0 } }
failure = { plastic_strain = { limit = 0.3, action = "erode" } }
[body.ball]
material = "hard"
velocity = ["40 m/s", 0]
shape = { disc = { centre = ["-6.2 mm", 0], radius = "6 mm" } }
[body.plate]
material = "soft"
shape = { box = { lower = [0, "-20 mm"], upper = ["6 mm", "20 mm"] } }
"""
BAR = """
[grid]
dimension = 2
cell_size = "1 mm"
box = { lower = [0, "-20 mm"], upper = ["80 mm", "40 mm"], walls = { x_min = "contact" } }
[run]
end_time = "1 ms"
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "20 MPa", nu = 0.3 } }
[material.metal]
density = "1000 kg/m^3"
strength = { j2 = { E = "100 MPa", nu = 0.3, Y0 = "0.5 MPa", H = 0 } }
[body.left]
material = "soft"
frame = "updated"
velocity = ["2 m/s", 0]
shape = { disc = { centre = ["50 mm", "20 mm"], radius = "5 mm" } }
[body.right]
material = "soft"
frame = "updated"
shape = { disc = { centre = ["60.2 mm", "20 mm"], radius = "5 mm" } }
[body.bar]
material = "metal"
frame = "material"
velocity = ["-18 m/s", 0]
shape = { box = { lower = ["0.2 mm", "-4 mm"], upper = ["24.2 mm", "4 mm"] } }
"""
HALF = """
[grid]
dimension = 2
cell_size = "2 mm"
[grid.box]
lower = [EDGE, "-8 mm"]
upper = ["24 mm", "24 mm"]
walls = { x_min = "WALL", y_min = "contact" }
[run]
end_time = "1 s"
[contact]
friction = 0.3
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[material.sand]
density = "1600 kg/m^3"
[material.sand.strength.mohr_coulomb]
E = "1 MPa"
nu = 0.3
cohesion = 0
friction_angle = "33 deg"
[body.block]
material = "soft"
shape = { box = { lower = [LEFT, "-8 mm"], upper = ["20 mm", 0] } }
[body.drop]
material = "sand"
velocity = [0, "-1 m/s"]
shape = { box = { lower = [NARROW, "0.3 mm"], upper = ["6 mm", "8.3 mm"] } }
"""


def heap(dimension: int) -> Case:
    """Two drops of sand fall on a block and are hit there by a ball and a rigid weight: all kinds
    of pairs but that of a gas."""
    text = HEAP.replace("DIMENSION", str(dimension))
    text = text.replace("SPHERE", "disc" if dimension == 2 else "sphere")
    for word, place in {
        "LOW": [-0.032, -0.008, -0.016],
        "HIGH": [0.032, 0.056, 0.016],
        "GRAVITY": [0.0, -20.0, 0.0],
        "BLOCK_LOW": [-0.02, -0.008, -0.01],
        "BLOCK_HIGH": [0.02, 0.0, 0.01],
        "BALL": [0.0041, 0.0201, 0.0013],
        "BALL_VELOCITY": [-0.3, -1.5, 0.0],
        "DROP": [-0.007, 0.0073, 0.0003],
        "SOIL": [0.0083, 0.0064, -0.0011],
        "VELOCITY": [0.2, -1.0, 0.1],
        "WEIGHT_LOW": [-0.0153, 0.0153, -0.004],
        "WEIGHT_HIGH": [-0.0063, 0.0213, 0.004],
    }.items():
        text = text.replace(f"= {word}\n", f"= {place[:dimension]}\n")
        text = text.replace(f"= {word},", f"= {place[:dimension]},")
        text = text.replace(f"= {word} ", f"= {place[:dimension]} ")
    return Case.from_text(text)


@pytest.mark.parametrize(("dimension", "steps"), [(2, 250), (3, 100)])
def test_another_world_is_the_same(dimension: int, steps: int) -> None:
    case = heap(dimension)
    here = World(tuple((k, 1) for k in range(dimension))).case(case, Simulation(case))
    check_worlds(here, steps, "", meet=False)
    simulation = Simulation(here)
    simulation.advance(steps)
    assert len(simulation.core.contact_pairs()) >= 2


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_same_bits(dimension: int, tmp_path: Path) -> None:
    """With any number of threads and ranks, stages fused or not, and after a restart amid it."""
    check_same_bits(heap(dimension), tmp_path)


def test_pairs_of_both_kinds_are_told() -> None:
    """Bodies in space meet at nodes, others by surfaces: both are in the table of contacts."""
    simulation = Simulation(heap(2))
    simulation.advance(300)
    rows = simulation.core.grains_and_contacts()[1]
    told = {(int(a), int(b)) for a, b in rows[:, :2]}
    pushed = {tuple(p.bodies) for p in simulation.core.contact_pairs() if any(p.force)}
    assert told == pushed and {(0, 2), (2, 3)} <= told


def test_nodes_laid_anew_beside_bodies_that_meet_at_nodes() -> None:
    """A bar mushrooms on a wall and gets its nodes anew; two discs in space lean on each other
    meanwhile, by as much as without the bar, of which the waves make steps shorter."""
    forces = []
    for text in (BAR, BAR.partition("[body.bar]")[0]):
        simulation = Simulation(Case.from_text(text), threads=1)
        renewals = 0
        while simulation.time < 0.8e-3:
            simulation.advance(20)
            renewals = int(simulation.history()["renewals"][-1])
        forces.append(simulation.core.contact_pairs()[-1].impulse[0])
        if "[body.bar]" in text:
            assert renewals > 0
    assert forces[0] == pytest.approx(forces[1], rel=0.02)


def test_what_erodes_takes_no_push_along() -> None:
    """A ball goes through a plate that is eroded. What has eroded keeps the velocity that it left
    with, so that the momentum of all is what it was: no particle pushes that is not pushed."""
    simulation = Simulation(Case.from_text(ERODED))
    assert sorted(body.frame for body in simulation.case.body.values()) == ["material", "updated"]

    def momentum() -> float:
        return sum(
            float(simulation.column(name, "mass")[:, 0] @ simulation.column(name, "velocity")[:, 0])
            for name in simulation.bodies
        )

    begin = momentum()
    simulation.advance(10**6, end_time=simulation.case.run.end_time)
    assert simulation.eroded()["count"] > 20
    assert momentum() == pytest.approx(begin, rel=1e-9)


def test_half_a_model() -> None:
    """A drop in space falls on a block, both cut by a plane of symmetry: as the half of the whole
    does, but for rounding that has grown for 400 steps."""
    found = []
    for cut in (False, True):
        text = HALF.replace("LEFT", "0" if cut else '"-20 mm"')
        text = text.replace("NARROW", "0" if cut else '"-6 mm"')
        text = text.replace("EDGE", "0" if cut else '"-24 mm"').replace(
            "WALL", "slip" if cut else "free"
        )
        simulation = Simulation(Case.from_text(text))
        simulation.advance(400)
        drop, block = (simulation.column(name, "velocity") for name in ("drop", "block"))
        right = simulation.column("drop", "position")[:, 0] > 0.0
        found.append([*drop[right].mean(axis=0), np.abs(block).max()])
        assert simulation.core.contact_summary()["touching_points_max"] > 5
    assert found[1] == pytest.approx(found[0], rel=1e-9)
