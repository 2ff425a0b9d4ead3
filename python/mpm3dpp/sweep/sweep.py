# SPDX-License-Identifier: BSD-3-Clause
"""A whole sweep."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from mpm3dpp.base.disk import make_folder
from mpm3dpp.case.case import Case
from mpm3dpp.io.foreign import refuse_to_draw

from .numbers import chosen
from .picture import save_sweep
from .plan import plan_of
from .runs import Say, refuse_other_cases, run_all
from .table import table_lines, write_table


@dataclass(frozen=True)
class Swept:
    """What has come of a sweep.

    Attributes:
        lines: the table for the terminal.
        files: the table and the picture.
        failed: how many runs came to no end.
    """

    lines: list[str]
    files: list[Path]
    failed: int


def run_sweep(
    case: Case,
    file: Path,
    sweeps: Sequence[str],
    out: Path,
    jobs: int,
    threads: int | None,
    numbers: Sequence[str],
    pictures: bool,
    say: Say,
) -> Swept:
    """Run a case with every combination of the values of some keys.

    Args:
        case: of the file.
        file: the case file.
        sweeps: `KEY=VALUE,VALUE,...`.
        out: the folder: of each run one, `sweep.csv` and `sweep.png`.
        jobs: runs at a time.
        threads: of each run.
        numbers: that the table and the picture show, see `numbers.numbers_of`.
        pictures: whether each run draws its own.
        say: tells the user as runs end.

    Raises:
        CaseError: a mistake in values or numbers, before any run begins; a folder holds what is
            not of this case; the disk is full.
    """
    plan = plan_of(case, sweeps, out)
    names = chosen(case, numbers)
    make_folder(out)
    refuse_to_draw(out / "sweep.png")
    refuse_other_cases(plan, file)
    outcomes = run_all(plan, file, jobs, threads, pictures, say)
    table = out / "sweep.csv"
    write_table(plan, outcomes, table)
    failed = sum(not outcome.numbers for outcome in outcomes)
    picture = save_sweep(plan, outcomes, names, out / "sweep.png")
    files = [table, *([picture] if picture else [])]
    return Swept(table_lines(plan, outcomes, names), files, failed)
