# SPDX-License-Identifier: BSD-3-Clause
"""Objects of a case as a small table, which a notebook shows: what was given, in SI units."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from .markup import Html, element, joined, table

_MOST_ROWS, _MOST_ITEMS, _LONGEST = 40, 8, 300


def model_html(model: Any) -> Html:
    """Return the HTML of a `CaseModel`: a row for each key, or each table of its tables."""
    rows = list(_rows(model, ""))
    shown = rows[:_MOST_ROWS]
    if len(rows) > len(shown):
        shown.append(("\N{HORIZONTAL ELLIPSIS}", f"and {len(rows) - len(shown):,} more"))
    cells = [(element("code", key), text) for key, text in shown]
    title = getattr(model, "title", "")
    name = type(model).__name__ + (f": {title}" if isinstance(title, str) and title else "")
    return joined([element("strong", name), table(("key", "value"), cells, words=2)])


def _rows(model: Any, prefix: str) -> Iterator[tuple[str, str]]:
    """Yield key and value of what was given; of a table of tables one row for each."""
    for key, field in type(model).model_fields.items():
        value = getattr(model, key)
        if key not in model.model_fields_set or value is None or key == "title":
            continue
        tables = isinstance(value, dict) and any(map(_is_model, value.values()))
        if tables:
            yield from ((f"{prefix}{key}.{name}", _text(one, "")) for name, one in value.items())
        else:
            yield f"{prefix}{key}", _text(value, _unit(field))


def _text(value: Any, unit: str, depth: int = 4) -> str:
    """Return a value as in a case file, without braces around the outermost table."""
    text = _words(value, unit, depth)
    if text.startswith("{ ") and text.endswith(" }"):
        text = text[2:-2]
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 1]}\N{HORIZONTAL ELLIPSIS}"


def _words(value: Any, unit: str, depth: int) -> str:
    if depth == 0:
        return "\N{HORIZONTAL ELLIPSIS}"
    if hasattr(value, "parameters") and hasattr(value, "model"):  # A model of a material.
        return _words(value.table(), "", depth)
    if _is_model(value):
        given = {
            key: _words(getattr(value, key), _unit(field), depth - 1)
            for key, field in type(value).model_fields.items()
            if key in value.model_fields_set and getattr(value, key) is not None
        }
        shape = getattr(type(value), "kind", "")
        return f"{{ {shape} = {_braced(given)} }}" if shape else _braced(given)
    if isinstance(value, dict):
        return _braced({str(key): _words(one, "", depth - 1) for key, one in value.items()})
    if isinstance(value, list | tuple):
        some = [_words(one, "", depth - 1) for one in value[:_MOST_ITEMS]]
        if len(value) > len(some):
            some.append(f"\N{HORIZONTAL ELLIPSIS} ({len(value):,})")
        return f"[{', '.join(some)}]{f' {unit}' if unit and value else ''}"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:.6g}{f' {unit}' if unit else ''}"
    return str(value)


def _braced(given: dict[str, str]) -> str:
    if not given:
        return "{}"
    pairs = [f"{key} = {text}" for key, text in list(given.items())[:_MOST_ITEMS]]
    if len(given) > len(pairs):
        pairs.append("\N{HORIZONTAL ELLIPSIS}")
    return f"{{ {', '.join(pairs)} }}"


def _is_model(value: Any) -> bool:
    return hasattr(type(value), "model_fields")


def _unit(field: Any) -> str:
    """Return the SI unit of a field; empty for none."""
    return next((rule.unit for rule in field.metadata if hasattr(rule, "unit")), "")
