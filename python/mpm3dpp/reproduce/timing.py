# SPDX-License-Identifier: BSD-3-Clause
"""Time and memory of a case with contact, without and bonded, in turns in one process.

Blocks of steps go A B C A B C, so that what slows the machine for a while slows both.
"""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from mpm3dpp.base.errors import RunError
from mpm3dpp.bench import WARM_UP, block_lengths
from mpm3dpp.bench.worker import advance, timed_block
from mpm3dpp.case.case import Case
from mpm3dpp.case.changes import Changes
from mpm3dpp.run.simulation import Simulation

TURNS: dict[str, Changes] = {
    "off": {("contact", "enabled"): False},
    "bonded": {("contact", "enabled"): True, ("contact", "bonded"): True},
    "on": {("contact", "enabled"): True, ("contact", "bonded"): False},
}
"""What is measured in turn: without contact the bodies do not see each other; bonded they have one
velocity field, which is the method before contact was added to it; and with contact."""


@dataclass
class Timed:
    """What was measured of a case in each of `TURNS`.

    Attributes:
        particles: count.
        steps: that were timed of each.
        blocks: time of a step in each block [s].
        bytes: the most that the core counts after a block: particles, grid, contact.
    """

    particles: int
    steps: int
    blocks: dict[str, list[float]] = field(default_factory=dict)
    bytes: dict[str, dict[str, int]] = field(default_factory=dict)

    def seconds(self, turn: str) -> float:
        """Time of a step [s], the median of the blocks."""
        return statistics.median(self.blocks[turn])

    def ratio(self, turn: str) -> float:
        """Time with contact over that of another turn, the median over pairs of blocks."""
        pairs = zip(self.blocks[turn], self.blocks["on"], strict=True)
        return statistics.median(on / other for other, on in pairs)

    def total(self, turn: str) -> int:
        """Memory of particles, grid and contact [bytes]."""
        return sum(self.bytes[turn].values())


def in_turns(
    cases: dict[str, Case],
    steps: int,
    threads: int,
    begin: float = 0.0,
    told: Callable[[int, int], None] | None = None,
) -> Timed:
    """Measure a case in turns.

    Args:
        cases: one for each of `TURNS`.
        steps: how many of each are timed, in blocks of nearly equal length.
        threads: how many.
        begin: time reached before steps are timed [s].
        told: called with (parts done, parts in all) as the measurement goes on.

    Raises:
        RunError: one of them became unstable.
    """
    lengths = block_lengths(steps)
    parts = len(TURNS) * (1 + len(lengths))
    tell = told or (lambda done, parts: None)
    cores: dict[str, Any] = {}
    tell(0, parts)
    try:
        for k, turn in enumerate(TURNS):
            simulation = Simulation(cases[turn], threads)
            cores[turn] = simulation.core
            _go_to(simulation, begin)
            advance(simulation.core, WARM_UP)
            tell(1 + k, parts)
        found = Timed(cores["on"].particle_count, steps, {t: [] for t in TURNS})
        for k, length in enumerate(lengths):
            for j, turn in enumerate(TURNS):
                ns = timed_block(cores[turn], length)["ns"]
                found.blocks[turn].append(1e-9 * ns * found.particles)
                now = {n: int(cores[turn].bytes()[n]) for n in ("particles", "grid", "contact")}
                found.bytes[turn] = max(found.bytes.get(turn, now), now, key=_sum)
                tell(len(TURNS) * (1 + k) + 1 + j, parts)
    except RuntimeError as error:
        raise RunError(str(error)) from None
    return found


def _sum(counts: dict[str, int]) -> int:
    return sum(counts.values())


def _go_to(simulation: Simulation, time: float) -> None:
    core = simulation.core
    while core.time < time:
        simulation.advance(max(1, core.history_capacity // 2), time)
        core.history()
