# SPDX-License-Identifier: BSD-3-Clause
"""Writer of the frames of a run, or of a slice of the particles of each.

Each frame is a file of its own (`io/frame_file.py`). Every file is written beside its place,
brought to the disk and renamed, so that a run that is killed or meets a full disk leaves whole
frames, and a frame that was written is never touched again. Arrays that do not change (body, grain,
material, size) stand in the first frame's file only, cells in the first with the same parts.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.disk import bring_folder_to_disk, checksum, writing
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.names import numbered
from mpm3dpp.base.outputs import CONSTANT, NUMBERS

from .fields import Column, Frame, frame_of
from .frame_file import CELLS, FrameInfo, frame_path, read_arrays, write_frame

_CONSTANT = (*NUMBERS, *CONSTANT)


class FramesWriter:
    """Writes frames, each in a file of its own, or a part of each.

    Args:
        folder: of the frames; it is there.
        bodies, materials, fields, compression: as those of `ResultsWriter`.
        writers: the ranks that write frames, each a slice of the particles.
        part: which of them this is.
        frames: those that there are already.
    """

    def __init__(
        self,
        folder: Path,
        bodies: Sequence[str],
        materials: Sequence[str],
        fields: Sequence[str],
        compression: int,
        writers: Sequence[int] = (0,),
        part: int = 0,
        frames: Sequence[FrameInfo] = (),
    ) -> None:
        self._folder = folder
        self._bodies, self._materials = list(bodies), numbered(materials)[1]
        self._fields, self._level = tuple(fields), compression
        self._writers, self._part = tuple(writers), part
        self._frames = list(frames)
        self._checks: list[int] = []  # of the files that were written here
        # What seldom changes: the digest, unless a run before had it, and the frame that has it.
        self._constant: dict[str, tuple[bytes | None, int]] = {}
        self._cells: dict[tuple[int, ...], int] = {}  # rows of parts -> frame that has their cells
        for k, info in enumerate(self._frames):
            if CELLS not in info.elsewhere:
                self._cells[tuple(info.rows)] = k
            self._constant |= {name: (None, k) for name in _CONSTANT if name in info.checks}
        self._knows_constants = "size" in self._constant

    @property
    def frames(self) -> int:
        """How many frames there are."""
        return len(self._frames)

    @property
    def infos(self) -> list[FrameInfo]:
        """What their files hold."""
        return list(self._frames)

    def closed(self) -> CaseError:
        """Return the mistake of a frame that comes after the end."""
        return CaseError(f"'{self._folder}' is closed: no frame can be added to it any more")

    def finish(self) -> list[int]:
        """Return the check sums of the files that were written here; all are on the disk then."""
        bring_folder_to_disk(self._folder)
        return list(self._checks)

    def write(self, simulation: Any) -> None:
        """Append the present state of the core's `Simulation` as a frame."""
        try:
            self.add(self.frame_of(simulation))
        except BaseException:
            self._knows_constants = "size" in self._constant
            raise

    def frame_of(self, simulation: Any) -> Frame:
        """Return the present state of the core's `Simulation`, as `fields.frame_of`.

        What does not change is in the first frame alone.
        """
        new, self._knows_constants = not self._knows_constants, True
        return frame_of(
            simulation,
            self._fields,
            self._bodies,
            self._materials,
            constants=new,
            writers=self._writers,
            part=self._part,
        )

    def add(self, frame: Frame) -> None:
        """Append a frame; each of its columns is asked for when the one before is in the file.

        A column that does not change may be left out of later frames. The frames written before
        stay whatever happens.

        Raises:
            CaseError: no room on the disk, or columns that do not fit each other. And what the
                columns raise.
        """
        number = self.frames
        info = FrameInfo(float(frame.time), int(frame.step), sum(frame.rows), list(frame.rows))
        info.elsewhere = {name: where for name, (_, where) in self._constant.items()}
        if tuple(info.rows) in self._cells:
            info.elsewhere[CELLS] = self._cells[tuple(info.rows)]
        new: dict[str, bytes] = {}
        path = frame_path(self._folder, number, self._part)
        arrays = self._own(frame.columns, info, new)
        write_frame(path, info, self._part, arrays, self._level, frame.tables)
        with writing(path):
            check = checksum(path)
        assert check is not None  # for no size was given
        self._frames.append(info)
        self._checks.append(check)
        self._constant |= {name: (digest, number) for name, digest in new.items()}
        self._cells.setdefault(tuple(info.rows), number)

    def _own(
        self, columns: Iterable[Column], info: FrameInfo, new: dict[str, bytes]
    ) -> Iterator[tuple[str, np.ndarray]]:
        """Give the arrays that a frame's file has to hold, and note where the others are.

        Args:
            columns: of the frame.
            info: of the frame.
            new: gets the digests of those that seldom change.
        """
        rows = info.rows[self._part]
        for name, _, make in columns:
            column = make()
            if name in _CONSTANT:
                digest = _digest(column)
                if digest == self._last(name):
                    continue
                new[name] = digest
            if len(column) != rows:
                rule = f"'{name}' has {len(column):,} rows, and 'position' has {rows:,}"
                raise CaseError(f"a frame in '{self._folder}': {rule}")
            info.elsewhere.pop(name, None)
            yield name, column
        if self._frames and self._frames[0].names != info.names:
            raise CaseError(f"a frame in '{self._folder}' must have the arrays of the first one")

    def _last(self, name: str) -> bytes | None:
        """Return the digest of a column that seldom changes, as it was last; None if it is new."""
        digest, frame = self._constant.get(name, (None, -1))
        if digest is None and frame >= 0 and len(self._writers) == 1:
            digest = _digest(read_arrays(self._folder, frame, [name])[name])
            self._constant[name] = digest, frame
        return digest


def _digest(column: np.ndarray) -> bytes:
    """Return what tells one column from another, in place of the column."""
    return hashlib.blake2b(np.ascontiguousarray(column).data, digest_size=16).digest()
