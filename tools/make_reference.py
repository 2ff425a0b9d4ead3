# SPDX-License-Identifier: BSD-3-Clause
"""Write docs/reference/ from the code, and docs/gallery.md from the examples.

python tools/make_reference.py (mpm3dpp must be installed)

The pages are committed; tests/python/test_reference.py fails while they differ from the code.
"""

from __future__ import annotations

import inspect
import re
from pathlib import Path
from typing import Any

from gallery import gallery_page
from reference_python import python_page

from mpm3dpp.base.damping import Damping, MaterialDamping
from mpm3dpp.base.rules import requirement
from mpm3dpp.case import body, case, grid, parts, transfer
from mpm3dpp.case.detonation import Detonation
from mpm3dpp.case.initial import Initial
from mpm3dpp.case.loads import Load
from mpm3dpp.case.motion import Motion
from mpm3dpp.case.probe import Probe, ProbeRegion
from mpm3dpp.case.stop import Stop
from mpm3dpp.grains import GrainLattice, GrainPacking, Grains
from mpm3dpp.io import history as terms
from mpm3dpp.io import pair_columns, part_cells
from mpm3dpp.materials.catalogue import KINDS as MODEL_KINDS
from mpm3dpp.materials.catalogue import catalogue
from mpm3dpp.materials.chosen import ACTIONS
from mpm3dpp.materials.describe import lines_for_a_case, provenance, rows
from mpm3dpp.materials.library import NamedMaterial, library
from mpm3dpp.shapes.base import KINDS

NOTE = "Made by `tools/make_reference.py` from the code: do not edit."
# Heading, class, note. The tables of a case in the order in which one writes them.
TABLES: tuple[tuple[str, type, str], ...] = (
    ("grid", grid.Grid, ""),
    ("grid.box", grid.GridBox, ""),
    ("grid.box.walls", grid.Walls, ""),
    ("grid.outflow_box", grid.GridOutflowBox, ""),
    ("grid.coarsening", grid.GridCoarsening, ""),
    ("run", parts.Run, ""),
    ("run.transfer", transfer.Transfer, "The key with a transfer's name chooses it."),
    ("run.settle", parts.Settle, ""),
    ("run.viscosity", parts.Viscosity, "`viscosity = {}` takes both defaults."),
    ("output", parts.Output, ""),
    ("contact", parts.Contact, ""),
    ("contact.pair", parts.ContactPair, "Written `[[contact.pair]]`, once for each pair."),
    ("material.NAME", case.Material, "[Models](materials.md), and [named ones](library.md)."),
    ("material.NAME.damping", MaterialDamping, ""),
    ("body.NAME", body.Body, ""),
    ("body.NAME.damping", Damping, "Likewise in `grains.NAME`."),
    ("body.NAME.motion", Motion, ""),
    ("body.NAME.initial", Initial, "[More](../how-to/run-a-case.md#begin-under-stress)."),
    (
        "grains.NAME",
        Grains,
        "[Many grains](../how-to/many-grains.md) explains them. Bodies and entries of grains have "
        "different names.",
    ),
    ("grains.NAME.lattice", GrainLattice, ""),
    ("grains.NAME.packing", GrainPacking, ""),
    ("load.NAME", Load, ""),
    ("detonation", Detonation, "Written `[[detonation]]`, once for each point."),
    ("run.stop", Stop, ""),
    ("probe.NAME", Probe, ""),
    ("probe.NAME.region", ProbeRegion, ""),
)


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


def case_page() -> str:
    """Return docs/reference/case.md."""
    lines = [
        "# Case file: every key",
        f"*{NOTE}*",
        "",
        "How to use them: [Run a case](../how-to/run-a-case.md).",
        "",
        'A quantity is text with a unit (`"30 mm"`) or a plain number in the SI unit given in',
        "brackets. A list of 2 or 3 (D numbers) has two in 2D and three in 3D. At the top of the",
        "file may stand `title`, a line of text for pictures and results, and `preset`:",
        '`preset = "paper"` takes the choices of Ma, Zhang & Huang (2010) where the case says',
        "nothing, the linear basis and lattices of particles.",
        "",
        "A function of time is a quantity or a table of one of these forms:",
        '`{ times = ["0 s", "1 ms"], values = [0, 5] }`, linear between and held at the ends;',
        '`{ sine = { amplitude = 5, frequency = "50 Hz" } }`, with `period` in place of',
        "`frequency`, and `phase`, `mean` (default 0) if needed;",
        '`{ ramp = { to = 5, end = "1 ms" } }`, with `from`, `start` (default 0) if needed.',
        "",
        "A formula is a table of the formula, the unit of its value and that of the lengths in it;",
        'units may be left out where they are SI: `{ expression = "2 * sin(pi * x / 50)", unit =',
        '"mm/s", length = "mm" }`.',
    ]
    for heading, model, note in TABLES:
        about, _ = docstring(model)
        lines += ["", f"## {heading}", about, *([note] if note else []), "", *keys_table(model)]
    lines += ["", "## Shapes", "A shape is a table with one of these as its only key."]
    for name, shape in sorted(KINDS.items()):
        about, _ = docstring(shape)
        lines += ["", f"### {name}", about]
        if "shapes" in shape.model_fields:
            lines += ["", f"Its value is the list of shapes itself: `{name} = [{{ ... }}, ...]`."]
        else:
            lines += ["", *keys_table(shape)]
    return "\n".join(lines) + "\n"


def materials_page() -> str:
    """Return docs/reference/materials.md."""
    lines = [
        "# Material models",
        f"*{NOTE}*",
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


EOS_USE = {
    "never": "Takes no equation of state.",
    "may": "An equation of state may give its pressure.",
    "must": "Needs an equation of state.",
}


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


def library_page() -> str:
    """Return docs/reference/library.md."""
    lines = [
        "# Named materials",
        f"*{NOTE}*",
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


def history_page() -> str:
    """Return docs/reference/history.md."""

    def table(columns: dict[str, tuple[str, str]]) -> list[str]:
        lines = ["| column | unit | meaning |", "| --- | --- | --- |"]
        return lines + [f"| `{name}` | {' | '.join(about)} |" for name, about in columns.items()]

    lines = [
        "# The history of a run: `history.csv`",
        f"*{NOTE}*",
        "",
        "The first line names the columns; then comes the start, and a row for each step",
        "(`output.history_every`: of how many steps one is kept; the step at which a frame is",
        "written is kept too, and the last). In 2D energies, momenta, impulses and forces are per",
        "metre of thickness: J/m, N s/m, N/m. How the terms of energy add up: [the energy",
        "ledger](../theory/step.md#the-energy-ledger). In Python `mpm3dpp.io.read_history` reads",
        "the file.",
        "",
        *table({name: (term["unit"], term["meaning"]) for name, term in terms.TERMS.items()}),
        "",
        "Some 16 steps apart, and where a frame is written, a row has these too, those with",
        "`body_A` for each body A (all grains of an entry count as one) if there are no more",
        f"than {part_cells.PART_LIMIT}; with more, each frame has the columns of all bodies",
        "(`results.bodies_at(k)`; `results.history(body)` reads either). Those with `wall_x_min`",
        "are of each face of the box that is not free. How angular momentum adds up: [its",
        "balance](../theory/step.md#the-balance-of-angular-momentum).",
        "",
        *table(
            part_cells.TOTALS
            | {f"body_A_{key}": row for key, row in part_cells.PART_COLUMNS.items()}
            | {f"wall_x_min_{key}": row for key, row in part_cells.WALL_COLUMNS.items()}
        ),
        "",
        "A run with contact has these too, for each pair of bodies; all grains of an entry count",
        "as one body. At the start they are empty.",
        f"With more than {pair_columns.PAIR_LIMIT} pairs they are in `{terms.PAIRS}`, one row for",
        "each pair that touches, with the columns `step`, `time`, `body_a`, `body_b`,",
        "`contact_force_x`, ...",
        "",
        *table(terms.PAIR_MEANINGS),
    ]
    return "\n".join(lines) + "\n"


def pages() -> dict[str, str]:
    """Return all pages: path below docs, text."""
    return {
        "gallery.md": gallery_page(NOTE),
        "reference/case.md": case_page(),
        "reference/history.md": history_page(),
        "reference/library.md": library_page(),
        "reference/materials.md": materials_page(),
        "reference/python.md": python_page(NOTE, {name: model for name, model, _ in TABLES}),
    }


def main() -> None:
    """Write the pages."""
    folder = Path(__file__).resolve().parents[1] / "docs"
    for name, text in pages().items():
        (folder / name).write_text(text)
        print(folder / name)


if __name__ == "__main__":
    main()
