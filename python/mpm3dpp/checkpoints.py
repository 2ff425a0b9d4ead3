# SPDX-License-Identifier: BSD-3-Clause
"""When a run writes checkpoints, and which run may go on from one."""

from __future__ import annotations

import dataclasses
import time as clock
from pathlib import Path
from typing import Any

from .case import Case
from .errors import CaseError, key_text, show
from .io.background import BackgroundWriter
from .io.checkpoint import ANEW, CHECKPOINT, read_about, write_checkpoint
from .io.history import HistoryWriter

# What a case may change before it goes on: nothing that a step made so far depends on.
_MAY_CHANGE = {("title",), ("run", "end_time"), ("run", "energy_growth_limit")}


@dataclasses.dataclass(frozen=True)
class Checkpoint:
    """A run that can go on.

    Attributes:
        path: of the file.          step: steps made.          time: reached [s].
        wall_time: that the run has taken so far [s].
        results: see `ResultsWriter.rows`.          history: see `HistoryWriter.state`.
        case: see `Case.content`.
    """

    path: Path
    step: int
    time: float
    wall_time: float
    results: dict[str, int]
    history: dict[str, Any]
    case: dict[str, Any]

    @classmethod
    def of(cls, folder: Path) -> Checkpoint:
        """Read that of an output folder. Raises `CaseError` where there is none."""
        path = folder / CHECKPOINT
        about = read_about(path)
        try:
            return cls(path, **about)
        except TypeError as error:
            rule = f"the checkpoint '{path}' was made by another version of mpm3dpp"
            raise CaseError(rule, ANEW) from error

    def check(self, case: Case) -> None:
        """Raise `CaseError` if the case is not that of the checkpoint, naming where they differ."""
        check_same(self.path, self.case, case)


def check_same(path: Path, before: dict[str, Any], case: Case) -> None:
    """Raise `CaseError` if a case is not that of a checkpoint, naming where they differ.

    Args:
        path: of the checkpoint.
        before: its case, `Case.content()`.
        case: the case that would go on.
    """
    found = _difference(before, case.content())
    if found is not None:
        key, then, now = found
        rule = f"was {show(then)} in the run of '{path}'"
        raise CaseError(rule, f"give the case as it was, or {ANEW}", key=key, value=now)


def refuse_to_begin_anew(folder: Path, case: Case) -> None:
    """Raise `CaseError` if a folder holds a run of this very case that has not come to its end."""
    try:
        before = Checkpoint.of(folder)
        before.check(case)
    except CaseError:
        return  # There is none, or none that helps.
    if before.time < case.run.end_time:
        done = before.time / case.run.end_time
        rule = f"'{folder}' holds this run, stopped at {done:.0%} of its time"
        raise CaseError(rule, f"go on with --resume, or {ANEW}")


class Checkpoints:
    """Writes the checkpoints of a run into its folder, when they are due.

    Args:
        folder: of the run.
        case: of the run.
        wall_time: that the run has taken before now [s].
    """

    def __init__(self, folder: Path, case: Case, wall_time: float) -> None:
        self._path = folder / CHECKPOINT
        self._case = case
        self._interval = case.output.checkpoint_interval
        self._begin = clock.monotonic() - wall_time
        self._last = clock.monotonic()

    @property
    def wall_time(self) -> float:
        """That the run has taken so far [s]."""
        return clock.monotonic() - self._begin

    @property
    def due(self) -> bool:
        """Whether one should be written now."""
        return 0.0 < self._interval <= clock.monotonic() - self._last

    def write(self, core: Any, results: BackgroundWriter, history: HistoryWriter) -> None:
        """Write one, unless the case wants none; frames that wait are written first.

        Raises:
            CaseError: it cannot be written, or a frame; the last checkpoint still stands.
        """
        if self._interval == 0.0:
            return
        about = {
            "step": core.step,
            "time": core.time,
            "wall_time": self.wall_time,
            "results": results.rows(),
            "history": history.state(),
            "case": self._case.content(),
        }
        write_checkpoint(self._path, core, about)
        self._last = clock.monotonic()


def _difference(
    before: Any, now: Any, path: tuple[str | int, ...] = ()
) -> tuple[str, Any, Any] | None:
    """Return where two cases differ in what may not change: key, value before, value now."""
    if path in _MAY_CHANGE or (path[:1] == ("output",) and path[1:2] not in ((), ("fields",))):
        return None
    if isinstance(before, dict) and isinstance(now, dict):
        for name in dict.fromkeys([*before, *now]):
            found = _difference(before.get(name), now.get(name), (*path, name))
            if found is not None:
                return found
        return None
    return None if before == now else (key_text(path), before, now)
