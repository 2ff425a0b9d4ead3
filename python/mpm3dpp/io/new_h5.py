# SPDX-License-Identifier: BSD-3-Clause
"""An HDF5 file that takes its place in one step, whatever the disk does."""

from __future__ import annotations

import contextlib
import io
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from mpm3dpp.base.disk import replacing

if TYPE_CHECKING:
    import h5py

LIBVER = ("v108", "v110")
"""Versions of HDF5's format: from the first on tables have check sums; virtual data sets need the
last."""


@contextlib.contextmanager
def new_h5(path: Path) -> Iterator[h5py.File]:
    """Give an HDF5 file to write, which takes the place of `path` in one step (`replacing`).

    HDF5 never hears of an error of the disk, for after one it cannot close its file, and takes the
    process with it.
    """
    import h5py

    with replacing(path) as raw:
        target = _Deaf(raw)
        with h5py.File(target, "w", libver=LIBVER) as file:
            yield file
        target.tell_error()


class _Deaf(io.RawIOBase):
    """A file that keeps its first error for later, and says to whoever writes that all is well."""

    def __init__(self, raw: BinaryIO) -> None:
        self._raw = raw
        self._error: OSError | None = None
        self._at = self._end = 0

    def tell_error(self) -> None:
        if self._error is not None:
            raise self._error

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET) -> int:
        self._at = offset + {io.SEEK_SET: 0, io.SEEK_CUR: self._at, io.SEEK_END: self._end}[whence]
        return self._at

    def tell(self) -> int:
        return self._at

    def write(self, data: Any) -> int:
        size = memoryview(data).nbytes
        self._try(lambda: self._write(data))
        self._at += size
        self._end = max(self._end, self._at)
        return size

    def truncate(self, size: int | None = None) -> int:
        self._end = self._at if size is None else size
        self._try(lambda: self._raw.truncate(self._end))
        return self._end

    def flush(self) -> None:
        self._try(self._raw.flush)

    def _write(self, data: Any) -> None:
        if self._raw.tell() != self._at:  # A seek would empty the buffer.
            self._raw.seek(self._at)
        self._raw.write(data)

    def _try(self, act: Any) -> None:
        if self._error is None:
            try:
                act()
            except OSError as error:
                self._error = error
