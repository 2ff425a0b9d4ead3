# SPDX-License-Identifier: BSD-3-Clause
"""What in the folder of a run is not of a run: it is the user's, and not written over."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterable
from pathlib import Path

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.ours import is_ours, refuse_link, refuse_others

from .checkpoint import CHECKPOINT, PREVIOUS, read_about
from .folders import OF_A_RUN, PICTURES
from .frame_file import frame_numbers, frame_path, frames_folder
from .history import PAIRS
from .open_h5 import open_h5
from .probe_tables import FIRST_COLUMNS, PROBES, probe_path
from .stored_manifest import manifest_data
from .vtkhdf import RESULTS

_HISTORY = "history.csv"
_PROBE = ",".join(FIRST_COLUMNS).encode()
_PICTURE = re.compile(r"frame_\d{4,}\.png|" + "|".join(map(re.escape, PICTURES)))


def is_run(folder: Path) -> bool:
    """Return whether a folder holds a run: one of the files that tell of it is ours."""
    with contextlib.suppress(CaseError):
        if {"case_hash", "result_hash"} <= manifest_data(folder).keys():
            return True
    with contextlib.suppress(CaseError):
        if "made_by" in read_about(folder / CHECKPOINT):
            return True
    with contextlib.suppress(CaseError, OSError):
        if is_ours(folder / _HISTORY, b"step,time,dt,", mark=""):
            return True
    with contextlib.suppress(CaseError, OSError), open_h5(folder / RESULTS) as file:
        return "mpm3dpp" in file
    return False


def refuse_foreign(folder: Path, probes: Iterable[str] = ()) -> None:
    """Raise `CaseError` if a run in a folder would write over a file that no run has written.

    Where there is a run, what has the names of a run's files is taken for its own, but for tables
    of probes; links are never followed.

    Args:
        folder: of the run that is to begin or to go on.
        probes: names of its probes.
    """
    frames = frames_folder(folder / RESULTS)
    tables = [probe_path(folder, name) for name in probes]
    names = (RESULTS, _HISTORY, PAIRS, CHECKPOINT, PREVIOUS, *OF_A_RUN)
    files = [folder / name for name in names]
    for path in (*files, frames, folder / PROBES, *tables):
        refuse_link(path)
        kind = path.is_dir if path in (frames, folder / PROBES) else path.is_file
        if path.exists() and not kind():  # A pipe, say.
            raise _foreign(path)
    if not is_run(folder):
        files += [frame_path(frames, frame) for frame in frame_numbers(frames)[:1]]
        for path in files:
            if path.exists() and path.stat().st_size > 0:
                raise _foreign(path)
    for path in tables:
        with contextlib.suppress(FileNotFoundError):
            if not is_ours(path, _PROBE, mark=""):
                raise _foreign(path)


def refuse_to_draw(path: Path) -> None:
    """Raise `CaseError` if a picture would take the place of a file that mpm3dpp has not made.

    In the folder of a run those that a run draws are its own; they had no mark once.
    """
    if not (_PICTURE.fullmatch(path.name) and is_run(path.parent)):
        refuse_others(path)
    refuse_link(path)


def _foreign(path: Path) -> CaseError:
    rule = f"'{path}' is there already, and no run of mpm3dpp has written it"
    return CaseError(rule, "move it away, or choose another --out")
