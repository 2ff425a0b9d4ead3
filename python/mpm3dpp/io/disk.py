# SPDX-License-Identifier: BSD-3-Clause
"""Writing to a disk that may be full, read-only or gone: one sentence, and nothing lost."""

from __future__ import annotations

import contextlib
import errno
import os
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from mpm3dpp.errors import CaseError

_REMEDIES = {
    errno.ENOSPC: "free some space, write fewer frames or choose another folder with --out",
    errno.EDQUOT: "your disk quota is used up; choose another folder with --out",
    errno.EFBIG: "the file size limit is reached; raise it (ulimit -f) or write fewer frames",
    errno.EACCES: "choose a folder you may write to with --out",
    errno.EPERM: "choose a folder you may write to with --out",
    errno.EROFS: "the disk is read-only; choose another folder with --out",
    errno.ENOTDIR: "a part of this path is a file; choose another folder with --out",
    errno.EISDIR: "a folder has this name; choose another folder with --out",
    errno.EEXIST: "a file has this name; choose another folder with --out",
}


def cannot_write(path: Path, error: Exception) -> CaseError:
    """The user's sentence for a failed write: file, reason, remedy.

    Args:
        path: the file that was being written.
        error: what the system (or HDF5) said.
    """
    number = getattr(error, "errno", None)
    reason = os.strerror(number) if number else str(error).splitlines()[0]
    remedy = _REMEDIES.get(number or 0, "check the disk and the folder, or choose another --out")
    return CaseError(f"cannot write '{path}': {reason.lower()}; {remedy}")


@contextlib.contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn any failure to write `path` inside the block into a `CaseError`."""
    try:
        yield
    except OSError as error:
        raise cannot_write(path, error) from error


def make_folder(path: Path) -> None:
    """Make the folder and its parents. Raises `CaseError` when that is not possible."""
    with writing(path):
        path.mkdir(parents=True, exist_ok=True)


def reserve(path: Path, end: int) -> None:
    """Make sure that the file can grow to `end` bytes, before anything in it is changed.

    Uses the system's reservation of disk blocks where it exists, else the free space reported.
    Raises OSError (ENOSPC, EDQUOT, EFBIG) when there is no room; the file is then as it was.
    """
    size = path.stat().st_size
    if end <= size:
        return
    if hasattr(os, "posix_fallocate"):
        with open(path, "r+b") as file:
            try:
                os.posix_fallocate(file.fileno(), size, end - size)
                return
            except OSError as error:
                os.ftruncate(file.fileno(), size)
                if error.errno not in (errno.EINVAL, errno.EOPNOTSUPP):
                    raise
    if shutil.disk_usage(path.parent).free < end - size:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(path))


def bring_to_disk(path: Path) -> None:
    """Wait until all that was written to a file would outlive a power cut."""
    with writing(path), open(path, "rb") as file:
        os.fsync(file.fileno())


@contextlib.contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a new file beside `path`, which takes its place at the end: there is never half a file.

    Raises `CaseError` when the folder cannot be written; the old file then still stands.
    """
    with writing(path):
        handle, name = tempfile.mkstemp(prefix=f".{path.name}.", dir=path.parent)
        os.close(handle)
        temporary = Path(name)
        try:
            yield temporary
            umask = os.umask(0)
            os.umask(umask)
            temporary.chmod(0o666 & ~umask)
            temporary.replace(path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise


def write_atomically(path: Path, text: str) -> None:
    """Replace a text file in one step (write, fsync, rename), see `replacing`."""
    with replacing(path) as new, open(new, "w", encoding="utf-8") as file:
        file.write(text)
        file.flush()
        os.fsync(file.fileno())
