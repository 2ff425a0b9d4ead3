# SPDX-License-Identifier: BSD-3-Clause
"""Benchmarks in words: lines for a terminal, and a page."""

from __future__ import annotations

from collections.abc import Sequence

from .benchmark import Benchmark
from .judge import KNOWN, MISSED, REACHED, Judged

HEAD = ("figure", "reached", "answer", "tolerance", "")


def lines_of(benchmark: Benchmark, judged: Sequence[Judged]) -> list[str]:
    """Return a benchmark's lines for a terminal."""
    rows = [_cells(one) for one in judged]
    widths = [max(len(row[k]) for row in [HEAD, *rows]) for k in range(len(HEAD))]

    def line(row: Sequence[str]) -> str:
        first, *rest = (cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        return "  ".join(["", first, *rest]).rstrip()

    lines = [f"{benchmark.name}: {benchmark.problem.title} ({benchmark.problem.source})"]
    lines += [line(HEAD), *map(line, rows)]
    return lines + [f"  {one.figure.title}: {note}" for one in judged if (note := _note(one))]


def last_line(judged: Sequence[Judged]) -> str:
    """Return how many figures are within their tolerances."""
    within = sum(one.within for one in judged)
    known = sum(one.word == KNOWN for one in judged)
    missed = sum(one.word == MISSED for one in judged)
    more = f", {known} missed as is known" if known else ""
    more += f", {missed} MISSED" if missed else ""
    return f"{within} of {len(judged)} figures within their tolerances{more}"


def page_of(all_judged: Sequence[tuple[Benchmark, Sequence[Judged]]]) -> str:
    """Return the page of some benchmarks, in Markdown."""
    figures = [one for _, judged in all_judged for one in judged]
    text = [
        "# Benchmarks",
        "*Made by `mpm3dpp validate --out docs/benchmarks.md`: do not edit.*",
        "",
        "Published problems and closed forms, each a file of `python/mpm3dpp/validate/problems`:",
        "a case with default settings, what is taken from its run, answers, tolerances and their",
        f"reasons, and the source. {last_line(figures)}.",
    ]
    for benchmark, judged in all_judged:
        problem = benchmark.problem
        text += ["", f"## {problem.title}", f"`{benchmark.name}`. Source: {problem.source}."]
        text += [problem.about] if problem.about else []
        text += ["", f"| {' | '.join(HEAD)} |", "| --- | --- | --- | --- | --- |"]
        text += [f"| {' | '.join(_cells(one))} |" for one in judged]
        reasons = dict.fromkeys(one.figure.why for one in judged)
        text += ["", f"Tolerances: {'; '.join(reasons)}."]
        missed = dict.fromkeys(
            f"{one.figure.title}: {one.figure.missed}" for one in judged if one.figure.missed
        )
        text += [f"Missed: {reason}." for reason in missed]
    return "\n".join(text) + "\n"


def _cells(one: Judged) -> tuple[str, ...]:
    title = f"{one.variant}: {one.figure.title}" if one.variant else one.figure.title
    return (title, f"{one.value:.4g}", f"{one.answer:.4g}", f"{one.tolerance:.2g}", one.word)


def _note(one: Judged) -> str:
    if one.word == KNOWN:
        return one.figure.missed
    if one.word == REACHED:
        return "is within its tolerance now: take `missed` out of the file"
    return ""
