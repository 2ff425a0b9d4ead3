# SPDX-License-Identifier: BSD-3-Clause
"""One point of a material by itself, driven by the core through given motions."""

from __future__ import annotations

import importlib
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

COUNTED = ("dissipated", "work", "sound_speed", "viscous")
"""Columns that are counted from the start or follow from the others, and cannot be given."""


def drive_point(
    density: float,
    strength: str,
    parameters: Mapping[str, float],
    increments: np.ndarray,
    lanes: bool = False,
    *,
    time_step: float = 1.0,
    eos: tuple[str, Mapping[str, float]] | None = None,
    failures: Sequence[tuple[str, Mapping[str, float], str]] = (),
    viscosity: tuple[float, float] = (0.0, 0.0),
    volume_averaging: bool | None = None,
    cell_size: float = 1.0,
    state: Mapping[str, float] | None = None,
) -> tuple[np.ndarray, list[str], list[str]]:
    """Return what a point goes through: rows, names and SI units of the columns.

    Args:
        density: initial [kg/m^3].
        strength: name of a strength model.
        parameters: of the strength model, SI units.
        increments: velocity gradient x time step of each step, shape (n, 3, 3).
        lanes: whether the SIMD instance computes it, else the scalar one.
        time_step: [s]; the first step begins at the time 0.
        eos: name and parameters of an equation of state.
        failures: name, parameters and action of failure models.
        viscosity: quadratic and linear factor of the artificial viscosity.
        volume_averaging: of no effect, as a point is its own mean; refused where a material is.
        cell_size: h [m]; also that of a detonation's front and of a viscous fluid's time step.
        state: values at the start by column, `{"burn_fraction": 0.5}`; the others are those of a
            point at rest. A row without the columns COUNTED goes on from there.

    Returns:
        Rows of shape (n + 1, columns): stress_xx yy zz yz xz xy [Pa], volume (relative), the state
        of the models, dissipated and work [J/m^3 of initial volume], sound_speed [m/s], and with
        viscosity its work, viscous [J/m^3]; the names of the columns; their units.

    Raises:
        ValueError: the core refuses an argument, which the sentence names.
    """
    core = importlib.import_module("mpm3dpp._core")
    given: dict[str, Any] = {
        "density": density,
        "strength": strength,
        "parameters": dict(parameters),
        "eos": None if eos is None else (eos[0], dict(eos[1])),
        "failures": [(name, dict(values), action) for name, values, action in failures],
    }
    return core.drive_material(
        **given,
        increments=np.ascontiguousarray(increments, dtype=float),
        time_step=time_step,
        cell_size=cell_size,
        viscosity=viscosity,
        volume_averaging=volume_averaging,
        state=dict(state or {}),
        lanes=lanes,
    )
