# SPDX-License-Identifier: BSD-3-Clause
"""`results.vtkhdf`: what ParaView and PyVista open; it holds no frame, only where each one is.

Format: VTKHDF 2.0 (VTK file formats, "VTKHDF"), temporal PolyData, one vertex per particle. The
data sets are virtual ones (HDF5 1.10) that map to the files of the frames, with paths relative to
this file, so that the folder can be moved. What is missing there reads as NaN (integers: -1).
"""

from __future__ import annotations

import io
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp import _core
from mpm3dpp.base.disk import replacing

from .frame_file import CELLS, FrameInfo, frame_path, frames_folder
from .new_h5 import LIBVER

if TYPE_CHECKING:
    import h5py

_FEW = 64  # frames of which the memory is not worth while to be given back
_TOPOLOGIES = ("Vertices", "Lines", "Polygons", "Strips")


def write_master(path: Path, frames: Sequence[FrameInfo], meta: Mapping[str, Any]) -> None:
    """Write the file anew, in one step.

    Args:
        path: the file.
        frames: what the file of each frame holds; all have arrays of the same names.
        meta: of the run, as JSON takes it.

    Raises:
        CaseError: it cannot be written; the old one still stands.
    """
    import h5py

    folder = frames_folder(path)
    image = io.BytesIO()  # It is small, and HDF5 must not hear of an error of the disk.
    with h5py.File(image, "w", libver=LIBVER) as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([2, 0], dtype=np.int64)
        root.attrs.create("Type", np.bytes_("PolyData"))
        for name in ("PointData", "CellData", "FieldData"):
            root.create_group(name)
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = np.int64(len(frames))
        steps["Values"] = np.array([frame.time for frame in frames], dtype=float)
        for name in ("PointDataOffsets", "CellDataOffsets", "FieldDataOffsets"):
            steps.create_group(name)
        _place_field_data(root, steps, frames, meta)
        _place_cells(root, steps, folder, frames)
        about = {**meta, "frames": folder.name}
        file.create_group("mpm3dpp").attrs["run"] = json.dumps(about)
    # One by one: HDF5 holds some kilobytes for each frame and array until a file is closed.
    for name in frames[0].names if frames else ():
        with h5py.File(image, "r+", libver=LIBVER) as file:
            _place_array(file["VTKHDF"], folder, frames, name)
        if len(frames) > _FEW:
            _core.return_freed_memory()
    with replacing(path) as raw:
        raw.write(image.getbuffer())


def _place_array(root: h5py.Group, folder: Path, frames: Sequence[FrameInfo], name: str) -> None:
    """An array of particles, of all frames."""
    rows = [f.rows if name in f.checks else [] for f in frames]
    offsets = _firsts([*map(sum, rows)])[[f.where(name, k) for k, f in enumerate(frames)]]
    components, kind = next(f.kinds[name] for f in frames if name in f.kinds)
    tail = (components,) if components else ()
    group, place = (root, "Points") if name == "position" else (root["PointData"], name)
    _virtual(group, place, folder, f"arrays/{name}", rows, tail, np.dtype(kind))
    if name == "position":
        root["Steps"]["PointOffsets"] = offsets
    else:
        root["Steps"]["PointDataOffsets"][name] = offsets


def _place_field_data(
    root: h5py.Group, steps: h5py.Group, frames: Sequence[FrameInfo], meta: Mapping[str, Any]
) -> None:
    """The step of each frame, and the names of the bodies that the array `body` counts."""
    import h5py

    names = np.array([name.encode() for name in meta["bodies"]], dtype=object)
    root["FieldData"]["step"] = np.array([frame.step for frame in frames], dtype=np.int64)
    # VTK takes strings of any length, and those of ASCII only by their type.
    kind = h5py.string_dtype("ascii")
    root["FieldData"].create_dataset("body_names", data=names, dtype=kind)
    sizes = steps.create_group("FieldDataSizes")
    for name, first, count in (("step", 1, 1), ("body_names", 0, len(names))):
        steps["FieldDataOffsets"][name] = first * np.arange(len(frames))
        sizes[name] = np.array([[1, count]] * len(frames), dtype=np.int64).reshape(-1, 2)


def _place_cells(
    root: h5py.Group, steps: h5py.Group, folder: Path, frames: Sequence[FrameInfo]
) -> None:
    """The cells, one vertex a particle: for VTK a part for each way to share out particles."""
    own = [CELLS not in frame.elsewhere for frame in frames]
    counts = np.array([frame.count for frame in frames], dtype=np.int64)
    parts = counts[own]
    number = np.cumsum(own) - 1  # of a frame's part, where it has its own
    part = number[[frame.where(CELLS, k) for k, frame in enumerate(frames)]].astype(np.int64)
    root["NumberOfPoints"] = parts
    for name in _TOPOLOGIES:
        group = root.create_group(name)
        cells = parts if name == "Vertices" else np.zeros_like(parts)
        group["NumberOfCells"] = group["NumberOfConnectivityIds"] = cells
        if name != "Vertices":
            group["Offsets"] = np.zeros(len(parts), dtype=np.int64)
            group["Connectivity"] = np.zeros(0, dtype=np.int64)
    for name, more in (("Offsets", 1), ("Connectivity", 0)):
        rows = [
            [f.rows[0] + more, *f.rows[1:]] if mine else []
            for f, mine in zip(frames, own, strict=True)
        ]
        source = f"{CELLS}/{name}"
        _virtual(root["Vertices"], name, folder, source, rows, (), np.dtype(np.int64))
    first = np.zeros((len(frames), len(_TOPOLOGIES)), dtype=np.int64)
    first[:, 0] = _firsts(parts.tolist())[part] if len(parts) else 0
    steps["PartOffsets"] = part
    steps["NumberOfParts"] = np.ones(len(frames), dtype=np.int64)
    steps["CellOffsets"] = steps["ConnectivityIdOffsets"] = first


def _firsts(counts: Sequence[int]) -> np.ndarray:
    """Return the first row of each block, int64, shape (blocks,)."""
    return np.cumsum([0, *counts[:-1]], dtype=np.int64)[: len(counts)]


def _virtual(
    group: h5py.Group,
    name: str,
    folder: Path,
    source: str,
    rows: Sequence[Sequence[int]],
    tail: tuple[int, ...],
    kind: np.dtype[Any],
) -> None:
    """Make a data set whose rows stand in files, `rows[k][j]` in that of part j of frame k."""
    import h5py

    plan = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plan.set_fill_value(np.array(np.nan if kind.kind == "f" else -1, kind))
    blocks = [(k, j, n) for k, parts in enumerate(rows) for j, n in enumerate(parts) if n]
    whole = h5py.h5s.create_simple((sum(n for _, _, n in blocks), *tail))
    first = 0
    for frame, part, count in blocks:
        block = (count, *tail)
        whole.select_hyperslab((first, *(0 for _ in tail)), (1,) * len(block), block=block)
        file = frame_path(Path(folder.name), frame, part).as_posix()
        plan.set_virtual(whole, file.encode(), source.encode(), h5py.h5s.create_simple(block))
        first += count
    whole.select_all()
    if not blocks:  # HDF5 has no virtual data set without a source.
        group.create_dataset(name, (0, *tail), kind)
        return
    h5py.h5d.create(group.id, name.encode(), h5py.h5t.py_create(kind), whole, plan)
