# SPDX-License-Identifier: BSD-3-Clause
"""Writer of the results of a run, for ParaView and PyVista: frames, and where they are.

`results.frames` has the frames (`io/frames_writer.py`), and `results.vtkhdf` tells where they are
(`io/master.py`).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.disk import bring_folder_to_disk, checksum, make_folder, unfinished, writing
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.names import numbered

from .fields import Column, Frame, column_units
from .frame_file import frame_numbers, frame_path, frames_folder, read_info, remove_frames
from .frames_writer import FramesWriter
from .master import write_master
from .rows import as_stored

RESULTS = "results.vtkhdf"

_OFTEN = 32
"""`results.vtkhdf` is written anew when the frames since are a 32nd of those it tells of: then its
writing takes a time proportional to the number of frames, not to its square."""


class ResultsWriter(FramesWriter):
    """Writes frames, each in a file of its own, and the VTKHDF file that tells where they are.

    Six-component arrays are given in the order xx yy zz yz xz xy and stored in VTK's order
    xx yy zz xy yz xz, because ParaView names the components by their place.

    Args:
        path: the file, usually `results.vtkhdf`; its folder is made, old results are removed.
        bodies: name of each body; bodies of one name are the grains of one entry. The array
            `body` counts the names in this order, `grain` the bodies of a name from 0.
        materials: name of the material of each body.
        dimension: 2 or 3.
        cell_size: edge of a grid cell [m].
        origin: a corner of the grid [m].
        walls, box: of the case's box, the words of its faces x- x+ y- y+ z- z+ and its lower and
            upper corner [m]; nothing without one.
        fields: further columns of the core to store.
        compression: 0 for none, else the level of gzip, 1 to 9, after a shuffle of bytes.
        title: title of the case.
        case_hash: hash of the case, so that a file can be traced to its run.
        rows: of a run that goes on, `rows()` then; the frames are there (`check_frames`), and those
            written later are removed.
        writers: the ranks that write frames, each a slice of the particles, this one the first.

    Attributes:
        whole: of several writers, how many frames have been written by all: those that the file
            may tell of. Who asks the others sets it.

    Raises:
        CaseError: a file cannot be written; frames that were written stay readable.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        bodies: Sequence[str],
        materials: Sequence[str],
        dimension: int,
        cell_size: float,
        origin: Sequence[float] = (),
        walls: Sequence[str] = (),
        box: Sequence[Sequence[float]] = (),
        fields: Sequence[str] = (),
        compression: int = 0,
        title: str = "",
        case_hash: str = "",
        rows: Mapping[str, Any] | None = None,
        writers: Sequence[int] = (0,),
    ) -> None:
        self.path = Path(path)
        folder = frames_folder(self.path)
        self._kept: list[list[int]] = [*rows["frames"]] if rows else []
        self._told = 0  # frames that the file tells of
        self._is_closed = False
        self._meta: dict[str, Any] = {
            "title": title,
            "case_hash": case_hash,
            "bodies": numbered(bodies)[0],
            "materials": numbered(materials)[0],
            "dimension": dimension,
            "cell_size": float(cell_size),
            "origin": [*map(float, origin), 0.0, 0.0, 0.0][:3],
            "units": dict(rows["units"]) if rows else {},
            "walls": [*walls],
            "box": [[*map(float, corner)] for corner in box],
        }
        make_folder(self.path.parent)
        if rows is None:
            with writing(self.path):  # First, for nobody may take old frames for those of this run.
                self.path.unlink(missing_ok=True)
            remove_frames(folder, 0)
        make_folder(folder)
        infos = [read_info(frame_path(folder, k)) for k in range(len(self._kept))]
        super().__init__(folder, bodies, materials, fields, compression, writers, frames=infos)
        self.whole = self.frames
        self._tell()
        remove_frames(folder, self.frames)
        with writing(folder):
            for left in folder.glob(unfinished(Path("*.h5")).name):
                left.unlink(missing_ok=True)

    def rows(self, others: Sequence[Sequence[int]] = ()) -> dict[str, Any]:
        """Return what a writer needs to go on from here, for JSON; all of it is on the disk then.

        It is `frames`, the check sums of each frame's files, and `units`.

        Args:
            others: what `finish` has returned to the other writers.
        """
        self._tell_of_all()
        written = [list(parts) for parts in zip(self.finish(), *others, strict=True)]
        bring_folder_to_disk(self.path.parent)
        return {"frames": self._kept + written, "units": dict(self._meta["units"])}

    def frame_of(self, simulation: Any) -> Frame:
        """Return the present state of the core's `Simulation`, as `fields.frame_of`."""
        if not self._knows_constants:
            self._meta["units"] = column_units(simulation)
        return super().frame_of(simulation)

    def append(self, time: float, step: int, arrays: Mapping[str, np.ndarray]) -> None:
        """Append one frame.

        Args:
            time: time of the frame [s].
            step: number of steps made until then.
            arrays: name -> array with one row per particle, SI units; "position" (n, 3) is
                needed. Every frame must bring the same names as the first.

        Raises:
            CaseError: no room on the disk; the frames written before stay readable. Or an array
                that a frame cannot hold.
        """
        if "position" not in arrays:
            raise CaseError("a frame needs the array 'position'")
        stored = [as_stored(array) for array in arrays.values()]
        columns = [
            Column(name, array.nbytes, partial(np.asarray, array))
            for name, array in zip(arrays, stored, strict=True)
        ]
        columns.sort(key=lambda column: column.name != "position")
        self.add(Frame(time, step, [len(arrays["position"])], columns))

    def add(self, frame: Frame) -> None:
        """Append a frame, as `FramesWriter.add`; the file tells of it now or later."""
        if self._is_closed:
            raise self.closed()
        super().add(frame)
        if _OFTEN * (self._whole() - self._told) >= self._told:
            self._tell()

    def closed(self) -> CaseError:
        """Return the mistake of a frame that comes after the end."""
        return CaseError(f"'{self.path}' is closed: no frame can be added to it any more")

    def close(self) -> None:
        """Let the file tell of all frames. Closing twice does nothing."""
        if not self._is_closed:
            self._is_closed = True
            self._tell_of_all()

    def __enter__(self) -> ResultsWriter:
        return self

    def __exit__(self, *about: object) -> None:
        self.close()

    def _tell(self) -> None:
        """Write the VTKHDF file anew."""
        told = self._whole()
        write_master(self.path, self._frames[:told], self._meta)
        self._told = told

    def _tell_of_all(self) -> None:
        if self._told < self._whole():
            self._tell()

    def _whole(self) -> int:
        return self.whole if len(self._writers) > 1 else self.frames


def has_no_results(path: Path) -> bool:
    """Return whether neither a results file nor any frame of it is there."""
    return not path.exists() and not frame_numbers(frames_folder(path))


def check_frames(path: Path, rows: Mapping[str, Any]) -> None:
    """Raise `CaseError` if a frame is missing or not as it was written, and say which.

    Args:
        path: the results file.
        rows: `ResultsWriter.rows` then.
    """
    folder = frames_folder(path)
    for frame, checks in enumerate(rows["frames"]):
        for part, check in enumerate(checks):
            file = frame_path(folder, frame, part)
            try:
                now = checksum(file)
            except FileNotFoundError:
                raise CaseError(f"frame {frame} is missing: there is no file '{file}'") from None
            except OSError as error:
                raise CaseError(f"frame {frame}: cannot read '{file}': {error.strerror}") from error
            if now != check:
                raise CaseError(f"frame {frame} is damaged: '{file}' is not as it was written")
