# SPDX-License-Identifier: BSD-3-Clause
"""Writer of the frames of a run, for ParaView and PyVista.

Each frame is a file of its own in `results.frames` (`io/frame_file.py`), and `results.vtkhdf` tells
where they are (`io/master.py`). Every file is written beside its place, brought to the disk and
renamed, so that a run that is killed or meets a full disk leaves whole frames, and a frame that
was written is never touched again. Arrays that do not change (cells, body, grain, material, size)
stand in the first frame's file only.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.disk import bring_folder_to_disk, checksum, make_folder, unfinished, writing
from mpm3dpp.base.errors import CaseError

from .fields import Column, Frame, column_units, frame_of, numbered
from .frame_file import (
    CELLS,
    FrameInfo,
    frame_numbers,
    frame_path,
    frames_folder,
    read_arrays,
    read_info,
    remove_frames,
    write_frame,
)
from .master import write_master
from .rows import as_stored

RESULTS = "results.vtkhdf"

_CONSTANT = ("body", "grain", "material", "size")
_OFTEN = 32
"""`results.vtkhdf` is written anew when the frames since are a 32nd of those it tells of: then its
writing takes a time proportional to the number of frames, not to its square."""


class ResultsWriter:
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
        fields: further columns of the core to store.
        compression: 0 for none, else the level of gzip, 1 to 9, after a shuffle of bytes.
        title: title of the case.
        case_hash: hash of the case, so that a file can be traced to its run.
        rows: of a run that goes on, `rows()` then; the frames are there (`check_frames`), and those
            written later are removed.

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
        fields: Sequence[str] = (),
        compression: int = 0,
        title: str = "",
        case_hash: str = "",
        rows: Mapping[str, Any] | None = None,
    ) -> None:
        self.path = Path(path)
        self._folder = frames_folder(self.path)
        self._fields = tuple(fields)
        self._level = compression
        self._bodies = list(bodies)
        names, self._materials = numbered(materials)
        self._frames: list[FrameInfo] = []
        self._checks: list[int] = []  # of the frames' files
        self._told = 0  # frames that the file tells of
        self._closed = False
        self._constant: dict[str, tuple[bytes, int]] = {}  # digest, and the frame that has it
        self._cells: dict[int, int] = {}  # count of particles -> frame that has their cells
        self._knows_constants = False
        self._meta: dict[str, Any] = {
            "title": title,
            "case_hash": case_hash,
            "bodies": numbered(bodies)[0],
            "materials": names,
            "dimension": dimension,
            "cell_size": float(cell_size),
            "origin": [*map(float, origin), 0.0, 0.0, 0.0][:3],
            "units": {},
        }
        make_folder(self.path.parent)
        if rows is None:
            with writing(self.path):  # First, for nobody may take old frames for those of this run.
                self.path.unlink(missing_ok=True)
            remove_frames(self._folder, 0)
        else:
            self._go_on(rows)
        make_folder(self._folder)
        self._tell()
        remove_frames(self._folder, self.frames)
        with writing(self._folder):
            for left in self._folder.glob(unfinished(Path("*.h5")).name):
                left.unlink(missing_ok=True)

    @property
    def frames(self) -> int:
        """How many frames there are."""
        return len(self._frames)

    def rows(self) -> dict[str, Any]:
        """Return what a writer needs to go on from here, for JSON; all of it is on the disk then.

        It is `frames`, the check sum of each frame's file, and `units`.
        """
        self._tell_of_all()
        bring_folder_to_disk(self._folder)
        bring_folder_to_disk(self.path.parent)
        return {"frames": list(self._checks), "units": dict(self._meta["units"])}

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
        if not self._knows_constants:
            self._meta["units"] = column_units(simulation)
        new, self._knows_constants = not self._knows_constants, True
        return frame_of(simulation, self._fields, self._bodies, self._materials, constants=new)

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
        self.add(Frame(time, step, len(arrays["position"]), columns))

    def add(self, frame: Frame) -> None:
        """Append a frame; each of its columns is asked for when the one before is in the file.

        A column that does not change may be left out of later frames. Raises what `append` raises,
        and what the columns raise; the frames written before stay.
        """
        if self._closed:
            raise self.closed()
        number = self.frames
        info = FrameInfo(float(frame.time), int(frame.step), frame.particles)
        info.elsewhere = {name: where for name, (_, where) in self._constant.items()}
        if info.count in self._cells:
            info.elsewhere[CELLS] = self._cells[info.count]
        new: dict[str, bytes] = {}
        path = frame_path(self._folder, number)
        write_frame(path, info, self._own(frame.columns, info, new), self._level)
        with writing(path):
            check = checksum(path)
        assert check is not None  # for no size was given
        self._frames.append(info)
        self._checks.append(check)
        self._constant |= {name: (digest, number) for name, digest in new.items()}
        self._cells.setdefault(info.count, number)
        if _OFTEN * (self.frames - self._told) >= self._told:
            self._tell()

    def _own(
        self, columns: Iterable[Column], info: FrameInfo, new: dict[str, bytes]
    ) -> Iterator[tuple[str, np.ndarray]]:
        """Give the arrays that a frame's file has to hold, and note where the others are.

        Args:
            columns: of the frame.
            info: of the frame.
            new: gets the digests of those that seldom change.
        """
        for name, _, make in columns:
            column = make()
            if name in _CONSTANT:
                digest = _digest(column)
                if digest == self._constant.get(name, (b"", 0))[0]:
                    continue
                new[name] = digest
            if len(column) != info.count:
                rule = f"'{name}' has {len(column):,} rows, and 'position' has {info.count:,}"
                raise CaseError(f"a frame of '{self.path}': {rule}")
            info.elsewhere.pop(name, None)
            yield name, column
        if self._frames and self._frames[0].names != info.names:
            raise CaseError(f"a frame of '{self.path}' must have the arrays of the first one")

    def closed(self) -> CaseError:
        """Return the mistake of a frame that comes after the end."""
        return CaseError(f"'{self.path}' is closed: no frame can be added to it any more")

    def close(self) -> None:
        """Let the file tell of all frames. Closing twice does nothing."""
        if not self._closed:
            self._closed = True
            self._tell_of_all()

    def __enter__(self) -> ResultsWriter:
        return self

    def __exit__(self, *about: object) -> None:
        self.close()

    def _tell(self) -> None:
        """Write the VTKHDF file anew."""
        write_master(self.path, self._frames, self._meta)
        self._told = self.frames

    def _tell_of_all(self) -> None:
        if self._told < self.frames:
            self._tell()

    def _go_on(self, rows: Mapping[str, Any]) -> None:
        """Learn what the frames hold that are kept."""
        self._checks = list(rows["frames"])
        self._meta["units"] = dict(rows["units"])
        self._frames = [read_info(frame_path(self._folder, k)) for k in range(len(self._checks))]
        for k, info in enumerate(self._frames):
            if CELLS not in info.elsewhere:
                self._cells[info.count] = k
        if not self._frames:
            return
        last = self.frames - 1
        for name, column in read_arrays(self._folder, last, _CONSTANT).items():
            self._constant[name] = _digest(column), self._frames[last].where(name, last)
        self._knows_constants = "size" in self._constant


def has_no_results(path: Path) -> bool:
    """Return whether neither a results file nor any frame of it is there."""
    return not path.exists() and not frame_numbers(frames_folder(path))


def check_frames(path: Path, rows: Mapping[str, Any]) -> None:
    """Raise `CaseError` if a frame is missing or not as it was written, and say which.

    Args:
        path: the results file.
        rows: `ResultsWriter.rows` then.
    """
    for frame, check in enumerate(rows["frames"]):
        file = frame_path(frames_folder(path), frame)
        try:
            now = checksum(file)
        except FileNotFoundError:
            raise CaseError(f"frame {frame} is missing: there is no file '{file}'") from None
        except OSError as error:
            raise CaseError(f"frame {frame}: cannot read '{file}': {error.strerror}") from error
        if now != check:
            raise CaseError(f"frame {frame} is damaged: '{file}' is not as it was written")


def _digest(column: np.ndarray) -> bytes:
    """Return what tells one column from another, in place of the column."""
    return hashlib.blake2b(np.ascontiguousarray(column).data, digest_size=16).digest()
