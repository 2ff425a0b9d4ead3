# SPDX-License-Identifier: BSD-3-Clause
"""CSV files of points: coordinates and one more number each, with a line of names at the top.

Blank lines and lines that begin with `#` are skipped. Numbers are in SI units; a unit in brackets
behind a name, `x [m]`, must say so.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import CaseError, violation

Array = NDArray[np.float64]
_COLUMN = re.compile(r"\s*(\w+)\s*(?:\[\s*(.*?)\s*\])?\s*")


@dataclass(frozen=True)
class Layout:
    """What a file of points holds beside the coordinates.

    Attributes:
        extra: name of the last column.
        units: its SI unit in 2D and 3D.
        needed: whether it must be there.
        thing: what a line is, for messages.
        give: remedy that tells where the columns are described.
    """

    extra: str
    units: tuple[str, str]
    needed: bool
    thing: str
    give: str


@dataclass(frozen=True)
class Points:
    """The numbers of a file, shape (n, columns), the dimension and the lines that hold them."""

    table: Array
    dimension: int
    lines: list[tuple[int, str]]


def read_points(path: Path, name: str, layout: Layout) -> Points:
    """Read a file of points.

    Args:
        path: the file.
        name: its name in messages.
        layout: its columns.

    Raises:
        CaseError: the file is missing or malformed; the rule names the line.
    """
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
        raise CaseError("is empty", layout.give, value=name)
    width, dimension = _header(*lines[0], name, layout)
    if len(lines) == 1:
        rule = f"holds no {layout.thing}"
        raise CaseError(rule, f"add a line for each {layout.thing}", value=name)
    return Points(_numbers(lines[1:], width, name, layout), dimension, lines[1:])


def _header(number: int, line: str, name: str, layout: Layout) -> tuple[int, int]:
    """Return the number of columns and the dimension that the line of names tells."""
    matches = [_COLUMN.fullmatch(word) for word in line.split(",")]
    names = [match.group(1) if match else "?" for match in matches]
    units = [match.group(2) if match else None for match in matches]
    for dimension in (2, 3):
        wanted = [*"xyz"[:dimension], layout.extra]
        if names == wanted or (names == wanted[:-1] and not layout.needed):
            right = [*["m"] * dimension, layout.units[dimension - 2]]
            for unit, si, word in zip(units, right, names, strict=False):
                if unit not in (None, si):
                    rule = f"gives {word} in [{unit}] in line {number} but must be in {si}"
                    raise CaseError(rule, "convert the column to SI units", value=name)
            return len(names), dimension
    choices = f"x,y,z,{layout.extra}" if layout.needed else f"x,y,z or x,y,z,{layout.extra}"
    rule = f"must name its columns {choices} (in 2D without z) in line {number}"
    raise CaseError(f"{rule}, which is: {short(line)}", layout.give, value=name)


def _numbers(lines: list[tuple[int, str]], width: int, name: str, layout: Layout) -> Array:
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
            raise CaseError(rule, layout.give, value=name)
        for word in words:
            try:
                float(word)
            except ValueError:
                rule = f"has {short(word.strip())} in line {number}, which is no number"
                raise CaseError(rule, layout.give, value=name) from None
    raise CaseError("cannot be read as numbers", layout.give, value=name)


def short(text: str) -> str:
    """Return a line of a file between quotation marks, at most 40 characters."""
    text = " ".join(text.split())
    return f'"{text}"' if len(text) <= 40 else f'"{text[:37]}..."'


class FromFile:
    """Annotation of a field of a case: an object, or the name of a file beside the case file.

    Args:
        kind: the object's class.
        read: makes one of a path and a name for messages.
        what: it is, for messages.
        example: a name of a file.
    """

    def __init__(
        self, kind: type, read: Callable[[Path, str], Any], what: str, example: str
    ) -> None:
        self.kind, self.read, self.what, self.example = kind, read, what, example

    def parse(self, value: Any, info: Any) -> Any:
        """Return the object, or raise the violation that pydantic collects."""
        if value is None or isinstance(value, self.kind):
            return value
        if not isinstance(value, str):
            rule = f"must be the name of a file of {self.what}"
            raise violation(rule, f'for example "{self.example}"', value=value)
        folder = Path((info.context or {}).get("folder", "."))
        try:
            return self.read(folder / value, value)
        except CaseError as error:
            raise violation(error.rule, error.remedy, value=value) from None

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.with_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        return {"type": "string"}
