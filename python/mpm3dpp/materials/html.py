# SPDX-License-Identifier: BSD-3-Clause
"""Materials as small tables of HTML, which a notebook shows."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from mpm3dpp.base.markup import Html, element, joined, paragraph, table

from .catalogue import KINDS, catalogue

if TYPE_CHECKING:
    from .library import NamedMaterial

_HEAD = ("", "parameter", "value", "unit", "meaning")


def model_html(kind: str, name: str, parameters: Mapping[str, Any], notes: str = "") -> Html:
    """Return a model with its parameters; `notes` stand behind its name."""
    title = element("strong", f"{name} ({KINDS[kind]}){notes}")
    return joined([title, table(_HEAD[1:], _rows(kind, name, parameters), words=4)])


def named_html(material: NamedMaterial) -> Html:
    """Return a material of the library: its numbers, and where they come from."""
    rows = [["", "density", *_split(material.parts["density"]), "initial density"]]
    for kind in KINDS:
        for name, given in material.parts.get(kind, {}).items():
            rows += [[f"{kind} {name}", *row] for row in _rows(kind, name, given)]
    marked = [[*row, _source(material, row)] for row in rows]
    sources = [
        f"{source.text}{f' ({source.where})' if source.where else ''}; "
        + (f"confirmed: {source.confirmed}" if source.confirmed else "NOT CONFIRMED")
        for source in material.sources
    ]
    numbered = element("ol", joined(element("li", source) for source in sources))
    title = element("strong", f"{material.name}: {material.title}")
    note = paragraph(material.note) if material.note else ""
    return joined([title, table((*_HEAD, "source"), marked, words=6), numbered, note])


def _rows(kind: str, name: str, given: Mapping[str, Any]) -> list[list[str]]:
    """Return parameter, value, unit and meaning of each parameter of a model."""
    rows = []
    for parameter in catalogue(kind)[name].parameters:
        value = given.get(parameter.name, parameter.default)
        split = _split(value) if isinstance(value, str) else [f"{value:.6g}", parameter.unit]
        rows.append([parameter.name, *split, parameter.meaning])
    return rows


def _split(value: Any) -> list[str]:
    """Return the number and the unit of a quantity."""
    number, _, unit = str(value).partition(" ")
    return [number, unit]


def _source(material: NamedMaterial, row: list[str]) -> str:
    kind = row[0].partition(" ")[0]
    found = material.source_of(f"{kind}.{row[1]}" if kind else row[1])
    return "default" if found is None else str(material.sources.index(found) + 1)
