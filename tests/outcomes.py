# SPDX-License-Identifier: BSD-3-Clause
"""What three blocks (tests/cases.py) end with, to the bit."""

from __future__ import annotations

from typing import Any

import numpy as np

from mpm3dpp import Simulation


def steps_of(dimension: int, scheme: str, basis: str = "gimp") -> int:
    """Return how many steps to make; USL soon fails in contact with the linear basis."""
    if scheme == "usl" and basis == "linear":
        return 15 if dimension == 2 else 13
    return 120 if dimension == 2 else 60


def outcome(
    case: Any,
    threads: int = 1,
    steps: int = 60,
    simulation: Simulation | None = None,
) -> dict[str, np.ndarray]:
    """Return all columns, all rows of the history and all pairs after so many steps."""
    simulation = simulation or Simulation(case, threads=threads)
    simulation.advance(steps - simulation.step)
    core, found = simulation.core, {}
    for b, name in enumerate(simulation.bodies):
        for column in core.columns(b):
            found[f"{column.name} of {name}"] = core.column(b, column.name)
    found["history"] = core.history()
    for pair in core.contact_pairs():
        a, b = (simulation.bodies[k] for k in pair.bodies)
        numbers = [pair.first_time, pair.first_gap, *pair.force, *pair.impulse, pair.friction_work]
        found[f"{a} on {b}"] = np.array(numbers)
    assert core.contact_summary()["bodies_per_node_max"] == 3
    assert core.step == steps
    return found


def different(one: dict[str, np.ndarray], other: dict[str, np.ndarray]) -> list[str]:
    """Return the names of what differs in a bit."""
    assert one.keys() == other.keys()
    return [name for name in one if one[name].tobytes() != other[name].tobytes()]
