# SPDX-License-Identifier: BSD-3-Clause
"""Frames that several processes write, each a slice of the particles in files of its own."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.names import numbered
from mpm3dpp.case.case import Case
from mpm3dpp.io.background import FRAME_SHARE, FrameThread
from mpm3dpp.io.fields import frame_of
from mpm3dpp.io.frame_file import FrameInfo, frames_folder
from mpm3dpp.io.frames_writer import FramesWriter
from mpm3dpp.ranks.world import World, together

from .simulation import Simulation

_MANY = 1 << 62  # Frames that a process without files keeps nobody from.


class SlicedFrames:
    """The part that this process has in the frames. All call its functions at once.

    Args:
        simulation: of the frames.
        core: the core's `Simulation` of this process.
        results: the results file.
        frames: those that there are already.
        ranks: all processes.
        file: of the first process, which has made it.
    """

    def __init__(
        self,
        simulation: Simulation,
        core: Any,
        results: Path,
        frames: list[FrameInfo],
        ranks: World,
        file: FramesWriter | None = None,
    ) -> None:
        case = simulation.case
        self._ranks = ranks
        self._writers = ranks.writers(case.output.files)
        self._simulation, self._fields, self._begun = simulation, fields_of(case), len(frames) > 0
        room = FRAME_SHARE * sum(core.bytes().values()) / len(self._writers)  # those of all ranks
        self._thread: FrameThread | None = None
        if ranks.rank in self._writers:
            file = file or FramesWriter(
                frames_folder(results),
                simulation.parts,
                simulation.materials,
                self._fields,
                case.output.compression,
                self._writers,
                self._writers.index(ranks.rank),
                frames,
            )
            self._thread = FrameThread(file, room)

    def hand_over(self, simulation: Any) -> None:
        """See `FrameThread`."""
        if self._thread is not None:
            self._thread.hand_over(simulation)
            return
        frame = frame_of(
            simulation,
            self._fields,
            self._simulation.parts,
            numbered(self._simulation.materials)[1],
            constants=not self._begun,
            writers=self._writers,
            part=None,
        )
        self._begun = True
        for column in frame.columns:  # Its particles go to those that write them.
            column.make()

    def look(self, again: bool) -> tuple[int, Exception | None]:
        """Return how many frames are whole, and what has gone wrong with one, the same to all."""
        written, error = self._thread.look(again) if self._thread else (_MANY, None)
        numbers = np.array([-written, error is not None])
        self._ranks.all_max(numbers)
        if numbers[1]:
            text = str(error) or type(error).__name__
            told = self._ranks.comm.allgather(text if error else None)
            error = CaseError(next(one for one in told if one is not None))
        return -int(numbers[0]), error

    def wait(self) -> None:
        """See `FrameThread`."""
        if self._thread is not None:
            self._thread.wait()

    def sums_of_others(self) -> list[list[int]]:
        """Return what `FramesWriter.finish` returns to the writers but the first."""

        def finish() -> list[int] | None:
            return self._thread.file.finish() if self._thread and self._ranks.rank else None

        return [sums for sums in together(finish, self._ranks) if sums is not None]

    def end(self) -> None:
        """See `FrameThread`."""
        if self._thread is not None:
            self._thread.end()


def fields_of(case: Case) -> list[str]:
    """Return the columns to write: those asked for; `failed` where particles may erode or leave.

    Without it a reader could not tell which particles are gone.
    """
    used = case.materials_used
    goes = any(f.action == "erode" for name in used for f in case.material[name].failure)
    goes = goes or case.grid.outflow_box is not None
    return list(dict.fromkeys([*case.output.fields, *(["failed"] if goes else [])]))
