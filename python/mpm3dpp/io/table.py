# SPDX-License-Identifier: BSD-3-Clause
"""A CSV file that grows by rows."""

from __future__ import annotations

import contextlib
import csv
import io
import os
import zlib
from collections.abc import Mapping
from io import FileIO
from pathlib import Path

from mpm3dpp.base.disk import bring_to_disk, checksum, no_link, writing
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import MEMORY
from mpm3dpp.base.reading import read_file


class Table:
    """A CSV file that only ever holds whole rows, even when the disk runs full.

    With what `saved` returned, an old one goes on from there.

    Args:
        path: the file.
        header: names of the columns.
        known: of an old one, what `saved` returned.
        keep_open: false where there are many: the system lets a process have some 1,000 files open.
    """

    def __init__(
        self,
        path: Path,
        header: list[str],
        known: Mapping[str, int] | None = None,
        keep_open: bool = True,
    ) -> None:
        self._path = path
        self._size, self._check = (known["size"], known["check"]) if known else (0, 0)
        with writing(path):
            self._file: FileIO | None = self._open("wb" if known is None else "ab")
            if known is not None:
                self._file.truncate(self._size)
        if not keep_open:
            self.close()
        if known is None:
            text = io.StringIO()
            csv.writer(text, lineterminator="\n").writerow(header)
            self._write(text.getvalue())

    def saved(self) -> dict[str, int]:
        """Return size [bytes] and CRC-32 of the file, when that much is on the disk."""
        bring_to_disk(self._path)
        return {"size": self._size, "check": self._check}

    def append(self, lines: list[list[str]]) -> None:
        self._write("".join(",".join(cells) + "\n" for cells in lines))

    def _write(self, text: str) -> None:
        data = memoryview(text.encode())
        check = zlib.crc32(data, self._check)
        with writing(self._path), self._opened() as file:
            left = data
            try:
                while left:
                    left = left[file.write(left) :]
            except OSError:
                with contextlib.suppress(OSError):  # A reader drops half a row.
                    file.truncate(self._size)
                raise
        self._size, self._check = self._size + len(data), check

    def _open(self, mode: str) -> FileIO:
        # Not buffered: what could not be written must not be tried again later.
        return FileIO(self._path, mode, opener=no_link)

    def _opened(self) -> contextlib.AbstractContextManager[FileIO]:
        """Return the file, which is closed after use if it is not kept open."""
        return contextlib.nullcontext(self._file) if self._file else self._open("ab")

    def close(self) -> None:
        """Close the file; another row opens it again."""
        with writing(self._path):
            if self._file is not None:
                self._file.close()
                self._file = None


def whole_lines(path: Path) -> list[str]:
    """Return the lines of a table; a last one that a killed run left unfinished is dropped.

    Raises:
        FileNotFoundError: there is none.
        CaseError: it is no file, has more than the memory, or cannot be read; rule and remedy only.
        UnicodeDecodeError: it is no text.
    """
    data = read_file(path, MEMORY // 8, "take rows out")
    return data.decode("utf-8").replace("\r\n", "\n").split("\n")[:-1]


def check_table(path: Path, known: Mapping[str, int]) -> None:
    """Raise `CaseError` if a table has not the rows that it had, and say which.

    Args:
        path: of the table.
        known: what `Table.saved` returned then.
    """
    try:
        now = checksum(path, known["size"])
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise CaseError(f"cannot read '{path}': {reason.lower()}") from error
    if now is None:
        raise CaseError(f"'{path}' has lost rows since the checkpoint")
    if now != known["check"]:
        raise CaseError(f"'{path}' is damaged: its rows are not those that were written")
