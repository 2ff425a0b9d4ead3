# SPDX-License-Identifier: BSD-3-Clause
"""Patch test of loads: a bar pressed on its end has the pressure everywhere, to the last column."""

from __future__ import annotations

import numpy as np
import pytest

from mpm3dpp import Case, Simulation

CELL, E, PRESSURE = 1e-3, 1e7, 1e3


def pressed(frame: str, end: float, per_cell: int, axis: int) -> np.ndarray:
    """Return the stress along a bar of so many cells over the pressure, at rest on a fixed wall."""
    upper = [2 * CELL, 2 * CELL]
    upper[axis] = end * CELL
    corners = {"lower": [0.0, 0.0], "upper": [4 * CELL, 4 * CELL]}
    corners["lower"][1 - axis], corners["upper"][axis] = -2 * CELL, 12 * CELL
    name = "xy"[axis]
    matter = {"density": 1000.0, "strength": {"elastic": {"E": E, "nu": 0.0}}}
    body = {
        "material": "m",
        "frame": frame,
        "particles_per_cell": per_cell,
        "shape": {"box": {"lower": [0.0, 0.0], "upper": upper}},
        "damping": {"mass": "20000 1/s"},
    }
    case = Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": CELL,
                "box": {**corners, "walls": {f"{name}_min": "fixed"}},
            },
            "run": {"end_time": 1.0},
            "material": {"m": matter},
            "body": {"a": body},
            "load": {"p": {"body": "a", "side": f"{name}_max", "pressure": PRESSURE}},
        }
    )
    simulation = Simulation(case)
    simulation.advance(1500)
    return np.asarray(simulation.column("a", "stress")[:, axis] / PRESSURE)


FRAMES = pytest.mark.parametrize("frame", ["updated", "material"])


@FRAMES
@pytest.mark.parametrize(("end", "per_cell"), [(6.0, 2), (6.0, 3), (6.5, 2)])
def test_a_pressed_bar(frame: str, end: float, per_cell: int) -> None:
    """The bar is a ten thousandth shorter than it was."""
    assert np.abs(pressed(frame, end, per_cell, 0) + 1.0).max() < 1e-3


@FRAMES
@pytest.mark.parametrize(("end", "per_cell"), [(6.24, 2), (5.75, 2), (6.5, 3)])
def test_a_bar_whose_spacing_is_no_part_of_a_cell(frame: str, end: float, per_cell: int) -> None:
    """Sums over points .52, .48 and .325 cells apart miss the integrals of splines: .4 to 4 %."""
    assert np.abs(pressed(frame, end, per_cell, 0) + 1.0).max() < 0.05


def test_along_the_other_axis() -> None:
    assert np.abs(pressed("material", 6.0, 2, 1) + 1.0).max() < 1e-3
