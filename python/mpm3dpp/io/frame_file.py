# SPDX-License-Identifier: BSD-3-Clause
"""One frame in a file of its own, which is written in one step and never changed after.

The HDF5 file has the group `arrays` with a data set per array, one row per particle, `cells` with
what VTK wants to know of a vertex per particle where no earlier frame has the same parts, and an
attribute `frame`: JSON with time, step and count of particles, the check sum of each array, and the
frames that hold those arrays which have not changed. Of several processes each writes a part of the
frame, a slice of its particles, in such a file: `000012.h5`, `000012.1.h5`, ...
"""

from __future__ import annotations

import contextlib
import json
import re
import zlib
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from pydantic import FiniteFloat, TypeAdapter

from mpm3dpp.base.disk import writing
from mpm3dpp.base.errors import CaseError

from .forms import Count
from .frame_tables import Table, columns_of, write_tables
from .new_h5 import new_h5
from .open_h5 import open_h5, own

if TYPE_CHECKING:
    import h5py

CELLS = "cells"
"""Among the arrays that stand elsewhere: the cells."""

_NAME = re.compile(r"(\d{6,})(?:\.(\d+))?\.h5")
_CHUNK_BYTES = (1 << 32) - 1  # HDF5's limit


@dataclass
class FrameInfo:
    """What a frame's file holds.

    Attributes:
        time: [s].          step: number of steps made until then.          count: of particles.
        rows: particles in each part of the frame.
        checks: name -> CRC-32 of each array that the file has.
        elsewhere: name -> number of the frame whose file has it.
        kinds: name -> components (0 for one number a particle) and type, of those in the file.
        tables: name -> CRC-32, of the tables that the file has (`io/frame_tables.py`).
    """

    time: FiniteFloat
    step: Count
    count: Count
    rows: list[Count] = field(default_factory=list)
    checks: dict[str, Count] = field(default_factory=dict)
    elsewhere: dict[str, Count] = field(default_factory=dict)
    kinds: dict[str, tuple[int, str]] = field(default_factory=dict)
    tables: dict[str, Count] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.rows = self.rows or [self.count]

    def where(self, name: str, own: int) -> int:
        """Return the number of the frame whose file has an array; `own` is this one's."""
        return self.elsewhere.get(name, own)

    @property
    def names(self) -> list[str]:
        """Names of all arrays, in alphabetical order but for "position", which comes first."""
        names = (self.checks.keys() | self.elsewhere.keys()) - {CELLS, "position"}
        return ["position", *sorted(names)]


def frames_folder(results: Path) -> Path:
    """Return the folder with the frames of a results file: `results.frames`."""
    return results.with_suffix(".frames")


def frame_path(folder: Path, frame: int, part: int = 0) -> Path:
    """Return the file of a frame, or of a part of it."""
    return folder / (f"{frame:06d}.{part}.h5" if part else f"{frame:06d}.h5")


def frame_numbers(folder: Path) -> list[int]:
    """Return the numbers of the frames that have files in a folder, in order."""
    return sorted({frame for frame, _ in _files(folder)})


def remove_frames(folder: Path, first: int) -> None:
    """Remove the frames from number `first` on. Raises `CaseError` if one cannot be removed."""
    # The last first, so that none is left without those it needs.
    for frame, part in sorted(_files(folder), key=lambda file: (-file[0], file[1])):
        if frame >= first:
            old = frame_path(folder, frame, part)
            with writing(old):
                old.unlink(missing_ok=True)


def is_whole(folder: Path, frame: int, info: FrameInfo) -> bool:
    """Return whether all parts of a frame have files."""
    return all(frame_path(folder, frame, part).is_file() for part in range(len(info.rows)))


def _files(folder: Path) -> list[tuple[int, int]]:
    """Return frame and part of each file in a folder."""
    with contextlib.suppress(OSError):
        found = (_NAME.fullmatch(path.name) for path in folder.iterdir())
        return [(int(match[1]), int(match[2] or 0)) for match in found if match]
    return []


def write_frame(
    path: Path,
    info: FrameInfo,
    part: int,
    arrays: Iterable[tuple[str, np.ndarray]],
    level: int,
    tables: Mapping[str, Table],
) -> None:
    """Write the file of a frame, or of a part of it.

    Args:
        path: the file.
        info: of which `checks`, `kinds` and `tables` are filled here.
        part: number of the part.
        arrays: (name, array as stored) of those that do not stand elsewhere, each asked for when
            the one before is in the file.
        level: of compression: 0 for none, else gzip's, 1 to 9, after a shuffle of bytes.
        tables: of the frame; the first part has them.

    Raises:
        CaseError: the file cannot be written; there is none then.
    """
    with new_h5(path) as file:
        group = file.create_group("arrays")
        for name, column in arrays:
            info.checks[name] = zlib.crc32(column.data)
            info.kinds[name] = _kind(column)
            rows = max(1, min(len(column), _CHUNK_BYTES // max(1, column[:1].nbytes)))
            how = {"compression": "gzip", "compression_opts": level, "shuffle": True}
            chunks = {"chunks": (rows, *column.shape[1:]), **how} if level and len(column) else {}
            group.create_dataset(name, data=column, **chunks)
        if CELLS not in info.elsewhere:
            cells = file.create_group(CELLS)
            first, last = sum(info.rows[:part]), sum(info.rows[: part + 1])
            # There is one offset more than there are cells: the first part has the first.
            cells["Offsets"] = np.arange(first + (part > 0), last + 1, dtype=np.int64)
            cells["Connectivity"] = np.arange(first, last, dtype=np.int64)
        if part == 0 and tables:
            info.tables = write_tables(file, tables)
        about: dict[str, Any] = {"time": info.time, "step": info.step, "count": info.count}
        about |= {"checks": info.checks, "elsewhere": info.elsewhere, "rows": info.rows}
        about |= {"tables": info.tables} if info.tables else {}
        file.attrs["frame"] = json.dumps(about, sort_keys=True)


def read_info(path: Path) -> FrameInfo:
    """Return what the file of a frame holds. Raises `CaseError` if it is missing or damaged."""
    with _frame(path) as file:
        info = _info(file)
        for name in info.checks:
            info.kinds[name] = _kind(file["arrays"][name])
        return info


def read_arrays(
    folder: Path, frame: int, names: Collection[str] | None = None
) -> dict[str, np.ndarray]:
    """Return arrays of a frame, as stored. Raises `CaseError` if a file is missing or damaged.

    Args:
        folder: with the frames.
        frame: number.
        names: of the arrays; those that there are not are left out. All if None.
    """
    info = read_info(frame_path(folder, frame))
    wanted = [name for name in info.names if names is None or name in names]
    found: dict[str, np.ndarray] = {}
    for k in {info.where(name, frame) for name in wanted}:
        here = [name for name in wanted if info.where(name, frame) == k]
        parts = [_read_part(folder, k, 0, here)]
        parts += [_read_part(folder, k, part, here) for part in range(1, len(parts[0][0].rows))]
        for name in here:
            of_parts = [columns.pop(name) for _, columns in parts]
            found[name] = np.concatenate(of_parts) if len(of_parts) > 1 else of_parts[0]
            if len(found[name]) != info.count:
                raise damaged(frame_path(folder, frame))
    return {name: found[name] for name in wanted}


def read_table(path: Path, name: str) -> dict[str, np.ndarray]:
    """Return a table of a frame, columns by name.

    Raises:
        CaseError: the file has no such table, or is missing or damaged.
    """
    with _frame(path) as file:
        checks = _info(file).tables.get(name)
        if checks is not None:
            return columns_of(file, name, checks)
    raise CaseError(f"'{path}' has no table of {name}")


def _read_part(
    folder: Path, frame: int, part: int, names: Collection[str]
) -> tuple[FrameInfo, dict[str, np.ndarray]]:
    """Return what the file of a part tells of its frame, and arrays that it has, as stored."""
    with _frame(frame_path(folder, frame, part)) as file:
        info, columns = _info(file), {}
        for name in names:
            columns[name] = column = own(file["arrays"][name], info.rows[part])[()]
            if zlib.crc32(column.data) != info.checks[name]:
                raise ValueError(name)
        return info, columns


@contextlib.contextmanager
def _frame(path: Path) -> Iterator[h5py.File]:
    """Give the file of a frame to read; what goes wrong in the block is one sentence."""
    try:
        with open_h5(path) as file:
            yield file
    except FileNotFoundError as error:
        rule = f"frame {_number(path)} is missing: there is no file '{path}'"
        raise CaseError(rule, "bring it back, or use other frames") from error
    except PermissionError as error:
        raise CaseError(f"cannot read '{path}': permission denied", "make it readable") from error
    except CaseError as error:
        rule = f"frame {_number(path)}: '{path}' {error.rule}"
        raise CaseError(rule, "bring it back, or use other frames") from error
    except (OSError, LookupError, TypeError, ValueError, RuntimeError, AttributeError) as error:
        raise damaged(path) from error


def damaged(path: Path, frame: int | None = None) -> CaseError:
    """Return the mistake that the file of a frame is not as it was written."""
    number = _number(path) if frame is None else frame
    rule = f"frame {number} is damaged: '{path}' cannot be read as it was written"
    return CaseError(rule, "bring it back, or use other frames")


def _number(path: Path) -> str:
    return path.stem.partition(".")[0].lstrip("0") or "0"


def _info(file: h5py.File) -> FrameInfo:
    info = _form().validate_json(file.attrs["frame"], strict=True)
    if sum(info.rows) != info.count:
        raise ValueError("other particles")
    return info


@cache
def _form() -> TypeAdapter[FrameInfo]:
    return TypeAdapter(FrameInfo)


def _kind(column: Any) -> tuple[int, str]:
    return (column.shape[1] if len(column.shape) == 2 else 0), np.dtype(column.dtype).str
