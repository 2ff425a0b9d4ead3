# SPDX-License-Identifier: BSD-3-Clause
"""What may be written over: only what mpm3dpp has written.

Files that users name get a mark where their format has a place for one; tables are known by their
first line. What a file stands for is never guessed from its name.
"""

from __future__ import annotations

import os
from pathlib import Path

from .errors import CaseError
from .reading import open_file

MARK = "written by mpm3dpp"
"""In pictures, pages and files for VTK, as a comment or in the place of the program's name."""

_LOOK = 1 << 20  # Bytes at either end in which the mark is looked for.


def is_ours(path: Path, *begins: bytes, mark: str = MARK) -> bool:
    """Return whether a file begins with one of these, and has the mark at either end.

    A file that holds nothing is, for there is nothing to lose.

    Args:
        path: the file.          begins: with which it may begin; any if none is given.
        mark: that it must have; none if empty.

    Raises:
        FileNotFoundError: there is none.
        CaseError: it is no file, or cannot be read; rule and remedy only.
    """
    with open_file(path) as file:
        head = file.read(_LOOK)
        size = os.fstat(file.fileno()).st_size
        file.seek(max(len(head), size - _LOOK))
        found = mark.encode() in head or mark.encode() in file.read(_LOOK)
    return not head or (found and (not begins or head.startswith(begins)))


def refuse_others(path: Path, *begins: bytes, mark: str = MARK) -> None:
    """Raise if something stands in the place of a file that mpm3dpp has not written: see `is_ours`.

    Raises:
        CaseError: it does.
    """
    refuse_link(path)
    try:
        ours = is_ours(path, *begins, mark=mark)
    except FileNotFoundError:
        return
    except CaseError as error:
        raise CaseError(error.rule, "give another name", key=str(path)) from None
    if not ours:
        rule = "is there already, and is none that mpm3dpp has written here"
        raise CaseError(rule, "give another name, or move it away", key=str(path))


def refuse_link(path: Path) -> None:
    """Raise if a link stands in the place of a file or folder that is to be written.

    Raises:
        CaseError: it does.
    """
    if path.is_symlink():
        rule = "is a link, which is not followed when something is written"
        raise CaseError(rule, "remove it, or give another name", key=str(path))
