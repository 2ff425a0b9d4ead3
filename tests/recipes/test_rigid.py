# SPDX-License-Identifier: BSD-3-Clause
"""Rigid bodies: the laws of Newton and Euler, and a rigid mass that hits an elastic bar."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, DENSITY, SCHEMES, YOUNG, block, materials
from mpm3dpp import Case, CaseError, Contact, Grid, GridBox, Material, Run, Simulation, Walls

STONE = Material(density=3000.0, strength={"rigid": {}})


def simulation(
    dimension: int,
    bodies: dict[str, Any],
    threads: int = 1,
    grid: Any = None,
    **run: Any,
) -> Simulation:
    settings = {"cfl": 0.2, "end_time": 1.0, "energy_growth_limit": 1e9} | run
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, **(grid or {})),
        run=Run(**settings),
        contact=Contact(),
        material=materials() | {"stone": STONE},
        body=bodies,
    )
    return Simulation(case, threads=threads)


def mean(values: np.ndarray) -> np.ndarray:
    """Return the mean over equal particles."""
    return values.mean(axis=0)


def spin(sim: Simulation) -> tuple[np.ndarray, float]:
    """Return angular momentum about the mass centre and kinetic energy, per particle mass."""
    x, v = sim.column("stone", "position"), sim.column("stone", "velocity")
    r = x - mean(x)
    return np.sum(np.cross(r, v - mean(v)), axis=0), float(0.5 * np.sum(v * v))


@pytest.mark.parametrize("scheme", SCHEMES)
def test_tumbles_freely(scheme: str) -> None:
    """About its middle axis a body tumbles: L stays to rounding, distances and energy with it.

    The energy of a torque-free body errs by the square of the angle per step.
    """
    bodies = {
        "stone": block((0, 0, 0), (2, 3, 5), material="stone", angular_velocity=(1.0, 80.0, 2.0)),
        "far": block((40, 0, 0), (2, 2, 2), material="solid"),
    }
    drift = []
    for factor in (0.2, 0.1):
        sim = simulation(3, bodies, scheme=scheme, cfl=factor)
        x = sim.column("stone", "position")
        shape = np.linalg.norm(x - x[0], axis=1)
        before, energy = spin(sim)
        while sim.core.time < 0.15:
            sim.advance(200, end_time=0.15)
        after, end = spin(sim)
        drift.append(abs(end / energy - 1))
        assert np.abs(after - before).max() < 1e-11 * np.linalg.norm(before)
        now = sim.column("stone", "position")
        assert np.abs(np.linalg.norm(now - now[0], axis=1) - shape).max() < 1e-11 * shape.max()
        turned = (now - mean(now))[0] @ (x - mean(x))[0] / np.sum((x - mean(x))[0] ** 2)
        assert turned < 0.9  # It has turned.
    assert drift[0] < 1e-4
    assert drift[1] < 0.3 * drift[0]


@pytest.mark.parametrize("dimension", [2, 3])
def test_falls_as_one(dimension: int) -> None:
    """Free fall: the first-order scheme's g t (t + dt) / 2 with the velocity exact."""
    d = dimension
    bodies = {
        "stone": block((0,) * d, (3,) * d, material="stone"),
        "far": block((40,) * d, (2,) * d, material="solid"),
    }
    sim = simulation(d, bodies, gravity=(0.0, 0.0, -10.0)[3 - d :])
    start = sim.column("stone", "position")
    sim.advance(300, end_time=0.01)
    t = sim.core.time
    v, x = sim.column("stone", "velocity"), sim.column("stone", "position")
    assert np.abs(v[:, -1] + 10 * t).max() < 1e-13
    dt = t / sim.core.step
    assert (x - start)[:, -1] == pytest.approx(-5 * t * (t + dt), rel=0.02)


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_hits_an_elastic_bar(scheme: str, basis: str) -> None:
    """A rigid mass M stops on a long bar as v0 exp(-rho c A t / M) until the wave comes back.

    De Saint-Venant 1867 (Timoshenko & Goodier 1970, art. 167). The mass is a third of the bar's; 2
    % of v0 is the front of the wave, which is spread over some cells; with the quadratic B-spline
    over half a cell more.
    """
    length, M = 120, 13 * CELL * 3000.0
    bar = {"elastic": {"E": YOUNG, "nu": 0.0}}
    speed, c = 0.05, np.sqrt(YOUNG / DENSITY)
    case = Case(
        grid=Grid(
            dimension=2,
            cell_size=CELL,
            basis=basis,
            box=GridBox(
                lower=[-20 * CELL, 0.0],
                upper=[(length + 60) * CELL, CELL],
                walls=Walls(y_min="slip", y_max="slip"),
            ),
        ),
        run=Run(end_time=1.0, scheme=scheme, cfl=0.2, energy_growth_limit=1e9),
        contact=Contact(),
        material={"bar": Material(density=DENSITY, strength=bar), "stone": STONE},
        body={
            "stone": block((0, 0), (13, 1), material="stone", velocity=(speed, 0.0)),
            "bar": block((13, 0), (length, 1), material="bar"),
        },
    )
    sim = Simulation(case, threads=1)
    end = 1.6 * length * CELL / c
    times = np.linspace(0.1, 1.0, 10) * end
    near = 0.025 if basis == "quadratic_bspline" else 0.02
    for t in times:
        sim.advance(10**9, end_time=float(t))
        v = mean(sim.column("stone", "velocity"))[0]
        assert v == pytest.approx(speed * np.exp(-DENSITY * c * t / M), abs=near * speed)
    assert np.ptp(sim.column("stone", "velocity")[:, 0]) < 1e-15
    rows, names = sim.core.history(), sim.core.history_columns
    momentum = rows[:, names.index("momentum_x")]
    assert np.abs(momentum - momentum[0]).max() < 1e-12 * abs(momentum[0])
    residual = rows[:, names.index("residual")]
    assert np.abs(residual).max() < 1e-12 * rows[0, names.index("kinetic")]


def test_walls_hold_it() -> None:
    """It stops where half a particle is left to the face; on a slip face it still slides."""
    bodies = {
        "stone": block((4, 2), (3, 3), material="stone", velocity=(0.5, -1.0)),
        "far": block((30, 2), (2, 2), material="solid"),
    }
    box = GridBox(lower=[0.0, 0.0], upper=[40 * CELL, 20 * CELL], walls=Walls(y_min="slip"))
    sim = simulation(2, bodies, grid={"box": box})
    while sim.core.time < 0.03:
        sim.advance(100, end_time=0.03)
    x, v = sim.column("stone", "position"), sim.column("stone", "velocity")
    assert x[:, 1].min() == pytest.approx(0.25 * CELL, abs=0.02 * CELL)
    assert np.abs(v[:, 1]).max() < 1e-15
    assert v[:, 0] == pytest.approx(0.5, rel=1e-12)


def test_the_same_bits_on_two_threads() -> None:
    bodies = {
        "stone": block((0, 6, 0), (6, 3, 5), material="stone", velocity=(1.0, -3.0, 0.5)),
        "solid": block((0, 0, 0), (12, 6, 8), material="solid"),
    }
    runs = []
    for threads in (1, 2):
        sim = simulation(3, bodies, threads)
        sim.advance(60)
        runs.append([sim.column(name, "velocity") for name in bodies])
    assert all(np.array_equal(a, b) for a, b in zip(*runs, strict=True))
    assert any(np.ptp(a, axis=0).max() > 0 for a in runs[0])


def test_what_a_rigid_body_cannot_have() -> None:
    stone = {"stone": block((0, 0), (2, 2), material="stone")}
    with pytest.raises(CaseError, match="one must deform"):
        simulation(2, stone)
    broken = {"rigid": {}}
    with pytest.raises(CaseError, match="takes no failure model"):
        Case(
            grid=Grid(dimension=2, cell_size=CELL),
            run=Run(end_time=1.0),
            material={
                "m": Material(
                    density=1.0,
                    strength=broken,
                    failure={"principal_stress": {"limit": 1.0}},
                )
            },
            body={"b": block((0, 0), (2, 2), material="m")},
        )
