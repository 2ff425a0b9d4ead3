# SPDX-License-Identifier: BSD-3-Clause
"""Cases with some keys changed: `contact.friction = 0.2` in place of what the file has."""

from __future__ import annotations

import copy
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mpm3dpp.base.errors import CaseError, guessed

from . import file as case_file

if TYPE_CHECKING:
    from .case import Case

Changes = Mapping[tuple[str, ...], Any]
"""A value for each key, given as its path: a number in SI units, text with a unit, a list or a
table; None takes the key out, if it is there."""
_NAMED = ("body", "grains", "material", "load", "probe")  # tables of tables that users name
_MAY_LACK = ("output", "contact")  # tables with a default for every key


def with_changes(case: Case, changes: Changes) -> Case:
    """Return a case of a file with other values of some keys, on top of what was changed before.

    Raises:
        CaseError: it is of no case file, or its objects were changed; there is no such key; or
            what a case breaks.
    """
    if not case._text:
        rule = "the case is of no case file, and only those have keys to change"
        raise CaseError(rule, "change its objects; of another program's file, import it first")
    before = case._changes
    case_type, text, name = type(case), case._text, str(case.source)
    if case.case_hash != _made(case_type, text, name, before).case_hash:
        rule = "objects of this case were changed, which its file does not know of"
        raise CaseError(rule, "load it again, and change keys alone")
    # In the order in which they were made: the last one of a key counts, or of a table about it.
    kept = {k: v for k, v in before.items() if k not in changes}
    return _made(case_type, text, name, kept | dict(changes))


def changed_file(case_type: type[Case], path: Path, changes: Changes) -> Case:
    """Return the case of a file with other values of some keys, which may mend what is wrong in it.

    Raises:
        CaseError: the file cannot be read; there is no such key; or what the changed case breaks.
    """
    case = _made(case_type, case_file.read_text(path), str(path), changes)
    case.note_file(path)
    return case


def _made(case_type: type[Case], text: str, name: str, changes: Changes) -> Case:
    tables = changed_tables(text, name, changes)
    lines = case_file.locate_keys(text, name)
    for key in changes:
        path = tuple(
            int(part) if part.isdigit() and above not in _NAMED else part  # A body may be "1".
            for above, part in zip(("", *key), key, strict=False)
        )
        lines = {at: line for at, line in lines.items() if at[: len(path)] != path}
        for length in range(1, len(path) + 1):  # Tables that the file has not, too.
            lines.setdefault(path[:length], case_file.CHANGED)
    found = case_type.from_tables(tables, name, lines)
    found._text, found._changes = text, dict(changes)
    return found


def path_of(key: str) -> tuple[str, ...]:
    """Return the path of a key such as `contact.pair.0.friction`. Raises `CaseError` for none."""
    path: tuple[str, ...] = ()
    if isinstance(key, str):  # Errors write pair[0] for pair.0.
        path = tuple(part.strip() for part in re.sub(r"\[(\d+)\]", r".\1", key).split("."))
    if not path or not all(path):
        raise CaseError("is no key", 'write one such as "contact.friction"', value=key)
    return path


def paths_of(changes: Mapping[str, Any]) -> Changes:
    """Return changes by the paths of their keys. Raises `CaseError` if they are none."""
    if not isinstance(changes, Mapping):
        raise CaseError("must be a value for each key", 'write {"contact.friction": 0.2}')
    return {path_of(key): value for key, value in changes.items()}


def changed_tables(text: str, name: str, changes: Changes) -> dict[str, Any]:
    """Return the tables of a case file with some keys changed.

    Args:
        text: of the case file.
        name: of the file, for messages.
        changes: what is changed; tables that there are not are made.

    Raises:
        CaseError: a key lies in what is no table, or in a body and the like that there is not.
    """
    tables = case_file.parse(text, name)
    for path, value in changes.items():
        _check_name(tables, path)
        if value is None and path[0] in _MAY_LACK and path[0] not in tables:
            continue  # The key is out already.
        table: Any = tables
        for key in path[:-1]:
            table = _inner(table, key, path, value is not None)
        place = path[-1] if isinstance(table, dict) else _number(table, path[-1], path)
        if value is not None:
            table[place] = copy.deepcopy(value)
        elif isinstance(table, dict):
            table.pop(place, None)
        else:
            del table[place]
    return tables


def assignment(text: str) -> tuple[str, str]:
    """Return key and value, which may be empty, of `KEY=VALUE`. Raises `CaseError` for another."""
    key, sign, value = text.partition("=")
    if not sign or not key.strip():
        remedy = "write KEY=VALUE, such as contact.friction=0.2"
        raise CaseError("is no change of a key", remedy, value=text)
    return key.strip(), value.strip()


def value_of(text: str) -> Any:
    """Return a value as a case file has it; text that is none is itself, as `10 mm`."""
    try:
        return case_file.parse(f"value = {text}", "")["value"]
    except (CaseError, KeyError):
        return text


def changes_of(assignments: Iterable[str]) -> Changes:
    """Return the changes of texts `KEY=VALUE`, or `KEY=` to take a key out.

    Raises:
        CaseError: one is no such text, has several values, or a key is given twice.
    """
    changes: dict[tuple[str, ...], Any] = {}
    for key, value in map(assignment, assignments):
        if path_of(key) in changes:
            raise CaseError("is given twice", "leave one out", key=key)
        if len(values_of(value)) > 1:
            remedy = "run several with `mpm3dpp sweep`, or put a text with commas in quotes"
            raise CaseError("takes one value", remedy, key=key, value=value)
        changes[path_of(key)] = value_of(value) if value else None
    return changes


def values_of(text: str) -> list[str]:
    """Return the values of a list `0.1, 0.2`; commas in brackets and quotes are of a value."""
    found, depth, quote = [""], 0, ""
    for letter in text:
        if quote:
            quote = "" if letter == quote else quote
        elif letter in "\"'":
            quote = letter
        depth += (letter in "[{") - (letter in "]}") if not quote else 0
        if letter == "," and depth == 0 and not quote:
            found.append("")
        else:
            found[-1] += letter
    return [value.strip() for value in found]


def _check_name(tables: dict[str, Any], path: tuple[str, ...]) -> None:
    """Refuse a key of a body and the like that the case has not: a whole one may be added."""
    kind, name = (*path, "", "")[:2]
    if kind not in _NAMED or len(path) <= len(("kind", "name")):
        return
    there = tables.get(kind)
    if isinstance(there, dict) and name not in there:
        rule = f"cannot be changed: there is no {kind}.{name}"
        raise CaseError(rule, guessed(name, there), key=".".join(path))


def _inner(table: Any, key: str, path: tuple[str, ...], make: bool) -> Any:
    """Return the table or list of a key in a table or list; a new one if it may be made."""
    inner = table.get(key) if isinstance(table, dict) else table[_number(table, key, path)]
    if inner is None and make:
        inner = table[key] = {}
    if not isinstance(inner, (dict, list)):
        rule = f"cannot be changed: {key} is no table of the case"
        raise CaseError(rule, "give the key of a value", key=".".join(path))
    return inner


def _number(table: list[Any], key: str, path: tuple[str, ...]) -> int:
    if not key.isdecimal() or int(key) >= len(table):
        rule = f"cannot be changed: {key} is no number of a list of {len(table)}"
        before = ".".join(path[: path.index(key)])
        remedy = f"write its number, from 0: {before}.0; or take all out with {before}="
        raise CaseError(rule, remedy, key=".".join(path))
    return int(key)
