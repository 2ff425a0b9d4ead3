# SPDX-License-Identifier: BSD-3-Clause
"""Loads on sides of every kind of body: resultants, and uniform pressure within."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import CELL, DENSITY, YOUNG, block, materials
from mpm3dpp import Body, Case, Grid, Particles, Run, Simulation, shapes
from mpm3dpp.case.loads import Load
from mpm3dpp.fill.build import build

PRESSURE = 1000.0


def loaded(body: Body, side: str, dimension: int, pressure: Any = PRESSURE, **run: Any) -> Case:
    return Case(
        grid=Grid(dimension=dimension, cell_size=CELL),
        run=Run(**{"end_time": 1.0} | run),
        material={"solid": materials()["solid"]},
        body={"body": body.model_copy(update={"frame": "updated"})},
        load={"load": Load(body="body", side=side, pressure=pressure)},
    )


def scaled(numbers: Any) -> tuple[float, ...]:
    """Return cells as lengths."""
    return tuple(CELL * number for number in numbers)


LOW, HIGH = scaled((0, 0, 0)), scaled((6, 4, 4))
ENDS: list[tuple[Any, str, float, tuple[int, ...]]] = [
    (shapes.Cylinder(centre=LOW, radius=3 * CELL, height=6 * CELL), "upper", 9 * np.pi, (0, 0, -1)),
    (
        shapes.Tube(
            centre=LOW, inner_radius=2 * CELL, outer_radius=4 * CELL, height=6 * CELL, axis="x"
        ),
        "lower",
        12 * np.pi,
        (1, 0, 0),
    ),
    (
        shapes.Frustum(
            centre=LOW, height=6 * CELL, lower_radius=2 * CELL, upper_radius=4 * CELL, axis="y"
        ),
        "lower",
        4 * np.pi,
        (0, 1, 0),
    ),
    # What a pressure on a slope pushes along the axis is that on what the slope shows.
    (
        shapes.Frustum(
            centre=LOW, height=6 * CELL, lower_radius=2 * CELL, upper_radius=4 * CELL, axis="y"
        ),
        "outer",
        12 * np.pi,
        (0, 1, 0),
    ),
    (
        shapes.OgiveRod(tip=LOW, radius=3 * CELL, length=10 * CELL, crh=1.0, towards="x"),
        "nose",
        9 * np.pi,
        (-1, 0, 0),
    ),
    (
        shapes.Polygon(points=[scaled(p) for p in ((0, 0), (6, 0), (6, 4), (2, 6))]),
        "side_1",
        4,
        (-1, 0),
    ),
    (
        shapes.Box(lower=LOW[:2], upper=HIGH[:2])
        - shapes.Disc(centre=scaled((3, 2)), radius=0.9 * CELL),
        "0.y_max",
        6,
        (0, -1),
    ),
]


def after_steps(case: Case, count: int) -> tuple[Simulation, dict[str, float]]:
    simulation = Simulation(case, 1)
    simulation.advance(count)
    rows = simulation.core.history()
    return simulation, dict(zip(simulation.core.history_columns, rows[-1].tolist(), strict=True))


@pytest.mark.parametrize(("shape", "side", "area", "way"), ENDS)
def test_the_resultant_on_a_side(shape: Any, side: str, area: float, way: tuple[int, ...]) -> None:
    """The momentum after the first step is pressure times area times its length."""
    dimension = len(way)
    simulation, row = after_steps(loaded(Body(material="solid", shape=shape), side, dimension), 1)
    impulse = PRESSURE * area * CELL ** (dimension - 1) * simulation.time
    momentum = [row[f"momentum_{axis}"] for axis in "xyz"[:dimension]]
    assert momentum == pytest.approx(impulse * np.array(way), rel=1e-11, abs=1e-11 * impulse)


@pytest.mark.parametrize("shape", [shape for shape, *_ in ENDS])
def test_a_pressure_all_around_pushes_no_one(shape: Any) -> None:
    dimension = len(shape.bounds()[0])
    simulation, row = after_steps(loaded(Body(material="solid", shape=shape), "all", dimension), 1)
    [found] = simulation.core.loads()
    scale = PRESSURE * found.area * simulation.time
    momentum = np.array([row[f"momentum_{axis}"] for axis in "xyz"[:dimension]])
    assert scale > 0.0 and np.abs(momentum).max() < 1e-13 * scale


@pytest.mark.parametrize("dimension", [2, 3])
def test_particles_on_a_lattice_bear_a_load_as_their_box_does(dimension: int) -> None:
    """To rounding, as they are the same particles with the same pieces."""
    box = block((4,) * dimension, (6, 4, 4)[:dimension], material="solid")
    [filled] = build(loaded(box, "x_max", dimension))
    cloud = Body(material="solid", particles=Particles(filled.positions, filled.volumes))
    found = []
    for body in (box, cloud):
        simulation, _ = after_steps(loaded(body, "x_max", dimension), 20)
        found.append(simulation.column("body", "position"))
    assert np.abs(found[0] - filled.positions).max() > 1e-6
    assert np.abs(found[0] - found[1]).max() < 1e-15


@pytest.mark.parametrize("kind", ["polygon", "cut", "particles"])
def test_a_body_under_pressure_all_around_has_that_pressure(kind: str) -> None:
    """Within a body pressed slowly from all sides the stress is -p, and it stays where it is."""
    square = shapes.Box(lower=scaled((-8, -8)), upper=scaled((8, 8)))
    hexagon = shapes.Polygon(
        points=[scaled((9 * np.cos(a), 9 * np.sin(a))) for a in np.arange(6) * np.pi / 3]
    )
    shape: Any = hexagon if kind == "polygon" else square
    if kind == "cut":
        shape = square - shapes.Disc(centre=scaled((8, 8)), radius=4 * CELL)
    body = Body(material="solid", shape=shape)
    if kind == "particles":
        round_body = Body(material="solid", shape=shapes.Disc(centre=(0.0, 0.0), radius=8 * CELL))
        [filled] = build(loaded(round_body, "all", 2))
        body = Body(material="solid", particles=Particles(filled.positions, filled.volumes))
    wave = CELL / np.sqrt(YOUNG / DENSITY)
    ramp = {"ramp": {"to": PRESSURE, "end": 100 * wave}}
    simulation = Simulation(loaded(body, "all", 2, ramp, end_time=150 * wave, cfl=0.5), 2)
    start = simulation.column("body", "position")
    simulation.advance(10**6, end_time=100 * wave)
    stresses = []
    while simulation.advance(5):
        stresses.append(simulation.column("body", "stress"))
    inner = np.linalg.norm(start, axis=1) < 4 * CELL
    mean = np.mean(stresses, axis=0)[inner].mean(axis=0)
    assert mean[:2] == pytest.approx([-PRESSURE, -PRESSURE], rel=0.03)
    assert abs(mean[5]) < 0.01 * PRESSURE
    moved = simulation.column("body", "position") - start
    assert np.abs(moved.mean(axis=0)).max() < 0.02 * np.abs(moved).max()
