# SPDX-License-Identifier: BSD-3-Clause
"""`mpm3dpp reproduce`: the paper's examples, its tables and figures beside ours, on one page."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from mpm3dpp.base.errors import CaseError, RunError, nearest
from mpm3dpp.base.machine import processor_name, thread_count
from mpm3dpp.base.ours import MARK, refuse_others
from mpm3dpp.base.shipped import shipped
from mpm3dpp.io.folders import writable_folder

from .examples import EXAMPLES, SIZES, chosen

STEPS = 100
"""Steps that are timed with contact, and as many without it and bonded."""


def reproduce(
    out: str | Path = "results/reproduce",
    size: str = "quick",
    only: Iterable[str] = (),
    steps: int = STEPS,
    threads: int | None = None,
    examples: str | Path | None = None,
    quiet: bool = True,
) -> list[Path]:
    """Run the paper's examples and write a page that compares them with the paper.

    Args:
        out: output folder; it is made.
        size: "quick" (coarser, shorter, fewer bodies) or "paper" (the case files as they are).
        only: names of examples, see `EXAMPLES`; none for all whose case files are there.
        steps: how many are timed with contact, and as many without it and bonded.
        threads: how many; by default OMP_NUM_THREADS, else all cores.
        examples: folder of the example cases; by default those that came with this package.
        quiet: print nothing.

    Returns:
        `reproduce.md`, `reproduce.html` and `reproduce.json` (what was measured). The pictures
        lie beside them, the results of the runs in `runs`.

    Raises:
        CaseError: no such size or example, a case with a mistake, or a folder that cannot be
            written.
        RunError: an example had to stop; the page is written all the same, and says so.
    """
    if size not in SIZES:
        raise CaseError("is not a size", nearest(size, SIZES), key="--size", value=size)
    if steps < 1:
        raise CaseError("must be >= 1", "give a number such as 100", key="--steps", value=steps)
    cases = Path(examples) if examples is not None else shipped("examples")
    there, missing = chosen(only, cases)
    folder, workers = writable_folder(Path(out)), thread_count(threads)
    for path in (*folder.glob("reproduce.*"), *folder.glob("*.png")):
        refuse_others(path)

    from mpm3dpp import (
        __version__,
        _core,  # With what follows the slowest imports: after mistakes.
    )

    from . import page, pictures
    from .runs import run_example, say

    measured, drawn = [], {}
    for number, example in enumerate(there, 1):
        say(f"[{number}/{len(there)}] section {example.section}: {example.title}", quiet)
        found = run_example(example, cases, folder / "runs", size, steps, workers, quiet)
        measured.append(found)
        for figure in example.figures:
            drawn[figure] = pictures.make(figure, found, folder)
    build = {
        "version": __version__,
        "machine": processor_name(),
        "isa": _core.build_info()["isa"],
        "threads": workers,
    }
    written = page.write(page.compose(measured, drawn, missing, size, build), folder)
    written.append(_write_numbers(measured, size, build, folder / "reproduce.json"))
    wrong = [f"{found.example.name}: {text}" for found in measured for text in found.wrong]
    if wrong:
        raise RunError(f"{'; '.join(wrong)}; the page is {written[0]}")
    return written


def _write_numbers(measured: list[Any], size: str, build: dict[str, Any], path: Path) -> Path:
    from mpm3dpp.base.disk import write_atomically

    from .pictures import first_gap

    examples = {
        found.example.name: {
            "timed": None if found.timed is None else dataclasses.asdict(found.timed),
            "cells_held_most": found.held,
            "cells_of_tiles_most": found.tiles,
            "residual_speed": found.speed,
            "first_gap_cells": {run.label or "run": first_gap(run) for run in found.runs},
            "wrong": found.wrong,
        }
        for found in measured
    }
    content = {"program": MARK, "size": size, **build, "examples": examples}
    write_atomically(path, json.dumps(content, indent=2) + "\n")
    return path


__all__ = ["EXAMPLES", "SIZES", "reproduce"]
