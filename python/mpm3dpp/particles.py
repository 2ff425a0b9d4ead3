# SPDX-License-Identifier: BSD-3-Clause
"""Particles given one by one: as arrays in Python, as a CSV file beside a case file.

The file's first line names the columns, `x [m],y [m],z [m],volume [m^3]` in 3D and
`x [m],y [m],volume [m^2]` in 2D; the units and the column `volume` may be left out. Every other
line is a particle, in SI units. Blank lines and lines that begin with `#` are skipped.
"""

from __future__ import annotations

import hashlib
import re
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import SkipValidation

from .errors import CaseError, violation
from .io.disk import writing

Array = NDArray[np.float64]
_COLUMN = re.compile(r"\s*(\w+)\s*(?:\[\s*(.*?)\s*\])?\s*")
_LARGEST = 1e100
_GIVE = "see the how-to page of MPM3D files for its columns"


class Particles:
    """The particles of a body, one by one.

    Attributes:
        positions: [m], shape (n, D).
        volumes: [m^3; in 2D m^2], shape (n,); None if all are cubes of the body's spacing.
        file: the name by which a case file knows them; empty if they come from no file.

    Raises:
        CaseError: an array has another shape, or numbers that are not finite or volumes <= 0.
    """

    def __init__(self, positions: Any, volumes: Any = None, file: str = "") -> None:
        self.positions: Array = np.ascontiguousarray(positions, dtype=np.float64)
        self.volumes: Array | None = None
        self.file = file
        if self.positions.ndim != 2 or self.positions.shape[1] not in (2, 3):
            raise CaseError("must have the shape (n, 2) or (n, 3)", key="particles.positions")
        if len(self.positions) == 0:
            raise CaseError("must hold a particle at least", key="particles.positions")
        if volumes is not None:
            self.volumes = np.ascontiguousarray(volumes, dtype=np.float64)
            if self.volumes.shape != (len(self.positions),):
                rule = "must have one number for each particle"
                raise CaseError(rule, key="particles.volumes")
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
        inside: NDArray[np.bool_] = np.all(np.abs(self.positions) < _LARGEST, axis=1)
        good = inside if self.volumes is None else inside & (np.abs(self.volumes) < _LARGEST)
        positive = good if self.volumes is None else good & (self.volumes > 0)
        if positive.all():
            return None
        first = int(np.argmin(positive))
        rule = "must have finite numbers" if not good[first] else "must have a volume > 0"
        return first, rule

    @cached_property
    def digest(self) -> str:
        """SHA-256 (hexadecimal) of the particles, numbers to 12 digits."""
        table = self.table_of_numbers() + 0.0  # No negative zero.
        line = ",".join(["%.12g"] * table.shape[1])
        text = "\n".join(line % tuple(row) for row in table.tolist())
        return hashlib.sha256(text.encode()).hexdigest()

    def table_of_numbers(self) -> Array:
        """Return positions and, if any, volumes, shape (n, D) or (n, D + 1)."""
        if self.volumes is None:
            return self.positions
        return np.column_stack([self.positions, self.volumes])

    def table(self) -> str:
        """Return the value of the key `particles` of a case file."""
        return self.file or f"({len(self.positions)} particles, SHA-256 {self.digest})"


def column_names(dimension: int, volumes: bool) -> list[str]:
    """Return the columns of a file of particles, with their units."""
    names = [f"{axis} [m]" for axis in "xyz"[:dimension]]
    return [*names, f"volume [m^{dimension}]"] if volumes else names


def write_particles(path: Path, particles: Particles, about: str = "") -> None:
    """Write a file of particles; its numbers come back to the last bit.

    Raises:
        CaseError: the file cannot be written.
    """
    table = particles.table_of_numbers() + 0.0
    lines = [f"# {line}" for line in about.splitlines()]
    lines.append(",".join(column_names(particles.dimension, particles.volumes is not None)))
    lines += [",".join(map(repr, row)) for row in table.tolist()]
    with writing(path):
        path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def read_particles(path: Path, name: str = "") -> Particles:
    """Read a file of particles.

    Args:
        path: the file.
        name: its name in messages and in the case; by default its path.

    Raises:
        CaseError: the file is missing or malformed; the rule names the line.
    """
    name = name or str(path)
    try:
        text = path.read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        raise CaseError(f"is not a file ({path})", "check the path", value=name) from None
    except (OSError, UnicodeDecodeError):
        raise CaseError("cannot be read as a text file", "check the file", value=name) from None
    lines = [
        (number, line)
        for number, line in enumerate(text.splitlines(), 1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if not lines:
        raise CaseError("is empty", _GIVE, value=name)
    width, dimension = _header(*lines[0], name)
    if len(lines) == 1:
        raise CaseError("holds no particle", "add a line for each particle", value=name)
    table = _numbers(lines[1:], width, name)
    volumes = table[:, dimension] if width > dimension else None
    found = Particles.__new__(Particles)  # Checked below, where the line is known.
    found.positions, found.file = np.ascontiguousarray(table[:, :dimension]), name
    found.volumes = None if volumes is None else np.ascontiguousarray(volumes)
    wrong = found.first_wrong()
    if wrong is not None:
        number, line = lines[1 + wrong[0]]
        raise CaseError(f"{wrong[1]}, in line {number} ({_short(line)})", _GIVE, value=name)
    return found


def _header(number: int, line: str, name: str) -> tuple[int, int]:
    """Return the number of columns and the dimension that the line of names tells."""
    matches = [_COLUMN.fullmatch(word) for word in line.split(",")]
    names = [match.group(1) if match else "?" for match in matches]
    units = [match.group(2) if match else None for match in matches]
    for dimension in (2, 3):
        wanted = [*"xyz"[:dimension], "volume"]
        if names in (wanted, wanted[:-1]):
            right = [*["m"] * dimension, f"m^{dimension}"]
            for unit, si, word in zip(units, right, names, strict=False):
                if unit not in (None, si):
                    rule = f"gives {word} in [{unit}] in line {number} but must be in {si}"
                    raise CaseError(rule, "convert the column to SI units", value=name)
            return len(names), dimension
    rule = f"must name its columns x,y,z or x,y,z,volume (in 2D without z) in line {number}"
    raise CaseError(f"{rule}, which is: {_short(line)}", _GIVE, value=name)


def _numbers(lines: list[tuple[int, str]], width: int, name: str) -> Array:
    """Return the numbers of all lines, shape (n, width)."""
    try:
        table = np.loadtxt([line for _, line in lines], delimiter=",", ndmin=2, comments=None)
        if table.shape[1] == width:
            return np.asarray(table, dtype=np.float64)
    except ValueError:
        pass
    for number, line in lines:  # Which line is it? Slower, and only now.
        words = line.split(",")
        if len(words) != width:
            rule = f"has {len(words)} numbers in line {number} but {width} columns"
            raise CaseError(rule, _GIVE, value=name)
        for word in words:
            try:
                float(word)
            except ValueError:
                rule = f"has {_short(word.strip())} in line {number}, which is no number"
                raise CaseError(rule, _GIVE, value=name) from None
    raise CaseError("cannot be read as numbers", _GIVE, value=name)


def _short(text: str) -> str:
    text = " ".join(text.split())
    return f'"{text}"' if len(text) <= 40 else f'"{text[:37]}..."'


class _FromFile:
    """Annotation of the field: `Particles`, or the name of a file beside the case file."""

    def parse(self, value: Any, info: Any) -> Particles | None:
        """Return the particles, or raise the violation that pydantic collects."""
        if value is None or isinstance(value, Particles):
            return value
        if not isinstance(value, str):
            rule = "must be the name of a file of particles"
            raise violation(rule, 'for example "points.csv"', value=value)
        folder = Path((info.context or {}).get("folder", "."))
        try:
            return read_particles(folder / value, value)
        except CaseError as error:
            raise violation(error.rule, error.remedy, value=value) from None

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.with_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        return {"type": "string"}


AnyParticles = Annotated[SkipValidation[Particles | None], _FromFile()]
