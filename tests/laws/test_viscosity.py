# SPDX-License-Identifier: BSD-3-Clause
"""Artificial viscosity at one material point: its pressure, its work and where the work goes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp.materials.point import drive_point

DENSITY, STEPS = 1000.0, 50
SOLID = ("elastic", {"E": 1e8, "nu": 0.3}, None)
GAS = ("fluid", {}, ("ideal_gas", {"gamma": 1.4, "E0": 2.5e5}))
SHEAR = np.array([[0.0, 0.4, 0.0], [-0.1, 0.0, 0.2], [0.3, 0.0, 0.0]])  # without a trace


def squeeze(
    point: Any,
    rate: float,
    dt: float,
    lanes: bool,
    viscosity: tuple[float, float],
    h: float = 1.0,
) -> dict[str, np.ndarray]:
    """Return columns of a point whose volume changes at a rate [1/s], while it is sheared."""
    strength, parameters, eos = point
    gradient = rate * (np.diag([0.5, 0.3, 0.2]) + SHEAR)
    moves = np.tile(gradient * dt, (STEPS, 1, 1))
    rows, names, units = drive_point(
        DENSITY,
        strength,
        parameters,
        moves,
        lanes,
        eos=eos,
        time_step=dt,
        viscosity=viscosity,
        cell_size=h,
    )
    assert dict(zip(names, units, strict=True))["viscosity_pressure"] == "Pa"
    return dict(zip(names, rows.T, strict=True))


@pytest.mark.parametrize("lanes", [False, True])
@pytest.mark.parametrize("h", [1.0, 0.02])
@pytest.mark.parametrize(("linear", "quadratic"), [(0.0, 1.5), (0.06, 0.0), (0.1, 2.0)])
@pytest.mark.parametrize("point", [SOLID, GAS], ids=["elastic", "gas"])
def test_the_pressure_is_that_of_the_formula(
    point: Any, linear: float, quadratic: float, h: float, lanes: bool
) -> None:
    """q = rho h^2 C2 e^2 - rho h C1 c e, and its work on the volume, of every step."""
    rate, dt = -200.0, 1e-5
    found = squeeze(point, rate, dt, lanes, viscosity=(quadratic, linear), h=h)
    rho, c = DENSITY / found["volume"][1:], found["sound_speed"][1:]
    q = rho * h * (h * quadratic * rate**2 - linear * c * rate)
    # With an EOS the speed is that of a guess of the pressure, a step's change of volume away.
    near = 1e-12 if point is SOLID or linear == 0.0 else 2 * abs(rate) * dt
    assert found["viscosity_pressure"][1:] == pytest.approx(q, rel=near)
    assert found["viscosity_pressure"][0] == 0.0
    work = -found["viscosity_pressure"][1:] * found["volume"][1:] * rate * dt
    assert np.diff(found["viscous"]) == pytest.approx(work, rel=1e-9)
    assert work.min() > 0.0


@pytest.mark.parametrize("point", [SOLID, GAS], ids=["elastic", "gas"])
def test_the_quadratic_term_dissipates_in_closed_form(point: Any) -> None:
    """At a constant rate e the term rho h^2 C2 e^2 does the work rho0 h^2 C2 |e|^3 t."""
    rate, dt, h, quadratic = -300.0, 1e-5, 0.3, 1.7
    found = squeeze(point, rate, dt, True, viscosity=(quadratic, 0.0), h=h)
    time = dt * np.arange(STEPS + 1)
    exact = DENSITY * h**2 * quadratic * abs(rate) ** 3 * time
    assert found["viscous"] == pytest.approx(exact, rel=1e-12)


def test_nothing_happens_while_the_volume_grows() -> None:
    for point in (SOLID, GAS):
        found = squeeze(point, 200.0, 1e-5, True, viscosity=(2.0, 0.1))
        assert np.all(found["viscosity_pressure"] == 0.0)
        assert np.all(found["viscous"] == 0.0)


def test_the_work_heats_the_gas_and_q_is_no_part_of_its_stress() -> None:
    """E grows by the work of the stress and of q; the stress stays p = (gamma - 1) E / V."""
    found = squeeze(GAS, -200.0, 1e-5, True, viscosity=(2.0, 0.1))
    energy = found["internal_energy"]
    gained = found["work"] + found["viscous"]
    assert energy - energy[0] == pytest.approx(gained, rel=1e-9, abs=1e-9 * energy[0])
    assert found["viscous"][-1] > 0.1 * found["work"][-1]
    p = -(found["stress_xx"] + found["stress_yy"] + found["stress_zz"]) / 3
    assert p == pytest.approx(0.4 * energy / found["volume"], rel=1e-12)
