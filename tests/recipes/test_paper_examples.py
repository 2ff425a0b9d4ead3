# SPDX-License-Identifier: BSD-3-Clause
"""Examples 02 and 03, made small, by default and as in the paper: momentum and energy close."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mpm3dpp import Case, Grid, GridBox, Simulation, load_case, shapes
from mpm3dpp.shapes import OgiveRod

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
OWN, PAPER = "case.toml", "case_paper.toml"
EACH = pytest.mark.parametrize("file", [OWN, pytest.param(PAPER, marks=pytest.mark.slow)])


def history(simulation: Simulation) -> dict[str, np.ndarray]:
    rows = simulation.core.history()
    return dict(zip(simulation.core.history_columns, rows.T, strict=True))


def penetration(layers: int, file: str = OWN) -> Case:
    """Return example 02 with so many cells through its plate, which is made smaller."""
    case = load_case(EXAMPLES / "02_penetration" / file)
    h = 26.3e-3 / layers
    cells = np.ceil(np.array([0.1, 0.05, 0.11]) / h) * h
    box = GridBox(
        lower=(-cells[0], 0.0, -cells[2]), upper=tuple(cells), walls={"y_min": "symmetry"}
    )
    plate = np.round(np.array([0.04, 0.03]) / h) * h
    basis = case.grid.basis
    case.grid = Grid(dimension=3, cell_size=h, basis=basis, origin=(0, 0, 0), box=box)
    case.body["plate"].shape = shapes.Box(
        lower=(-plate[0], 0.0, -26.3e-3), upper=(plate[0], plate[1], 0.0)
    )
    return case


@pytest.mark.parametrize("file", [OWN, PAPER])
def test_the_rod_is_that_of_the_experiment(file: str) -> None:
    """Half of 80.6 g, Piekutowski et al. 1996; the particles' mass is within 1 % of it."""
    case = load_case(EXAMPLES / "02_penetration" / file)
    simulation = Simulation(case, threads=1)
    assert simulation.column("rod", "mass").sum() == pytest.approx(0.5 * 80.6e-3, rel=0.01)
    count = sum(len(simulation.column(b, "mass")) for b in simulation.bodies)
    assert count == pytest.approx(200_864, rel=0.005)  # the paper's table 1
    v = simulation.column("rod", "velocity")[0]
    assert np.linalg.norm(v) == pytest.approx(575.0, rel=1e-6)
    assert np.degrees(np.arctan2(v[0], -v[2])) == pytest.approx(30.0, abs=1e-4)
    rod = case.body["rod"].shape.shapes[0].shape  # type: ignore[union-attr]
    assert isinstance(rod, OgiveRod)
    assert 2 * rod.radius == pytest.approx(12.9e-3)


@EACH
def test_a_coarse_penetration_keeps_its_balances(file: str) -> None:
    simulations = [Simulation(penetration(5, file), threads=k) for k in (1, 2)]
    for simulation in simulations:
        simulation.advance(10**6, 30e-6)
    rows = history(simulations[0])
    start = rows["kinetic"][0]
    assert np.abs(rows["residual"]).max() < 1e-11 * start
    scale = simulations[0].column("rod", "mass").sum() * 575.0
    for axis in "xz":  # a plane of symmetry takes up momentum along y
        momentum = rows[f"momentum_{axis}"]
        assert np.abs(momentum - momentum[0]).max() < 1e-11 * scale
    speed = np.linalg.norm(simulations[0].column("rod", "velocity").mean(axis=0))
    assert 450.0 < speed < 570.0  # it is slowed down, and not stopped
    assert rows["plastic"][-1] > 0.02 * start
    for body in ("rod", "plate"):
        one, two = (s.column(body, "velocity") for s in simulations)
        assert np.array_equal(one, two)


def spheres(count: int, file: str = OWN) -> Case:
    """Return example 03 with so many spheres along an edge."""
    case = load_case(EXAMPLES / "03_thousand_spheres" / file)
    edge = 5e-3 * count
    walls = case.grid.box.walls  # type: ignore[union-attr]
    box = GridBox(lower=(0, 0, 0), upper=(edge, edge, edge + 5e-3), walls=walls)
    case.grid = Grid(dimension=3, cell_size=1e-3, basis=case.grid.basis, box=box)
    case.grains["spheres"].lattice.count = [count] * 3  # type: ignore[union-attr]
    case.body["slab"].shape = shapes.Box(lower=(0, 0, edge), upper=(edge, edge, edge + 5e-3))
    return case


@EACH
def test_few_spheres_under_pressure_keep_their_balances(file: str) -> None:
    count = 2
    simulations = [Simulation(spheres(count, file), threads=k) for k in (1, 2)]
    for simulation in simulations:
        simulation.advance(10**6, 8e-6)
    rows = history(simulations[0])
    assert np.abs(rows["residual"]).max() < 1e-11 * rows["load_work"].max()
    assert rows["load_work"][-1] > 0.0
    # Every sphere touches those below and above it, the next numbers; the top ones touch the slab.
    touched = {tuple(p.bodies) for p in simulations[0].core.contact_pairs()}
    tops = range(count, count**3 + 1, count)
    assert {(k, k + 1) for k in range(1, count**3) if k not in tops} < touched
    assert {pair for pair in touched if pair[0] == 0} == {(0, k) for k in tops}
    one, two = (s.column("spheres", "stress") for s in simulations)
    assert np.array_equal(one, two)
    # The wave has come down to the lowest layer.
    mises = np.abs(one[:, 2])
    lowest = simulations[0].column("spheres", "position")[:, 2] < 5e-3
    assert mises[lowest].max() > 1e6
