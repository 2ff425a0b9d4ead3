# SPDX-License-Identifier: BSD-3-Clause
"""When a run writes checkpoints, and which run may go on from one."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import time as clock
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mpm3dpp import _core
from mpm3dpp.base.disk import writing
from mpm3dpp.base.errors import CaseError, show
from mpm3dpp.base.errors import Path as KeyPath
from mpm3dpp.case.case import Case
from mpm3dpp.io.about import check_about
from mpm3dpp.io.background import BackgroundWriter
from mpm3dpp.io.checkpoint import (
    ANEW,
    CHECKPOINT,
    PREVIOUS,
    DamagedError,
    read_about,
    write_checkpoint,
)
from mpm3dpp.io.frame_file import frames_folder
from mpm3dpp.io.history import PAIRS, HistoryWriter
from mpm3dpp.io.probe_tables import check_probe, probe_path
from mpm3dpp.io.read_history import check_history, has_no_history
from mpm3dpp.io.vtkhdf import RESULTS, check_frames, has_no_results

if TYPE_CHECKING:
    from .watch import Watch

# What a case may change before it goes on: nothing that a step made so far depends on.
_LIMITS = ("energy_growth_limit", "outside_limit", "volume_limit")
_MAY_CHANGE = {("title",), ("run", "end_time"), ("run", "stop"), *(("run", key) for key in _LIMITS)}
_BITS = ("compiler", "flags", "isa", "velocity_and_stress")


@dataclasses.dataclass(frozen=True)
class Checkpoint:
    """A run that can go on.

    Attributes:
        path: of the file.          step: steps made.          time: reached [s].
        wall_time: that the run has taken so far [s].
        results: see `ResultsWriter.rows`.          history: see `HistoryWriter.state`.
        watch: see `Watch.state`.
        case: see `Case.content`.          made_by: see `_program`.
    """

    path: Path
    step: int
    time: float
    wall_time: float
    results: dict[str, Any]
    history: dict[str, Any]
    watch: dict[str, Any]
    case: dict[str, Any]
    made_by: dict[str, str]

    @classmethod
    def of(cls, path: Path) -> Checkpoint:
        """Read one. Raises `DamagedError` where there is none that can be used."""
        about = read_about(path)
        try:
            check_about(about)
        except ValueError as error:
            rule = f"'{path}' is not a checkpoint of a run by this version of mpm3dpp, or damaged"
            raise DamagedError(rule, ANEW) from error
        return cls(path, **about)

    @property
    def results_are_gone(self) -> bool:
        """Whether none of the frames is there any more."""
        return has_no_results(self.path.parent / RESULTS)

    @property
    def history_is_gone(self) -> bool:
        """Whether no table is there any more."""
        return has_no_history(self.path.parent)

    def check(self, case: Case) -> None:
        """Raise `CaseError` if a case cannot go on from here, and say why; nothing is changed.

        Frames and tables are compared with their check sums. They may be gone altogether.
        """
        check_same(self.path, self.case, case)
        if case.run.end_time < self.time:
            rule = f"is before the {self.time:.6g} s that the run of '{self.path}' has reached"
            remedy = f"give a later one, or {ANEW}"
            raise CaseError(rule, remedy, key="run.end_time", value=case.run.end_time)
        folder = self.path.parent
        table, pairs, results = folder / "history.csv", folder / PAIRS, folder / RESULTS
        for file in (table, results):
            if file.exists() and not os.access(file, os.W_OK):
                raise CaseError(f"cannot write '{file}'", "make it writable")
        with _damaged(table, *([pairs] if pairs.exists() else [])):
            if not self.history_is_gone:
                check_history(folder, self.history)
        for name, of_probe in self.watch["probes"].items():
            with _damaged(probe_path(folder, name)):
                check_probe(folder, name, of_probe)
        with _damaged(results, frames_folder(results)):
            if not self.results_are_gone:
                check_frames(results, self.results)

    def notes(self, case: Case) -> list[str]:
        """Sentences for the user who goes on from here."""
        lines = [f"going on from step {self.step:,}, t = {self.time:.6g} s"]
        if self.time >= case.run.end_time:
            lines.append("this run has come to its end; a later run.end_time lets it go on")
        changed = [name for name, value in _program().items() if self.made_by.get(name) != value]
        if changed:
            what = " and ".join(f"{name} {self.made_by.get(name)}" for name in changed)
            lines.append(f"the run began with {what}: it will not end with the same bits")
        return lines


@contextlib.contextmanager
def _damaged(*names: Path) -> Iterator[None]:
    """Let a mistake in files say that they may be removed, by their names."""
    try:
        yield
    except CaseError as error:
        listed = " and ".join(f"'{name}'" for name in names)
        remedy = f"bring it back, remove {listed} to go on with new files, or {ANEW}"
        raise DamagedError(error.rule, remedy) from error


def _program() -> dict[str, str]:
    """Return what the bits of a result depend on, beside the case."""
    from mpm3dpp import __version__

    build = _core.build_info()
    return {"version": __version__} | {name: str(build[name]) for name in _BITS}


def check_same(path: Path, before: dict[str, Any], case: Case) -> None:
    """Raise `CaseError` if a case is not that of a checkpoint, naming where they differ.

    Args:
        path: of the checkpoint.
        before: its case, `Case.content()`.
        case: the case that would go on.
    """
    found = _difference(before, case.content())
    if found is not None:
        where, then, now = found
        remedy = f"give the case as it was, or {ANEW}"
        if now is None or then is None:
            rule = "is missing, and was there" if now is None else "was not there"
            raise case.error(where, f"{rule} in the run of '{path}'", remedy)
        if where[-1] in ("file", "particles"):
            rule = f"names a file whose contents have changed since the run of '{path}'"
            raise case.error(where, rule, remedy)
        raise case.error(where, f"was {show(then)} in the run of '{path}'", remedy, value=now)


class Checkpoints:
    """Writes the checkpoints of a run into its folder, when they are due.

    Args:
        folder: of the run.
        case: of the run.
        before: from which it goes on, if it does.

    Attributes:
        watch: of the run, once there is one.
    """

    def __init__(self, folder: Path, case: Case, before: Checkpoint | None) -> None:
        self.watch: Watch | None = None
        self._path = folder / CHECKPOINT
        self._case = case
        self._interval = case.output.checkpoint_interval
        # One that is there must not stay behind the files.
        self._last_too = self._interval > 0.0 or before is not None
        if before is not None and before.path != self._path:  # The last one cannot be used.
            with writing(self._path):
                before.path.replace(self._path)
        self._last = clock.monotonic()
        self._begin = self._last - (before.wall_time if before else 0.0)

    @property
    def wall_time(self) -> float:
        """That the run has taken so far [s]."""
        return clock.monotonic() - self._begin

    @property
    def due(self) -> bool:
        """Whether one should be written now."""
        return 0.0 < self._interval <= clock.monotonic() - self._last

    def write(self, core: Any, results: BackgroundWriter, history: HistoryWriter) -> str:
        """Write one; frames that wait are written first.

        Returns:
            What is wrong, if it cannot be written: the last one still stands then, and the run can
            do without.

        Raises:
            CaseError: a frame could not be written.
        """
        about = {
            "step": core.step,
            "time": core.time,
            "wall_time": self.wall_time,
            "results": results.rows(),
            "history": history.state(),
            "watch": self.watch.state() if self.watch else {"probes": {}, "stops": {}},
            "case": self._case.content(),
            "made_by": _program(),
        }
        self._last = clock.monotonic()
        try:
            write_checkpoint(self._path, core, about, keep=self._path.with_name(PREVIOUS))
        except CaseError as error:
            return str(error)
        return ""

    def write_last(self, core: Any, results: BackgroundWriter, history: HistoryWriter) -> str:
        """As `write`, at the end of a run; nothing if the case wants none."""
        return self.write(core, results, history) if self._last_too else ""


def _difference(before: Any, now: Any, path: KeyPath = ()) -> tuple[KeyPath, Any, Any] | None:
    """Return where two cases differ in what may not change: path, value before, value now."""
    if path in _MAY_CHANGE or (path[:1] == ("output",) and path[1:2] not in ((), ("fields",))):
        return None
    if isinstance(before, dict) and isinstance(now, dict):
        for name in dict.fromkeys([*before, *now]):
            found = _difference(before.get(name), now.get(name), (*path, name))
            if found is not None:
                return found
        return None
    return None if before == now else (path, before, now)
