# SPDX-License-Identifier: BSD-3-Clause
"""Pressures that bodies on nodes of their own average: noise, energy, and what is left alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from in_body import (
    CELL,
    DENSITY,
    E,
    energies,
    frame_tables,
    noise_of_pressure,
    period,
    run_to_end,
)
from mpm3dpp import Case, Simulation

MODE = 4.730040745  # of a free bar, the first; Timoshenko, Vibration Problems in Engineering


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


ELASTIC = {"elastic": {"E": E, "nu": 0.3}}
FIRM = {"j2": {"E": E, "nu": 0.3, "Y0": E}}
SOFT = {"j2": {"E": E, "nu": 0.3, "Y0": 1e-4 * E}}
RUBBER = {"neo_hookean": {"K": 20.0 * E, "G": E}}


def sheared(strength: dict[str, Any], dimension: int, **material: Any) -> np.ndarray:
    """Return where a block of a material is that has gone to and fro for a while."""
    h = 4 * CELL
    tables = frame_tables(
        dimension,
        {
            "shape": {"box": {"lower": [0.0] * dimension, "upper": [h] * dimension}},
            "velocity": [{"expression": f"2 * sin(3 * y / {h}) * x / {h}"}]
            + [0.0] * (dimension - 1),
        },
        1.0,
    )
    tables["material"]["m"] = {"density": DENSITY, "strength": strength, **material}
    simulation = Simulation(Case.model_validate(tables), threads=1)
    simulation.advance(60)
    return simulation.column("a", "position")


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("strength", [ELASTIC, FIRM, SOFT, RUBBER], ids=lambda s: next(iter(s)))
def test_what_is_averaged_by_default(strength: dict[str, Any], dimension: int) -> None:
    """What yields, once it does, and not what could; no rubber, which would lose its energy."""
    default, never, always = (
        sheared(strength, dimension, **given)
        for given in ({}, {"volume_averaging": False}, {"volume_averaging": True})
    )
    assert (default == never).all() == (strength is not SOFT)
    assert not (never == always).all()
    assert not (default == always).all()


def test_viscous_pressure_acts_until_a_body_flows() -> None:
    """Which is stored beside that which forces use."""
    given = {"artificial_viscosity": {}}
    default, never = (
        sheared(FIRM, 2, **given, **more) for more in ({}, {"volume_averaging": False})
    )
    assert (default == never).all()
    assert not (never == sheared(FIRM, 2)).all()
