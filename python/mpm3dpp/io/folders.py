# SPDX-License-Identifier: BSD-3-Clause
"""Where results go: folders that can be written, one run at a time in each."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from mpm3dpp.base.disk import cannot_write, make_folder, unfinished
from mpm3dpp.base.errors import CaseError

from .checkpoint import CHECKPOINT, PREVIOUS
from .history import PAIRS
from .probe_tables import PROBES, tables_of_probes


def default_folder(case_file: Path) -> Path:
    """Return `results/NAME` beside the current directory.

    NAME is the folder of a file called `case.toml`, that folder and NAME for `case_NAME.toml`
    (`01_two_rings_velocity`), else the file's name without its ending.
    """
    stem, folder = case_file.stem, case_file.resolve().parent.name
    if folder and stem == "case":
        return Path("results") / folder
    if folder and stem.startswith("case_"):
        return Path("results") / f"{folder}_{stem.removeprefix('case_')}"
    return Path("results") / stem


def beside_default(case_file: Path, what: str) -> Path:
    """Return `results/NAME_WHAT`, for several runs of a case."""
    usual = default_folder(case_file)
    return usual.with_name(f"{usual.name}_{what}")


# What a run writes beside the frames and the history, which it begins anew.
PICTURES = (
    *("frame.png", "energies.png", "probes.png", "first_contact.png", "force_network.png"),
    "animation.gif",
)
REPORT = "report.html"
OF_A_RUN = ("manifest.json", REPORT, *PICTURES)


def forget_last_run(folder: Path, checkpoint: bool = True) -> None:
    """Remove what an earlier run has left in a folder, so that it is not taken for the new one's.

    Args:
        folder: of the runs.
        checkpoint: remove its checkpoint and table of pairs too, for the new run does not go on
            from them.

    Raises:
        CaseError: it cannot be removed.
    """
    half = unfinished(Path(CHECKPOINT)).name
    anew = (PAIRS, half, PREVIOUS, CHECKPOINT)  # A run that begins anew may have no such table.
    old = [folder / name for name in (*OF_A_RUN, *(anew if checkpoint else ()))]
    for path in [*old, *(tables_of_probes(folder) if checkpoint else ())]:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            raise cannot_write(path, error) from error
    if checkpoint:
        with contextlib.suppress(OSError):  # Not there, or the user has files of their own in it.
            (folder / PROBES).rmdir()


@contextlib.contextmanager
def only_run_in(folder: Path) -> Iterator[None]:
    """Within it, no other run goes on in the folder; where the system has locks, not on Windows.

    Raises:
        CaseError: one does already.
    """
    try:
        import fcntl
    except ImportError:
        yield
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            rule = f"a run is going on in '{folder}'"
            raise CaseError(rule, "wait for its end, or choose another --out") from None
        except OSError:  # A disk without locks.
            pass
        yield
    finally:
        os.close(handle)


def is_run_in(folder: Path) -> bool:
    """Return whether a run goes on in a folder; False where the system has no locks."""
    try:
        with only_run_in(folder):
            return False
    except CaseError:
        return True
    except OSError:  # It cannot be opened.
        return False


@contextlib.contextmanager
def folder_of_run(path: Path) -> Iterator[None]:
    """Within it there is a folder that can be written; made for a run that is refused, it goes.

    Raises:
        CaseError: it cannot be made or written.
    """
    new = [folder for folder in (path, *path.parents) if not os.path.exists(folder)]
    writable_folder(path)
    try:
        yield
    finally:
        with contextlib.suppress(OSError):  # Not empty: it is kept.
            for folder in new:
                folder.rmdir()


def writable_folder(path: Path) -> Path:
    """Make a folder, prove that files can be written in it, and return it.

    Raises:
        CaseError: it cannot be made or written.
    """
    make_folder(path)
    try:
        with tempfile.TemporaryFile(dir=path):
            return path
    except OSError as error:
        raise cannot_write(path, error) from error
