# SPDX-License-Identifier: BSD-3-Clause
"""Run the verification problems and write their table."""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

from .figure import Figure
from .matrix import page, rows_of, updated
from .runs import RUNS, Run


def number(value: float | None) -> str:
    """Write a number in at most six figures."""
    return "-" if value is None else "none" if math.isnan(value) else f"{value:.6g}"


def row(run: Run, figure: Figure) -> str:
    """Return a row of the table."""
    if isinstance(figure.tolerance, tuple):
        tolerance = f"{number(figure.tolerance[0])} to {number(figure.tolerance[1])}"
    else:
        tolerance = "-" if figure.tolerance is None else f"± {number(figure.tolerance)}"
    verdict = "reported" if not figure.judged else "pass" if figure.passed else "**FAIL**"
    name = f"{figure.name} [{figure.unit}]" if figure.unit else figure.name
    remark = f" ({figure.remark})" if figure.remark else ""
    cells = (_name(run), _options(run), name + remark, number(figure.ours))
    return "| " + " | ".join([*cells, number(figure.answer), tolerance, verdict]) + " |\n"


def _name(run: Run) -> str:
    return f"{run.problem} {run.make.__name__} {run.scheme} {run.dimension}D {run.basis}"


def _options(run: Run) -> str:
    return ", ".join(f"{k} {v}" for k, v in run.options.items()) or "default"


def main() -> None:
    """Run what was asked for; print every row as it comes, write the page at the end."""
    parser = argparse.ArgumentParser(prog="python -m verification", description=__doc__)
    parser.add_argument("--only", help="problems, separated by commas: E5,E6")
    parser.add_argument("--quick", action="store_true", help="leave out the long runs")
    parser.add_argument("--basis", help="one basis only")
    parser.add_argument("--out", type=Path, help="the page to write")
    parser.add_argument("--again", type=Path, help="run nothing: the rows of a page written before")
    parser.add_argument(
        "--update",
        type=Path,
        help="a page, in which rows of these runs are replaced",
    )
    parser.add_argument("--workers", type=int, default=1, help="runs at a time, each on one core")
    chosen = parser.parse_args()
    if chosen.again:
        (chosen.out or chosen.again).write_text(page(rows_of(chosen.again.read_text())))
        return
    only = chosen.only.split(",") if chosen.only else None
    runs = [
        run
        for run in RUNS
        if not (only and run.problem not in only)
        and not (chosen.quick and run.slow)
        and not (chosen.basis and run.basis not in (chosen.basis, "-"))
    ]
    old = rows_of(chosen.update.read_text()) if chosen.update else []
    rows, judged, passed, seconds = [], 0, 0, 0.0
    for run, (figures, stopped, took) in zip(runs, _done(runs, chosen.workers), strict=True):
        seconds += took
        lines = [row(run, figure) for figure in figures]
        judged += sum(f.judged for f in figures) + bool(stopped)
        passed += sum(f.judged and f.passed for f in figures)
        if stopped:
            where = f"| {_name(run)} | {_options(run)} "
            lines.append(f"{where}| stopped: {stopped} | none | - | - | **FAIL** |\n")
        print(*lines, sep="", end="", flush=True)
        rows.append((run.problem, lines))
    total = f"{passed} of {judged} figures with a tolerance are within it"
    print(f"{total}; {seconds:.0f} s")
    if chosen.update:
        rows = updated(old, rows)
    if out := chosen.out or chosen.update:
        out.write_text(page(rows))


def _done(runs: list[Run], workers: int) -> Iterator[tuple[list[Figure], str, float]]:
    """Make the runs, so many at a time; what they found, in their order."""
    if workers == 1:
        yield from map(Run.figures, runs)
        return
    with ProcessPoolExecutor(workers) as pool:
        yield from pool.map(Run.figures, runs)


if __name__ == "__main__":
    main()
