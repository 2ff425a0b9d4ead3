# SPDX-License-Identifier: BSD-3-Clause
"""An imported case as a case file with comments, and its particles as CSV files beside it."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.csv_points import write_points
from mpm3dpp.base.disk import make_folder, write_atomically
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.ours import refuse_link
from mpm3dpp.base.readers import reader_of
from mpm3dpp.case.particles import Particles
from mpm3dpp.grains import GrainCentres

from .imported import Imported

_UNITS = {
    "cell_size": "m",
    "end_time": "s",
    "interval": "s",
    "gravity": "m/s^2",
    "density": "kg/m^3",
    "velocity": "m/s",
    "spacing": "m",
    "point": "m",
}
_POINTS = (Particles, GrainCentres)
_NAMED = ("material", "body", "grains", "load")
_BARE = re.compile(r"[A-Za-z0-9_-]+")


def write_case(found: Imported, target: Path, force: bool = False) -> list[Path]:
    """Write a case file, and beside it a CSV file for each list of particles or grains.

    Args:
        found: what was imported.
        target: the case file; the others are named `NAME_BODY.csv` after it.
        force: write over files that are there, whose they are; but over no link.

    Returns:
        The files written, the case file first.

    Raises:
        CaseError: a file cannot be written, is there already, or is the one that was imported.
    """
    tables = dict(found.tables)
    points: dict[tuple[str, str, str], Particles | GrainCentres] = {}
    for kind in ("body", "grains"):
        for name, entry in tables.get(kind, {}).items():
            points |= {(kind, name, key): v for key, v in entry.items() if isinstance(v, _POINTS)}
    files = [target, *(target.with_name(f"{target.stem}_{name}.csv") for _, name, _ in points)]
    _keep_source(Path(found.name), files)
    there = next((file for file in files if file.exists()), None)
    if there is not None and not force:
        remedy = "give another name with -o, or --force to write over it"
        raise CaseError("is there already", remedy, key=str(there))
    for file in files:
        refuse_link(file)
    make_folder(target.parent)
    origin = Path(found.name).name
    for ((kind, name, key), given), file in zip(points.items(), files[1:], strict=True):
        line = f", line {found.lines[kind, name]}" if (kind, name) in found.lines else ""
        what = "Particles" if kind == "body" else "Grains"
        about = f"{what} of {name} from {origin}{line}; SI units."
        write_points(file, given.columns(), given.table_of_numbers(), about)
        tables[kind] = tables[kind] | {name: tables[kind][name] | {key: file.name}}
    write_atomically(target, case_text(found, tables))
    return files


def _keep_source(source: Path, files: list[Path]) -> None:
    """Refuse to write over what was imported, by whatever name: a link, another path to it."""
    for file in files:
        if (other := reader_of(file)) is not None:
            rule = f"ends in {other.suffix}, so that it would be read as a file of {other.program}"
            raise CaseError(rule, "give a name that ends in .toml with -o", key=str(file))
        try:
            same = file.samefile(source)
        except (OSError, ValueError):
            same = False  # One of them is not there.
        if same:
            rule = "is the file that is imported, which must not be written over"
            raise CaseError(rule, "give another name with -o", key=str(file))


def case_text(found: Imported, tables: dict[str, Any]) -> str:
    """Return the text of the case file; in `tables` particles are names of files."""
    origin = Path(found.name).name
    lines = [
        f"# From {origin}, an input file of {found.program}, "
        f"with units {found.units}; here SI units."
    ]
    lines += [f"# - {_comment(note)}" for note in found.notes]
    lines.append(f"title = {value_text(tables['title'])}")
    for name, table in tables.items():
        if name == "title":
            continue
        if name in _NAMED:
            for key, inner in table.items():
                lines += _section(f"[{name}.{key_text(key)}]", inner, _line(found, name, key))
        elif isinstance(table, list):
            for index, inner in enumerate(table):
                lines += _section(f"[[{name}]]", inner, _line(found, name, index))
        else:
            lines += _section(f"[{name}]", table, "")
    return "\n".join(lines) + "\n"


def _section(head: str, table: dict[str, Any], origin: str) -> list[str]:
    lines = ["", f"{head}{origin}"]
    for key, value in table.items():
        unit = f"  # {_UNITS[key]}" if key in _UNITS else ""
        lines.append(f"{key_text(key)} = {value_text(value)}{unit}")
    return lines


def _line(found: Imported, *path: str | int) -> str:
    line = found.lines.get(path)
    return f"  # line {line}" if line else ""


def _comment(text: str) -> str:
    return "".join(c if c.isprintable() else "?" for c in text)


def key_text(key: str) -> str:
    """Return a key as TOML, quoted if it must be."""
    return key if _BARE.fullmatch(key) else json.dumps(key)


def value_text(value: Any) -> str:
    """Return a value as TOML; numbers come back to the last bit."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, dict):
        inner = ", ".join(f"{key_text(key)} = {value_text(item)}" for key, item in value.items())
        return f"{{ {inner} }}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(value_text, value))}]"
    if isinstance(value, str):
        return json.dumps(_comment(value), ensure_ascii=False)
    return repr(value).lower() if isinstance(value, bool) else repr(value)
