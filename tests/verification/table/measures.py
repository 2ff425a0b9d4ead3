# SPDX-License-Identifier: BSD-3-Clause
"""What the table says of a run: error, noise, angular momentum, energy, steps and seconds."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from mpm3dpp import Case, RunError, Simulation, _core
from mpm3dpp.case.frame import all_in_bodies

from ..numerics import Numerics
from ..scene import Array, Failed

BATCH = 500  # steps between two looks at the history


@dataclass
class Measured:
    """One run; NaN for what a problem does not have.

    Attributes:
        error: against the answer, relative.
        noise: rms of a particle's stress minus a local linear fit, over that of the stress.
        spin: angular momentum at the end over the start.
        energy: mechanical energy at the end over what there should be.
        steps: made.
        seconds: of processor time.
        stopped: why the run did not end, or nothing.
    """

    error: float = math.nan
    noise: float = math.nan
    spin: float = math.nan
    energy: float = math.nan
    steps: int = 0
    seconds: float = 0.0
    stopped: str = ""

    def row(self) -> dict[str, Any]:
        """Return the columns of the table."""
        return asdict(self)


class Watched:
    """A case that has been run with some numerics, and its history."""

    def __init__(self, case: Case, name: str, scheme: str) -> None:
        case.run.scheme = scheme
        Numerics.named(name).give_case(case)
        in_body = all_in_bodies(case)
        self.cell, rows = case.grid.cell_size, []
        self.affine = not in_body and _core.transfers[case.run.transfer.word]["affine"]
        self.simulation = Simulation(case, threads=1)
        self.start = {body: self.position(body) for body in self.simulation.bodies}
        self.spin_at_start = self.spin()
        end = case.run.end_time
        try:
            while self.simulation.time < end and self.simulation.advance(BATCH, end):
                rows.append(self.simulation.core.history())
        except RunError as error:
            raise Failed(str(error)) from None
        rows = np.concatenate(rows)
        names = self.simulation.core.history_columns
        self.history = {column: rows[:, k] for k, column in enumerate(names)}

    def position(self, body: str) -> Array:
        """Return the places of a body's particles [m], (n, D)."""
        return self.simulation.column(body, "position")

    def spin(self) -> float:
        """Return the angular momentum of all bodies about the origin's z axis [kg m^2/s].

        Turning of the affine part included (Jiang et al. 2015): m D (C_yx - C_xy).
        """
        found = 0.0
        for body in self.simulation.bodies:
            m, x, v = (self.simulation.column(body, n) for n in ("mass", "position", "velocity"))
            found += float((m[:, 0] * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum())
            if self.affine:
                c = self.simulation.column(body, "affine_velocity")
                size = int(c.shape[1] ** 0.5)
                turning = c[:, size] - c[:, 1]
                found += float((m[:, 0] * turning).sum() * self.cell**2 / 4)
        return found

    def over_start(self, *columns: str) -> float:
        """Return the sum of columns of the history at the end over the energy at the start."""
        h = self.history
        start = h["kinetic"][0] + h["internal"][0]
        return float(sum(h[c][-1] for c in columns) / start)

    def measured(self, error: float, body: str, **more: float) -> Measured:
        """Return the row, with the noise of a body's von Mises stress and the energy left."""
        figures = {
            "noise": noise(self.position(body), von_mises(self, body), self.cell),
            "energy": self.over_start("kinetic", "internal", "plastic", "viscous"),
        } | more
        return Measured(error, steps=self.simulation.step, **figures)


def von_mises(run: Watched, body: str) -> Array:
    """Return the equivalent stress of a body's particles in 2D [Pa]."""
    s = run.simulation.column(body, "stress")
    differences = (s[:, 0] - s[:, 1]) ** 2 + (s[:, 1] - s[:, 2]) ** 2 + (s[:, 2] - s[:, 0]) ** 2
    return np.sqrt(differences / 2 + 3 * s[:, 3] ** 2)


def noise(x: Array, values: Array, cell: float) -> float:
    """Rms of values minus a linear fit of the neighbours within 1.5 cells, over their rms."""
    left = np.empty(len(x))
    for k, near in enumerate(cKDTree(x).query_ball_point(x, 1.5 * cell)):
        arms = np.column_stack([np.ones(len(near)), x[near] - x[k]])
        left[k] = values[k] - np.linalg.lstsq(arms, values[near], rcond=None)[0][0]
    size = np.sqrt((values**2).mean())
    return float(np.sqrt((left**2).mean()) / size) if size else math.nan


def timed(problem: Callable[[str, str], Measured], name: str, scheme: str) -> Measured:
    """Run a problem; what stops is a row too."""
    begin = time.process_time()
    try:
        found = problem(name, scheme)
    except Failed as error:
        found = Measured(stopped=str(error).splitlines()[0])
    found.seconds = time.process_time() - begin
    return found
