# SPDX-License-Identifier: BSD-3-Clause
"""An HDF5 file of results to read: what it holds stands in the file itself.

HDF5 lets a file name others, by links and as the places of raw data. So a file that somebody has
sent could have others read, or wait for ever for a pipe. Of ours only `results.vtkhdf` names
others, the frames, for other programs: it is read without them.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mpm3dpp.base.reading import refuse_other_kinds

if TYPE_CHECKING:
    import h5py

_DEEPEST = 8  # Groups in groups; ours have three.


@contextlib.contextmanager
def open_h5(path: Path) -> Iterator[h5py.File]:
    """Give a file to read.

    Raises:
        FileNotFoundError: there is none.
        CaseError: it is a pipe, a device or the like; rule and remedy only.
        OSError, ValueError: it cannot be read, is no HDF5 file, or one that names others by links.
    """
    with checked_h5(path) as file:
        yield file


def checked_h5(path: Path) -> h5py.File:
    """Return a file to read, as `open_h5`; the caller closes it."""
    import h5py

    refuse_other_kinds(path)
    file = h5py.File(path, "r", locking=False)
    try:
        _refuse_links(file, 0)
    except BaseException:
        file.close()
        raise
    return file


def own(data: Any, rows: int | None = None) -> Any:
    """Return a data set whose numbers are in its file.

    Args:
        data: the data set.
        rows: how many it must have; not asked if None.

    Raises:
        ValueError: they are elsewhere, or it has not so many.
    """
    if data.external or data.is_virtual:
        raise ValueError(f"the data of '{data.name}' are in another file")
    if rows is not None and len(data) != rows:
        raise ValueError(f"'{data.name}' has {len(data)} rows in place of {rows}")
    return data


def _refuse_links(group: h5py.Group, depth: int) -> None:
    import h5py

    if depth > _DEEPEST:
        raise ValueError(f"'{group.name}' is too deep")
    for name in group:
        if not isinstance(group.get(name, getlink=True), h5py.HardLink):
            raise ValueError(f"'{name}' of '{group.name}' is a link")
        if group.get(name, getclass=True) is h5py.Group:
            _refuse_links(group[name], depth + 1)
