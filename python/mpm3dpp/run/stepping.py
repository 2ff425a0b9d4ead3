# SPDX-License-Identifier: BSD-3-Clause
"""The steps of a run: frames, rows of the history, checkpoints and progress on the way."""

from __future__ import annotations

import math
from typing import Any

from mpm3dpp.base.errors import RunError
from mpm3dpp.base.signals import Notice
from mpm3dpp.io.background import BackgroundWriter
from mpm3dpp.io.history import HistoryWriter
from mpm3dpp.io.manifest import Status
from mpm3dpp.io.part_cells import sums_of

from .checkpoints import Checkpoints
from .progress import Progress
from .simulation import Simulation
from .watch import Watch

_NO_STATE = ("non-finite", "negative volume")  # Failures after which particles have no values.
_BLOCK = 64  # Steps between two looks at the clock, without contact.
_PARTS_EVERY = 16  # Steps between two rows with the sums of bodies, at least.


def step_to_end(
    simulation: Simulation,
    checkpoints: Checkpoints,
    results: BackgroundWriter,
    history: HistoryWriter,
    watch: Watch,
    progress: Progress,
    notice: Notice,
) -> tuple[Status, str | None]:
    """Step to the end time; return how it ended, and why.

    Args:
        simulation: ready to step.
        checkpoints: written when they are due.
        results, history, watch: of the run, open.
        progress: where the user looks.
        notice: of the user's wish to stop.
    """
    case, core = simulation.case, simulation.core
    contact = case.contact_enabled
    most = min(case.output.history_every if contact else _BLOCK, core.history_capacity // 2)
    sums_every = max(_PARTS_EVERY, case.output.history_every)
    if case.run.stop:
        most = min(most, sums_every)
    frames = [t for t in case.frame_times() if t > core.time]
    touched = _touched(core.contact_groups()) if contact else 0
    told = len(core.warnings())  # Those of the parts of the run before.
    if core.step == 0:
        start = sums_of(core)
        history.append(core.history(), None, start)
        if ends := watch.look() or watch.end_of(start, history.first_bodies):
            return "completed", ends
    while core.time < case.run.end_time:
        failed, ends, before, settling = None, None, core.step, core.time < 0.0
        try:
            # To the end of settling, when the clock jumps to 0: there is a frame.
            ends = _advance(
                simulation, _steps(most, frames, core), 0.0 if settling else None, watch
            )
        except RunError as error:
            failed = str(error)
        told = _tell_new(progress, core, told)
        rows, pairs = core.history(), core.contact_groups() if contact else []
        if settling and core.time >= 0.0:
            ratio = rows[rows[:, 1] >= 0.0, core.history_columns.index("unbalanced")][0]
            settled = case.run.settle is not None and ratio <= case.run.settle.ratio
            word = "settled" if settled else "not settled"
            progress.note(f"{word}: forces out of balance are {ratio:.3g} of those applied")
        due = bool(frames) and core.time >= frames[0]
        # By the steps' numbers, so that a run that goes on has them in the same rows.
        summed = due or core.step // sums_every > before // sums_every
        sums = sums_of(core) if summed else None
        history.append(rows, pairs, sums)
        if failed is not None:
            if core.failure.kind not in _NO_STATE:  # Else the last frame is the last good one.
                results.write(core)
            return "failed", failed
        if sums is not None and not ends:
            ends = watch.end_of(sums, history.first_bodies)
        while frames and core.time >= frames[0]:
            frames.pop(0)
        if due or core.step // _BLOCK > before // _BLOCK:  # Not at each step: others are asked too.
            results.check()
        # A frame too whenever two entries first touch, but for those that do so while they settle.
        if due or ends or (_touched(pairs) > touched and core.time >= 0.0):
            results.write(core)
        touched = _touched(pairs)
        overlapped = core.contact_summary()["overlapped_nodes"] if contact else None
        kinetic, internal = rows[-1, 3:5]
        progress.update(core.time, core.step, core.dt, kinetic, internal, overlapped)
        if ends:
            return "completed", ends
        if notice.taken:
            return "interrupted", f"stopped by the user at t = {core.time:.6g} s"
        if checkpoints.due:
            tell(progress, checkpoints.write(core, results, history))
    return "completed", None


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


def _touched(pairs: list[Any]) -> int:
    """Return how many pairs have had their first contact; what comes before it, where a body has
    only just reached a node, is not one."""
    return sum(pair.first_step >= 0 for pair in pairs)


def _steps(most: int, frames: list[float], core: Any) -> int:
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
