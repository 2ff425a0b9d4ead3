# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a run: frames, rows of the history, checkpoints and progress on the way."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Sequence
from typing import Any

import numpy as np

from mpm3dpp.base.errors import RunError
from mpm3dpp.base.signals import Notice, sentence
from mpm3dpp.case.frame import in_body
from mpm3dpp.io.background import BackgroundWriter
from mpm3dpp.io.history import HistoryWriter
from mpm3dpp.io.manifest import Status
from mpm3dpp.io.part_cells import sums_of

from .checkpoints import Checkpoints
from .device import CPU
from .progress import Progress
from .simulation import Simulation
from .watch import Watch

Outcome = tuple[Status, str | None]
"""How a run ended, and why."""

_NO_STATE = ("non-finite", "negative volume")  # Failures after which particles have no values.
_BLOCK = 64  # Steps between two looks at the clock, without contact.
_PARTS_EVERY = 16  # Steps between two rows with the sums of bodies, at least.
_PARTS_EVERY_OF_DEVICE = 512  # Where particles must be brought home for them.


class Stepping:
    """The steps of a run.

    Args:
        simulation: ready to step.
        checkpoints: written when they are due.
        results, history, watch: of the run, open.
        progress: where the user looks.
        notice: of the user's wish to stop.
    """

    def __init__(
        self,
        simulation: Simulation,
        checkpoints: Checkpoints,
        results: BackgroundWriter,
        history: HistoryWriter,
        watch: Watch,
        progress: Progress,
        notice: Notice,
    ) -> None:
        self._simulation, self._checkpoints, self._results = simulation, checkpoints, results
        self._history, self._watch, self._progress = history, watch, progress
        self._notice = notice
        case, core = simulation.case, simulation.core
        self._contact, self._by_surfaces = case.contact_enabled, bool(in_body(case))
        every = case.output.history_every
        most = min(every if self._contact else _BLOCK, core.history_capacity // 2)
        # Where they may end the run it is the same step with and without a device.
        rare = simulation.device.name != CPU and not case.run.stop
        self._sums_every = max(_PARTS_EVERY_OF_DEVICE if rare else _PARTS_EVERY, every)
        self._most = min(most, self._sums_every) if case.run.stop else most
        self._frames = deque(t for t in case.frame_times() if t > core.time)
        self._touched = _touched(core.contact_groups()) if self._contact else 0
        self.told: list[str] = []
        self._told = len(core.warnings())  # Those of the parts of the run before.
        self._begun = False
        # The steps between the last look and the next.
        self._last_look = self._next_look = core.step
        self._settles = False

    def advance(self, last_step: float = math.inf) -> Outcome | None:
        """Step to the end time, or to a step; return how the run ended and why, None if it goes on.

        Where it is interrupted so changes nothing of what is written.
        """
        core = self._simulation.core
        if core.step == 0 and not self._begun:
            self._begun = True
            start = sums_of(core)
            self._history.append(core.history(), None, start)
            if ends := self._watch.look() or self._watch.end_of(start, self._history.first_bodies):
                return "completed", ends
        while core.time < self._simulation.case.run.end_time:
            if core.step >= last_step:
                return None
            if core.step >= self._next_look:
                self._last_look, self._settles = core.step, core.time < 0.0
                self._next_look = core.step + _steps(self._most, self._frames, core)
            outcome, looked = self._make_steps(last_step)
            if outcome is not None:
                return outcome
            if looked and self._checkpoints.due:
                told = self._checkpoints.write(core, self._results, self._history)
                tell(self._progress, told)
        return "completed", None

    def flush(self) -> None:
        """Write the rows of the steps since the last look, where the run ends between two."""
        core = self._simulation.core
        self._history.append(core.history(), core.contact_groups() if self._contact else [])

    def _make_steps(self, last_step: float) -> tuple[Outcome | None, bool]:
        """Make steps to the next look or to `last_step`; return how the run ended, if it did, and
        whether it was a look."""
        core = self._simulation.core
        failed, ends, until = None, None, min(self._next_look, last_step)
        try:
            # To the end of settling, when the clock jumps to 0: there is a frame.
            end = 0.0 if self._settles else None
            ends = _advance(self._simulation, int(until - core.step), end, self._watch)
        except RunError as error:
            failed = str(error)
        is_end = core.time >= self._simulation.case.run.end_time
        if not (ends or failed or is_end) and core.step == until < self._next_look:
            return None, False
        return self._look(ends, failed), True

    def _look(self, ends: str | None, failed: str | None) -> Outcome | None:
        """Write what is due; return how the run has ended, if it has."""
        core, history, results = self._simulation.core, self._history, self._results
        before, self._next_look = self._last_look, core.step
        self._told = _tell_new(self._progress, core, self._told)
        rows, pairs = core.history(), core.contact_groups() if self._contact else []
        if self._settles and core.time >= 0.0:
            self._tell_settled(rows)
            history.begin_bodies()
        due = bool(self._frames) and core.time >= self._frames[0]
        # By the steps' numbers, so that a run that goes on has them in the same rows.
        summed = due or core.step // self._sums_every > before // self._sums_every
        sums = sums_of(core) if summed else None
        history.append(rows, pairs, sums)
        if failed is not None:
            if core.failure.kind not in _NO_STATE:  # Else the last frame is the last good one.
                results.write(core)
            return "failed", failed
        if sums is not None and not ends:
            ends = self._watch.end_of(sums, history.first_bodies)
        while self._frames and core.time >= self._frames[0]:
            self._frames.popleft()
        if due or core.step // _BLOCK > before // _BLOCK:  # Not at each step: others are asked too.
            results.check()
        # A frame too whenever two entries first touch, but for those that do so while they settle.
        touched = _touched(pairs)
        if due or ends or (touched > self._touched and core.time >= 0.0):
            results.write(core)
        self._touched = touched
        touching = None
        if self._contact:
            touching = _touching(core.contact_summary(), self._by_surfaces)
        kinetic, internal = rows[-1, 3:5]
        self._progress.update(core.time, core.step, core.dt, kinetic, internal, touching)
        if ends:
            return "completed", ends
        if self._notice.taken:
            return "interrupted", f"{sentence(self._notice.kind)} at t = {core.time:.6g} s"
        return None

    def _tell_settled(self, rows: np.ndarray) -> None:
        core, settle = self._simulation.core, self._simulation.case.run.settle
        ratio = rows[rows[:, 1] >= 0.0, core.history_columns.index("unbalanced")][0]
        if ratio == 0.0:  # Forces that balance do so but for rounding.
            sentence = (
                "warning: run.settle had nothing to settle: at the time 0 no force acts on any "
                "body that deforms and is not held; the run begins as the bodies are filled"
            )
            if self._simulation.presses:
                sentence = (
                    "note: run.settle has pressed the interferences; no other force acts at the "
                    "time 0, so that no ratio tells whether the bodies have come to rest"
                )
            self.told.append(sentence)
            self._progress.note(sentence)
            return
        word = "settled" if settle is not None and ratio <= settle.ratio else "not settled"
        self._progress.note(f"{word}: forces out of balance are {ratio:.3g} of those applied")


def _tell_new(progress: Progress, core: Any, told: int) -> int:
    """Tell what the core has to warn of since the first `told` times; return how often now."""
    found = core.warnings()
    for warning in found[told:]:
        progress.note(f"{'warning' if warning.is_error else 'note'}: {warning.message}")
    return len(found)


def tell(progress: Progress, problem: str) -> None:
    """Tell that there is no new checkpoint, if so."""
    if problem:
        progress.note(f"warning: no checkpoint: {problem}")


def _touching(contact: dict[str, Any], by_surfaces: bool) -> tuple[int, str]:
    """Return how many nodes are overlapped, or points of surfaces touch, and the word for them."""
    points = int(contact.get("touching_points", 0))
    if points or by_surfaces:
        return points, "points"
    return int(contact["overlapped_nodes"]), "nodes"


def _touched(pairs: list[Any]) -> int:
    """Return how many pairs have had their first contact; what comes before it, where a body has
    only just reached a node, is not one."""
    return sum(pair.first_step >= 0 for pair in pairs)


def _steps(most: int, frames: Sequence[float], core: Any) -> int:
    """Return how many steps to make before the next look: not past the next frame's time.

    Looks are at multiples of `most`, so that those at frames do not shift them.
    """
    most -= core.step % most
    if not frames or core.dt <= 0.0:
        return most
    return max(1, min(most, math.ceil((frames[0] - core.time) / core.dt)))


def _advance(simulation: Simulation, steps: int, end: float | None, watch: Watch) -> str | None:
    """Make steps, with looks of `watch` between them; return why the run is to end, if it is.

    So these looks move neither rows of the history nor frames.
    """
    core = simulation.core
    last = core.step + steps
    while core.step < last:
        wanted = last - core.step
        if watch.next < math.inf and core.dt > 0.0:
            left = math.ceil((watch.next - core.time) / core.dt)
            # Half of the way, and in the end one by one: steps may grow.
            wanted = max(1, min(wanted, left // 2))
        made = simulation.advance(wanted, end)
        ends = watch.look()
        if ends or made < wanted:
            return ends
    return None
