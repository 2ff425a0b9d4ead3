# SPDX-License-Identifier: BSD-3-Clause
"""The runs of an example: to the end for the pictures, and in turns for the time."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.bench.report import progress
from mpm3dpp.bench.worker import forget_peak
from mpm3dpp.case.case import Case
from mpm3dpp.case.changes import Changes, with_changes
from mpm3dpp.io.read_history import read_history
from mpm3dpp.io.results import open_results
from mpm3dpp.io.stored_manifest import read_manifest
from mpm3dpp.plots.frames import drawn
from mpm3dpp.run.run import run_case

from .examples import Example, load
from .timing import TURNS, Timed, in_turns

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
        held: most cells that hold a particle, as a share of the box's; None if not known.
        tiles: most cells of tiles, each body's counted, as a share of the box's; likewise.
        speed: residual speed of the projectile [m/s]; None without one.
        wrong: sentences about what could not be done.
    """

    example: Example
    runs: list[Done] = field(default_factory=list)
    timed: Timed | None = None
    held: float | None = None
    tiles: float | None = None
    speed: float | None = None
    wrong: list[str] = field(default_factory=list)


def run_example(
    example: Example, cases: Path, out: Path, size: str, steps: int, threads: int, quiet: bool
) -> Measured:
    """Run an example to its end, and time it with contact, without and bonded.

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
        forget_peak()  # Of the runs before.
        try:
            run_case(case, folder, threads=threads, quiet=quiet, pictures=False)
        except RunError as error:
            found.wrong.append(str(error))
        found.runs.append(Done(label, case, changes, folder, read_manifest(folder)))
    last = found.runs[-1]
    if example.table is not None:
        found.held, found.tiles = _most(held_cells(last)[1]), _most(tile_cells(last)[1])
    found.speed = residual_speed(last.folder, example.projectile)
    if example.table is not None:
        say(f"{example.name}: {steps} steps with contact, without and bonded, in turns", quiet)
        case, changes = loaded[last.label]
        try:
            with progress(quiet) as told:
                begin = example.timed_from * case.run.end_time
                found.timed = in_turns(_variants(case), steps, threads, begin, told)
        except RunError as error:
            found.wrong.append(str(error))
    return found


def say(sentence: str, quiet: bool) -> None:
    """Print what comes next on standard error."""
    if not quiet:
        print(sentence, file=sys.stderr, flush=True)


def _variants(case: Case) -> dict[str, Case]:
    """Return the case for each turn of the timing."""
    return {turn: with_changes(case, more) for turn, more in TURNS.items()}


def held_cells(done: Done) -> tuple[np.ndarray, np.ndarray]:
    """Return the times of the frames [s] and the share of the box's cells that hold a particle.

    Both (frames,); the shares are NaN without a box. The cells are those between the nodes, as the
    paper's and as the box is cut into them, with GIMP too.
    """
    grid, shares = done.case.grid, []
    cells = math.prod(grid.box_cells) if grid.box_cells else math.nan
    with open_results(done.folder) as results:
        for frame in range(len(results)):
            places = drawn(results, frame)["position"].astype(float)[:, : grid.dimension]
            numbers = np.floor((places - np.array(grid.lower)) / grid.cell_size).astype(np.int64)
            shares.append(len(np.unique(numbers, axis=0)) / cells)
        return results.times.copy(), np.array(shares)


def tile_cells(done: Done) -> tuple[np.ndarray, np.ndarray]:
    """Return the times of the steps [s] and the cells of all tiles as a share of the box's.

    Both (rows,); the shares are NaN without a box. A tile is 4 x 4 x 4 cells (8 x 8 in 2D) and is
    counted once for each body in it, so that the share may be above 1.
    """
    grid, history = done.case.grid, read_history(done.folder)
    cells = math.prod(grid.box_cells) if grid.box_cells else math.nan
    tile = (history["cell_size"] / grid.cell_size) * (8 if grid.dimension == 2 else 4)
    return history["time"], history["tiles"] * tile**grid.dimension / cells


def _most(shares: np.ndarray) -> float | None:
    """Return the largest; None where there is none."""
    return float(shares.max()) if len(shares) and np.isfinite(shares).all() else None


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
