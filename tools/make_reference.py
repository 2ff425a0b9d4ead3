# SPDX-License-Identifier: BSD-3-Clause
"""Write docs/reference/ from the code, and docs/gallery.md from the examples.

python tools/make_reference.py (mpm3dpp must be installed)

The pages are committed; tests/python/test_reference.py fails while they differ from the code.
"""

from __future__ import annotations

from pathlib import Path

from gallery import gallery_page
from markdown_tables import docstring, keys_table
from material_pages import library_page, materials_page
from reference_python import python_page

from mpm3dpp.base.damping import Damping, MaterialDamping
from mpm3dpp.case import body, box, case, grid, parts, transfer
from mpm3dpp.case.detonation import Detonation
from mpm3dpp.case.initial import Initial
from mpm3dpp.case.loads import Load
from mpm3dpp.case.motion import Motion
from mpm3dpp.case.probe import Probe, ProbeRegion
from mpm3dpp.case.stop import Stop
from mpm3dpp.grains import GrainLattice, GrainPacking, Grains
from mpm3dpp.io import history as terms
from mpm3dpp.io import pair_columns, part_cells
from mpm3dpp.shapes.base import KINDS

NOTE = "Made by `tools/make_reference.py` from the code: do not edit."
# Heading, class, note. The tables of a case in the order in which one writes them.
TABLES: tuple[tuple[str, type, str], ...] = (
    ("grid", grid.Grid, ""),
    ("grid.box", box.GridBox, ""),
    ("grid.box.walls", box.Walls, ""),
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
        "reference/library.md": library_page(NOTE),
        "reference/materials.md": materials_page(NOTE),
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
