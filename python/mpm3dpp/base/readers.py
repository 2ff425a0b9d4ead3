# SPDX-License-Identifier: BSD-3-Clause
"""Programs of which input files are read: a row each; what reads them is loaded when it is asked.

A package of `importers` that offers `read(path, units)`, which returns an `Imported`, is a reader
once it has its row here.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Reader:
    """A program's input files.

    Attributes:
        suffix: how their names end, in small letters.
        program: its name.
        package: that reads them, of `mpm3dpp.importers`.
        units: unit systems that may be asked for where a file states none, in words.
    """

    suffix: str
    program: str
    package: str
    units: str


READERS = (Reader(".mpm", "MPM3D-F90", "mpm3d", "mm-g-N-ms (default), SI, cm-g-us"),)

SUFFIXES = tuple(reader.suffix for reader in READERS)
PROGRAMS = " or ".join(f"{reader.program} ({reader.suffix})" for reader in READERS)
"""All of them in words: `MPM3D-F90 (.mpm)`."""


def reader_of(path: Path) -> Reader | None:
    """Return the reader of a file by the end of its name, or None."""
    return next((reader for reader in READERS if reader.suffix == path.suffix.lower()), None)
