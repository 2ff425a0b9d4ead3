# SPDX-License-Identifier: BSD-3-Clause
"""`checkpoint.zip`: the state of a run between two steps, from which it goes on with the same bits.

Two members, not compressed: `about.json`, and `state`, the bytes of the core. The archive has their
check sums. It is no HDF5 file because HDF5 takes the process with it when the disk is full.
"""

from __future__ import annotations

import contextlib
import json
import os
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from mpm3dpp.errors import CaseError
from mpm3dpp.io.disk import cannot_write

CHECKPOINT = "checkpoint.zip"
UNFINISHED = f".{CHECKPOINT}.new"  # while it is written
ANEW = "begin the run anew with --anew"


def write_checkpoint(path: Path, core: Any, about: Mapping[str, Any]) -> None:
    """Write a checkpoint in one step: the file is the old one until the new one is whole.

    Args:
        path: the file.
        core: the core's `Simulation`.
        about: what else is needed to go on, as JSON takes it.

    Raises:
        CaseError: the file cannot be written; the old one still stands.
    """
    new = path.parent / f".{path.name}.new"
    try:
        with open(new, "wb") as file:
            with zipfile.ZipFile(file, "w") as archive:
                archive.writestr("about.json", json.dumps(about))
                with archive.open("state", "w", force_zip64=True) as state:
                    core.save(state.write)
            file.flush()
            os.fsync(file.fileno())
        new.replace(path)
    except BaseException as error:
        with contextlib.suppress(OSError):
            new.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise cannot_write(path, error) from error
        raise


def read_about(path: Path) -> dict[str, Any]:
    """Return what was written with a checkpoint beside the state.

    Raises:
        CaseError: the file is missing or is not a checkpoint.
    """
    if not path.is_file():
        remedy = (
            "give the --out of the run that is to go on; one that was killed or met a full disk "
            "before its first checkpoint has none: leave out --resume"
        )
        raise CaseError(f"there is no checkpoint '{path}'", remedy)
    try:
        with zipfile.ZipFile(path) as archive:
            return dict(json.loads(archive.read("about.json")))
    except PermissionError as error:
        raise CaseError(f"cannot read '{path}': permission denied", "make it readable") from error
    except (OSError, KeyError, TypeError, ValueError, zipfile.BadZipFile) as error:
        raise CaseError(f"'{path}' is not a checkpoint of mpm3dpp, or damaged", ANEW) from error


def restore_checkpoint(path: Path, core: Any) -> None:
    """Bring a `Simulation` of the core to the state of a checkpoint; it must not have stepped.

    Raises:
        CaseError: the state is damaged, or is that of another case or version.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            if archive.testzip() is not None:  # Before the core makes anything of the bytes.
                raise zipfile.BadZipFile
            with archive.open("state") as state:
                core.restore(state.readinto)  # type: ignore[attr-defined]
                whole = not state.read(1)
    except (OSError, KeyError, zipfile.BadZipFile) as error:
        raise CaseError(f"the checkpoint '{path}' is damaged", ANEW) from error
    except ValueError as error:
        raise CaseError(f"the checkpoint '{path}' cannot be used: {error}", ANEW) from error
    if not whole:
        raise CaseError(f"the checkpoint '{path}' cannot be used: it is too long", ANEW)
