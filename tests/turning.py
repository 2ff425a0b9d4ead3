# SPDX-License-Identifier: BSD-3-Clause
"""A block with its balance of angular momentum, for the tests of it."""

from __future__ import annotations

from typing import Any

import numpy as np

from cases import CELL, block, materials
from mpm3dpp import Case, Grid, Run, Simulation
from mpm3dpp.case.loads import Load
from mpm3dpp.io.part_cells import TOTALS

GRAVITY = (0.7, -9.81, 0.4)
SPLINE = "quadratic_bspline"
Array = np.ndarray


def balance(sim: Simulation) -> dict[str, Array]:
    """Return the terms of the balance, vectors about the origin: `momentum`, `gravity`, ..."""
    row = dict(zip(TOTALS, sim.core.part_sums()[0], strict=True))
    names = dict.fromkeys(name.rpartition("_")[0] for name in row)
    return {
        name.removeprefix("angular_").removeprefix("impulse_").removeprefix("momentum_"): np.array(
            [row[f"{name}_{axis}"] for axis in "xyz"]
        )
        for name in names
    }


def size(sim: Simulation, body: str = "body") -> float:
    """Return the sum of m |x| |v|, by which balances are judged [N m s]."""
    x, v, m = (sim.column(body, name) for name in ("position", "velocity", "mass"))
    return float(m[:, 0] @ (np.linalg.norm(x, axis=1) * np.linalg.norm(v, axis=1)))


def stirred(sim: Simulation, body: str = "body", speed: float = 1.0) -> Simulation:
    """Give each particle a velocity of its own."""
    shape = sim.column(body, "velocity").shape
    sim.set_velocity(body, np.random.default_rng(1).uniform(-speed, speed, shape))
    return sim


def one(
    dimension: int,
    grid: dict[str, Any] | None = None,
    at: tuple[int, int, int] = (3, 3, 3),
    body: dict[str, Any] | None = None,
    load: dict[str, Load] | None = None,
    sizes: tuple[int, ...] | None = None,
    **run: Any,
) -> Case:
    """Return a case of a block of 4 cells along each axis, or of these sizes, from a cell on."""
    return Case(
        grid=Grid(**{"dimension": dimension, "cell_size": CELL, "basis": SPLINE} | (grid or {})),
        run=Run(**{"end_time": 1.0, "energy_growth_limit": 1e9} | run),
        material=materials(),
        body={
            "body": block(
                at[:dimension], sizes or (4,) * dimension, material="solid", **(body or {})
            )
        },
        load=load or {},
    )
