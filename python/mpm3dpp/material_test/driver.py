# SPDX-License-Identifier: BSD-3-Clause
"""One material point of the core, driven along a path of strain.

Strains are logarithmic: a step multiplies the length along x by exp(to/steps).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.case import Material
from mpm3dpp.materials.point import COUNTED, drive_point

from . import sense
from .failing import Failed, first_failure
from .options import Options

SQUEEZE_STEPS = 10  # of the compression on all sides, which is smooth
TENSOR = ("xx", "yy", "zz", "yz", "xz", "xy")
DERIVED = {"strain": "1", "lateral_strain": "1", "volumetric_strain": "1", "deviator": "Pa"}
DERIVED |= {"pressure": "Pa", "von_mises": "Pa"}
"""Units of the columns that are made here; the core gives those of the others."""


class Path(NamedTuple):
    """What a point went through.

    Attributes:
        columns: name -> values, shape (steps + 1,).
        units: name -> SI unit, "1" for plain numbers.
        failed: where it failed in a test; None if it did not, or is no test.
    """

    columns: dict[str, np.ndarray]
    units: dict[str, str]
    failed: Failed | None = None


def drive(
    material: Material,
    moves: np.ndarray,
    time_step: float,
    state: dict[str, float] | None = None,
) -> Path:
    """Return what a point goes through.

    Args:
        material: of the point.
        moves: velocity gradient x time step of each step, shape (steps, 3, 3).
        time_step: [s].
        state: where it starts, by column; None for rest.

    Returns:
        The columns stress_xx ... [Pa], volume (relative), those of the material's state, dissipated
        and work [J/m^3 of initial volume] and sound_speed [m/s], shape (steps + 1,).

    Raises:
        CaseError: the core refuses the material.
    """
    try:
        values, names, units = drive_point(
            **material.for_core(), increments=moves, time_step=time_step, state=state
        )
    except ValueError as error:
        raise CaseError(f"the material cannot be made: {error}") from None
    columns = {name: values[:, k].copy() for k, name in enumerate(names)}
    return Path(columns, dict(zip(names, units, strict=True)))


def stress_test(name: str, material: Material, options: Options) -> Path:
    """Return what a test other than hugoniot gives; the column `strain` is the first.

    Args:
        name: of the material, for messages.
        material: what is tested.
        options: completed.

    Raises:
        CaseError: the material cannot be tested so.
    """
    sense.check_before(name, material, options)
    steps, to = int(options.steps or 0), float(options.to or 0.0)
    time_step = abs(to) / (steps * float(options.rate or 1.0))
    if options.test == "compression-release":
        half = steps // 2
        strain = np.concatenate([np.linspace(0, to, half + 1), np.linspace(to, 0, half + 1)[1:]])
        time_step = abs(to) / (half * float(options.rate or 1.0))
    else:
        strain = np.linspace(0.0, to, steps + 1)
    moves = np.zeros((len(strain) - 1, 3, 3))
    lateral, start, held = None, None, float(options.pressure or 0.0)
    if options.test == "shear":
        moves[:, 0, 1] = np.diff(strain)
    else:
        moves[:, 0, 0] = np.expm1(np.diff(strain))
    if options.test == "triaxial":
        start = squeezed(name, material, held, float(options.rate or 1.0))
    if options.test in ("uniaxial-stress", "triaxial"):
        lateral = free_sides(name, material, moves, time_step, held, start)
    columns, units, _ = drive(material, moves, time_step, start)
    stress = np.array([columns[f"stress_{c}"] for c in TENSOR])
    found = {"strain": strain}
    if lateral is not None:
        found["lateral_strain"] = lateral
    if options.test == "triaxial":
        found["volumetric_strain"] = np.log(columns["volume"] / columns["volume"][0])
        found["deviator"] = columns["stress_yy"] - columns["stress_xx"]
    if not np.isfinite(stress).all():
        first = int(np.argmin(np.isfinite(stress).all(axis=0)))
        raise CaseError(f"has no finite stress from strain {strain[first]:g} on", value=name)
    stiffness = material.density * columns["sound_speed"][0] ** 2
    sense.check_after(name, material, options, stress, stiffness)
    found |= {f"stress_{c}": columns.pop(f"stress_{c}") for c in TENSOR}
    found |= {"pressure": pressure(stress), "von_mises": von_mises(stress)}
    columns = found | columns

    def again(other: Material) -> dict[str, np.ndarray]:
        known = drive(other, moves[:0], time_step).columns
        own = {key: value for key, value in (start or {}).items() if key in known}
        return drive(other, moves, time_step, own).columns

    failed = first_failure(material, options.test, columns, again)
    return Path(columns, DERIVED | units, failed)


def pressure(stress: np.ndarray) -> np.ndarray:
    """Return the pressure of stresses of shape (6, n), positive in compression."""
    return -stress[:3].mean(axis=0)


def von_mises(stress: np.ndarray) -> np.ndarray:
    """Return von Mises' stress of stresses of shape (6, n)."""
    deviator = stress.copy()
    deviator[:3] += pressure(stress)
    return np.sqrt(1.5 * (deviator[:3] ** 2).sum(axis=0) + 3.0 * (stress[3:] ** 2).sum(axis=0))


def squeezed(name: str, material: Material, pressure: float, rate: float) -> dict[str, float]:
    """Return the state of a material after compression on all sides to a pressure.

    Args:
        name: of the material, for messages.
        material: at rest.
        pressure: wanted [Pa].
        rate: of the strain along each axis [1/s].

    Raises:
        CaseError: it does not reach the pressure.
    """
    end = drive(material, np.zeros((0, 3, 3)), 1.0).columns
    stiffness = material.density * end["sound_speed"][0] ** 2

    def compressed(strain: float) -> dict[str, np.ndarray]:
        moves = np.tile(np.expm1(strain / SQUEEZE_STEPS) * np.eye(3), (SQUEEZE_STEPS, 1, 1))
        return drive(material, moves, abs(strain) / (SQUEEZE_STEPS * rate)).columns

    def excess(strain: float) -> float:
        return pressure + float(compressed(strain)["stress_xx"][-1])

    if pressure > 0.0:
        guess = -pressure / (3.0 * stiffness)  # not too much: rho c^2 is more than the bulk modulus
        tolerance = 1e-12 * stiffness + 1e-10 * pressure
        root = find_root(excess, guess, -guess, tolerance)
        if root is None:
            rule = f"is not compressed to a cell pressure of {pressure:g} Pa"
            raise CaseError(rule, "give a smaller --pressure", value=name)
        end = compressed(root)
    return {key: float(value[-1]) for key, value in end.items() if key not in COUNTED}


def free_sides(
    name: str,
    material: Material,
    moves: np.ndarray,
    time_step: float,
    held: float = 0.0,
    start: dict[str, float] | None = None,
) -> np.ndarray:
    """Give `moves` the lateral strain that keeps the pressure on the sides, step by step.

    Each step is a root in one unknown, found to 1e-11 of the stiffness rho c^2. The pressure is
    `held` [Pa], 0 for free sides; `start` is the state before, None for rest.

    Returns:
        The logarithmic lateral strain, shape (steps + 1,).
    """
    columns = drive(material, moves[:0], time_step, start).columns
    tolerance = 1e-11 * material.density * columns["sound_speed"][0] ** 2
    guess = -0.3 * moves[0, 0, 0]
    for n in range(len(moves)):
        state = {key: float(v[-1]) for key, v in columns.items() if key not in COUNTED}

        move = moves[n : n + 1]

        def side_stress(
            lateral: float, move: np.ndarray = move, state: dict[str, float] = state
        ) -> float:
            move[0, 1, 1] = move[0, 2, 2] = lateral
            side = drive(material, move, time_step, state).columns["stress_yy"][-1]
            return held + float(side)

        root = find_root(side_stress, guess, 0.05 * abs(moves[n, 0, 0]), tolerance)
        if root is None:
            strain = float(np.log1p(moves[: n + 1, 0, 0]).sum())
            rule = f"keeps a lateral stress at strain {strain:.4g} whatever its lateral strain"
            raise CaseError(
                rule, "end the test earlier with --to, or take more --steps", value=name
            )
        move[0, 1, 1] = move[0, 2, 2] = guess = root
        columns = drive(material, move, time_step, state).columns
    return np.concatenate([[0.0], np.cumsum(np.log1p(moves[:, 1, 1]))])


def find_root(
    f: Callable[[float], float], guess: float, width: float, tolerance: float
) -> float | None:
    """Return x near `guess` with |f(x)| <= tolerance for an f that grows; None if there is none.

    The bracket grows from `width`; then false position, halved at the end that stays (Illinois).
    """
    a, fa = guess, f(guess)
    b, fb = a, fa
    for _ in range(30):
        if not math.isfinite(fb):
            return None
        if abs(fb) <= tolerance:
            return b
        if fa * fb < 0:
            break
        a, fa = b, fb
        b = a - math.copysign(width, fa)
        fb, width = f(b), 2.0 * width
    else:
        return None
    for _ in range(200):
        x = b - fb * (b - a) / (fb - fa)
        fx = f(x)
        if abs(fx) <= tolerance or x in (a, b):
            return x if abs(fx) <= 1e3 * tolerance else None
        if fx * fb < 0:
            a, fa = b, fb
        else:
            fa *= 0.5
        b, fb = x, fx
    return None
