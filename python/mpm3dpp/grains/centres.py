# SPDX-License-Identifier: BSD-3-Clause
"""Centres and radii of grains, one by one: as arrays in Python, as a CSV file beside a case file.

The file's first line names the columns, `x [m],y [m],z [m],radius [m]` in 3D and
`x [m],y [m],radius [m]` in 2D; the units may be left out. Every other line is a grain.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import SkipValidation

from mpm3dpp.base.csv_points import Layout, digest_of, read_points, short
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.from_file import FromFile, file_entry
from mpm3dpp.base.machine import BODY_BYTES

Array = NDArray[np.float64]
_LARGEST = 1e100
_GIVE = "see the how-to page of many grains for its columns"
_LAYOUT = Layout("radius", (1, 1), True, False, "grain", _GIVE, BODY_BYTES)


class GrainCentres:
    """Discs (2D) or spheres (3D), one by one.

    Attributes:
        centres: [m], shape (n, D).
        radii: [m], shape (n,).
        file: the name by which a case file knows them; empty if they come from no file.
        unit: of the lengths in that file.

    Raises:
        CaseError: an array has another shape, or numbers that are not finite or radii <= 0.
    """

    def __init__(self, centres: Any, radii: Any, file: str = "") -> None:
        self.centres: Array = np.array(centres, dtype=np.float64, order="C")
        if self.centres.ndim != 2 or self.centres.shape[1] not in (2, 3) or not len(self.centres):
            rule = "must have the shape (n, 2) or (n, 3), n > 0"
            raise CaseError(rule, key="grain_centres.centres")
        self.radii: Array = np.array(radii, dtype=np.float64)
        if self.radii.shape != (len(self.centres),):
            raise CaseError("must have one number for each grain", key="grain_centres.radii")
        self.file, self.unit = file, "m"
        wrong = self.first_wrong()
        if wrong is not None:
            raise CaseError(f"{wrong[1]} (grain {wrong[0]})", key="grain_centres")

    @property
    def dimension(self) -> int:
        """Number of coordinates of a centre."""
        return int(self.centres.shape[1])

    def first_wrong(self) -> tuple[int, str] | None:
        """Return (number of the grain, rule) of the first one that cannot be."""
        finite = np.all(np.abs(self.centres) < _LARGEST, axis=1) & (np.abs(self.radii) < _LARGEST)
        good = finite & (self.radii > 0)
        if good.all():
            return None
        first = int(np.argmin(good))
        rule = "must have finite numbers" if not finite[first] else "must have a radius > 0"
        return first, rule

    @cached_property
    def digest(self) -> str:
        """SHA-256 (hexadecimal) of the grains, numbers to 12 digits."""
        return digest_of(self.table_of_numbers())

    def table_of_numbers(self) -> Array:
        """Return centres and radii, shape (n, D + 1)."""
        return np.column_stack([self.centres, self.radii])

    def columns(self) -> list[str]:
        """Return the names of the columns of those numbers in a file, with their units."""
        return [*(f"{axis} [m]" for axis in "xyz"[: self.dimension]), "radius [m]"]

    def table(self) -> str | dict[str, str]:
        """Return the value of the key `file` of a case file."""
        if self.file:
            return file_entry(self.file, self.unit)
        return f"({len(self.radii)} grains, SHA-256 {self.digest})"


def read_centres(path: Path, name: str = "", unit: str = "m") -> GrainCentres:
    """Read a file of centres and radii.

    Args:
        path: the file.
        name: its name in messages and in the case; by default its path.
        unit: of the lengths in it.

    Raises:
        CaseError: the file is missing or malformed; the rule names the line.
    """
    name = name or str(path)
    points = read_points(path, name, _LAYOUT, unit)
    found = GrainCentres.__new__(GrainCentres)  # Checked below, where the line is known.
    found.centres, found.radii = points.positions, points.columns["radius"].copy()
    found.file, found.unit = name, unit
    wrong = found.first_wrong()
    if wrong is not None:
        number, line = points.line(wrong[0])
        raise CaseError(f"{wrong[1]}, in line {number} ({short(line)})", _GIVE, value=name)
    return found


AnyCentres = Annotated[
    SkipValidation[GrainCentres | None],
    FromFile(GrainCentres, read_centres, "centres and radii", "centres.csv"),
]
