# SPDX-License-Identifier: BSD-3-Clause
"""A sphere of aluminium through a plate of the same at 6.5 km/s, to the end."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES
from mpm3dpp import Case, Simulation

RADIUS, THICK, WIDE = 5e-3, 3e-3, 20e-3
SPEED = 6500.0
FAILURES: tuple[Any, ...] = (None, "library", {"library": {"action": "erode"}})


def impact(
    dimension: int, cell: float, end: float, basis: str, failure: Any, spall: float | None = None
) -> Case:
    """Return the case; `spall` replaces the library's spall strength [Pa], 0 is none."""
    material: dict[str, Any] = {"library": "aluminium_6061_t6"}
    if failure is not None:
        material["failure"] = failure
    if spall is not None:
        material["eos"] = {"mie_gruneisen": {"spall_strength": spall}}
    across = dimension - 1
    ball = {"disc" if dimension == 2 else "sphere": {"centre": [0.0] * dimension, "radius": RADIUS}}
    plate = {"lower": [RADIUS, *[-WIDE] * across], "upper": [RADIUS + THICK, *[WIDE] * across]}
    return Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": cell, "basis": basis},
            "run": {"end_time": end, "viscosity": {}},
            "material": {"al": material},
            "body": {
                "ball": {"material": "al", "shape": ball, "velocity": [SPEED, *[0.0] * across]},
                "plate": {"material": "al", "shape": {"box": plate}},
            },
        }
    )


def finish(case: Case) -> tuple[Simulation, dict[str, np.ndarray], list[float]]:
    """Run to the end; also the least pressure and energy at any of the looks."""
    simulation, rows, least = Simulation(case, threads=1), [], [0.0, 0.0]
    while simulation.time < case.run.end_time:
        simulation.advance(20)
        rows.append(simulation.core.history())
        for body in ("ball", "plate"):
            pressure = -simulation.column(body, "stress")[:, :3].mean(axis=1)
            least[0] = min(least[0], pressure.min())
            least[1] = min(least[1], simulation.column(body, "internal_energy").min())
    table = np.concatenate(rows).T
    return simulation, dict(zip(simulation.core.history_columns, table, strict=True)), least


def judge(case: Case) -> None:
    """Bounds hold, the ledger closes, no step makes 5 % of the energy."""
    simulation, row, (pressure, energy) = finish(case)
    [eos] = [case.material["al"].eos]
    assert eos is not None
    assert pressure >= -eos.parameters["spall_strength"] * (1 + 1e-6)
    assert energy >= -case.material["al"].density * 885.0 * 298.0
    start = row["kinetic"][0]
    assert np.abs(row["residual"]).max() < 1e-11 * start  # some thousand roundings
    made = np.diff(row["numerical"] + row["contact"] + row["energy_floor"])
    assert np.abs(made).max() < 0.05 * start
    assert row["dt"][1:].min() > 0.1 * np.median(row["dt"][1:])
    assert not [w for w in simulation.core.warnings() if w.kind != "volume"]


@pytest.mark.parametrize("failure", FAILURES)
@pytest.mark.parametrize("basis", BASES)
def test_a_disc_through_a_plate(basis: str, failure: Any) -> None:
    judge(impact(2, 1e-3, 8e-6, basis, failure))


@pytest.mark.slow
@pytest.mark.parametrize("failure", FAILURES)
@pytest.mark.parametrize("basis", BASES)
def test_a_sphere_through_a_plate(basis: str, failure: Any) -> None:
    judge(impact(3, 1e-3, 15e-6, basis, failure))
