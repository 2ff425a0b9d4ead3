# SPDX-License-Identifier: BSD-3-Clause
"""Patch test of contact between surfaces: what is pressed on another has the pressure everywhere,
to the last column; and how long a step it bears."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from in_body import run_and_look
from mpm3dpp import Case, Simulation
from mpm3dpp.base.errors import CaseError
from mpm3dpp.fill.advisories import refuse_time_step
from mpm3dpp.fill.build import build

CELL, E, PRESSURE = 1e-3, 1e7, 1e4
WIDE = 6 * CELL


def block(lower: float, upper: float, per_cell: int) -> dict[str, Any]:
    return {
        "material": "m",
        "frame": "material",
        "particles_per_cell": per_cell,
        "shape": {"box": {"lower": [lower, 0.0], "upper": [upper, WIDE]}},
        "damping": {"mass": "20000 1/s"},
    }


def pressed(on: str, end: float, per_cell: int, **grid_words: str) -> np.ndarray:
    """Return stresses over the pressure of a block that is pressed on what begins at x = end cells,
    of rows behind each other from there on."""
    end *= CELL
    bodies = {"a": block(end, end + 6 * CELL, per_cell)}
    rigid = {"density": 1e4, "strength": {"rigid": {}}}
    grid: dict[str, Any] = {"dimension": 2, "cell_size": CELL, **grid_words}
    if on == "wall":
        corners = {"lower": [0.0, -4 * CELL], "upper": [20 * CELL, 16 * CELL]}
        grid["box"] = {**corners, "walls": {"x_min": "contact"}}
    elif on == "plate":
        box = {"lower": [end - 3 * CELL, -2 * CELL], "upper": [end, 8 * CELL]}
        bodies["b"] = {"material": "rigid", "shape": {"box": box}, "motion": "fixed"}
    else:
        bodies["b"] = block(end - 4 * CELL, end, per_cell)
        corners = {"lower": [end - 4 * CELL, -4 * CELL], "upper": [end + 12 * CELL, 16 * CELL]}
        grid["box"] = {**corners, "walls": {"x_min": "fixed"}}
    case = Case.model_validate(
        {
            "grid": grid,
            "run": {"end_time": 1.0},
            "material": {
                "m": {"density": 1000.0, "strength": {"elastic": {"E": E, "nu": 0.0}}},
                "rigid": rigid,
            },
            "body": bodies,
            "load": {"p": {"body": "a", "side": "x_max", "pressure": PRESSURE}},
        }
    )
    simulation = Simulation(case)
    simulation.advance(3000)
    return stresses(simulation, "a")


def stresses(simulation: Simulation, body: str) -> np.ndarray:
    along = simulation.column(body, "reference_position")[:, 0]
    stress = np.asarray(simulation.column(body, "stress")[:, 0] / PRESSURE)
    return stress[np.argsort(along, kind="stable")].reshape(len(np.unique(along.round(9))), -1)


@pytest.mark.parametrize("basis", ["quadratic_bspline", "gimp"])
@pytest.mark.parametrize("per_cell", [2, 3])
@pytest.mark.parametrize(
    ("on", "end"), [("wall", 0.0), ("plate", 0.0), ("plate", 0.25), ("plate", 0.8), ("block", 0.0)]
)
def test_what_is_pressed_on_another(on: str, end: float, per_cell: int, basis: str) -> None:
    """Forces behind the surface, by linear functions: .45 to .79 and .9 to 1.34 of the pressure in
    the first two rows. On a wall to 1.7 % inside. Points of another body push those of a face
    around them, at its edge those within it, so that the last column bears .88 of the pressure and
    the third 1.04; had faces that are drawn touching not been levelled, .72 and 1.10."""
    stress = pressed(on, end, per_cell, basis=basis)
    assert np.abs(stress[:, 2:-2] + 1.0).max() < (0.02 if on == "wall" else 0.05)
    assert np.abs(stress + 1.0).max() < 0.15


def hit(**run: Any) -> Case:
    """Three times of a wave through a block of 6 cells that flies at a wall 1/2 cell before it."""
    box = {"lower": [-3 * CELL, 0.5 * CELL], "upper": [3 * CELL, 6.5 * CELL]}
    corners = {"lower": [-12 * CELL, 0.0], "upper": [12 * CELL, 24 * CELL]}
    body = {"material": "m", "frame": "material", "shape": {"box": box}, "velocity": [0.0, -1.0]}
    return Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": CELL,
                "box": {**corners, "walls": {"y_min": "contact"}},
            },
            "run": {"end_time": 7.4e-4, **run},
            "material": {"m": {"density": 1000.0, "strength": {"elastic": {"E": 1e6, "nu": 0.3}}}},
            "body": {"b": body},
        }
    )


def test_steps_are_no_longer_than_springs_bear() -> None:
    """With 1 for cfl the hit made a third of the energy again, or ended the run."""
    columns, _ = run_and_look(Simulation(hit(cfl=1.0)), 50)
    energy = columns["kinetic"] + columns["internal"] + columns["springs"]
    assert energy.max() / energy[0] < 1.005
    assert energy[-1] / energy[0] > 0.98
    case = hit(time_step=2.5e-5)
    with pytest.raises(CaseError, match=r"passes 0\.6 of a cell.*contact between surfaces"):
        Simulation(case)
    with pytest.raises(CaseError, match=r"0\.6 of a cell: contact between surfaces"):  # As `check`.
        refuse_time_step(case, build(case))
