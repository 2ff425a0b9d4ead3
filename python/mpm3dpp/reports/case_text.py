# SPDX-License-Identifier: BSD-3-Clause
"""The section on the case: the text of its file, or its tables written as one."""

from __future__ import annotations

from typing import Any

from mpm3dpp.base.markup import Html, details, element, joined, paragraph
from mpm3dpp.importers.write import key_text, value_text

from .document import Section
from .found import Found
from .numbers import counted

_NAMED = ("material", "body", "grains", "load", "probe")


def case(found: Found) -> Section:
    """Return the section on the case."""
    manifest, sentence = found.manifest, ""
    text = manifest.case_text if manifest is not None else ""
    if manifest is not None and manifest.case_file:
        sentence = f"From {manifest.case_file}."
    if not text and found.case:
        text = toml_of(found.case)
        sentence += (
            " The case as it was run, in SI units and with all defaults: keys of its file were "
            "changed, or it was imported or made in Python."
            if manifest is not None
            else "As the last checkpoint has it, in SI units and with all defaults."
        )
    if not text:
        body = paragraph("A run records its case in its checkpoints and at its end: none is there.")
        return _section(body)
    title = f"The whole case, {counted(len(text.splitlines()), 'line')} of TOML"
    code = element("pre", element("code", text))
    return _section(joined([paragraph(sentence.strip()), details(title, code)]))


def _section(body: Html) -> Section:
    return Section("case", "Case", body)


def toml_of(tables: dict[str, Any]) -> str:
    """Return a case's tables as the text of a case file; what is empty is left out."""
    plain = _without_nothing(tables)
    lines = [f"{key_text(k)} = {value_text(v)}" for k, v in plain.items() if not _is_table(v)]
    for name, value in plain.items():
        if not _is_table(value):
            continue
        if isinstance(value, list):
            for entry in value:
                lines += _lines(f"[[{name}]]", entry)
        elif name in _NAMED:
            for key, entry in value.items():
                lines += _lines(f"[{name}.{key_text(key)}]", entry)
        else:
            lines += _lines(f"[{name}]", value)
    return "\n".join(lines).strip("\n") + "\n"


def _is_table(value: Any) -> bool:
    return isinstance(value, dict) or (isinstance(value, list) and isinstance(value[0], dict))


def _lines(head: str, table: dict[str, Any]) -> list[str]:
    return ["", head, *(f"{key_text(k)} = {value_text(v)}" for k, v in table.items())]


def _without_nothing(value: Any) -> Any:
    """Return plain data without None and empty lists."""
    if isinstance(value, dict):
        return {k: _without_nothing(v) for k, v in value.items() if v is not None and v != []}
    return [_without_nothing(v) for v in value] if isinstance(value, list) else value
