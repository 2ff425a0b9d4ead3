# SPDX-License-Identifier: BSD-3-Clause
"""CSV files of points: coordinates and some more numbers each, with a line of names at the top.

Blank lines and lines that begin with `#` are skipped. Numbers are in SI units; lengths, areas and
volumes in those of the length that the case names, `{ file = "points.csv", unit = "mm" }`. A unit
in brackets behind a name, `x [mm]`, must say the same.
"""

from __future__ import annotations

import hashlib
import io
import itertools
import os
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .disk import write_atomically
from .errors import CaseError
from .machine import MEMORY, memory_text
from .other_programs import mistaken_file
from .reading import open_file, unreadable
from .units import to_si

Array = NDArray[np.float64]
VELOCITIES = ("vx", "vy", "vz")
_COLUMN = re.compile(r"\s*(\w+)\s*(?:\[\s*(.*?)\s*\])?\s*")
_LONGEST = 10_000  # Characters of a line; four numbers need a hundred.
_ROWS = 1 << 16  # Of numbers that are made text at once.
_SAMPLE = 1 << 16  # Bytes at the beginning from which the number of lines is estimated.


@dataclass(frozen=True)
class Layout:
    """What a file of points holds beside the coordinates.

    Attributes:
        extra: name of the column behind the coordinates.
        powers: the power of a length that it is, in 2D and 3D.
        needed: whether it must be there.
        velocities: whether columns vx, vy, vz [m/s] may follow.
        thing: what a line is, for messages.
        give: remedy that tells where the columns are described.
        bytes_each: memory that a line of it needs in a run, about.
    """

    extra: str
    powers: tuple[int, int]
    needed: bool
    velocities: bool
    thing: str
    give: str
    bytes_each: float

    def choices(self, dimension: int) -> list[list[str]]:
        """Return the names of columns that a file may have."""
        axes = "xyz"[:dimension]
        found = [[*axes, self.extra]] if self.needed else [[*axes], [*axes, self.extra]]
        moving = [[*names, *(f"v{axis}" for axis in axes)] for names in found]
        return found + moving if self.velocities else found

    def dimension_of(self, names: list[str]) -> int | None:
        """Return the dimension of a file with such columns; None if it may not have them."""
        return next((d for d in (2, 3) if names in self.choices(d)), None)

    def power_of(self, name: str, dimension: int) -> int:
        """Return the power of a length that a column is; 0 for one in units of its own."""
        if name in VELOCITIES:
            return 0
        return self.powers[dimension - 2] if name == self.extra else 1

    def unit_of(self, name: str, dimension: int, length: str) -> str:
        """Return the unit of a column, of a unit of length."""
        if name in VELOCITIES:
            return "m/s"
        power = self.power_of(name, dimension)
        return f"{length}^{power}" if power > 1 else length

    def in_words(self) -> str:
        """Return what columns a file may have."""
        choices = f"x,y,z,{self.extra}" if self.needed else f"x,y,z or x,y,z,{self.extra}"
        more = f", or with {','.join(VELOCITIES)} behind them" if self.velocities else ""
        return f"{choices}{more}"


@dataclass(frozen=True)
class Points:
    """The numbers of a file.

    Attributes:
        columns: by their names, in SI units, shape (n,) each.
        dimension: 2 or 3.
        line: gives the line that holds a row, its number and its text.
    """

    columns: dict[str, Array]
    dimension: int
    line: Callable[[int], tuple[int, str]]

    @property
    def positions(self) -> Array:
        """The coordinates [m], shape (n, D)."""
        return np.stack([self.columns[axis] for axis in "xyz"[: self.dimension]], axis=1)

    @property
    def velocities(self) -> Array | None:
        """The velocities [m/s], shape (n, D); None without such columns."""
        if "vx" not in self.columns:
            return None
        return np.stack([self.columns[name] for name in VELOCITIES[: self.dimension]], axis=1)


def read_points(path: Path, name: str, layout: Layout, unit: str = "m") -> Points:
    """Read a file of points.

    Args:
        path: the file.
        name: its name in messages.
        layout: its columns.
        unit: of its lengths; areas and volumes are in its powers.

    Raises:
        CaseError: the file is missing, malformed or no file, or holds more points than the memory;
            the rule names the line.
    """
    try:
        with _text(path) as file:
            _check_kind(file, layout)
            _check_size(file, name, layout)
            lines = _lines(file, name)
            first = next(lines, None)
            if first is None:
                raise CaseError("is empty", layout.give, value=name)
            names, dimension = _header(*first, name, layout, unit)
            table = _numbers(path, lines, len(names), name, layout)
    except FileNotFoundError:
        raise CaseError(f"is not a file ({path})", "check the path", value=name) from None
    except UnicodeDecodeError:
        raise CaseError("cannot be read as a text file", "check the file", value=name) from None
    except OSError as error:
        raise CaseError(unreadable(error).rule, "check the file", value=name) from None
    except CaseError as error:
        raise CaseError(error.rule, error.remedy, value=name) from None
    columns = dict(zip(names, table.T, strict=True))
    if unit != "m":
        for column in names:
            if power := layout.power_of(column, dimension):
                columns[column] = _scaled(columns[column], to_si(f"1 {unit}", "m"), power)

    def line_of(row: int) -> tuple[int, str]:
        with _text(path) as again:
            rows = _lines(again, name)
            next(rows)
            return next(found for k, found in enumerate(rows) if k == row)

    return Points(columns, dimension, line_of)


def _scaled(values: Array, factor: float, power: int) -> Array:
    """Return values in SI units; divided where that is exact: 0.3 mm is 0.3 / 1000 m."""
    parts = round(1.0 / factor) if factor < 1.0 else 0
    if parts and abs(parts * factor - 1.0) < 1e-12:
        return np.asarray(values / float(parts**power))
    return np.asarray(values * factor**power)


def _text(path: Path) -> io.TextIOWrapper:
    return io.TextIOWrapper(open_file(path), encoding="utf-8-sig")


def _check_kind(file: io.TextIOWrapper, layout: Layout) -> None:
    """Raise if a file is one of another program."""
    head = os.pread(file.fileno(), _SAMPLE, 0)
    if other := mistaken_file(head, os.fstat(file.fileno()).st_size):
        raise CaseError(other.rule, layout.give)


def _check_size(file: io.TextIOWrapper, name: str, layout: Layout) -> None:
    """Raise if a run with so many lines, by the length of the first ones, exceeds the memory."""
    size = os.fstat(file.fileno()).st_size
    sample = os.pread(file.fileno(), _SAMPLE, 0)
    count = size * max(1, sample.count(b"\n")) / max(1, len(sample))
    need = count * layout.bytes_each
    if need > MEMORY:
        rule = (
            f"has some {count:.1e} lines, a {layout.thing} each, which need {memory_text(need)} of "
            f"memory, and there are {memory_text(MEMORY)}"
        )
        raise CaseError(rule, f"give a file with fewer {layout.thing}s", value=name)


def _lines(file: io.TextIOWrapper, name: str) -> Iterator[tuple[int, str]]:
    """Yield the lines that hold something, each with its number."""
    number = 0
    while line := file.readline(_LONGEST):
        number += 1
        if len(line) == _LONGEST:
            rule = f"has more than {_LONGEST:,} characters in line {number}"
            raise CaseError(rule, "give a line for each point", value=name)
        if line.strip() and not line.lstrip().startswith("#"):
            if not line.endswith("\n"):
                rule = f"ends in the midst of line {number}, which has no end of a line"
                remedy = "copy or write the file anew, or, if it is whole, end that line too"
                raise CaseError(rule, remedy, value=name)
            yield number, line


def _header(
    number: int, line: str, name: str, layout: Layout, length: str
) -> tuple[list[str], int]:
    """Return the names of the columns and the dimension that the line of names tells."""
    matches = [_COLUMN.fullmatch(word) for word in line.split(",")]
    names = [match.group(1) if match else "?" for match in matches]
    units = [match.group(2) if match else None for match in matches]
    dimension = layout.dimension_of(names)
    if dimension is None:
        rule = f"must name its columns {layout.in_words()} (in 2D without z) in line {number}"
        raise CaseError(f"{rule}, which is: {short(line)}", layout.give, value=name)
    for unit, word in zip(units, names, strict=True):
        own = layout.unit_of(word, dimension, length)
        if unit not in (None, own):
            rule = f"gives {word} in [{unit}] in line {number} but must be in {own}"
            remedy = f'name the unit, {{ file = "{name}", unit = "{unit}" }}'
            if word not in "xyz":
                remedy = "convert the column"
            raise CaseError(rule, remedy, value=name)
    return names, dimension


def _numbers(
    path: Path, lines: Iterator[tuple[int, str]], width: int, name: str, layout: Layout
) -> Array:
    """Return the numbers of all lines that are left, shape (n, width)."""
    first = next(lines, None)
    if first is None:
        rule = f"holds no {layout.thing}"
        raise CaseError(rule, f"add a line for each {layout.thing}", value=name)
    texts = itertools.chain([first[1]], (line for _, line in lines))
    try:
        table = np.loadtxt(texts, delimiter=",", ndmin=2, comments=None)
        if table.shape[1] == width:
            return np.asarray(table, dtype=np.float64)
    except UnicodeDecodeError:
        raise
    except ValueError:
        pass
    with _text(path) as file:
        _find_wrong(_lines(file, name), width, name, layout)
    raise CaseError("cannot be read as numbers", layout.give, value=name)


def _find_wrong(lines: Iterator[tuple[int, str]], width: int, name: str, layout: Layout) -> None:
    """Raise for the first line that is not so many numbers; slower, so only where there is one."""
    next(lines)
    for number, line in lines:
        words = line.split(",")
        if len(words) != width:
            rule = f"has {len(words)} numbers in line {number} but {width} columns"
            raise CaseError(rule, layout.give, value=name)
        for word in words:
            try:
                float(word)
            except ValueError:
                rule = f"has {short(word.strip())} in line {number}, which is no number"
                raise CaseError(rule, layout.give, value=name) from None


def short(text: str) -> str:
    """Return a line of a file between quotation marks, at most 40 characters."""
    text = " ".join(text.split())
    return f'"{text}"' if len(text) <= 40 else f'"{text[:37]}..."'


def write_points(path: Path, names: list[str], table: Array, about: str = "") -> None:
    """Write a file of points; its numbers come back to the last bit.

    Raises:
        CaseError: the file cannot be written.
    """
    lines = [f"# {line}" for line in about.splitlines()]
    lines.append(",".join(names))
    lines += [",".join(map(repr, row)) for row in (table + 0.0).tolist()]
    write_atomically(path, "\n".join(lines) + "\n")


def digest_of(table: Array) -> str:
    """Return the SHA-256 (hexadecimal) of rows of numbers to 12 digits, without negative zeros."""
    line = ",".join(["%.12g"] * table.shape[1])
    found = hashlib.sha256()
    for start in range(0, len(table), _ROWS):
        rows = (table[start : start + _ROWS] + 0.0).tolist()
        found.update(("\n" * (start > 0) + "\n".join(line % tuple(r) for r in rows)).encode())
    return found.hexdigest()
