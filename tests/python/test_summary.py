# SPDX-License-Identifier: BSD-3-Clause
"""The echo says what holds, drives and removes the bodies."""

from __future__ import annotations

from itertools import product
from pathlib import Path

import pytest

from cases import BASES
from mpm3dpp import Body, Case, Grains, Grid, Material, Run, Simulation, load_case, shapes
from mpm3dpp.base.time_functions import TimeFunction
from mpm3dpp.case.box import GridBox
from mpm3dpp.case.grid import GridCoarsening
from mpm3dpp.fill.build import build
from mpm3dpp.run.memory import memory_bytes
from mpm3dpp.run.summary import echo
from mpm3dpp.run.summary_conditions import coarsenings, in_words

CASE = """
[grid]
dimension = 2
cell_size = "10 mm"
box = { lower = [0, 0], upper = ["480 mm", "240 mm"], walls = { x_min = "slip", y_min = "fixed" } }
outflow_box = { lower = ["-1 m", "-2 m"], upper = ["5 m", "6 m"] }
coarsening = { tiles = 2000 }
[run]
end_time = "1 ms"
gravity = [0, { sine = { amplitude = "3 m/s^2", frequency = "15 Hz", mean = "-9.81 m/s^2" } }]
[material.any]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[material.hard]
density = 1000
strength = { rigid = {} }
[body.block]
material = "any"
shape = { box = { lower = ["100 mm", "100 mm"], upper = ["200 mm", "200 mm"] } }
[body.piston]
material = "hard"
motion = { velocity = [0, { ramp = { from = 0, to = "-5 m/s", end = "2 ms" } }] }
shape = { box = { lower = ["100 mm", "200 mm"], upper = ["200 mm", "220 mm"] } }
[load.push]
body = "block"
side = "x_min"
pressure = "2 kPa"
[contact]
friction = 0.1
[[contact.pair]]
bodies = ["block", "piston"]
friction = 0.4
[[contact.pair]]
materials = ["any", "hard"]
friction = 0.2
"""


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> str:
    path: Path = tmp_path_factory.mktemp("echo") / "case.toml"
    path.write_text(CASE)
    case = load_case(path)
    return echo(case, build(case))


@pytest.mark.parametrize(
    "line",
    [
        "walls: x_min slip, x_max free, y_min fixed, y_max free",
        "outflow box: x > -1 m, x < 5 m, y > -2 m, y < 6 m; particles outside are taken out",
        # 48 x 24 cells can be halved three times.
        "coarsening: beyond 2,000 tiles, 3 times at most, to cells of 0.08 m",
        "gravity: (0 m/s^2, -9.81 m/s^2 + 3 m/s^2 sin at 15 Hz)",
        "load push: pressure 2 kPa on x_min of block, 0.1 m^2 per metre, carried by 20 particles",
        "contact: gap detection, springs, friction 0.1",
        "friction: 0.4 between block and piston",
        "friction: 0.2 between all any and all hard",
    ],
)
def test_conditions(shown: str, line: str) -> None:
    assert line in shown.splitlines()


def test_motion(shown: str) -> None:
    assert "moves as prescribed: velocity (0 m/s, 0 m/s to -5 m/s from 0 s to 2 ms)" in shown


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (2e6, "2 MPa"),
        (0.0, "0 Pa"),
        (
            {"times": ["0 s", "1 ms", "2 ms"], "values": [0, "5 MPa", 0]},
            "3 values of 0 Pa to 5 MPa from 0 s to 2 ms",
        ),
        (
            {"sine": {"amplitude": "3 Pa", "frequency": "2 Hz", "phase": "90 deg"}},
            "3 Pa sin at 2 Hz and 90 deg",
        ),
    ],
)
def test_quantities_in_words(given: object, said: str) -> None:
    value = TimeFunction.parse(given, "Pa")
    assert in_words(value, "Pa") == said


SOFT = Material(density=1000, strength={"elastic": {"E": 1e6, "nu": 0.3}})
COPPER = Material(library="copper_ofhc")


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize(
    ("frame", "what", "basis"),
    [
        *(("updated", *of) for of in product(["soft block", "copper block", "soft grains"], BASES)),
        *(("material", what, "quadratic_bspline") for what in ("soft block", "soft grains")),
    ],
)
def test_the_memory_is_about_that_of_a_run(
    what: str, dimension: int, basis: str, frame: str
) -> None:
    """To a quarter: nodes lie in blocks, and arrays have room to grow.

    With the quadratic B-spline to a third: grains share more nodes with their neighbours. So on
    nodes in the body: faces of cells are not quite the surface, on which contact points lie.
    """
    edge, count = {2: (0.15, 20), 3: (0.024, 5)}[dimension]
    material = what.split()[0]
    corner = [0.0] * dimension
    box = shapes.Box(lower=corner, upper=[edge] * dimension)
    lattice = {"lower": corner, "count": [count] * dimension, "radius": 2.5e-3}
    grains = {"few": Grains(material=material, lattice=lattice, frame=frame)}
    case = Case(
        grid=Grid(dimension=dimension, cell_size=1e-3, basis=basis),
        run=Run(end_time=1.0),
        material={"soft": SOFT, "copper": COPPER},
        body={"block": Body(material=material, shape=box, frame=frame)} if "block" in what else {},
        grains=grains if "grains" in what else {},
    )
    simulation = Simulation(case, threads=1)
    simulation.advance(20)
    needed = sum(simulation.core.bytes().values())
    assert memory_bytes(case, build(case)) == pytest.approx(
        needed, rel=0.33 if basis == "quadratic_bspline" or frame == "material" else 0.25
    )


def test_coarsenings_of_a_box_and_without() -> None:
    coarsening = GridCoarsening(tiles=10, times=4)
    assert coarsenings(None, coarsening) == 4
    assert coarsenings((32, 64), coarsening) == 4
    assert coarsenings((6, 64), coarsening) == 1


def test_what_contact_with_walls_alone_and_a_longer_step_come_to() -> None:
    box = shapes.Box(lower=[1e-3, 1e-3], upper=[5e-3, 5e-3])
    walls = GridBox(lower=[0, 0], upper=[10e-3, 10e-3], walls="contact")
    case = Case(
        grid=Grid(dimension=2, cell_size=1e-3, box=walls),
        run=Run(end_time=1e-3, cfl=0.9),
        material={"soft": SOFT},
        body={"block": Body(material="soft", shape=box, frame="material")},
        contact={"restitution": 0.4},
    )
    lines = echo(case, build(case))
    assert "contact: of surfaces with themselves and walls, restitution 0.4" in lines
    assert "cfl 0.9 (0.6 with contact between surfaces), " in lines
