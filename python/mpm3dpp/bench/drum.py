# SPDX-License-Identifier: BSD-3-Clause
"""The benchmark `drum`: discs with friction in a rigid drum that turns, all as in a user's case.

The discs fill the drum and turn with it, so that all touch from the first step on, and gravity
presses them. SI units.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mpm3dpp.grains import GrainCentres

from .numerics import CELL

RADIUS = 2.75 * CELL  # Of a disc: 5.5 cells across.
PARTICLES = 95  # Of a disc, about.
TURNING = 2 * math.pi  # [rad/s], 60 rpm.
GRAIN = {"density": 1500.0, "strength": {"elastic": {"E": 0.5e6, "nu": 0.3}}}


def tables(count: int) -> dict[str, Any]:
    """Return the tables of the case, but for what all benchmarks have."""
    places = centres(count)
    inner = float(np.linalg.norm(places, axis=1).max()) + RADIUS
    ring = {"centre": [0.0, 0.0], "inner_radius": inner, "outer_radius": inner + 3 * CELL}
    motion = {"angular_velocity": TURNING, "centre": [0.0, 0.0]}
    discs = {
        "material": "grain",
        "file": GrainCentres(places, np.full(count, RADIUS)),
        "velocity": [{"expression": f"{TURNING} * {x}"} for x in ("-y", "x")],
    }
    return {
        "run": {"gravity": [0.0, -9.81]},
        "material": {"grain": GRAIN},
        "body": {"drum": {"material": "grain", "shape": {"ring": ring}, "motion": motion}},
        "grains": {"discs": discs},
    }


def centres(count: int) -> np.ndarray:
    """Return where discs stand that touch [m], shape (count, 2): the places nearest the middle."""
    reach = math.ceil(math.sqrt(count)) + 2
    rows, columns = np.mgrid[-reach : reach + 1, -reach : reach + 1].reshape(2, -1)
    places = np.stack([2.0 * columns + rows % 2, math.sqrt(3.0) * rows], axis=1) * RADIUS
    nearest = np.argsort(np.linalg.norm(places, axis=1), kind="stable")
    return np.asarray(places[nearest[:count]])
