# SPDX-License-Identifier: BSD-3-Clause
"""PIC damping: what the grid does not see dies away, momentum stays, the ledger closes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cases import CELL, SCHEMES, block, materials
from mpm3dpp import Case, Contact, Grid, Run, Simulation

RATE, TIME_STEP_FACTOR = 50.0, 0.2


def simulation(dimension: int, scheme: str, rate: float) -> Simulation:
    """Return a block at rest, 4 cells along each edge, two particles a cell along each axis."""
    body = block((0,) * dimension, (4,) * dimension, material="solid")
    run = Run(
        end_time=1.0,
        scheme=scheme,
        cfl=TIME_STEP_FACTOR,
        transfer={"flip": 1.0, "pic_rate": rate},
        energy_growth_limit=1e9,
    )
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis="linear"),
        run=run,
        contact=Contact(),
        material=materials(),
        body={"body": body},
    )
    return Simulation(case, threads=1)


def noise(sim: Simulation) -> np.ndarray:
    """Return 1 or -1 for each particle, alternating along every axis: next to nothing at nodes."""
    x = sim.column("body", "position")
    place = np.rint(x / (CELL / 2) - 0.5).astype(int)
    return np.prod(1 - 2 * (place % 2), axis=1)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_decays_towards_the_grid(dimension: int, scheme: str) -> None:
    """In a step from one state, damping takes r dt (v - that of the grid) from v.

    So twice the rate takes twice as much, to rounding; its mean is zero, as momentum is kept.
    """
    outcomes = {}
    for rate in (0.0, RATE, 2 * RATE):
        sim = simulation(dimension, scheme, rate)
        v = np.zeros_like(sim.column("body", "velocity"))
        v[:, 0] = noise(sim) + 3.0
        sim.set_velocity("body", v)
        sim.advance(1)
        outcomes[rate] = sim.column("body", "velocity")
        rows = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
        dt, mass = rows["dt"][-1], sim.column("body", "mass")[:, 0]
        scale = float(0.5 * np.sum(mass[:, None] * v**2))
        # Sums over at most 512 particles of terms of this size: some thousand roundings.
        assert abs(rows["residual"][-1]) <= 1e-12 * scale
        assert rows["momentum_x"][-1] == pytest.approx(float(mass @ v[:, 0]), rel=1e-13)
        # What is taken from v is at most r dt |v|, so twice r dt of the energy; the rest is room
        # for the terms of the stress.
        if rate > 0.0:
            assert 0.0 < rows["numerical_transfer"][-1] < 2.5 * rate * dt * scale
    taken, twice = (outcomes[0.0] - outcomes[r] for r in (RATE, 2 * RATE))
    # Of a noise of 1 m/s what the grid does not see is taken: a third at least.
    assert np.abs(taken[:, 0]).max() > 0.3 * RATE * dt
    # Some hundred roundings of velocities of 4 m/s.
    assert np.abs(twice - 2 * taken).max() <= 1e-13
    # An even translation is no noise.
    assert abs(taken[:, 0].mean()) <= 1e-13


def test_noise_decays_over_time() -> None:
    """After 1 / r noise is down to 1/e; a fifth more, as some turns into waves."""
    left = {}
    for rate in (0.0, RATE):
        sim = simulation(2, "musl", rate)
        v = np.zeros_like(sim.column("body", "velocity"))
        v[:, 0] = 0.01 * noise(sim)
        sim.set_velocity("body", v)
        sim.advance(10**6, end_time=1.0 / RATE)
        left[rate] = np.abs(sim.column("body", "velocity")).max() / 0.01
    assert left[RATE] <= 1.2 * math.exp(-1.0)
    assert left[0.0] > 2.0 * left[RATE]
