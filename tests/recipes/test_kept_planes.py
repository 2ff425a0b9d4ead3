# SPDX-License-Identifier: BSD-3-Clause
"""Normals and gaps that are kept while bodies hardly move (decision 0012)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import SCHEMES, three_blocks
from mpm3dpp import Simulation


def after(case: Any, travel: float, steps: int) -> Simulation:
    """Make so many steps of the case with planes kept for so many cells."""
    case.contact.normal_refresh_distance, case.contact.response = travel, "impulses"
    simulation = Simulation(case, threads=1)
    simulation.advance(steps)
    return simulation


def velocities(simulation: Simulation) -> np.ndarray:
    """Return the mean velocity of each body [m/s]."""
    return np.array([simulation.column(b, "velocity").mean(axis=0) for b in simulation.bodies])


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_bodies_move_as_with_planes_of_every_step(scheme: str, dimension: int) -> None:
    """Velocities to 1 % of what contact has changed; the bits differ, so planes were kept."""
    steps = 120 if dimension == 2 else 60
    case = three_blocks(dimension, scheme)
    start = velocities(after(case, 0.0, 0))
    every = velocities(after(case, 0.0, steps))
    kept = velocities(after(case, 0.1, steps))
    changed = np.abs(every - start).max()
    assert changed > 0.0
    assert 0.0 < np.abs(kept - every).max() < 0.01 * changed


def test_the_way_counts_from_when_a_plane_was_found() -> None:
    """No plane lasts a step on so short a way: the same bits as planes of every step.

    And planes that last 0.1 cells are not those that last 0.25: the way of several steps counts.
    """
    case = three_blocks(2, "musl")
    every, hardly = after(case, 0.0, 60), after(case, 1e-9, 60)
    assert velocities(every).tobytes() == velocities(hardly).tobytes()
    short, long = after(case, 0.1, 60), after(case, 0.25, 60)
    assert velocities(short).tobytes() != velocities(long).tobytes()
