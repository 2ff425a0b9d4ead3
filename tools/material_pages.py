# SPDX-License-Identifier: BSD-3-Clause
"""The pages docs/reference/materials.md, of the models, and library.md, of named materials."""

from __future__ import annotations

from markdown_tables import cell

from mpm3dpp.base.rules import requirement
from mpm3dpp.materials.catalogue import KINDS as MODEL_KINDS
from mpm3dpp.materials.catalogue import catalogue
from mpm3dpp.materials.chosen import ACTIONS
from mpm3dpp.materials.describe import lines_for_a_case, provenance, rows
from mpm3dpp.materials.library import NamedMaterial, library

EOS_USE = {
    "never": "Takes no equation of state.",
    "may": "An equation of state may give its pressure.",
    "must": "Needs an equation of state.",
}


def materials_page(note: str) -> str:
    """Return docs/reference/materials.md."""
    lines = [
        "# Material models",
        f"*{note}*",
        "",
        "The formulas: [theory](../theory/materials.md). A new model:",
        "[Write a material](../how-to/write-a-material.md).",
        "",
        "A material is a density, one strength model,",
        '`strength = { elastic = { E = "70 GPa", nu = 0.3 } }`, at most one equation of state,',
        '`eos = { tait = { c0 = "30 m/s" } }`, and any number of failure models,',
        '`failure = { plastic_strain = { limit = 1.5, action = "no_tension" } }`.',
    ]
    for kind, words in MODEL_KINDS.items():
        plural = "equations of state" if kind == "eos" else f"{words}s"
        lines += [
            "",
            f"## {plural[:1].upper()}{plural[1:]}: `{kind}`",
        ]
        if kind == "failure":
            lines += ["`action` beside the parameters says what becomes of a particle that fails:"]
            lines += [f"- `{word}`: {meaning}." for word, meaning in ACTIONS.items()]
        lines += models_of(kind)
    return "\n".join(lines) + "\n"


def models_of(kind: str) -> list[str]:
    """Return the Markdown lines of all models of a kind."""
    lines: list[str] = []
    for name, model in catalogue(kind).items():
        lines += ["", f"### {name}", f"{model.doc[:1].upper()}{model.doc[1:]}.", ""]
        lines += [EOS_USE[model.eos], ""] if kind == "strength" else []
        lines += [f"Source: {model.source}.", "", "| parameter | unit | meaning | rule | default |"]
        lines += ["| --- | --- | --- | --- | --- |"]
        for p in model.parameters:
            start = "required" if p.default is None else f"{p.default:g}"
            rule = requirement(p.rule) if p.rule else ""
            cells = (f"`{p.name}`", p.unit or "1", p.meaning, rule, start)
            lines.append("| " + " | ".join(cell(part) for part in cells) + " |")
        names = ["internal_energy"] if kind == "eos" else [column.name for column in model.state]
        stored = ", ".join(f"`{name}`" for name in names) or "nothing"
        lines += ["", f"Stores for each particle (for `output.fields`): {stored}."]
    return lines


def library_page(note: str) -> str:
    """Return docs/reference/library.md."""
    lines = [
        "# Named materials",
        f"*{note}*",
        "",
        '`library = "NAME"` in a `[material.X]` table of a case file takes one of these. Beside',
        "it, parameters of the same model replace single numbers,",
        '`strength = { johnson_cook = { A = "900 MPa" } }`, and another model replaces the part;',
        '`without = ["eos"]` leaves a part out. `mpm3dpp check` and the manifest of a run have the',
        "numbers that follow.",
        'A material fails only where the case says so: `failure = "library"` takes the models here',
        'with action `no_tension`; `failure = { library = { action = "erode" } }` with another.',
        "[Check a material](../how-to/check-a-material.md) draws its curves.",
        "",
        "Every number has a source, in the last column. What nothing has confirmed is marked with",
        "an asterisk: compare it with the source before a result depends on it. A number that we",
        "do not know is not here, so some materials have no equation of state.",
    ]
    group = ""
    for material in library().values():
        if material.group != group:
            group = material.group
            lines += ["", f"## {group.capitalize()}"]
        lines += material_lines(material)
    return "\n".join(lines) + "\n"


def material_lines(material: NamedMaterial) -> list[str]:
    """Return the Markdown lines of a named material."""
    lines = ["", f"### {material.name}", f"{material.title}."]
    lines += ["", "```toml", *lines_for_a_case(material), "```", ""]
    lines += ["| part | parameter | value | meaning | source |", "| --- | --- | --- | --- | --- |"]
    for part, name, value, meaning, source in rows(material):
        doubt = " *" if (f"{part.split(' ')[0]}.{name}").strip(".") in material.unconfirmed else ""
        cells = (part, f"`{name}`", value, meaning, source + doubt)
        lines.append("| " + " | ".join(cell(text) for text in cells) + " |")
    lines += ["", *(f"{n}. {text}." for n, text in enumerate(provenance(material), 1))]
    return [*lines, "", material.note] if material.note else lines
