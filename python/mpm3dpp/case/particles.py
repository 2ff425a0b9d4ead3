# SPDX-License-Identifier: BSD-3-Clause
"""Particles given one by one: as arrays in Python, as a CSV file beside a case file.

The file's first line names the columns, `x [m],y [m],z [m],volume [m^3],vx [m/s],vy [m/s],vz [m/s]`
in 3D and `x [m],y [m],volume [m^2],vx [m/s],vy [m/s]` in 2D; the units, the column `volume` and
those of the velocity may be left out. Every other line is a particle, in SI units; lengths and
volumes may be in the unit of length that the case gives. Blank lines and lines that begin with `#`
are skipped.
"""

from __future__ import annotations

from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import SkipValidation

from mpm3dpp.base.csv_points import (
    Layout,
    digest_of,
    read_points,
    short,
    write_points,
)
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.from_file import FromFile, file_entry
from mpm3dpp.base.machine import PARTICLE_BYTES_WITH_GRID

Array = NDArray[np.float64]
_LARGEST = 1e100
_GIVE = 'see "A file of particles" in docs/how-to/run-a-case.md for its columns'
_LAYOUT = Layout("volume", (2, 3), False, True, "particle", _GIVE, PARTICLE_BYTES_WITH_GRID)


class Particles:
    """The particles of a body, one by one.

    Attributes:
        positions: [m], shape (n, D).
        volumes: [m^3; in 2D m^2], shape (n,); None if all are cubes of the body's spacing.
        velocities: at the start [m/s], shape (n, D); None if the body has those of its keys.
        file: the name by which a case file knows them; empty if they come from no file.
        unit: of the lengths in that file.

    Raises:
        CaseError: an array has another shape, or numbers that are not finite or volumes <= 0.
    """

    def __init__(
        self, positions: Any, volumes: Any = None, velocities: Any = None, file: str = ""
    ) -> None:
        self.positions: Array = np.ascontiguousarray(positions, dtype=np.float64)
        self.volumes: Array | None = None
        self.velocities: Array | None = None
        self.file, self.unit = file, "m"
        if self.positions.ndim != 2 or self.positions.shape[1] not in (2, 3):
            raise CaseError("must have the shape (n, 2) or (n, 3)", key="particles.positions")
        if len(self.positions) == 0:
            raise CaseError("must hold a particle at least", key="particles.positions")
        if volumes is not None:
            self.volumes = np.ascontiguousarray(volumes, dtype=np.float64)
            if self.volumes.shape != (len(self.positions),):
                rule = "must have one number for each particle"
                raise CaseError(rule, key="particles.volumes")
        if velocities is not None:
            self.velocities = np.ascontiguousarray(velocities, dtype=np.float64)
            if self.velocities.shape != self.positions.shape:
                rule = f"must have the shape of the positions, {self.positions.shape}"
                raise CaseError(rule, key="particles.velocities")
        wrong = self.first_wrong()
        if wrong is not None:
            raise CaseError(f"{wrong[1]} (particle {wrong[0]})", key="particles")

    @property
    def dimension(self) -> int:
        """Number of coordinates of a position."""
        return int(self.positions.shape[1])

    def edge(self) -> float | None:
        """Return the edge of a cube of the mean volume [m]; None without volumes."""
        if self.volumes is None:
            return None
        return float(self.volumes.mean() ** (1.0 / self.dimension))

    def first_wrong(self) -> tuple[int, str] | None:
        """Return (number of the particle, rule) of the first one that cannot be."""
        good: NDArray[np.bool_] = np.all(np.abs(self.table_of_numbers()) < _LARGEST, axis=1)
        positive = good if self.volumes is None else good & (self.volumes > 0)
        if positive.all():
            return None
        first = int(np.argmin(positive))
        rule = "must have finite numbers" if not good[first] else "must have a volume > 0"
        return first, rule

    @cached_property
    def digest(self) -> str:
        """SHA-256 (hexadecimal) of the particles, numbers to 12 digits."""
        return digest_of(self.table_of_numbers())

    def table_of_numbers(self) -> Array:
        """Return positions and, if any, volumes and velocities: as many columns as `columns`."""
        given = (self.positions, self.volumes, self.velocities)
        there = [numbers for numbers in given if numbers is not None]
        return there[0] if len(there) == 1 else np.column_stack(there)

    def columns(self) -> list[str]:
        """Return the names of the columns of those numbers in a file, with their units."""
        axes = "xyz"[: self.dimension]
        names = [f"{axis} [m]" for axis in axes]
        names += [] if self.volumes is None else [f"volume [m^{self.dimension}]"]
        return names + ([] if self.velocities is None else [f"v{axis} [m/s]" for axis in axes])

    def table(self) -> str | dict[str, str]:
        """Return the value of the key `particles` of a case file."""
        if self.file:
            return file_entry(self.file, self.unit)
        return f"({len(self.positions)} particles, SHA-256 {self.digest})"


def write_particles(path: Path, particles: Particles, about: str = "") -> None:
    """Write a file of particles; its numbers come back to the last bit.

    Raises:
        CaseError: the file cannot be written.
    """
    write_points(path, particles.columns(), particles.table_of_numbers(), about)


def read_particles(path: Path, name: str = "", unit: str = "m") -> Particles:
    """Read a file of particles.

    Args:
        path: the file.
        name: its name in messages and in the case; by default its path.
        unit: of the lengths in it.

    Raises:
        CaseError: the file is missing or malformed; the rule names the line.
    """
    name = name or str(path)
    points = read_points(path, name, _LAYOUT, unit)
    found = Particles.__new__(Particles)  # Checked below, where the line is known.
    found.positions, found.velocities = points.positions, points.velocities
    found.file, found.unit = name, unit
    found.volumes = points.columns["volume"].copy() if "volume" in points.columns else None
    wrong = found.first_wrong()
    if wrong is not None:
        number, line = points.line(wrong[0])
        raise CaseError(f"{wrong[1]}, in line {number} ({short(line)})", _GIVE, value=name)
    return found


AnyParticles = Annotated[
    SkipValidation[Particles | None],
    FromFile(Particles, read_particles, "particles", "points.csv"),
]
