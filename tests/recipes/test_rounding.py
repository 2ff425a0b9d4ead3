# SPDX-License-Identifier: BSD-3-Clause
"""What rounding does to a run, in a build of doubles and in one with MPM_FLOAT32."""

from __future__ import annotations

import numpy as np
import pytest

import cases
from mpm3dpp import Simulation, _core

# Largest error of a balance after some hundred steps, as a fraction of what is balanced: some
# roundings of 1e-16 or 6e-8.
ERROR = {"float64": 1e-12, "float32": 3e-6}[_core.build_info()["velocity_and_stress"]]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("scheme", cases.SCHEMES)
def test_energy_and_momentum_balance(dimension: int, scheme: str) -> None:
    """Of three blocks that meet."""
    simulation = Simulation(cases.three_blocks(dimension, scheme), threads=1)
    simulation.advance(200)
    rows = simulation.core.history()
    of = {name: rows[:, k] for k, name in enumerate(simulation.core.history_columns)}
    assert of["friction"][-1] > 0.0
    assert np.abs(of["residual"]).max() < ERROR * of["kinetic"].max()
    mass = simulation.core.total_mass
    size = np.sqrt(2.0 * mass * of["kinetic"].max())  # of momenta that cancel
    for axis in "xyz"[:dimension]:
        momentum = of[f"momentum_{axis}"]
        assert np.abs(momentum - momentum[0]).max() < ERROR * size


@pytest.mark.parametrize("dimension", [2, 3])
def test_columns_are_rounded_and_no_others(dimension: int) -> None:
    simulation = Simulation(cases.three_blocks(dimension), threads=1)
    simulation.advance(20)
    floats = set()
    for body in simulation.bodies:
        for column in simulation.core.columns(simulation.bodies.index(body)):
            values = simulation.column(body, column.name)
            if np.all(values == values.astype(np.float32)) and np.any(values):
                floats.add(column.name)
    of_a_float32_build = {"velocity", "stress"} if ERROR > 1e-9 else set()
    assert floats & {"position", "volume", "velocity", "stress"} == of_a_float32_build
