# SPDX-License-Identifier: BSD-3-Clause
"""The runs of an example: to the end for the pictures, with and without contact for the time."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from ..bench.report import progress
from ..case import Case
from ..errors import CaseError, RunError
from ..io.history import read_history
from ..io.manifest import read_manifest
from ..io.results import open_results
from ..run import run_case
from .examples import Changes, Example, changed, load
from .timing import Timed, in_turns

Say = Callable[[str], None]


@dataclass
class Done:
    """A run of an example that has ended.

    Attributes:
        label: of the run; empty where the example has one.
        case, changes: what was run, and what was changed in its file.
        folder: its results.
        manifest: as in `manifest.json`.
    """

    label: str
    case: Case
    changes: Changes
    folder: Path
    manifest: dict[str, Any]


@dataclass
class Measured:
    """An example as run here.

    Attributes:
        example: which.
        runs: in the order of the figures.
        timed: time and memory; None where the paper has no table.
        used: most cells in use as a share of the box's; None without a box or a run.
        speed: residual speed of the projectile [m/s]; None without one.
        wrong: sentences about what could not be done.
    """

    example: Example
    runs: list[Done] = field(default_factory=list)
    timed: Timed | None = None
    used: float | None = None
    speed: float | None = None
    wrong: list[str] = field(default_factory=list)


def run_example(
    example: Example, cases: Path, out: Path, size: str, steps: int, threads: int, quiet: bool
) -> Measured:
    """Run an example to its end, and time it with contact and without.

    Args:
        example: which.
        cases: folder of the example cases.
        out: folder for the results of the runs.
        size: "quick" or "paper".
        steps: how many are timed.
        threads: how many.
        quiet: print nothing.

    Raises:
        CaseError: a mistake in the case.
        KeyboardInterrupt: the user stopped it.
    """
    found = Measured(example)
    loaded = {label: load(example, label, cases, size) for label in example.files}
    for label, (case, changes) in loaded.items():
        name = " ".join(word for word in (example.name, label) if word)
        say(f"{name}: {case.title}", quiet)
        folder = out / name.replace(" ", "_")
        try:
            run_case(case, folder, threads=threads, quiet=quiet)
        except RunError as error:
            found.wrong.append(str(error))
        found.runs.append(Done(label, case, changes, folder, read_manifest(folder)))
    last = found.runs[-1]
    found.used = used_most(last)
    found.speed = residual_speed(last.folder, example.projectile)
    if example.table is not None:
        say(f"{example.name}: {steps} steps without contact and with it, in turns", quiet)
        case, changes = loaded[last.label]
        try:
            with progress(quiet) as told:
                begin = example.timed_from * case.run.end_time
                found.timed = in_turns(_twins(case, changes), steps, threads, begin, told)
        except RunError as error:
            found.wrong.append(str(error))
    return found


def say(sentence: str, quiet: bool) -> None:
    """Print what comes next on standard error."""
    if not quiet:
        print(sentence, file=sys.stderr, flush=True)


def _twins(case: Case, changes: Changes) -> dict[str, Case]:
    """Return the case without contact and with it."""
    path = case.source
    assert path is not None
    text = path.read_text(encoding="utf-8-sig")
    key = ("contact", "enabled")
    return {
        turn: changed(text, str(path), {**changes, key: on})
        for turn, on in (("off", False), ("on", True))
    }


def used_cells(done: Done) -> tuple[np.ndarray, np.ndarray] | None:
    """Return times [s] and the share of the box's cells in tiles that are in use, both (rows,).

    None without a box. A tile is 4 x 4 x 4 cells (8 x 8 in 2D), counted once for each body in it.
    """
    grid = done.case.grid
    if grid.box is None:
        return None
    history = read_history(done.folder)
    size = history["cell_size"] * (8 if grid.dimension == 2 else 4)
    volume = math.prod(b - a for a, b in zip(grid.box.lower, grid.box.upper, strict=True))
    return history["time"], history["tiles"] * size**grid.dimension / volume


def used_most(done: Done) -> float | None:
    """Return the most of `used_cells` over the run; None without a box or a step."""
    found = used_cells(done)
    return None if found is None or not len(found[1]) else float(found[1].max())


def residual_speed(folder: Path, body: str) -> float | None:
    """Return the speed of a body's mass centre in x and z at the end of a run [m/s].

    Half of the body is computed, so that the motion of its own half along y is not its speed.
    None for a run that has no such body or no frame.
    """
    try:
        with open_results(folder) as results:
            if body not in results.bodies or not len(results):
                return None
            arrays = results.arrays(-1)
            mine = arrays["body"] == results.bodies.index(body)
            x, _, z = arrays["velocity"][mine].astype(float).mean(axis=0)  # Equal masses.
    except CaseError:
        return None
    return math.hypot(x, z)
