# SPDX-License-Identifier: BSD-3-Clause
"""`checkpoint.zip`: the state of a run between two steps, from which it goes on with the same bits.

Two members, not compressed: `about.json`, and `state`, the bytes of the core. The archive has their
check sums. It is no HDF5 file because HDF5 takes the process with it when the disk is full.
"""

from __future__ import annotations

import json
import struct
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mpm3dpp.base.disk import replacing
from mpm3dpp.base.errors import CaseError

CHECKPOINT = "checkpoint.zip"
PREVIOUS = "checkpoint_previous.zip"
"""The last but one, for the case that the last is damaged."""
ANEW = "begin the run anew with --anew"

_UNREADABLE = (
    *(OSError, EOFError, LookupError, TypeError, ValueError, OverflowError, RuntimeError),
    *(struct.error, zlib.error, zipfile.BadZipFile),
)
"""What `zipfile` and `json` raise when they meet bytes that nobody has written."""


class DamagedError(CaseError):
    """A checkpoint, or a file that goes with it, is not as it was written; another one may be."""


def write_checkpoint(
    path: Path, core: Any, about: Mapping[str, Any], keep: Path | None = None
) -> None:
    """Write a checkpoint in one step: the file is the old one until the new one is whole.

    Args:
        path: the file.
        core: the core's `Simulation`.
        about: what else is needed to go on, as JSON takes it.
        keep: name that the old one gets then.

    Raises:
        CaseError: the file cannot be written, or there are more particles than it may hold; the old
            one still stands.
    """
    with replacing(path, keep) as file, zipfile.ZipFile(file, "w") as archive:
        archive.writestr("about.json", json.dumps(about))
        with archive.open("state", "w", force_zip64=True) as state:
            try:
                core.save(state.write)
            except ValueError as error:
                raise CaseError(str(error)) from error


def no_checkpoint(path: Path) -> DamagedError:
    """Return the mistake that there is none."""
    remedy = (
        "give the --out of the run that is to go on; one that was killed or met a full disk before "
        "its first checkpoint has none: leave out --resume"
    )
    return DamagedError(f"there is no checkpoint '{path}'", remedy)


def read_about(path: Path) -> dict[str, Any]:
    """Return what was written with a checkpoint beside the state.

    Raises:
        DamagedError: the file is missing or is not a checkpoint.
    """
    if not path.is_file():
        raise no_checkpoint(path)
    try:
        with zipfile.ZipFile(path) as archive:
            return dict(json.loads(archive.read(_stored(archive, "about.json"))))
    except PermissionError as error:
        raise CaseError(f"cannot read '{path}': permission denied", "make it readable") from error
    except _UNREADABLE as error:
        rule = f"'{path}' is not a checkpoint of mpm3dpp, or damaged"
        raise DamagedError(rule, ANEW) from error


def restore_checkpoint(path: Path, core: Any) -> None:
    """Bring a `Simulation` of the core to the state of a checkpoint; it must not have stepped.

    Raises:
        DamagedError: the state is damaged, or is that of another case or version; the simulation
            steps no more then.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            member = _stored(archive, "state")
            if archive.testzip() is not None:  # Before the core makes anything of the bytes.
                raise zipfile.BadZipFile
            state = archive.open(member)
    except _UNREADABLE as error:
        raise DamagedError(f"the checkpoint '{path}' is damaged", ANEW) from error
    try:
        with state:
            core.restore(state.readinto, member.file_size)  # type: ignore[attr-defined]
    except (MemoryError, *_UNREADABLE) as error:
        rule = f"the checkpoint '{path}' cannot be used: {error or 'it does not fit into memory'}"
        raise DamagedError(rule, ANEW) from error


def _stored(archive: zipfile.ZipFile, name: str) -> zipfile.ZipInfo:
    """Return a member that is as `write_checkpoint` has made it: not compressed.

    So nothing gets longer when it is read than the file is.
    """
    for other in archive.infolist():
        if other.compress_type != zipfile.ZIP_STORED or other.file_size != other.compress_size:
            raise zipfile.BadZipFile
    return archive.getinfo(name)
