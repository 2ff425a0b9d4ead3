# SPDX-License-Identifier: BSD-3-Clause
"""Reading a file that a user names: whatever it is, an answer at once and within the memory."""

from __future__ import annotations

import os
import stat
from pathlib import Path
from typing import BinaryIO

from .errors import CaseError

# What a name may stand for that is no file; opening some of them waits for ever, or has effects.
_KINDS = {
    stat.S_IFDIR: "a folder",
    stat.S_IFIFO: "a pipe",
    stat.S_IFSOCK: "a socket",
    stat.S_IFCHR: "a device",
    stat.S_IFBLK: "a device",
}


def refuse_nul(path: Path) -> None:
    """Raise if a path has a NUL character, which no name of a file has.

    Raises:
        CaseError: it has.
    """
    if "\0" in str(path):
        raise CaseError("has a NUL character in its name", "check the name of the file")


def open_file(path: Path) -> BinaryIO:
    """Open a file for reading, in bytes.

    Raises:
        FileNotFoundError: there is none, for the caller to say what else there is.
        CaseError: it is no regular file, or cannot be read; rule and remedy only.
    """
    refuse_nul(path)
    try:
        _refuse_other_kinds(os.stat(path).st_mode)
        # If it has just become a pipe, it is not waited for.
        handle = os.open(path, os.O_RDONLY | os.O_CLOEXEC | os.O_NONBLOCK)
        try:
            _refuse_other_kinds(os.fstat(handle).st_mode)
        except CaseError:
            os.close(handle)
            raise
        return os.fdopen(handle, "rb")
    except FileNotFoundError:
        raise
    except OSError as error:
        raise unreadable(error) from None


def refuse_other_kinds(path: Path) -> None:
    """Raise if something stands there that is no file, for a library that will open it.

    Raises:
        OSError: there is nothing, or it cannot be asked.
        CaseError: it is a pipe, a device or the like; rule and remedy only.
    """
    _refuse_other_kinds(os.stat(path).st_mode)


def read_file(path: Path, most: int, remedy: str) -> bytes:
    """Return all bytes of a file.

    Args:
        path: the file.
        most: bytes that are read at most.
        remedy: what to do about a file that has more.

    Raises:
        FileNotFoundError: there is none.
        CaseError: it is no regular file, has more bytes, or cannot be read; rule and remedy only.
    """
    with open_file(path) as file:
        size = os.fstat(file.fileno()).st_size
        try:
            data = file.read(most + 1) if size <= most else b""
        except OSError as error:
            raise unreadable(error) from None
    if max(size, len(data)) > most:
        has = f"{size / 2**20:,.1f} MiB" if size > most else "more"
        raise CaseError(f"has {has}, and {most / 2**20:,.0f} MiB is the most that is read", remedy)
    return data


def unreadable(error: OSError) -> CaseError:
    """Return the mistake that a file cannot be read, by what the system says."""
    reason = (error.strerror or "unknown reason").lower()
    return CaseError(f"cannot be read ({reason})", "check the path")


def _refuse_other_kinds(mode: int) -> None:
    if not stat.S_ISREG(mode):
        kind = _KINDS.get(stat.S_IFMT(mode), "something else")
        raise CaseError(f"must be a file but is {kind}", "check the path")
