# SPDX-License-Identifier: BSD-3-Clause
"""A simulation that a program steps: forces that it gives, the history, the next step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from commands import CASE
from mpm3dpp import Case, Simulation
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io.result_hash import result_hash

APART = CASE.replace('"60 mm", "10 mm"', '"160 mm", "10 mm"').replace('"110 mm"', '"210 mm"')


def test_a_constant_force_accelerates_a_body_and_does_work() -> None:
    """Symplectic Euler to rounding, and the work of the force is the kinetic energy gained."""
    case = Case.from_text(APART)
    simulation = Simulation(case, threads=1, forced=["left"])
    mass = simulation.column("left", "mass")
    start = simulation.column("left", "position")
    simulation.set_body_force("left", np.tile([100.0, -50.0], (len(mass), 1)))
    simulation.advance(60)
    t = simulation.time
    way = simulation.column("left", "position") - start
    np.testing.assert_allclose(simulation.column("left", "velocity")[:, 1], -50.0 * t, rtol=1e-9)
    history = simulation.history()
    v, x = 5.0, 0.0
    for dt in history["dt"][1:]:  # Velocities of the end of each step move it.
        v += 100.0 * dt
        x += v * dt
    np.testing.assert_allclose(way[:, 0], x, rtol=1e-9)
    gained = 0.5 * mass.sum() * (v**2 - 5.0**2 + (50.0 * t) ** 2)
    assert history["external"][-1] == pytest.approx(gained, rel=1e-9)
    np.testing.assert_allclose(simulation.column("right", "velocity")[:, 0], -5.0, rtol=1e-12)


def test_it_is_the_force_of_a_formula() -> None:
    """A spring to the start: given particle by particle each step, or by the case."""
    text = APART.replace(
        'velocity = ["5 m/s", "0 m/s"]',
        'velocity = ["5 m/s", 0]\nbody_force = [{ expression = "-1e6 * (x - X)" }, 0.0]',
    )
    told = Simulation(Case.from_text(text), threads=1)
    given = Simulation(Case.from_text(APART), threads=1, forced=["left"])
    start = given.column("left", "position")
    for _ in range(100):
        force = -1e6 * (given.column("left", "position") - start) * [1.0, 0.0]
        given.set_body_force("left", force)
        given.advance(1)
    told.advance(100)
    for name in ("position", "velocity"):
        one, other = told.column("left", name), given.column("left", name)
        np.testing.assert_allclose(one, other, rtol=1e-12, atol=1e-12)
    assert np.abs(told.column("left", "velocity")[:, 0]).max() < 5.5
    works = [s.history()["external"][-1] for s in (told, given)]
    assert works[0] == pytest.approx(works[1], rel=1e-12) and abs(works[0]) > 1e-3


def test_threads_ranks_and_a_break_change_nothing(tmp_path: Path) -> None:
    case, found = Case.from_text(APART), []
    for more in ({"threads": 1}, {"threads": 2}, {"ranks": 3, "threads": 1}):
        simulation = Simulation(case, forced=["left"], **more)
        x = simulation.column("left", "position")
        simulation.set_body_force("left", 1e3 * np.sin(100.0 * x))
        simulation.advance(30)
        if more["threads"] == 2:
            simulation.save(tmp_path / "state.zip")
            simulation = Simulation(case, forced=["left"], threads=1)
            simulation.restore(tmp_path / "state.zip")
        simulation.advance(30)
        found.append(result_hash(simulation.core))
    assert found[0] == found[1] == found[2]


def test_forces_of_grains_one_by_one() -> None:
    text = (
        CASE.partition("[body.left]")[0]
        + """
[grains.sand]
material = "soft"
lattice = { lower = [0, 0], count = [2, 1], radius = "30 mm", spacing = "200 mm" }
"""
    )
    simulation = Simulation(Case.from_text(text), forced=["sand"])
    shape = simulation.column("sand_0000", "velocity").shape
    simulation.set_body_force("sand_0000", np.full(shape, 10.0))
    simulation.advance(10)
    np.testing.assert_allclose(
        simulation.column("sand_0000", "velocity"), 10.0 * simulation.time, rtol=1e-9
    )
    assert not simulation.column("sand_0001", "velocity").any()


def test_the_next_step_and_the_history() -> None:
    simulation = Simulation(Case.from_text(CASE))
    next_step = simulation.dt
    simulation.advance(1)
    history = simulation.history()
    assert history["dt"][-1] == next_step and history["step"].tolist() == [0.0, 1.0]
    simulation.advance(3)
    assert simulation.history()["step"].tolist() == [2.0, 3.0, 4.0]
    assert len(simulation.history()["step"]) == 0


def test_mistakes() -> None:
    simulation = Simulation(Case.from_text(CASE), forced=["left"])
    shape = simulation.column("left", "velocity").shape
    with pytest.raises(CaseError, match=r'make it with Simulation\(case, forced=\["right"\]\)'):
        simulation.set_body_force("right", np.zeros(shape))
    with pytest.raises(CaseError, match='did you mean "left"'):
        simulation.set_body_force("lefft", np.zeros(shape))
    with pytest.raises(CaseError, match="forces must be finite numbers, shape"):
        simulation.set_body_force("left", np.zeros(3))
    with pytest.raises(CaseError, match="must be text"):
        simulation.set_body_force(["left"], np.zeros(shape))  # type: ignore[arg-type]
    with pytest.raises(CaseError, match="must be a list of names"):
        Simulation(Case.from_text(CASE), forced="left")
    with pytest.raises(CaseError, match="it has a body force already; leave it out of forced"):
        Simulation(Case.from_text(CASE), forced=["left", "left"])
    with pytest.raises(CaseError, match="is not a body of the case"):
        Simulation(Case.from_text(CASE), forced=["none"])
