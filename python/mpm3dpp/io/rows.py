# SPDX-License-Identifier: BSD-3-Clause
"""Data sets of an HDF5 file that grow by rows, frame by frame."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import h5py

TO_VTK = (0, 1, 2, 5, 3, 4)
"""Order of VTK's symmetric tensors (xx yy zz xy yz xz) taken from ours (xx yy zz yz xz xy)."""

_CHUNK_ROWS = 131072


def as_stored(array: np.ndarray) -> np.ndarray:
    """Return as stored: float32 (integers int32), two components as three, tensors in VTK order."""
    array = np.asarray(array)
    if array.ndim == 2 and array.shape[1] == 6:
        array = array[:, TO_VTK]
    if array.ndim == 2 and array.shape[1] == 2:
        array = np.column_stack([array, np.zeros(len(array))])
    kind = np.int32 if np.issubdtype(array.dtype, np.integer) else np.float32
    with np.errstate(over="ignore"):  # beyond float32 means a run that blew up: stored as inf
        return np.ascontiguousarray(array, dtype=kind)


def make_rows(
    group: h5py.Group, name: str, shape: tuple[int, ...], kind: Any, rows: int, level: int = 0
) -> Any:
    """Return an empty data set that grows along its first axis, in chunks of `rows` rows."""
    how = {"compression": "gzip", "compression_opts": level, "shuffle": True} if level else {}
    whole, chunks = (None, *shape), (max(rows, 1), *shape)
    return group.create_dataset(name, (0, *shape), maxshape=whole, chunks=chunks, dtype=kind, **how)


def append_rows(group: h5py.Group, name: str, values: np.ndarray, level: int = 0) -> int:
    """Append rows to a data set, made at the first call, and return the row where they start.

    Args:
        group: of the data set.
        name: of the data set in it.
        values: the rows, shape (n, ...).
        level: of compression, for the call that makes it: 0 for none, else gzip's, 1 to 9.
    """
    if name not in group:
        if level and len(values) > 1:
            # One chunk a frame, as long as the number of particles stays: a chunk of two would be
            # written again elsewhere with the second, and a killed run could lose the first. HDF5
            # allows 4 GiB.
            rows = min(len(values), ((1 << 32) - 1) // (values.nbytes // len(values)))
        else:
            level, chunks = 0, max(1, -(-len(values) // _CHUNK_ROWS))
            rows = -(-len(values) // chunks) if len(values) > 1 else 256
        make_rows(group, name, values.shape[1:], values.dtype, rows, level)
    data = group[name]
    first = int(data.shape[0])
    data.resize(first + len(values), axis=0)
    data[first:] = values
    return first


def row_counts(group: h5py.Group) -> dict[str, int]:
    """Return how many rows each data set that grows has, by its path below the group."""
    found: dict[str, int] = {}

    def note(name: str, item: Any) -> None:
        if getattr(item, "maxshape", None):
            found[name] = int(item.shape[0])

    group.visititems(note)
    return found


def has_rows(path: Path, group: str, counts: Mapping[str, int]) -> bool:
    """Return whether a file can be opened and its group has at least the rows of `row_counts`."""
    import h5py

    try:
        with h5py.File(path, locking=False) as file:
            now = row_counts(file[group])
    except (OSError, KeyError, RuntimeError):
        return False
    return all(now.get(name, -1) >= rows for name, rows in counts.items())


def cut_rows(group: h5py.Group, counts: Mapping[str, int]) -> None:
    """Take off the rows, and the data sets, that have come since `row_counts`."""
    for name in row_counts(group):
        if name in counts:
            group[name].resize(counts[name], axis=0)
        else:
            del group[name]


def hold_metadata(file: h5py.File) -> None:
    """Let HDF5 write its tables at a flush only, so that the file on disk is whole between."""
    config = file.id.get_mdc_config()
    config.evictions_enabled = False
    config.incr_mode = 0
    config.flash_incr_mode = 0
    config.decr_mode = 0
    file.id.set_mdc_config(config)
