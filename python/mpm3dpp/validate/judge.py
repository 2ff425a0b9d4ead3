# SPDX-License-Identifier: BSD-3-Clause
"""Runs of benchmarks, and how their numbers compare with the answers."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mpm3dpp.base.errors import CaseError, nearest
from mpm3dpp.case.case import Case
from mpm3dpp.io.probe_tables import read_probe
from mpm3dpp.io.read_history import read_history
from mpm3dpp.run.run import run_case

from .benchmark import Benchmark, Figure, Take, value_of

OK, MISSED, KNOWN, REACHED = "ok", "MISSED", "missed", "reached now"


@dataclass(frozen=True)
class Judged:
    """A figure of a run.

    Attributes:
        variant: which run, "" if there is one.
        figure: what was asked.
        value: what was reached.
        answer: what should be.
        tolerance: how far off it may be.
    """

    variant: str
    figure: Figure
    value: float
    answer: float
    tolerance: float

    @property
    def within(self) -> bool:
        """Whether it is as near as it should be."""
        return abs(self.value - self.answer) <= self.tolerance

    @property
    def word(self) -> str:
        """`ok`, `MISSED`; of what is known to be missed `missed`, or `reached now`."""
        if self.figure.missed:
            return REACHED if self.within else KNOWN
        return OK if self.within else MISSED


def judge(
    benchmark: Benchmark,
    threads: int | None = None,
    only: Sequence[str] = (),
    change: Callable[[Case], Case] | None = None,
) -> list[Judged]:
    """Run a benchmark, and return its figures.

    Args:
        benchmark: which.
        threads: of each run.
        only: which of its variants; all by default.
        change: what is changed of each case, such as the frame.

    Raises:
        CaseError: what is taken is no column of the run.
        RunError: a run became unstable.
    """
    found = []
    for variant in only or benchmark.variants:
        with tempfile.TemporaryDirectory() as folder:
            case = benchmark.case(variant)
            case = case if change is None else change(case)
            run_case(case, Path(folder) / "out", threads=threads, pictures=False)
            takes = benchmark.problem.take
            tables = {
                take.probe: _table(Path(folder) / "out", take.probe) for take in takes.values()
            }
        numbers = benchmark.constants(variant)
        numbers |= {name: taken(take, tables[take.probe]) for name, take in takes.items()}
        for figure in benchmark.problem.figure:
            answer = value_of(str(figure.answer), numbers)
            share = figure.share
            off = float(figure.tolerance) if share is None else share * abs(answer)
            value = value_of(figure.value, numbers)
            found.append(Judged(variant, figure, value, answer, off))
    return found


def _table(folder: Path, probe: str) -> dict[str, np.ndarray]:
    """Return the table of a probe, or that of the run."""
    return read_probe(folder, probe) if probe else read_history(folder)


def taken(take: Take, table: dict[str, np.ndarray]) -> float:
    """Return a number of a table.

    Raises:
        CaseError: it has no such column, or no number between those times.
    """
    if take.column not in table:
        where = f"probe.{take.probe}" if take.probe else "history.csv"
        raise CaseError(f"is no column of {where}", nearest(take.column, list(table)))
    values, times = table[take.column], table["time"]
    kept = ~np.isnan(values)
    if take.after is not None:
        kept &= times >= take.after
    if take.before is not None:
        kept &= times <= take.before
    values = values[kept]
    if len(values) == 0:
        raise CaseError(f"has no number of {take.column} between those times", key="take")
    chosen = {"end": -1, "start": 0, "largest": values.argmax(), "smallest": values.argmin()}
    return float(values[chosen[take.at]])
