# SPDX-License-Identifier: BSD-3-Clause
"""States behind a shock, from the equation of state alone."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.case import Material

from .driver import drive
from .options import Options
from .sense import OTHERS

UNITS = {
    "particle_velocity": "m/s",
    "shock_velocity": "m/s",
    "pressure": "Pa",
    "density": "kg/m^3",
    "volume": "1",
    "internal_energy": "J/m^3",
    "sound_speed": "m/s",
}
_FIRST_STEP, _LEAST_STEP = 0.02, 1e-13  # of the relative volume


def shock_test(name: str, material: Material, options: Options) -> dict[str, np.ndarray]:
    """Return the states behind shocks of particle velocities up to `options.to`.

    Raises:
        CaseError: the material has no equation of state, or no shock as fast as that.
    """
    fluid = without_strength(name, material)
    velocities = np.linspace(0.0, float(options.to or 0.0), int(options.steps or 0) + 1)
    rows = [state(name, fluid, up) for up in velocities]
    return {key: np.array([row[key] for row in rows]) for key in rows[0]}


def without_strength(name: str, material: Material) -> Material:
    """Return a fluid without viscosity that has the material's equation of state."""
    if material.strength.model == "rigid":
        raise CaseError("is rigid: no shock runs through it", OTHERS, value=name)
    if material.eos is None:
        rule = "has no equation of state, which the test hugoniot needs"
        raise CaseError(rule, "give the material an eos, or choose another --test", value=name)
    if material.strength.model == "high_explosive":
        rule = "is a high explosive: its equation of state is that of the products, not of a shock"
        raise CaseError(rule, "test another material", value=name)
    table = material.table()
    return Material(density=table["density"], strength={"fluid": {}}, eos=table["eos"])


def state(name: str, fluid: Material, particle_velocity: float) -> dict[str, float]:
    """Return the state behind a shock of a particle velocity [m/s].

    Mass and momentum, v = 1 - up/Us and p - p0 = rho0 Us up, give up^2 = (p - p0) (1 - v) / rho0
    with the relative volume v; that is solved for v by bisection.
    """
    density = fluid.density
    rest = jump(fluid, 1.0)
    p0 = rest["pressure"]

    def square(volume: float) -> float:
        return (jump(fluid, volume)["pressure"] - p0) * (1.0 - volume) / density

    if particle_velocity == 0.0:
        behind, volume, speed = rest, 1.0, rest["sound_speed"]
    else:
        found = bracket(square, particle_velocity**2)
        if found is None:
            rule = f"has no shock of particle velocity {particle_velocity:g} m/s"
            raise CaseError(rule, "give a smaller --to", value=name)
        low, high = found
        for _ in range(60):
            middle = 0.5 * (low + high)
            slower = square(middle) < particle_velocity**2
            low, high = (low, middle) if slower else (middle, high)
        volume = 0.5 * (low + high)
        behind = jump(fluid, volume)
        speed = (behind["pressure"] - p0) / (density * particle_velocity)
    return {
        "particle_velocity": particle_velocity,
        "shock_velocity": speed,
        "pressure": behind["pressure"],
        "density": density / volume,
        "volume": volume,
        "internal_energy": behind["internal_energy"],
        "sound_speed": behind["sound_speed"],
    }


def bracket(square: Callable[[float], float], goal: float) -> tuple[float, float] | None:
    """Return volumes (low, high) with square(high) < goal <= square(low), coming from 1; or None.

    The pressure behind a shock may have a pole: an ideal gas is never compressed below (gamma - 1)
    / (gamma + 1) by one shock. Beyond it 1 + B dV/2 and the pressure are negative, so a step after
    which `square` has not grown has gone too far and is halved.
    """
    high, at_high, step = 1.0, 0.0, _FIRST_STEP
    while step > _LEAST_STEP:
        low = high - step
        at_low = square(low) if low > 0.0 else -math.inf
        if at_low >= goal:
            return low, high
        if at_low > at_high:
            high, at_high = low, at_low
        else:
            step *= 0.5
    return None


def jump(fluid: Material, volume: float) -> dict[str, float]:
    """Return the state after one step of the driver from rest to a relative volume.

    The core's step adds the work of the mean pressure on the exact change of volume, E - E0 =
    (p0 + p) (V0 - V) / 2. For a smooth path that is the trapezoidal rule; for a jump in one step it
    is exactly Rankine's and Hugoniot's relation of energy, so the step ends on the Hugoniot.
    """
    columns = drive(fluid, np.diag([volume - 1.0, 0.0, 0.0])[None], 1.0).columns
    last = {key: float(value[-1]) for key, value in columns.items()}
    return last | {"pressure": -last["stress_xx"]}
