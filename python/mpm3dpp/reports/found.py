# SPDX-License-Identifier: BSD-3-Clause
"""What lies in the folder of a run, whole or not."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.io.about import check_about
from mpm3dpp.io.checkpoint import CHECKPOINT, read_about
from mpm3dpp.io.folders import is_run_in
from mpm3dpp.io.foreign import is_run
from mpm3dpp.io.forms import check_case
from mpm3dpp.io.manifest import Manifest
from mpm3dpp.io.read_history import read_history
from mpm3dpp.io.results import Results, open_results
from mpm3dpp.io.stored_manifest import stored_manifest
from mpm3dpp.io.vtkhdf import RESULTS

Thing = TypeVar("Thing")


@dataclass
class Found:
    """What there is of a run; None for what there is not.

    Attributes:
        folder: of the run.
        goes_on: whether a run goes on in it.
        manifest: of a run that has ended, whatever its end.
        history: columns by name, with one row or more.
        results: the frames, open.
        checkpoint: step, time, wall_time and case of the last.
        problems: a sentence for each file that is damaged.
    """

    folder: Path
    goes_on: bool
    manifest: Manifest | None = None
    history: dict[str, np.ndarray] | None = None
    results: Results | None = None
    checkpoint: dict[str, Any] | None = None
    problems: list[str] = field(default_factory=list)

    @property
    def case(self) -> dict[str, Any]:
        """The case as tables, SI units; empty where nothing tells it."""
        if self.manifest is not None:
            return self.manifest.case
        case = (self.checkpoint or {}).get("case")
        return case if isinstance(case, dict) else {}

    @property
    def title(self) -> str:
        """Of the case; empty where it has none."""
        title = self.results.title if self.results is not None else self.case.get("title")
        return str(title or "")

    @property
    def dimension(self) -> int:
        """2 or 3."""
        if self.results is not None:
            return self.results.dimension
        return int(self.case.get("grid", {}).get("dimension", 3))

    @property
    def per(self) -> str:
        """What stands behind units of masses, forces and energies: "/m" in 2D."""
        return "/m" if self.dimension == 2 else ""

    @property
    def bodies(self) -> list[str]:
        """Names of bodies and of entries of grains."""
        if self.results is not None:
            return self.results.bodies
        return list(self.manifest.bodies) if self.manifest is not None else []

    @property
    def time(self) -> float:
        """Time reached [s]."""
        if self.manifest is not None:
            return self.manifest.end_time
        if self.history is not None:
            return float(self.history["time"][-1])
        times = [] if self.results is None else self.results.times.tolist()
        return times[-1] if times else 0.0

    @property
    def steps(self) -> int | None:
        """Steps made."""
        if self.manifest is not None:
            return self.manifest.steps
        return None if self.history is None else int(self.history["step"][-1])

    def read(self, read: Callable[[], Thing]) -> Thing | None:
        """Return what a function reads; None, and a sentence more in `problems`, if it cannot."""
        try:
            return read()
        except CaseError as error:
            if str(error) not in self.problems:
                self.problems.append(str(error))
            return None


@contextlib.contextmanager
def look(folder: Path) -> Iterator[Found]:
    """Give what there is in a folder; within the block its frames can be read.

    Raises:
        CaseError: it is no folder, or has nothing of a run.
    """
    if not folder.is_dir():
        rule = "is not a folder" if folder.exists() else "there is no such folder"
        raise CaseError(rule, "give the --out of a run", place=str(folder))
    names = ("manifest.json", "history.csv", RESULTS)
    there = {name for name in names if (folder / name).exists()}
    if not there:
        rule = f"has nothing of a run: none of {', '.join(names)}"
        raise CaseError(rule, "give the --out of a run", place=str(folder))
    if there == {"history.csv"} and not is_run(folder):
        rule = "has a history.csv that is of no run, and nothing else of one"
        raise CaseError(rule, "give the --out of a run", place=str(folder))
    found = Found(folder, is_run_in(folder))
    if "manifest.json" in there:
        found.manifest = found.read(lambda: stored_manifest(folder))
    if "history.csv" in there:
        history = found.read(lambda: read_history(folder))
        found.history = history if history and len(history["time"]) else None
    if found.manifest is None and (folder / CHECKPOINT).exists():
        # If it is damaged that matters to who goes on, and is told then.
        with contextlib.suppress(CaseError, ValueError):
            about = read_about(folder / CHECKPOINT)
            check_about(about)
            check_case(about["case"])
            found.checkpoint = about
    if RESULTS in there:
        found.results = found.read(lambda: open_results(folder))
    try:
        yield found
    finally:
        if found.results is not None:
            found.results.close()
