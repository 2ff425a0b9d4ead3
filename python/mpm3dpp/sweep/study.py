# SPDX-License-Identifier: BSD-3-Clause
"""A case on ever finer grids: what its numbers converge to, and how sure they are."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from mpm3dpp.base.disk import make_folder
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.units import to_si
from mpm3dpp.case.case import Case
from mpm3dpp.case.changes import changes_of, path_of, value_of, with_changes
from mpm3dpp.io.foreign import refuse_to_draw

from .numbers import chosen, unit_of
from .plan import Planned, plan_of
from .richardson import Converged, convergence
from .runs import Outcome, Say, refuse_other_cases, run_all
from .study_picture import save_study
from .sweep import Swept
from .table import replace_table

KEY = "grid.cell_size"
_LEAST = 3  # grids, of which an order is told
_NOT_COMPARED = ("wall_time", "steps")


def run_study(
    case: Case,
    file: Path,
    cells: int,
    ratio: float,
    finest: str | None,
    changes: Sequence[str],
    out: Path,
    jobs: int,
    threads: int | None,
    numbers: Sequence[str],
    pictures: bool,
    say: Say,
) -> Swept:
    """Run a case on some grids; tell order, extrapolated value and uncertainty of its numbers.

    Args:
        case: of the file.
        file: the case file.
        cells: how many sizes of cells, three at least.
        ratio: of a size to the next, more than 1.
        finest: the smallest size, as a case file has it; by default that of the case.
        changes: `KEY=VALUE` of other keys, the same for all runs.
        out: the folder: of each run one, `study.csv` and `study.png`.
        jobs: runs at a time.
        threads: of each run.
        numbers: that the table and the picture show, see `numbers.numbers_of`.
        pictures: whether each run draws its own.
        say: tells the user as runs end.

    Raises:
        CaseError: a mistake in the sizes or numbers, before any run begins; a folder holds what is
            not of this case; the disk is full.
    """
    if cells < _LEAST:
        raise CaseError("is too few to tell an order", "give 3 or more", key="--cells", value=cells)
    if not 1.0 < ratio < 100.0:
        raise CaseError("must be between 1 and 100", "give 2", key="--ratio", value=ratio)
    given = changes_of(changes)
    if path_of(KEY) in given:
        raise CaseError("is what a study changes", "give --finest", key=KEY)
    case = with_changes(case, given) if given else case
    smallest = case.grid.cell_size if finest is None else _length(finest)
    sizes = [smallest * ratio**k for k in reversed(range(cells))]
    names = chosen(case, numbers)
    for name in names:
        if name in _NOT_COMPARED:
            remedy = "give another, such as kinetic"
            raise CaseError("converges to nothing", remedy, key="--number", value=name)
    plan = _plan(case, changes, sizes, out)
    make_folder(out)
    refuse_to_draw(out / "study.png")
    refuse_other_cases(plan, file)
    outcomes = run_all(plan, file, jobs, threads, pictures, say)
    failures = [
        f"{planned.words()}: {outcome.said}"
        for planned, outcome in zip(plan, outcomes, strict=True)
        if not outcome.numbers
    ]
    failed = len(failures)
    good = next((k for k, o in enumerate(reversed(outcomes)) if not o.numbers), len(outcomes))
    if good < _LEAST:
        rule = "no order is told: the three finest grids must come to their ends"
        return Swept([*failures, rule], [], failed)
    sizes, outcomes = sizes[-good:], outcomes[-good:]
    told = {name: convergence(_values(outcomes, name), ratio) for name in _all_names(outcomes)}
    table = out / "study.csv"
    D = case.grid.dimension
    _write_table(sizes, outcomes, told, D, table)
    shown = {name: told[name] for name in names if name in told}
    picture = save_study(sizes, outcomes, shown, D, out / "study.png")
    return Swept([*failures, *_lines(sizes, outcomes, shown, D)], [table, picture], failed)


def _length(text: str) -> float:
    """Return a length, in metres where no unit is given."""
    try:
        found = to_si(value_of(text), "m")
    except CaseError as error:
        raise CaseError(error.rule, error.remedy, key="--finest", value=text) from None
    if found <= 0.0:
        raise CaseError("must be > 0", 'give one such as "1 mm"', key="--finest", value=text)
    return found


def _plan(case: Case, changes: Sequence[str], sizes: Sequence[float], out: Path) -> list[Planned]:
    try:
        return plan_of(case, [*changes, f"{KEY}={','.join(map(repr, sizes))}"], out)
    except CaseError as error:
        given = " and ".join(f"{size:.6g} m" for size in sizes)
        rule = f"does not go with cells of {given} ({error})"
        remedy = "choose another --ratio, --cells or --finest; a box must be whole cells of each"
        raise CaseError(rule, remedy, key="the case") from None


def _all_names(outcomes: Sequence[Outcome]) -> list[str]:
    everywhere = set.intersection(*(set(outcome.numbers) for outcome in outcomes))
    return [x for x in outcomes[-1].numbers if x in everywhere and x not in _NOT_COMPARED]


def _values(outcomes: Sequence[Outcome], name: str) -> list[float]:
    return [outcome.numbers[name] for outcome in outcomes]


def _write_table(
    sizes: Sequence[float],
    outcomes: Sequence[Outcome],
    told: dict[str, Converged],
    dimension: int,
    path: Path,
) -> None:
    of_sizes = [f"cell_size={size!r}" for size in sizes]
    rows = [["number", "unit", *of_sizes, "order", "extrapolated", "uncertainty", "said"]]
    for name, found in told.items():
        told_of = (found.order, found.extrapolated, found.uncertainty)
        cells = ["" if x is None else repr(x) for x in told_of]
        values = map(repr, _values(outcomes, name))
        rows.append([name, unit_of(name, dimension), *values, *cells, found.said])
    replace_table(path, rows)


def _lines(
    sizes: Sequence[float],
    outcomes: Sequence[Outcome],
    told: dict[str, Converged],
    dimension: int,
) -> list[str]:
    """Return the lines of the table for the terminal, a number each."""
    head = ["cells [mm]", *(f"{1e3 * size:.5g}" for size in sizes)]
    rows = [[*head, "order", "extrapolated", "uncertainty"]]
    for name, found in told.items():
        unit = unit_of(name, dimension)
        cells = [f"{value:.6g}" for value in _values(outcomes, name)]
        order = found.said or f"{found.order:.2f}"
        cells.append(order)
        for number, digits in ((found.extrapolated, 6), (found.uncertainty, 2)):
            cells.append("" if number is None else f"{number:.{digits}g}")
        rows.append([f"{name} [{unit}]" if unit else name, *cells])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    return ["  ".join(map(str.rjust, row, widths)).rstrip() for row in rows]
