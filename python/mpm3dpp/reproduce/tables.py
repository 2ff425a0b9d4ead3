# SPDX-License-Identifier: BSD-3-Clause
"""The paper's tables 1 and 2 with a column of ours, as Markdown."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from .paper import Program, Table
from .runs import Measured
from .timing import TURNS

MIB = 2**20


def markdown(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """Return the lines of a Markdown table, numbers to the right."""
    rule = ["---", *["---:"] * (len(head) - 1)]
    return [f"| {' | '.join(row)} |" for row in (head, rule, *rows)]


def comparison(table: Table, measured: Measured, size: str) -> list[str]:
    """Return a table of the paper beside what was measured here.

    Args:
        table: of the paper.
        measured: of its example; what is missing is a dash.
        size: of the run, for the head.
    """
    columns = [_paper_column(table, program) for program in table.programs.values()]
    ours = _our_column(measured)
    known = {key for column in [*columns, ours] for key in column}
    order = [key for key in _ROWS if key in known]
    rows = [[key, *[column.get(key, "-") for column in [*columns, ours]]] for key in order]
    head = ["", *[f"{name}, paper" for name in table.programs], f"here, {size}"]
    return markdown(head, rows)


_WORDS = {"off": "without contact", "bonded": "bonded", "on": "with contact"}
_CONTACTS = "contact surfaces; here pairs of bodies that have touched"
_ROWS = (
    "particles",
    "cells of the box",
    "cells in use at most",
    "cells of tiles at most, each body's counted",
    _CONTACTS,
    *(f"time of a step {word} [s]" for word in _WORDS.values()),
    "time with contact / without contact",
    "time with contact / bonded",
    *(f"time {word}, MPM3D / MPM3Dpp" for word in ("without contact", "with contact")),
    *(f"time per particle {word} [ns]" for word in _WORDS.values()),
    "time of a step with contact, mean of the whole run [s]",
    *(f"memory {word}, program [MiB]" for word in _WORDS.values()),
    *(f"memory {word}, core [MiB]" for word in _WORDS.values()),
    "memory with contact / without contact",
    "memory with contact / bonded",
    *(f"memory {word}, MPM3D / MPM3Dpp" for word in ("without contact", "with contact")),
    *(f"memory per particle {word}, program [bytes]" for word in _WORDS.values()),
    *(f"memory per particle {word}, core [bytes]" for word in _WORDS.values()),
    *(f"... of which {name} [bytes]" for name in ("particles", "grid", "contact")),
    "memory of the whole run, process [MiB]",
    "memory of the whole run, process, per particle [bytes]",
    "memory at the end of the whole run, core [MiB]",
    "residual speed [m/s]",
)


def _paper_column(table: Table, program: Program) -> dict[str, str]:
    (off, on), (light, heavy) = program.seconds, program.memory
    column = {
        "particles": f"{table.particles:,}",
        "cells of the box": f"{table.cells:,}",
        **_times({"off": off, "on": on}, {"off": on / off}, table.particles),
        **_memories({"off": MIB * light, "on": MIB * heavy}, table.particles, "program"),
    }
    if program is not list(table.programs.values())[-1]:
        return column
    if table.used is not None:
        column["cells in use at most"] = f"{table.used:.2%}"
    if table.speed is not None:
        column["residual speed [m/s]"] = f"{table.speed[0]:.0f} (experiment {table.speed[1]:.0f})"
    if table.contacts is not None:
        column[_CONTACTS] = f"{table.contacts:,}"
    for what, ratios in zip(("time", "memory"), table.ratios or (), strict=False):
        for turn, ratio in zip(("off", "on"), ratios, strict=True):
            column[f"{what} {_WORDS[turn]}, MPM3D / MPM3Dpp"] = f"{ratio:.3f}"
    return column


def _our_column(measured: Measured) -> dict[str, str]:
    run = measured.runs[-1]
    manifest, cells = run.manifest, run.case.grid.box_cells
    count = manifest["particles"]
    column = {"particles": f"{count:,}"}
    if cells is not None:
        column["cells of the box"] = f"{math.prod(cells):,}"
    if measured.held is not None:
        column["cells in use at most"] = f"{measured.held:.2%}"
    if measured.tiles is not None:
        column["cells of tiles at most, each body's counted"] = f"{measured.tiles:.2%}"
    mean = 1e-9 * manifest["ns_per_particle_step"] * count
    column["time of a step with contact, mean of the whole run [s]"] = f"{mean:.4g}"
    used = sum(manifest["bytes"][name] for name in ("particles", "grid", "contact"))
    column["memory at the end of the whole run, core [MiB]"] = f"{used / MIB:.2f}"
    peak = manifest["peak_memory_bytes"]
    column["memory of the whole run, process [MiB]"] = f"{peak / MIB:.2f}"
    column["memory of the whole run, process, per particle [bytes]"] = f"{peak / count:.0f}"
    if measured.example.table is not None and measured.example.table.contacts is not None:
        touched = sum(pair["pairs"] for pair in manifest["contact"]["pairs"])
        column[_CONTACTS] = f"{touched:,}"
    if measured.speed is not None:
        column["residual speed [m/s]"] = f"{measured.speed:.0f}"
    timed = measured.timed
    if timed is not None:
        ratios = {turn: timed.ratio(turn) for turn in ("off", "bonded")}
        column |= _times({turn: timed.seconds(turn) for turn in TURNS}, ratios, timed.particles)
        column |= _memories({turn: timed.total(turn) for turn in TURNS}, timed.particles, "core")
        for name, size in timed.bytes["on"].items():
            column[f"... of which {name} [bytes]"] = f"{size / timed.particles:.1f}"
    return column


def _times(seconds: dict[str, float], ratios: dict[str, float], particles: int) -> dict[str, str]:
    """Return the rows about time: of each turn [s], and of contact over another turn."""
    rows = {f"time of a step {_WORDS[turn]} [s]": f"{s:.4g}" for turn, s in seconds.items()}
    for turn, ratio in ratios.items():
        rows[f"time with contact / {_WORDS[turn]}"] = f"{ratio:.3f}"
    for turn, s in seconds.items():
        rows[f"time per particle {_WORDS[turn]} [ns]"] = f"{1e9 * s / particles:.0f}"
    return rows


def _memories(sizes: Mapping[str, float], particles: int, of: str) -> dict[str, str]:
    """Return the rows about memory: of each turn [bytes], and of contact over the others."""
    rows = {}
    for turn, size in sizes.items():
        rows[f"memory {_WORDS[turn]}, {of} [MiB]"] = f"{size / MIB:.2f}"
        rows[f"memory per particle {_WORDS[turn]}, {of} [bytes]"] = f"{size / particles:.0f}"
        if turn != "on":
            rows[f"memory with contact / {_WORDS[turn]}"] = f"{sizes['on'] / size:.3f}"
    return rows
