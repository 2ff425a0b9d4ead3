# SPDX-License-Identifier: BSD-3-Clause
"""Reading the input files of other programs; their rows stand in `base.readers`."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import TYPE_CHECKING

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.readers import PROGRAMS, READERS, reader_of

if TYPE_CHECKING:
    from mpm3dpp.case import Case

    from .imported import Imported


def load_any(path: Path, units: str | None = None) -> tuple[Case, list[str]]:
    """Read a case file, or a file of another program by the end of its name.

    Args:
        path: the file.
        units: unit system of a file that states none.

    Returns:
        The case, and sentences about what is not the same as in the other program.

    Raises:
        CaseError: a mistake in the file, or something in it that cannot be honoured.
    """
    if reader_of(path) is not None:
        found = import_file(path, units)
        return found.case, found.notes
    if units is not None:
        rule = f"is for files of {PROGRAMS} only"
        raise CaseError(rule, "leave it out; a case file has its units in it", key="--units")
    from mpm3dpp.case import load_case

    return load_case(path), []


def import_file(path: str | Path, units: str | None = None) -> Imported:
    """Read a file of another program, by the end of its name; of the first of them, if none fits.

    Raises:
        CaseError: a case file, a mistake in the file, or something in it that cannot be honoured.
    """
    path = Path(path)
    if path.suffix.lower() == ".toml":
        rule = f"is a case file, but import wants an input file of {PROGRAMS}"
        raise CaseError(rule, "run, check and preview take a case file as it is", key=str(path))
    reader = reader_of(path) or READERS[0]
    module = importlib.import_module(f"mpm3dpp.importers.{reader.package}")
    found: Imported = module.read(path, units)
    return found
