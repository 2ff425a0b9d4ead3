# SPDX-License-Identifier: BSD-3-Clause
"""What the runs of a sweep came to: `sweep.csv`, and lines for the terminal."""

from __future__ import annotations

import csv
import io
import itertools
from collections.abc import Sequence
from pathlib import Path

from mpm3dpp.base.disk import replacing, writing

from .plan import Planned
from .runs import Outcome


def replace_table(path: Path, rows: Sequence[Sequence[str]]) -> None:
    """Write a table as CSV; one of other runs stays, with its picture, as `sweep_1.csv` and so on.

    Raises:
        CaseError: the file cannot be written.
    """
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    keep, picture = None, path.with_suffix(".png")
    if path.exists() and path.read_text(errors="replace") != text.getvalue():
        free = (f"{path.stem}_{k}" for k in itertools.count(1))
        stem = next(stem for stem in free if not path.with_stem(stem).exists())
        keep = path.with_stem(stem)
        if picture.exists():
            with writing(picture):
                picture.replace(picture.with_stem(stem))
    with replacing(path, keep) as file:
        file.write(text.getvalue().encode())


def write_table(plan: Sequence[Planned], outcomes: Sequence[Outcome], path: Path) -> None:
    """Write a row for each run: its folder, the values, how it ended, and all numbers.

    Raises:
        CaseError: the file cannot be written.
    """
    names = list(dict.fromkeys(name for outcome in outcomes for name in outcome.numbers))
    rows = [["folder", *plan[0].values, "status", *names]]
    for planned, outcome in zip(plan, outcomes, strict=True):
        numbers, status = outcome.numbers, "completed" if outcome.numbers else outcome.said
        cells = [repr(numbers[name]) if name in numbers else "" for name in names]
        rows.append([planned.folder.name, *planned.values.values(), status, *cells])
    replace_table(path, rows)


def table_lines(
    plan: Sequence[Planned], outcomes: Sequence[Outcome], names: Sequence[str]
) -> list[str]:
    """Return the lines of a table with some numbers of each run."""
    rows = [[*plan[0].values, *names]]
    for planned, outcome in zip(plan, outcomes, strict=True):
        numbers = outcome.numbers
        cells = [f"{numbers[name]:.6g}" if name in numbers else "" for name in names]
        rows.append([*planned.values.values(), *cells])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = ["  ".join(map(str.rjust, row, widths)).rstrip() for row in rows]
    for k, outcome in enumerate(outcomes):
        lines[k + 1] += "" if outcome.numbers else f"  {outcome.said}"
    return lines
