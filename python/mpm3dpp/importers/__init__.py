# SPDX-License-Identifier: BSD-3-Clause
"""Reading the input files of other programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from mpm3dpp.base.errors import CaseError

if TYPE_CHECKING:
    from mpm3dpp.case.case import Case

MPM3D_SUFFIX = ".mpm"


def load_any(path: Path, units: str | None = None) -> tuple[Case, list[str]]:
    """Read a case file, or a file of MPM3D-F90 by its ending `.mpm`.

    Args:
        path: the file.
        units: unit system of a file that states none; see `mpm3d.import_mpm`.

    Returns:
        The case, and sentences about what is not the same as in the other program.

    Raises:
        CaseError: a mistake in the file, or something in it that cannot be honoured.
    """
    if path.suffix.lower() == MPM3D_SUFFIX:
        from .mpm3d import import_mpm

        found = import_mpm(path, units)
        return found.case, found.notes
    if units is not None:
        rule = "is for files of MPM3D-F90 (.mpm) only"
        raise CaseError(rule, "leave it out; a case file has its units in it", key="--units")
    from mpm3dpp.case.case import load_case

    return load_case(path), []
