# SPDX-License-Identifier: BSD-3-Clause
"""What `mpm3dpp materials` prints: an overview, or the detail of a model or a named material."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterator
from typing import Any

from mpm3dpp.base.errors import CaseError, nearest
from mpm3dpp.base.rules import requirement

from .catalogue import KINDS, catalogue
from .chosen import ACTIONS
from .examples import example
from .library import ON_REQUEST, NamedMaterial, library

_WIDTH = 100
_CHOICE = {"strength": "one of", "eos": "at most one of", "failure": "any of"}


def listing(name: str | None = None) -> str:
    """Return the models and named materials as text: an overview, or one of them in detail.

    Args:
        name: a model or a named material; None for the overview.

    Raises:
        CaseError: there is no such model or material.
    """
    if name is None:
        return overview()
    if name in library():
        return _named_entry(library()[name])
    for kind in KINDS:
        if name in catalogue(kind):
            return _model_entry(kind, catalogue(kind)[name])
    names = [*library(), *(model for kind in KINDS for model in catalogue(kind))]
    closest = nearest(name, names).partition("?")
    hint = f"{closest[0]}? " if closest[1] else ""
    remedy = f"{hint}mpm3dpp materials lists them all"
    raise CaseError("is not a known model or named material", remedy, value=name)


def overview() -> str:
    """Return one line for each model and each named material, in groups."""
    lines = ["Models: a material has a density, a strength and, if you like, an eos and failure."]
    every = [*library(), *(name for kind in KINDS for name in catalogue(kind))]
    wide = max(len(name) for name in every)
    for kind, words in KINDS.items():
        plural = "equations of state" if kind == "eos" else f"{words}s"
        lines += ["", f"{kind}: {_CHOICE[kind]} these {plural}"]
        for model in catalogue(kind).values():
            lines.append(f"  {model.name:<{wide}}  {_short(model.doc, _WIDTH - wide - 4)}")
    lines += ["", 'Named materials: library = "NAME" in a [material.X] table']
    titles = max(len(material.title) for material in library().values())
    group = ""
    for material in library().values():
        if material.group != group:
            group = material.group
            lines.append(f"{group}:")
        models = ", ".join(model for kind, model, _ in _models_of(material) if kind != ON_REQUEST)
        models += "  +" if ON_REQUEST in material.parts else ""
        doubt = "  *" if material.unconfirmed else ""
        lines.append(f"  {material.name:<{wide}}  {material.title:<{titles}}  {models}{doubt}")
    lines += [
        "",
        '+ has constants of failure, for failure = "library" in a case.',
        "* some numbers could not be confirmed; the detail says which.",
        "mpm3dpp materials NAME prints parameters, units, sources and the lines for a case file;",
        "mpm3dpp material-test NAME draws its stress-strain curve or Hugoniot.",
    ]
    return "\n".join(lines)


def _short(doc: str, width: int) -> str:
    """Return the words of a model's description that come before its formulas and details."""
    words = re.split(r"[:;]|, (?:[A-Za-z]+ = |yielding )| \(|\. ", doc, maxsplit=1)[0]
    words = doc if words.endswith("+") else words
    return textwrap.shorten(words, width, placeholder=" ...")


def _model_entry(kind: str, model: Any) -> str:
    lines = [f"{model.name} ({KINDS[kind]}): {model.doc}", f"  source: {model.source}"]
    lines.append("  parameters:")
    wide = max([len(p.name) for p in model.parameters], default=0)
    for p in model.parameters:
        rule = f", {requirement(p.rule)}" if p.rule else ""
        default = "" if p.default is None else f", default {p.default:g}"
        lines.append(f"    {p.name:<{wide}}  [{p.unit or '1'}] {p.meaning}{rule}{default}")
    if model.state:
        stored = ", ".join(column.name for column in model.state)
        lines.append(f"  stores {stored} (for output.fields)")
    if kind == "strength":
        pressure = {"never": "takes no eos", "may": "an eos may give the pressure"}
        lines.append(f"  {pressure.get(model.eos, 'needs an eos')}")
    if kind == "failure":
        lines.append("  action: what becomes of a particle that fails")
        wide = max(map(len, ACTIONS))
        lines += [f"    {word:<{wide}}  {meaning}" for word, meaning in ACTIONS.items()]
    users = [m.name for m in library().values() if model.name in m.parts.get(kind, {})]
    if users:
        lines.append(f"  named materials that use it: {', '.join(users)}")
    inside = example(kind, model.name)
    if kind == "failure":
        inside = f'{inside.removesuffix(" }")}, action = "no_tension" }}'
    lines.append(f"  case file: {kind} = {{ {model.name} = {inside} }}")
    return "\n".join(lines)


def _models_of(material: NamedMaterial) -> Iterator[tuple[str, str, dict[str, Any]]]:
    """Yield (kind, model, parameters) of a named material."""
    for kind in KINDS:
        for model, given in material.parts.get(kind, {}).items():
            yield kind, model, given


def rows(material: NamedMaterial) -> Iterator[tuple[str, str, str, str, str]]:
    """Yield (part, parameter, value, meaning, source) of each number of a named material.

    The source is the number of one of `material.sources`, counted from 1, or "default of the
    model".
    """

    def source(key: str) -> str:
        found = material.source_of(key)
        return "default of the model" if found is None else str(material.sources.index(found) + 1)

    density = str(material.parts["density"])
    yield "", "density", density, "initial density", source("density")
    for kind, model, given in _models_of(material):
        for p in catalogue(kind)[model].parameters:
            value = given.get(p.name, p.default)
            text = f"{value:g} {p.unit}".strip() if not isinstance(value, str) else value
            yield f"{kind} {model}", p.name, text, p.meaning, source(f"{kind}.{p.name}")


def provenance(material: NamedMaterial) -> list[str]:
    """Return one line for each source of a named material: publication, place, confirmation."""
    lines = []
    for source in material.sources:
        place = f" ({source.where})" if source.where else ""
        checked = f"confirmed: {source.confirmed}" if source.confirmed else "NOT CONFIRMED"
        lines.append(f"{source.text}{place}; {checked}")
    return lines


def lines_for_a_case(material: NamedMaterial) -> list[str]:
    """Return the lines that use a named material in a case file."""
    short = material.name.split("_")[0]
    lines = [f"[material.{short}]", f'library = "{material.name}"']
    if ON_REQUEST in material.parts:
        lines.append(f'# {ON_REQUEST} = "library"  # if it shall fail')
    return lines


def _named_entry(material: NamedMaterial) -> str:
    lines = [f"{material.name} (named material, {material.group}): {material.title}"]
    table = list(rows(material))
    wide, values = (max(len(row[k]) for row in table) for k in (1, 2))
    part = ""
    for where, name, value, meaning, source in table:
        if where != part:
            part = where
            asked = f' (only with {ON_REQUEST} = "library")' if part.startswith(ON_REQUEST) else ""
            lines.append(f"  {part}{asked}")
        mark = f"[{source}]" if source.isdigit() else f"({source})"
        lines.append(f"    {name:<{wide}}  {value:<{values}}  {meaning} {mark}")
    lines.append("  sources:")
    for number, text in enumerate(provenance(material), 1):
        lines += textwrap.wrap(
            text,
            _WIDTH,
            initial_indent=f"    [{number}] ",
            subsequent_indent="        ",
            break_on_hyphens=False,
        )
    if material.note:
        lines += textwrap.wrap(
            f"note: {material.note}", _WIDTH, initial_indent="  ", subsequent_indent="    "
        )
    lines.append("  case file:")
    lines += [f"    {line}" for line in lines_for_a_case(material)]
    [(model, numbers)] = material.parts["strength"].items()
    if numbers:
        key = next((k for k in ("A", "Y0") if k in numbers), list(numbers)[-1])
        value = numbers[key]
        text = f'"{value}"' if isinstance(value, str) else f"{value:g}"
        change = f"strength = {{ {model} = {{ {key} = {text} }} }}"
        words = f"Beside it {change} replaces that number alone; another model replaces the part."
        lines += textwrap.wrap(words, _WIDTH, initial_indent="  ", subsequent_indent="  ")
    return "\n".join(lines)
