# SPDX-License-Identifier: BSD-3-Clause
"""Writer of `results.vtkhdf`: one growing file with every frame, for ParaView and PyVista.

Format: VTKHDF 2.0 (VTK file formats, "VTKHDF"), temporal PolyData, one vertex per particle,
float32 in chunks, compressed if asked for. Arrays that do not change (cells, body, grain, material,
size) are stored once and referred to by every frame. A frame counts only after all its bytes are in
the file: the number of frames is raised last, so that a killed run leaves every finished frame
readable.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.errors import CaseError
from mpm3dpp.io.disk import bring_to_disk, cannot_write, make_folder, reserve
from mpm3dpp.io.fields import Column, Frame, column_units, frame_of, numbered
from mpm3dpp.io.rows import append_rows, as_stored, cut_rows, hold_metadata, make_rows, row_counts

if TYPE_CHECKING:
    import h5py

RESULTS = "results.vtkhdf"

_TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")
_CONSTANT = ("body", "grain", "material", "size")
_SLACK = 1 << 20  # bytes reserved beyond the arrays of a frame: indices and chunk tables


class ResultsWriter:
    """Appends frames to one temporal VTKHDF file.

    Six-component arrays are given in the order xx yy zz yz xz xy and stored in VTK's order
    xx yy zz xy yz xz, because ParaView names the components by their place.

    Args:
        path: the file, usually `results.vtkhdf`; its folder is made, an old file replaced.
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
        rows: of a run that goes on, `rows()` then; the file has them (`rows.has_rows`), and frames
            written later are cut off.

    Raises:
        CaseError: the file cannot be written; what it held before stays readable.
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
        rows: Mapping[str, int] | None = None,
    ) -> None:
        import h5py

        self.path = Path(path)
        self.frames = 0
        self._fields = tuple(fields)
        self._level = compression
        self._bodies = list(bodies)
        names, self._materials = numbered(materials)
        self._dimension = dimension
        self._constant: dict[str, tuple[bytes, int]] = {}  # digest of the bytes, first row
        self._knows_constants = False
        self._parts: list[tuple[int, int, int]] = []  # particles, first cell, first index
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
        try:
            # An old superblock has no "open for writing" mark, which a killed run would leave
            # behind; without locks ParaView can look at a run while it goes on.
            mode = "w" if rows is None else "r+"
            self._file: h5py.File | None = h5py.File(
                self.path, mode, libver=("earliest", "v108"), locking=False
            )
            hold_metadata(self._file)
            if rows is None:
                self._lay_out(self._file)
            else:
                self._go_on(self._file["VTKHDF"], rows)
            self._file.flush()
        except (OSError, RuntimeError) as error:
            raise cannot_write(self.path, error) from error

    def rows(self) -> dict[str, int]:
        """Return what a writer needs to go on from here; what it needs is on the disk then."""
        if self._file is None:
            return {}
        bring_to_disk(self.path)
        return row_counts(self._file["VTKHDF"])

    def write(self, simulation: Any) -> None:
        """Append the present state of the core's `Simulation` as a frame."""
        self.add(self.frame_of(simulation))

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
            CaseError: no room on the disk; the frames written before stay readable.
        """
        stored = [as_stored(array) for array in arrays.values()]
        columns = [Column(n, a.nbytes, lambda a=a: a) for n, a in zip(arrays, stored, strict=True)]
        columns.sort(key=lambda column: column.name != "position")
        self.add(Frame(time, step, len(stored[0]), sum(a.nbytes for a in stored), columns))

    def add(self, frame: Frame) -> None:
        """Append a frame; each of its columns is asked for when the one before is in the file.

        A column that does not change may be left out of later frames. Raises what `append` raises,
        and what the columns raise; the file is closed then, and keeps the frames before.
        """
        if self._file is None:
            raise CaseError(f"'{self.path}' is closed: no frame can be added to it any more")
        try:
            reserve(self.path, self._file.id.get_filesize() + frame.bytes + _SLACK)
        except OSError as error:
            raise cannot_write(self.path, error) from error  # nothing was touched
        try:
            self._append(self._file["VTKHDF"], frame)
            self._file.flush()
            # only now does the frame exist for a reader
            self._file["VTKHDF/Steps"].attrs.modify("NSteps", np.int64(self.frames + 1))
            self._file.flush()
        except BaseException as error:
            with contextlib.suppress(CaseError):
                self.close()
            if isinstance(error, (OSError, RuntimeError)):
                raise cannot_write(self.path, error) from error
            raise
        self.frames += 1

    def close(self) -> None:
        """Close the file; it keeps all frames. Closing twice does nothing."""
        file, self._file = self._file, None
        if file is not None:
            try:
                file.flush()
                size = file.id.get_filesize()
                file.close()
                os.truncate(self.path, size)  # gives back what was reserved and not used
            except (OSError, RuntimeError) as error:
                raise cannot_write(self.path, error) from error

    def __enter__(self) -> ResultsWriter:
        return self

    def __exit__(self, *about: object) -> None:
        self.close()

    def _lay_out(self, file: h5py.File) -> None:
        """The groups and the index arrays of the format, without any frame."""
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        root.attrs.create("Type", np.bytes_("PolyData"))
        make_rows(root, "NumberOfPoints", (), np.int64, 256)
        for name in _TOPOLOGIES:
            group = root.create_group(name)
            for index in ("NumberOfCells", "NumberOfConnectivityIds"):
                make_rows(group, index, (), np.int64, 256)
        for name in ("PointData", "CellData", "FieldData"):
            root.create_group(name)
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = np.int64(0)
        make_rows(steps, "Values", (), np.float64, 256)
        for name in ("PartOffsets", "NumberOfParts", "PointOffsets"):
            make_rows(steps, name, (), np.int64, 256)
        for name in ("CellOffsets", "ConnectivityIdOffsets"):
            make_rows(steps, name, (len(_TOPOLOGIES),), np.int64, 64)
        for name in ("PointDataOffsets", "CellDataOffsets", "FieldDataOffsets"):
            steps.create_group(name)
        file.create_group("mpm3dpp").attrs["run"] = json.dumps(self._meta)

    def _go_on(self, root: h5py.Group, rows: Mapping[str, int]) -> None:
        """Cut off the frames that came later, and learn what stands in the file already."""
        steps = root["Steps"]
        self.frames = rows["Steps/Values"]
        steps.attrs.modify("NSteps", np.int64(self.frames))
        root.file.flush()  # From here on no reader looks at what is cut off.
        cut_rows(root, rows)
        cell = 0
        for particles in root["NumberOfPoints"][:].tolist():
            self._parts.append((particles, cell, cell))
            cell += particles
        count = int(self._parts[int(steps["PartOffsets"][-1])][0])
        for name in _CONSTANT:
            if name in root["PointData"]:
                offset = int(steps["PointDataOffsets"][name][-1])
                column = root["PointData"][name][offset : offset + count]
                self._constant[name] = (_digest(column), offset)
        self._knows_constants = "size" in self._constant
        stored = json.loads(root.file["mpm3dpp"].attrs["run"])
        self._meta["units"] = stored["units"]
        root.file["mpm3dpp"].attrs["run"] = json.dumps(self._meta)

    def _append(self, root: h5py.Group, frame: Frame) -> None:
        if self.frames == 0:
            root.file["mpm3dpp"].attrs["run"] = json.dumps(self._meta)
        steps = root["Steps"]
        part, cell, index = self._part(root, frame.particles)
        columns = iter(frame.columns)
        first = append_rows(root, "Points", next(columns).make(), self._level)
        for name, values in (
            ("PartOffsets", part),
            ("NumberOfParts", 1),
            ("PointOffsets", first),
            ("CellOffsets", [cell, 0, 0, 0]),
            ("ConnectivityIdOffsets", [index, 0, 0, 0]),
        ):
            append_rows(steps, name, np.array([values], dtype=np.int64))
        offsets = {name: offset for name, (_, offset) in self._constant.items()}
        for name, _, make in columns:
            offsets[name] = self._append_column(root["PointData"], name, make())
        for name, offset in offsets.items():
            append_rows(steps["PointDataOffsets"], name, np.array([offset], dtype=np.int64))
        row = append_rows(root["FieldData"], "step", np.array([frame.step], dtype=np.int64))
        append_rows(steps["FieldDataOffsets"], "step", np.array([row], dtype=np.int64))
        append_rows(steps, "Values", np.array([frame.time]))

    def _append_column(self, group: h5py.Group, name: str, column: np.ndarray) -> int:
        """Return the row where a column starts, which may be where the same values stand."""
        if name not in _CONSTANT:
            return append_rows(group, name, column, self._level)
        digest = _digest(column)
        if self._constant.get(name, (b"", 0))[0] != digest:
            self._constant[name] = digest, append_rows(group, name, column, self._level)
        return self._constant[name][1]

    def _part(self, root: h5py.Group, particles: int) -> tuple[int, int, int]:
        """The cells of a frame (one vertex a particle): an earlier set or a new one.

        Returns the number of the part and its first entries in Offsets and Connectivity.
        """
        for part, (count, cell, index) in enumerate(self._parts):
            if count == particles:
                return part, cell, index
        append_rows(root, "NumberOfPoints", np.array([particles], dtype=np.int64))
        cell = sum(count for count, _, _ in self._parts)
        for name in _TOPOLOGIES:
            cells = particles if name == "Vertices" else 0
            group = root[name]
            append_rows(group, "NumberOfCells", np.array([cells], dtype=np.int64))
            append_rows(group, "NumberOfConnectivityIds", np.array([cells], dtype=np.int64))
            append_rows(group, "Offsets", np.arange(cells + 1, dtype=np.int64))
            append_rows(group, "Connectivity", np.arange(cells, dtype=np.int64))
        self._parts.append((particles, cell, cell))
        return len(self._parts) - 1, cell, cell


def _digest(column: np.ndarray) -> bytes:
    """Return what tells one column from another, in place of the column."""
    return hashlib.blake2b(np.ascontiguousarray(column), digest_size=16).digest()
