# SPDX-License-Identifier: BSD-3-Clause
"""Runs that a program steps by itself, with all files of a run."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.base.signals import Notice, sentence
from mpm3dpp.io.checkpoint import CHECKPOINT, no_checkpoint
from mpm3dpp.io.folders import forget_last_run, only_run_in, writable_folder
from mpm3dpp.io.foreign import refuse_foreign
from mpm3dpp.io.manifest import Manifest
from mpm3dpp.ranks.world import world

from .checkpoints import Checkpoint, Checkpoints
from .recording import Recording
from .resume import go_on, has_checkpoint
from .simulation import Simulation


class Recorded:
    """A run that a program steps.

    Attributes:
        simulation: what is stepped; it may be looked at, and given velocities, between two steps.
        manifest: what `manifest.json` holds; None until the end.
    """

    def __init__(self, recording: Recording, simulation: Simulation, notice: Notice) -> None:
        self._recording, self.simulation, self._notice = recording, simulation, notice
        self.manifest: Manifest | None = None

    def advance(self, steps: int) -> bool:
        """Make up to so many steps; return whether the run goes on.

        It does not at the end time of the case, by its `run.stop`, and when it became unstable,
        which `record` tells at its end. Frames, rows of the history, probes and checkpoints are
        written as in a run by `run_case`, wherever these steps end.

        Raises:
            CaseError: `steps` is no whole number > 0; or the disk is full.
            KeyboardInterrupt: Ctrl-C, SIGTERM or their like; the step is made to its end.
        """
        steps = arguments.whole_number("steps", steps, 1)
        with self._notice:  # Whole steps, and whole rows of what is written.
            goes_on = self._recording.advance(self.simulation.step + steps)
        if self._notice.taken:
            raise KeyboardInterrupt(sentence(self._notice.kind))
        return goes_on

    def write_frame(self) -> None:
        """Write a frame of the present state, besides those of the case.

        Raises:
            CaseError: the disk is full.
        """
        self._recording.frames.write(self.simulation.core)


@contextlib.contextmanager
def record(
    simulation: Simulation, out: str | Path, resume: bool = False, quiet: bool = True
) -> Iterator[Recorded]:
    """Write the files of a run whose steps the program makes.

    >>> with mpm3dpp.record(mpm3dpp.Simulation(case), "out") as run:
    ...     while run.advance(100):
    ...         print(run.simulation.time, run.simulation.column("ball", "velocity").mean(axis=0))

    They are those of `run_case`, pictures apart (`mpm3dpp.plots.plot_results`): results.vtkhdf,
    history.csv, probes and checkpoints, and at the end manifest.json; also where the program
    leaves the block early or by an exception.

    Args:
        simulation: one that has made no step; `Simulation(case, device="cuda")` has a GPU make
            them.
        out: the output folder; it is made. Results in it are replaced; files of their names that no
            run has written are not.
        resume: go on from the checkpoint in the folder.
        quiet: no progress.

    Raises:
        CaseError: the simulation has made steps; a folder that cannot be written, or has no
            checkpoint of this case to go on from; or there are several processes.
        RunError: at the end of the block: the run became unstable; what was written is kept.
    """
    if world() is not None:
        raise CaseError("record works in one process only", "use run_case(every=..., call=...)")
    if not isinstance(simulation, Simulation):
        raise CaseError("must be a Simulation", "write Simulation(case)", key="simulation")
    if simulation.step > 0:
        raise CaseError("a simulation that has made steps cannot be recorded", "make a new one")
    folder = arguments.path("out", out)
    if resume and not has_checkpoint(folder):
        raise no_checkpoint(folder / CHECKPOINT)
    writable_folder(folder)
    before: Checkpoint | None = None
    notes: list[str] = []
    with only_run_in(folder):
        refuse_foreign(folder, simulation.case.probe)
        if resume:
            _, before, notes = go_on(folder, simulation.case, lambda: simulation)
        checkpoints = Checkpoints(folder, simulation.case, before)
        forget_last_run(folder, checkpoint=before is None)
        begin, notice = simulation.step, Notice()
        error: BaseException | None = None
        recording = Recording(simulation, folder, checkpoints, before, notes, quiet, notice)
        run = Recorded(recording, simulation, notice)
        with recording:
            try:
                yield run
            except BaseException as raised:
                error = raised
                recording.end("interrupted", f"by {type(raised).__name__}: {raised}")
            recording.end("completed", f"ended by the program at t = {simulation.time:.6g} s")
        run.manifest = recording.write_manifest(begin)
    if error is not None:
        raise error
    if run.manifest.status == "failed":
        raise RunError(f"{run.manifest.reason}; frames and history up to then are in {folder}")
