# SPDX-License-Identifier: BSD-3-Clause
"""Writing to a disk that may be full, read-only or gone: one sentence, and nothing lost."""

from __future__ import annotations

import contextlib
import errno
import os
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from .errors import CaseError
from .reading import open_file

_PIECE = 1 << 16  # bytes that are read at a time, less than what is mapped anew for each

_REMEDIES = {
    errno.ENOSPC: "free some space, write fewer frames or choose another folder with --out",
    errno.EDQUOT: "your disk quota is used up; choose another folder with --out",
    errno.EFBIG: "the file size limit is reached; raise it (ulimit -f) or write fewer frames",
    errno.EACCES: "choose a folder you may write to with --out",
    errno.EPERM: "choose a folder you may write to with --out",
    errno.EROFS: "the disk is read-only; choose another folder with --out",
    errno.ENOTDIR: "a part of this path is a file; choose another folder with --out",
    errno.EISDIR: "a folder has this name; choose another folder with --out",
    errno.ELOOP: "a link has this name, which is not followed: remove it",
    errno.EEXIST: "a file has this name; choose another folder with --out",
}


def cannot_write(path: Path, error: Exception) -> CaseError:
    """The user's sentence for a failed write: file, reason, remedy.

    Args:
        path: the file that was being written.
        error: what the system (or HDF5) said.
    """
    number = getattr(error, "errno", None)
    reason = os.strerror(number) if number else (str(error) or "unknown reason").splitlines()[0]
    remedy = _REMEDIES.get(number or 0, "check the disk and the folder, or choose another --out")
    return CaseError(f"cannot write '{path}': {reason.lower()}; {remedy}")


@contextlib.contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn any failure to write `path` inside the block into a `CaseError`."""
    try:
        yield
    except OSError as error:
        raise cannot_write(path, error) from error


def no_link(path: str, flags: int) -> int:
    """Open a file as `open` does by its `opener`, but no link: that is not followed in writing."""
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_NONBLOCK", 0), 0o666)


def make_folder(path: Path) -> None:
    """Make the folder and its parents. Raises `CaseError` when that is not possible."""
    with writing(path):
        path.mkdir(parents=True, exist_ok=True)


def bring_to_disk(path: Path) -> None:
    """Wait until all that was written to a file would outlive a power cut."""
    with writing(path), open(path, "rb") as file:
        os.fsync(file.fileno())


def bring_folder_to_disk(path: Path) -> None:
    """Wait until the names of the files in a folder would outlive a power cut."""
    if os.name != "posix":  # Elsewhere a folder cannot be opened.
        return
    with writing(path):
        handle = os.open(path, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def unfinished(path: Path) -> Path:
    """Return the name that a file has while `replacing` writes it."""
    return path.parent / f".{path.name}.new"


@contextlib.contextmanager
def replacing(path: Path, keep: Path | None = None) -> Iterator[BinaryIO]:
    """Give a file to write, which takes the place of `path` when the block ends: never half a file.

    It is written beside the old one, brought to the disk and renamed; the old one gets the name
    `keep`, if that is given.

    Raises:
        CaseError: it cannot be written; the old file then still stands.
    """
    new = unfinished(path)
    with writing(path):
        try:
            if new.is_symlink():
                new.unlink()
            with open(new, "wb", opener=no_link) as file:
                yield file
                file.flush()
                os.fsync(file.fileno())
            if keep is not None and path.exists():
                _second_name(path, keep)
            new.replace(path)
        except BaseException:
            with contextlib.suppress(OSError):
                new.unlink(missing_ok=True)
            raise


def _second_name(path: Path, name: Path) -> None:
    """Let a file stand under another name too; under that alone on a disk without such names."""
    try:
        name.unlink(missing_ok=True)
        os.link(path, name)
    except OSError:
        path.replace(name)


def write_atomically(path: Path, text: str) -> None:
    """Replace a text file in one step: see `replacing`."""
    with replacing(path) as file:
        file.write(text.encode())


def checksum(path: Path, size: int | None = None) -> int | None:
    """Return the CRC-32 of a file, or of its first `size` bytes; None if it has not so many.

    Raises:
        FileNotFoundError: there is none.
        CaseError: it is no file, or cannot be read.
    """
    value, left = 0, size
    try:
        opened = open_file(path)
    except CaseError as error:
        raise CaseError(f"'{path}' {error.rule}", error.remedy) from error
    with opened as file:
        while left != 0 and (piece := file.read(min(_PIECE, left or _PIECE))):
            value = zlib.crc32(piece, value)
            left = None if left is None else left - len(piece)
    return None if left else value
