# SPDX-License-Identifier: BSD-3-Clause
"""The whole run of a case: frames, history, manifest, pictures."""

from __future__ import annotations

import json as json_format
import sys
from pathlib import Path

from mpm3dpp import _core
from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.base.signals import Notice, as_exceptions
from mpm3dpp.case.case import Case, load_case
from mpm3dpp.io.checkpoint import CHECKPOINT, no_checkpoint
from mpm3dpp.io.folders import forget_last_run, only_run_in, writable_folder
from mpm3dpp.io.foreign import refuse_foreign
from mpm3dpp.io.manifest import Manifest
from mpm3dpp.plots.apart import draw_apart
from mpm3dpp.ranks.world import world

from .checkpoints import Checkpoint, Checkpoints
from .device import CPU
from .lead import Mistake, follow, make_simulation, release
from .recording import Recording
from .report import summary_lines
from .resume import as_it_was, go_on, has_checkpoint
from .watch import Call, interval_of


def run_case(
    case: Case | str | Path,
    out: str | Path,
    threads: int | None = None,
    quiet: bool = True,
    json: bool = False,
    pictures: bool = True,
    resume: bool = False,
    every: float | str | None = None,
    call: Call | None = None,
    device: str = CPU,
) -> Manifest:
    """Run a case to its end: results.vtkhdf, history.csv, manifest.json and pictures in a folder.

    Args:
        case: what to run, or its file.
        out: the output folder; it is made. Results in it are replaced, also those of another case:
            only the command refuses that. Files of these names that no run has written are not.
            Of several processes, which mpiexec has started, all
            return what the first one does; the folder is on a disk that all have.
        threads: of each process, how many; by default OMP_NUM_THREADS, else all cores.
        quiet: no progress and no summary.
        json: print the manifest at the end.
        pictures: make them; `mpm3dpp.plots.plot_results` makes them later.
        resume: go on from the checkpoint in the folder, in place of beginning anew, with the same
            results as a run in one go. A run that has come to its end may get a later one; its last
            two steps were fitted to the first.
        every: time between two calls of `call` [s], or text with a unit.
        call: a function of the `Simulation`, called at the start and at the first step at or after
            each of these times; the run ends, with all outputs, when it returns False. It may look
            at anything and change nothing.
        device: who makes the steps: "cpu"; "cuda", a GPU, with the same bits; "auto", it if it can,
            else the processor.

    Raises:
        CaseError: a mistake in the case or the call, a folder that cannot be written, or no device.
        RunError: the run became unstable, or the disk is full; what was written before is kept.
        KeyboardInterrupt: the user or the system stopped it; what was computed is kept.
    """
    ranks = world()
    if ranks is not None and ranks.rank > 0:
        followed = follow(ranks)
        if isinstance(followed, Mistake):
            raise followed.kind(followed.sentence)
        if followed is None:
            raise SystemExit(1)  # The first process has said why.
        return followed
    ended: Manifest | Mistake | None = None
    try:
        ended = _run_case(case, out, threads, quiet, json, pictures, resume, every, call, device)
    except (CaseError, RunError) as error:
        ended = Mistake(type(error), str(error))
        raise
    finally:
        release(ended)
    return ended


def _run_case(
    case: Case | str | Path,
    out: str | Path,
    threads: int | None,
    quiet: bool,
    json: bool,
    pictures: bool,
    resume: bool,
    every: float | str | None,
    call: Call | None,
    device: str,
) -> Manifest:
    interval = interval_of(every, call)
    folder = arguments.path("out", out)
    _core.return_freed_memory()
    if not isinstance(case, Case):
        case = load_case(arguments.path("case", case))
    if resume and not has_checkpoint(folder):
        raise no_checkpoint(folder / CHECKPOINT)
    writable_folder(folder)
    with only_run_in(folder):
        refuse_foreign(folder, case.probe)
        manifest, late = _run(case, folder, threads, quiet or json, resume, interval, call, device)
    if json:
        print(json_format.dumps(manifest.to_dict(), indent=2))
    elif not quiet:
        print("\n".join([*summary_lines(manifest), f"results in {folder}"]), flush=True)
    can_go_on = "; --resume goes on" if has_checkpoint(folder) else ""
    if manifest.status == "interrupted" and not quiet:
        text = f"mpm3dpp: {manifest.reason}; results are in {folder}{can_go_on}"
        print(text, file=sys.stderr, flush=True)
    if pictures and not late:
        _draw(folder, quiet or json)
    elif pictures and not quiet:
        print(f"no pictures: `mpm3dpp plot {folder}` makes them later", file=sys.stderr)
    if manifest.status == "failed":
        raise RunError(f"{manifest.reason}; frames and history up to then are in {folder}")
    if manifest.status == "interrupted":
        raise KeyboardInterrupt((manifest.reason or "").partition(" at t = ")[0])
    return manifest


def _run(
    case: Case,
    folder: Path,
    threads: int | None,
    quiet: bool,
    resume: bool,
    every: float,
    call: Call | None,
    device: str,
) -> tuple[Manifest, bool]:
    """Make the run, and write all but pictures; return also whether Ctrl-C came after its end."""
    before: Checkpoint | None = None
    notes: list[str] = []
    if resume:
        case = as_it_was(folder, case)
        simulation, before, notes = go_on(
            folder, case, lambda: make_simulation(case, threads, device)
        )
    else:
        simulation = make_simulation(case, threads, device)
    checkpoints = Checkpoints(folder, simulation.case, before)
    with Notice() as notice:
        forget_last_run(folder, checkpoint=before is None)
        begin = simulation.step
        recording = Recording(
            simulation, folder, checkpoints, before, notes, quiet, notice, every, call
        )
        try:
            with recording:
                recording.advance()
            manifest = recording.write_manifest(begin)
        except CaseError as error:  # Disk or device: it was no mistake when the run began.
            if simulation.step == begin:
                raise
            can_go_on = ", and --resume goes on" if has_checkpoint(folder) else ""
            raise RunError(f"{error}; what was written before is in {folder}{can_go_on}") from error
        return manifest, manifest.status == "completed" and notice.taken


def _draw(folder: Path, quiet: bool) -> None:
    """Draw the pictures of a run; it is not lost if they cannot be drawn, nor by Ctrl-C."""
    later = f"`mpm3dpp plot {folder}` makes them later"
    try:
        if not quiet:
            text = f"drawing pictures (Ctrl-C leaves them out, {later})"
            print(text, file=sys.stderr, flush=True)
        _core.return_freed_memory()  # It is the pictures' turn.
        with as_exceptions():
            said = draw_apart(folder)
        if said and not quiet:
            print(said, file=sys.stderr)
    except KeyboardInterrupt:
        if not quiet:
            print(f"no pictures: {later}", file=sys.stderr)
    except Exception as error:
        if not quiet:
            print(f"no picture: {error}", file=sys.stderr)
