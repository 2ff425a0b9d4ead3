# SPDX-License-Identifier: BSD-3-Clause
"""Tables in Markdown: their cells, and the keys of a table of a case with what they mean."""

from __future__ import annotations

import inspect
import re
from typing import Any


def docstring(model: type) -> tuple[str, dict[str, str]]:
    """Return a class's docstring without its list of attributes, and the attributes' texts."""
    text = inspect.cleandoc(model.__doc__ or "")
    about, _, attributes = text.partition("Attributes:")
    found: dict[str, str] = {}
    entry = re.compile(r"^    (\w+(?:, \w+)*): (.*(?:\n {8}.*)*)", re.M)
    for names, meaning in entry.findall(attributes):
        for name in names.split(", "):
            found[name] = " ".join(meaning.split()).replace("None for", "leave it out for")
    return " ".join(about.split()), found


def kind(schema: dict[str, Any]) -> str:
    """Return in words what values a key of the JSON schema takes."""
    if "enum" in schema:
        return " ".join(f'`"{word}"`' for word in schema["enum"])
    if "$ref" in schema:
        return "table"
    if schema.get("type") == "array":
        item = schema["items"]
        if "description" in item:
            return f"list of 2 or 3, each {item['description']}"
        return "list of tables" if kind(item) == "table" else f"list of {kind(item)}"
    if "description" in schema and "type" not in schema:
        return str(schema["description"])
    if "anyOf" in schema:
        return " or ".join(kind(part) for part in schema["anyOf"] if part.get("type") != "null")
    if schema.get("type") == "integer":
        if "maximum" in schema:
            return f"whole number from {schema['minimum']} to {schema['maximum']}"
        return f"whole number >= {schema['minimum']}"
    words = {"object": "table", "string": "text", "boolean": "`true` or `false`"}
    return words[schema["type"]]


def default(name: str, schema: dict[str, Any], needed: bool) -> str:
    """Return a key's default as one would write it; empty where leaving it out means none."""
    if needed:
        return "required"
    value = schema.get("default")
    if value in (None, [], "") or isinstance(value, dict):
        return ""
    return f"`{str(value).lower()}`" if not isinstance(value, str) else f'`"{value}"`'


def cell(text: str) -> str:
    """Return text that does not break a Markdown table."""
    return text.replace("|", "\\|")


def keys_table(model: type) -> list[str]:
    """Return the Markdown table of the keys of a model."""
    schema = model.model_json_schema()  # type: ignore[attr-defined]
    _, meanings = docstring(model)
    rows = ["| key | value | default | meaning |", "| --- | --- | --- | --- |"]
    required = schema.get("required", [])
    for name, entry in sorted(schema["properties"].items(), key=lambda p: p[0] not in required):
        needed = name in required
        cells = (f"`{name}`", kind(entry), default(name, entry, needed), meanings.get(name, ""))
        rows.append("| " + " | ".join(cell(part) for part in cells) + " |")
    return rows
