# SPDX-License-Identifier: BSD-3-Clause
"""The settings that the compiled core has, as fields of a case's tables.

Name, unit, rule, default, words and text of a setting stand in one row of the core (for example in
`cpp/mpm/run/settings.hpp`); nothing is listed here again.
"""

from __future__ import annotations

import textwrap
from collections.abc import Callable
from typing import Annotated, Any, ClassVar

from pydantic import create_model

from mpm3dpp import _core

from .model import CaseModel, Choice, Exactly, Flag
from .rules import Bounds
from .time_functions import TimedAcceleration, TimeFunction
from .units import Quantity


def choice(words: tuple[dict[str, str], dict[str, str]]) -> Choice:
    """Return a choice of the core as the annotation of a field.

    Args:
        words: the words with their meanings, and other words for the same.
    """
    meanings, also = words
    return Choice(tuple(meanings), tuple(also.items()))


def _field(row: dict[str, Any]) -> tuple[Any, Any]:
    """Return type and default of the field for a row of the core."""
    bounds = Bounds(*row["bounds"])
    makers: dict[str, Any] = {
        "number": lambda: Annotated[float, Quantity(row["unit"], row["rule"], bounds)],
        "whole number": lambda: Annotated[int, Exactly(int, int(bounds.lower), int(bounds.upper))],
        "flag": lambda: Flag,
        "word": lambda: Annotated[str, choice(row["words"])],
        "functions of time": lambda: TimedAcceleration,
    }
    made = makers[row["kind"]]()
    if row["required"]:
        return made, ...
    if row["kind"] == "functions of time":
        return made, ()
    return (made if row["default"] is not None else made | None), row["default"]


def core_table(name: str) -> Any:
    """Return a model with the settings of a table of the core, for the table's class to derive of.

    Args:
        name: such as "contact".
    """
    return table_of_rows(name, _core.settings[name], _field)


def table_of_rows(
    name: str, rows: dict[str, dict[str, Any]], field: Callable[[dict[str, Any]], tuple[Any, Any]]
) -> Any:
    """Return a model with a field for each row.

    Args:
        name: of the table.
        rows: of the core, by the fields' names; each has a `meaning`.
        field: gives type and default of the field for a row.
    """
    fields: Any = {key: field(row) for key, row in rows.items()}
    base: Any = create_model(f"Core_{name.replace('.', '_')}", __base__=_CoreTable, **fields)
    base.rows = rows
    base.formerly = {row["formerly"]: key for key, row in rows.items() if row.get("formerly")}
    return base


class _CoreTable(CaseModel):
    """Adds the texts of the core's settings to the docstring of a class that derives of it."""

    rows: ClassVar[dict[str, dict[str, Any]]] = {}

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        if not cls.rows:
            return
        about, section, own = (cls.__doc__ or "").partition("    Attributes:\n")
        entries = [
            textwrap.fill(f"{key}: {row['meaning']}.", 98, **_INDENTS)
            for key, row in cls.rows.items()
        ]
        gap = "" if section else "\n\n"
        cls.__doc__ = f"{about.rstrip(' ')}{gap}    Attributes:\n" + "\n".join([*entries, own])


_INDENTS: dict[str, Any] = {
    "initial_indent": " " * 8,
    "subsequent_indent": " " * 12,
    "break_long_words": False,
}


def fill_core_table(target: Any, table: _CoreTable) -> Any:
    """Set the attributes of a table of the core from that of a case, and return it."""
    for key, row in table.rows.items():
        value = getattr(table, key)
        setattr(target, key, functions(value) if row["kind"] == "functions of time" else value)
    return target


def functions(values: Any) -> list[Any]:
    """Return three functions of time for the core; those missing are zero."""
    given = [
        _core.TimeFunction(**v.for_core())
        if isinstance(v, TimeFunction)
        else _core.TimeFunction(float(v))
        for v in values
    ]
    return [*given, *(_core.TimeFunction(0.0) for _ in range(3))][:3]
