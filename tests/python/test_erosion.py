# SPDX-License-Identifier: BSD-3-Clause
"""Particles that erode: mass, energy and momentum stay accounted for."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import CELL, DENSITY, SCHEMES, YOUNG, block
from mpm3dpp import Case, Contact, Eos, Grid, Material, Run, Simulation, Strength, Viscosity
from mpm3dpp.materials.chosen import Failure

SPEED = 6.0


def torn_bar(
    dimension: int,
    scheme: str,
    basis: str = "gimp",
    eos: bool = False,
    action: str = "erode",
    **run: object,
) -> Case:
    """Return a bar that yields and then tears."""
    limit = 0.05 * YOUNG
    material = Material(
        density=DENSITY,
        strength=Strength(model="j2", parameters={"E": YOUNG, "nu": 0.3, "Y0": 0.5 * limit}),
        eos=Eos(model="linear", parameters={"K": YOUNG}) if eos else None,
        failure=[Failure(model="principal_stress", parameters={"limit": limit}, action=action)],
    )
    size = (16, 4, 4)[:dimension]
    return Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis=basis),
        run=Run(end_time=1.0, scheme=scheme, cfl=0.3, energy_growth_limit=1e9, **run),
        material={"solid": material},
        body={"bar": block((140, 140, 140)[:dimension], size, material="solid")},
    )


def start(case: Case, threads: int = 1) -> Simulation:
    """Return a simulation of the bar stretching, most in the middle, and flying upwards."""
    simulation = Simulation(case, threads=threads)
    x = simulation.column("bar", "position")
    v = np.zeros_like(x)
    v[:, 0] = SPEED * np.sin(np.pi / 16 * (x[:, 0] / CELL - 148))
    v[:, 1] = 1.0
    simulation.set_velocity("bar", v)
    return simulation


def history(simulation: Simulation) -> dict[str, np.ndarray]:
    rows = simulation.core.history()
    return dict(zip(simulation.core.history_columns, rows.T, strict=True))


def kept(simulation: Simulation) -> dict[str, Any]:
    """Return mass, energies and momentum of the particles that have not eroded."""
    stays = simulation.column("bar", "failed")[:, 0] < 3
    m, v = (simulation.column("bar", c)[stays] for c in ("mass", "velocity"))
    energy = simulation.column("bar", "recoverable_energy")[stays] * m / DENSITY
    sums = {"mass": m.sum(), "kinetic": 0.5 * (m * v**2).sum(), "internal": energy.sum()}
    return sums | {"momentum": (m * v).sum(axis=0)}


@pytest.mark.parametrize("eos", [False, True])
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_bar_torn_apart(dimension: int, scheme: str, eos: bool) -> None:
    simulation = start(torn_bar(dimension, scheme, eos=eos))
    whole = kept(simulation)
    assert simulation.eroded() == {"mass": 0.0, "count": 0}
    before = 0
    for _ in range(60):
        simulation.advance(1)
        eroded = simulation.eroded()
        # What has failed in this step leaves at the start of the next.
        failed = simulation.column("bar", "failed")[:, 0] == 3
        assert before <= eroded["count"] <= failed.sum()
        before = eroded["count"]
        assert not simulation.column("bar", "stress")[failed].any()
    while simulation.eroded()["count"] != (simulation.column("bar", "failed")[:, 0] == 3).sum():
        simulation.advance(1)
    eroded, rest, row = simulation.eroded(), kept(simulation), history(simulation)
    assert 0 < eroded["count"] < len(failed) / 2
    assert eroded["mass"] + rest["mass"] == pytest.approx(whole["mass"], rel=1e-14)
    begin = whole["kinetic"]
    assert np.abs(row["residual"]).max() < 1e-12 * begin  # some thousand roundings
    assert row["eroded"][-1] > 0
    assert (np.diff(row["eroded"]) >= 0).all()
    # The sums of a step run over exactly the particles that are left.
    assert row["kinetic"][-1] == pytest.approx(rest["kinetic"], rel=1e-12)
    assert row["internal"][-1] == pytest.approx(rest["internal"], rel=1e-10)
    for a, axis in enumerate("xyz"[:dimension]):
        size = whole["mass"] * SPEED
        assert row[f"momentum_{axis}"][-1] == pytest.approx(rest["momentum"][a], abs=1e-12 * size)


def test_an_eroded_particle_stays_where_it_was() -> None:
    simulation = start(torn_bar(2, "musl"))
    while simulation.eroded()["count"] == 0:
        simulation.advance(1)
    columns = ("position", "velocity", "volume", "mass")
    last = simulation.column("bar", "position")
    simulation.advance(1)
    gone = (simulation.column("bar", "position") == last).all(axis=1)
    before = {name: simulation.column("bar", name)[gone] for name in columns}
    assert gone.sum() == simulation.eroded()["count"]
    simulation.advance(400)  # far enough for particles to change tile and columns to be sorted
    for name in columns:
        assert (simulation.column("bar", name)[gone] == before[name]).all()


def test_erosion_does_not_depend_on_threads() -> None:
    def run(threads: int) -> tuple[np.ndarray, np.ndarray]:
        simulation = start(torn_bar(3, "musl"), threads)
        simulation.advance(80)
        assert simulation.eroded()["count"] > 0
        return simulation.core.history(), simulation.column("bar", "position")

    one, two = run(1), run(2)
    assert all((a == b).all() for a, b in zip(one, two, strict=True))


def test_a_body_that_erodes_as_a_whole_is_in_nobodys_way() -> None:
    """Stretched everywhere the bar is gone, and a block flies through its place untouched."""
    case = torn_bar(2, "musl")
    case.material["solid"].failure[0].parameters["limit"] = 1.0
    hard = Material(density=DENSITY, strength={"elastic": {"E": YOUNG, "nu": 0.3}})
    flying = block((170, 140), (4, 4), material="hard", velocity=(-10.0, 0.0))
    case = Case(
        grid=case.grid,
        run=Run(end_time=4e-2, cfl=0.3),
        contact=Contact(),
        material=dict(case.material) | {"hard": hard},
        body=dict(case.body) | {"block": flying},
    )
    simulation = Simulation(case, threads=1)
    x = simulation.column("bar", "position")
    simulation.set_velocity("bar", 10.0 * (x - x.mean(axis=0)))
    simulation.advance(10_000)
    assert simulation.time == case.run.end_time
    assert simulation.eroded()["count"] == len(x)
    assert simulation.column("block", "position")[:, 0].max() < x[:, 0].min()
    v = simulation.column("block", "velocity")
    assert np.abs(v - [-10.0, 0.0]).max() < 1e-10 * 10
    row = history(simulation)
    assert np.abs(row["residual"]).max() < 1e-12 * row["kinetic"][0]


def test_when_all_has_eroded_the_run_goes_to_its_end() -> None:
    case = torn_bar(2, "musl")
    case.material["solid"].failure[0].parameters["limit"] = 1.0
    simulation = Simulation(case, threads=1)
    x = simulation.column("bar", "position")
    simulation.set_velocity("bar", 10.0 * (x - x.mean(axis=0)))
    simulation.advance(10_000)
    assert simulation.time == case.run.end_time
    assert simulation.eroded()["count"] == len(x)
    row = history(simulation)
    assert row["kinetic"][-1] == 0.0
    assert row["eroded"][-1] > 0.9 * row["kinetic"][0]


def test_debris_flies_at_its_own_speed() -> None:
    """Torn particles that gape carry no waves and no viscosity: h / |v| alone bounds the step."""
    case = torn_bar(2, "musl", "linear", True, "no_tension", viscosity=Viscosity())
    simulation = Simulation(case, threads=1)
    away = simulation.column("bar", "position") - CELL * np.array([148.0, 142.0])
    simulation.set_velocity("bar", 2.0 * SPEED / CELL * away)  # it bursts in all directions
    simulation.advance(400)
    rows = history(simulation)
    assert (simulation.column("bar", "failed") > 0).all()
    assert np.abs(simulation.column("bar", "stress")).max() == 0.0
    fastest = np.sqrt((simulation.column("bar", "velocity") ** 2).sum(axis=1)).max()
    assert rows["dt"][-1] == pytest.approx(0.3 * CELL / fastest, rel=1e-9)
    assert simulation.core.limiter().sound_speed == 0.0
    assert rows["viscous"][-1] == rows["viscous"][200]


def test_loose_matter_at_rest_falls_in_steps_of_a_cell() -> None:
    """No wave and no speed bounds the step of torn particles; gravity does: dt = f sqrt(h / g)."""
    case = torn_bar(2, "musl", "linear", True, "no_tension", gravity=[0.0, -9.81])
    simulation = Simulation(case, threads=1)
    away = simulation.column("bar", "position") - CELL * np.array([148.0, 142.0])
    simulation.set_velocity("bar", 2.0 * SPEED / CELL * away)
    simulation.advance(400)
    assert (simulation.column("bar", "failed") > 0).all()
    simulation.set_velocity("bar", 0.0 * away)
    simulation.advance(2)
    assert history(simulation)["dt"][-1] == pytest.approx(0.3 * np.sqrt(CELL / 9.81), rel=1e-9)
