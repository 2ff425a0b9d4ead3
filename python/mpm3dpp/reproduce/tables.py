# SPDX-License-Identifier: BSD-3-Clause
"""The paper's tables 1 and 2 with a column of ours, as Markdown."""

from __future__ import annotations

from collections.abc import Sequence

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
    known = {key: None for column in [*columns, ours] for key in column}
    order = [key for key in _ROWS if key in known]
    rows = [[key, *[column.get(key, "-") for column in [*columns, ours]]] for key in order]
    head = ["", *[f"{name}, paper" for name in table.programs], f"here, {size}"]
    return markdown(head, rows)


_ROWS = (
    "particles",
    "cells of the box",
    "cells in use at most",
    "time of a step without contact [s]",
    "time of a step with contact [s]",
    "time with / without contact",
    "time per particle without contact [ns]",
    "time per particle with contact [ns]",
    "time of a step, mean of the whole run with contact [s]",
    "memory without contact [MiB]",
    "memory with contact [MiB]",
    "memory with / without contact",
    "memory per particle without contact [bytes]",
    "memory per particle with contact [bytes]",
    "... of which particles",
    "... of which grid",
    "... of which contact",
    "memory at the end of the whole run [MiB]",
    "residual speed [m/s]",
)


def _paper_column(table: Table, program: Program) -> dict[str, str]:
    off, on = program.seconds
    column = {
        "particles": f"{table.particles:,}",
        "cells of the box": f"{table.cells:,}",
        **_times(off, on, on / off, table.particles),
        **_memories(*(MIB * m for m in program.memory), table.particles),
    }
    if table.used is not None and program is list(table.programs.values())[-1]:
        column["cells in use at most"] = f"{table.used:.2%}"
    if table.speed is not None and program is list(table.programs.values())[-1]:
        column["residual speed [m/s]"] = f"{table.speed[0]:.0f} (experiment {table.speed[1]:.0f})"
    return column


def _our_column(measured: Measured) -> dict[str, str]:
    run = measured.runs[-1]
    manifest, cells = run.manifest, run.case.grid.box_cells
    count = manifest["particles"]
    column = {"particles": f"{count:,}"}
    if cells is not None:
        total = 1
        for number in cells:
            total *= number
        column["cells of the box"] = f"{total:,}"
    if measured.used is not None:
        column["cells in use at most"] = f"{measured.used:.2%}"
    mean = 1e-9 * manifest["ns_per_particle_step"] * count
    column["time of a step, mean of the whole run with contact [s]"] = f"{mean:.4g}"
    used = sum(manifest["bytes"][name] for name in ("particles", "grid", "contact"))
    column["memory at the end of the whole run [MiB]"] = f"{used / MIB:.2f}"
    if measured.speed is not None:
        column["residual speed [m/s]"] = f"{measured.speed:.0f}"
    timed = measured.timed
    if timed is not None:
        off, on = (timed.seconds(turn) for turn in TURNS)
        column |= _times(off, on, timed.ratio(), timed.particles)
        column |= _memories(*(timed.total(turn) for turn in TURNS), timed.particles)
        for name, size in timed.bytes["on"].items():
            column[f"... of which {name}"] = f"{size / timed.particles:.1f}"
    return column


def _times(off: float, on: float, ratio: float, particles: int) -> dict[str, str]:
    return {
        "time of a step without contact [s]": f"{off:.4g}",
        "time of a step with contact [s]": f"{on:.4g}",
        "time with / without contact": f"{ratio:.3f}",
        "time per particle without contact [ns]": f"{1e9 * off / particles:.0f}",
        "time per particle with contact [ns]": f"{1e9 * on / particles:.0f}",
    }


def _memories(off: float, on: float, particles: int) -> dict[str, str]:
    return {
        "memory without contact [MiB]": f"{off / MIB:.2f}",
        "memory with contact [MiB]": f"{on / MIB:.2f}",
        "memory with / without contact": f"{on / off:.3f}",
        "memory per particle without contact [bytes]": f"{off / particles:.0f}",
        "memory per particle with contact [bytes]": f"{on / particles:.0f}",
    }
