# SPDX-License-Identifier: BSD-3-Clause
"""What readers of other programs' files make of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mpm3dpp.case import Case

Lines = dict[tuple[str | int, ...], int]


@dataclass(frozen=True)
class Imported:
    """An input file of another program as a case.

    Attributes:
        case: the case.
        tables: it as tables in SI units; particles are `mpm3dpp.Particles`.
        lines: line of the file by the key that came from it.
        notes: sentences about what is not the same as in the other program.
        name: of the file.
        program: the other one.
        units: the name of its unit system.
    """

    case: Case
    tables: dict[str, Any]
    lines: Lines
    notes: list[str]
    name: str
    program: str
    units: str
