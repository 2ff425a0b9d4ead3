# SPDX-License-Identifier: BSD-3-Clause
"""Cases of bodies on nodes of their own, and what is looked at."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from mpm3dpp import Case, Simulation, _core

CELL, DENSITY, E = 1e-3, 1000.0, 1e7
SPEED = 100.0  # of waves along a bar of E, without contraction
COLUMNS = list(_core.part_columns)


def part(simulation: Simulation, name: str, body: int = 0) -> float:
    """A column of the table of parts."""
    return float(np.array(simulation.core.part_sums()[1])[body][COLUMNS.index(name)])


def frame_tables(
    dimension: int,
    body: dict[str, Any],
    end_time: float,
    nu: float = 0.3,
    run: dict[str, Any] | None = None,
    **more: Any,
) -> dict[str, Any]:
    """Return the tables of a case of one body, "a"."""
    material = {"density": DENSITY, "strength": {"elastic": {"E": E, "nu": nu}}}
    return {
        "grid": {"dimension": dimension, "cell_size": CELL},
        "run": {"end_time": end_time, **(run or {})},
        "material": {"m": material},
        "body": {"a": {"material": "m", "frame": "material", **body}},
        **more,
    }


def frame_case(*about: Any, **more: Any) -> Case:
    return Case.model_validate(frame_tables(*about, **more))


def run_and_look(
    simulation: Simulation, every: int, look: Any = None
) -> tuple[dict, list[tuple[float, Any]]]:
    """Run to the end; return the columns of all steps, and times with what `look` sees then."""
    core, end = simulation.core, simulation.case.run.end_time
    rows, seen = [core.history()], []
    while simulation.time < end:
        simulation.advance(every, end)
        rows.append(core.history())
        if look is not None:
            seen.append((simulation.time, look(simulation)))
    return dict(zip(core.history_columns, np.concatenate(rows).T, strict=True)), seen


def run_to_end(simulation: Simulation, every: int, look: Any = None) -> tuple[dict, np.ndarray]:
    """Return the columns of all steps; times, and the number that `look` sees then."""
    columns, seen = run_and_look(simulation, every, look)
    return columns, np.array(seen).T


def energies(columns: dict[str, np.ndarray]) -> np.ndarray:
    """Kinetic and internal energy over that at the start, of every step."""
    total = columns["kinetic"] + columns["internal"]
    return np.asarray(total / total[0])


def period(times: np.ndarray, values: np.ndarray) -> float:
    """Twice the mean time between two changes of sign."""
    k = np.flatnonzero(np.diff(np.sign(values)))
    at = times[k] - values[k] * (times[k + 1] - times[k]) / (values[k + 1] - values[k])
    return float(2.0 * (at[-1] - at[0]) / (len(at) - 1))


def rms(values: Any) -> float:
    return float(np.sqrt(np.mean(np.square(values))))


def noise_of_pressure(
    simulation: Simulation, name: str = "a", cell: float = CELL
) -> tuple[float, float]:
    """Return the rms of what a linear fit within 1.5 cells does not have, and of the pressure."""
    places, stress = (simulation.column(name, field) for field in ("position", "stress"))
    pressure = -stress[:, :3].sum(axis=1) / 3.0
    beyond = []
    for k, near in enumerate(cKDTree(places).query_ball_point(places, 1.5 * cell)):
        terms = np.column_stack([np.ones(len(near)), places[near] - places[k]])
        fit, *_ = np.linalg.lstsq(terms, pressure[near], rcond=None)
        beyond.append(pressure[k] - fit[0])
    return rms(beyond), rms(pressure)


BLOCKS = """
[grid]
dimension = DIMENSION
cell_size = "2 mm"
box = { lower = LOWER, upper = UPPER, walls = { y_min = "contact" }, friction = { y_min = 0.4 } }
[run]
end_time = "1 s"
gravity = GRAVITY
[contact]
friction = 0.3
restitution = 0.8
[material.soft]
density = 1000
strength = { j2 = { E = "1 MPa", nu = 0.3, Y0 = "20 kPa", H = "50 kPa" } }
[material.rigid]
density = 3000
strength = { rigid = {} }
[body.one]
material = "soft"
frame = "material"
particles_per_cell = 2
shape = { box = { lower = ONE, upper = TO } }
velocity = FAST
[body.two]
material = "soft"
frame = "material"
particles_per_cell = 2
shape = { box = { lower = TWO, upper = UNTIL } }
[body.three]
material = "rigid"
shape = { box = { lower = THREE, upper = END } }
"""


def blocks(dimension: int) -> str:
    """Return a case of a block that hits another askew, and a rigid one, on a wall."""
    text = BLOCKS.replace("DIMENSION", str(dimension))
    for word, value in {
        "LOWER": [-0.04, 0.0, -0.04],
        "UPPER": [0.06, 0.06, 0.04],
        "GRAVITY": [0.0, -9.81, 0.0],
        "ONE": [-0.012, 0.0, -0.004],
        "TO": [0.0, 0.008, 0.004],
        "FAST": [4.0, -0.2, 0.3],
        "TWO": [0.0, 0.002, -0.002],
        "UNTIL": [0.008, 0.012, 0.006],
        "THREE": [0.008, 0.0, -0.004],
        "END": [0.016, 0.01, 0.004],
    }.items():
        text = text.replace(f"= {word}", f"= {value[:dimension]}")
    return text
