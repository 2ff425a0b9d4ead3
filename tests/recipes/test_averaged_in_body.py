# SPDX-License-Identifier: BSD-3-Clause
"""Pressures that bodies on nodes of their own average: noise, energy, and what is left alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from in_body import CELL, DENSITY, E, energies, frame_tables, period, run_to_end
from mpm3dpp import Case, Simulation

MODE = 4.730040745  # of a free bar, the first; Timoshenko, Vibration Problems in Engineering


def rms(values: Any) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def noise_of_pressure(simulation: Simulation) -> tuple[float, float]:
    """Return the rms of what a linear fit within 1.5 cells does not have, and of the pressure."""
    places, stress = (simulation.column("a", name) for name in ("position", "stress"))
    pressure = -stress[:, :3].sum(axis=1) / 3.0
    beyond = []
    for k, near in enumerate(cKDTree(places).query_ball_point(places, 1.5 * CELL)):
        terms = np.column_stack([np.ones(len(near)), places[near] - places[k]])
        fit, *_ = np.linalg.lstsq(terms, pressure[near], rcond=None)
        beyond.append(pressure[k] - fit[0])
    return rms(beyond), rms(pressure)


def bending(averages: bool, nu: float) -> tuple[float, float, float]:
    """Return period over Bernoulli's, noise of the pressure over it, largest change of energy.

    A free bar, 32 cells long and 4 thick, in plane strain.
    """
    length = 32 * CELL
    x, part = f"({MODE / length} * x)", 0.982502215
    form = f"cosh({x}) + cos({x}) - {part} * (sinh({x}) + sin({x}))"
    body = {
        "shape": {"box": {"lower": [0, 0], "upper": [length, 4 * CELL]}},
        "velocity": [0.0, {"expression": form}],
    }
    stiff = E / (1.0 - nu**2) * (4 * CELL) ** 2 / 12.0 / DENSITY
    exact = 2.0 * np.pi / ((MODE / length) ** 2 * np.sqrt(stiff))
    tables = frame_tables(2, body, 5.0 * exact, nu)
    tables["material"]["m"]["volume_averaging"] = averages
    simulation = Simulation(Case.model_validate(tables))
    first, noise = simulation.column("a", "velocity")[:, 1], []
    steps = iter(range(10**6))

    def look(simulation: Simulation) -> float:
        if next(steps) % 20 == 19:
            noise.append(noise_of_pressure(simulation))
        return float((first * simulation.column("a", "velocity")[:, 1]).mean())

    columns, (times, values) = run_to_end(simulation, 20, look)
    beyond, all_of_it = np.mean(noise, axis=0)
    assert np.abs(columns["residual"]).max() < 1e-12 * columns["kinetic"][0]
    change = float(np.abs(energies(columns) - 1.0).max())
    return period(times, values) / exact, beyond / all_of_it, change


def test_it_takes_noise_and_no_energy_of_what_is_nearly_incompressible() -> None:
    """Noise by two thirds; the period stays, as quadratic functions do not lock in bending.

    That is 1.086 of Bernoulli's with and without, as a bar of eight thicknesses has shear.
    """
    own_period, own_noise, _ = bending(False, 0.499)
    period, noise, change = bending(True, 0.499)
    assert period == pytest.approx(own_period, rel=2e-3)
    assert noise < 0.4 * own_noise
    assert change < 2e-3


@pytest.mark.parametrize("basis", ["quadratic_bspline", "gimp"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_uniform_pressure_is_left_as_it_is(dimension: int, basis: str) -> None:
    """At the start, to rounding, also at the surface; and so what it sets in motion."""
    found = []
    pressed = [-1000.0] * 3 + [0.0] * (2 * dimension - 3)
    for averages in (False, True):
        body: dict[str, Any] = {
            "material": "m",
            "frame": "material",
            "shape": {"box": {"lower": [0.0] * dimension, "upper": [5 * CELL] * dimension}},
        }
        case = Case.model_validate(
            {
                "grid": {"dimension": dimension, "cell_size": CELL, "basis": basis},
                "run": {"end_time": 1.0, "viscosity": {}},
                "material": {
                    "m": {
                        "density": DENSITY,
                        "strength": {"elastic": {"E": E, "nu": 0.3}},
                        "volume_averaging": averages,
                    }
                },
                "body": {"a": body | {"initial": {"stress": pressed}}},
            }
        )
        simulation = Simulation(case, threads=1)
        stress = simulation.column("a", "stress")
        simulation.advance(1)
        found.append([stress, simulation.column("a", "velocity")])
    for own, averaged in zip(*found, strict=True):
        assert np.abs(averaged - own).max() < 1e-12 * np.abs(own).max() > 0.0
