# SPDX-License-Identifier: BSD-3-Clause
"""A run that is written as it goes on: frames, history, probes, checkpoints, manifest."""

from __future__ import annotations

import math
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from mpm3dpp import _core
from mpm3dpp.base.signals import Notice
from mpm3dpp.io.background import BackgroundWriter
from mpm3dpp.io.history import HistoryWriter
from mpm3dpp.io.manifest import Manifest, Status, build_manifest
from mpm3dpp.io.part_cells import sums_of
from mpm3dpp.io.vtkhdf import RESULTS, ResultsWriter
from mpm3dpp.ranks.world import world

from .checkpoints import Checkpoint, Checkpoints
from .device import failures_of
from .lead import background_writer, column_parts
from .progress import Progress
from .report import energies_made, energy_line
from .simulation import Simulation
from .sliced_frames import fields_of
from .stepping import Outcome, Stepping, tell
from .watch import Call, Watch


class Recording:
    """The files of a run, from its first frame to its last checkpoint.

    Args:
        simulation: ready to step.
        folder: of the run.
        checkpoints: of the run.
        before: of a run that goes on, the checkpoint.
        notes: what is to be told at the beginning.
        quiet: whether nothing is told.
        notice: of the user's wish to stop.
        every, call: see `run_case`.

    Attributes:
        outcome: how the run ended and why, None while it goes on.
        frames: the writer of the frames, while it is open.

    Raises:
        CaseError: a file cannot be written.
    """

    def __init__(
        self,
        simulation: Simulation,
        folder: Path,
        checkpoints: Checkpoints,
        before: Checkpoint | None,
        notes: list[str],
        quiet: bool,
        notice: Notice,
        every: float = math.inf,
        call: Call | None = None,
    ) -> None:
        self.outcome: Outcome | None = None
        self._simulation, self._folder, self._before = simulation, folder, before
        self._checkpoints, self._notes, self._quiet = checkpoints, notes, quiet
        self._notice, self._every, self._call = notice, every, call
        self._stack = ExitStack()

    def advance(self, last_step: float = math.inf) -> bool:
        """Step to the end time, or to a step; return whether the run goes on."""
        if self.outcome is None:
            with failures_of(self._simulation.device):
                self.outcome = self._stepping.advance(last_step)
        return self.outcome is None

    def end(self, status: Status, reason: str) -> None:
        """End a run that would go on."""
        self.outcome = self.outcome or (status, reason)

    def write_manifest(self, begin: int) -> Manifest:
        """Write the manifest of a run whose first step was `begin`, when all else is closed."""
        assert self.outcome is not None
        status, reason = self.outcome
        wall_time = self._checkpoints.wall_time
        with failures_of(self._simulation.device):
            manifest = _manifest(self._simulation, status, reason, wall_time, begin)
        manifest.energies, manifest.bodies = self._history.summary(), self._history.bodies()
        manifest.notes = [*self._told, *self._stepping.told]
        if energies_made(manifest)[1]:
            manifest.notes.append(energy_line(manifest))
        manifest.write(self._folder)
        return manifest

    def __enter__(self) -> Recording:
        with failures_of(self._simulation.device), self._stack as stack:
            self._open(stack)
            self._simulation.is_recorded = True
            self._stack = stack.pop_all()
        return self

    def __exit__(self, *about: Any) -> None:
        self._simulation.is_recorded = False
        with failures_of(self._simulation.device), self._stack:
            if about[1] is not None:
                raise about[1]
            if self.outcome is None or self.outcome[0] != "failed":
                core = self._simulation.core
                self._stepping.flush()
                # Without a step the sums stay: those of particles in other lists differ in their
                # last bits.
                if self._before is None or core.step > self._before.step:
                    self._history.note_bodies(sums_of(core))
                told = self._checkpoints.write_last(core, self.frames, self._history)
                tell(self._progress, told)

    def _open(self, stack: ExitStack) -> None:
        """Open all files, and write the first frame."""
        simulation, folder, before = self._simulation, self._folder, self._before
        case, core = simulation.case, simulation.core
        kept = None if before is None or before.results_are_gone else before.results
        history_anew = before is not None and before.history_is_gone
        file = _results_writer(simulation, folder, kept)
        self.frames: BackgroundWriter = stack.enter_context(background_writer(simulation, file))
        self._history = stack.enter_context(
            HistoryWriter(
                folder / "history.csv",
                columns=core.history_columns,
                bodies=simulation.parts,
                contact=case.contact_enabled,
                parts=True,
                walls=[face.name for face in core.walls()],
                every=case.output.history_every,
                state=before.history if before else None,
                anew=history_anew,
            )
        )
        seen = before.watch if before else None
        watch = Watch(simulation, folder, seen, self._call, self._every)
        self._checkpoints.watch = stack.enter_context(watch)
        unit = "J/m" if case.grid.dimension == 2 else "J"
        self._progress = progress = stack.enter_context(
            Progress(case.run.end_time, quiet=self._quiet, energy_unit=unit)
        )
        gone = [f"the table of probe {name} was gone: a new one begins" for name in watch.lost]
        device = [simulation.device.told] if simulation.device.told else []
        notes = [*device, *simulation.notes, *self._notes, *gone]
        self._told = [f"warning: {sentence}" for sentence in simulation.warnings]
        self._told += [f"note: {sentence}" for sentence in notes]
        for sentence in self._told:
            progress.note(sentence)
        if kept is None and core.time >= 0.0:  # Else it settles first.
            self.frames.write(core)
        if before is not None and (kept is None or history_anew or gone):  # Of the new files.
            tell(progress, self._checkpoints.write(core, self.frames, self._history))
        self._stepping = Stepping(
            simulation,
            self._checkpoints,
            self.frames,
            self._history,
            watch,
            progress,
            self._notice,
        )


def _results_writer(
    simulation: Simulation, folder: Path, kept: dict[str, Any] | None
) -> ResultsWriter:
    """Return the writer of the frames; `kept`: those that are there, as `ResultsWriter.rows`."""
    case, ranks = simulation.case, world()
    box = case.grid.box
    return ResultsWriter(
        folder / RESULTS,
        bodies=simulation.parts,
        materials=simulation.materials,
        dimension=case.grid.dimension,
        cell_size=case.grid.cell_size,
        origin=case.grid.lower,
        walls=case.grid.walls if box else (),
        box=(box.lower, box.upper) if box else (),
        fields=fields_of(case),
        compression=case.output.compression,
        title=case.title,
        case_hash=case.case_hash,
        rows=kept,
        writers=ranks.writers(case.output.files) if ranks else (0,),
    )


def _manifest(
    simulation: Simulation, status: Status, reason: str | None, wall_time: float, begin: int
) -> Manifest:
    from mpm3dpp import __version__

    case, ranks = simulation.case, world()
    return build_manifest(
        simulation.core,
        version=__version__,
        case=case.table(),
        case_text=case.text,
        case_file=case.file_path,
        bodies=simulation.bodies,
        parts=simulation.parts,
        cell_size=case.grid.cell_size,
        threads=simulation.threads,
        device=simulation.device.name,
        device_seconds=simulation.device_seconds,
        mpi=ranks.library + ("" if ranks.native else ", through mpi4py") if ranks else None,
        wall_time=wall_time,
        status=status,
        resumed_step=begin,
        reason=reason,
        case_hash=case.case_hash,
        build=_core.build_info(),
        columns=column_parts(simulation),
    )
