# SPDX-License-Identifier: BSD-3-Clause
"""The same bits of a case with any number of threads and ranks, fused or not, after a restart."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mpm3dpp import Case, Simulation


def check_same_bits(case: Case, folder: Path) -> None:
    """Run 60 steps of a case in several ways, one of them with a restart after 30."""
    one = _state(Simulation(case, threads=1))
    assert one == _state(Simulation(case, threads=3))
    assert one == _state(Simulation(case, threads=1, fused=False))
    first = Simulation(case, threads=2)
    first.advance(30)
    first.save(folder / "state.zip")
    again = Simulation(case, threads=1)
    again.restore(folder / "state.zip")
    assert _state(first) == one
    assert one == _state(again)
    assert one == _state(Simulation(case, threads=1, ranks=3))
    # From one rank to several, and from these to others.
    parts = Simulation(case, threads=1, ranks=2)
    parts.restore(folder / "state.zip")
    parts.advance(10)
    parts.save(folder / "parts.zip")
    assert one == _state(parts)
    others = Simulation(case, threads=1, ranks=3)
    others.restore(folder / "parts.zip")
    assert one == _state(others)
    alone = Simulation(case, threads=2)
    alone.restore(folder / "parts.zip")
    assert one == _state(alone)


def _state(simulation: Simulation) -> list[bytes]:
    """Return the bytes of all columns, of the history's last row and of pairs, after 60 steps."""
    simulation.advance(60 - simulation.step)
    core = simulation.core
    columns = [
        core.column(b, column.name) for b in range(core.body_count) for column in core.columns(b)
    ]
    pairs = [[*pair.force, *pair.impulse, pair.friction_work] for pair in core.contact_pairs()]
    numbers = [*columns, core.history()[-1], np.array(core.part_sums()[1]), np.array(pairs)]
    return [c.tobytes() for c in numbers]
