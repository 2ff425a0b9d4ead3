# SPDX-License-Identifier: BSD-3-Clause
"""Benchmarks as data: their files, what is taken from runs, how figures are judged and told."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import mpm3dpp
from mpm3dpp import CaseError
from mpm3dpp.validate.benchmark import FOLDER, Benchmark, Figure, Problem, Take, names, value_of
from mpm3dpp.validate.judge import Judged, judge, taken
from mpm3dpp.validate.tell import last_line, lines_of, page_of

TABLE = {
    "time": np.array([0.0, 1.0, 2.0, 3.0]),
    "speed": np.array([5.0, math.nan, 9.0, -1.0]),
}


@pytest.mark.parametrize("name", names())
def test_files_can_be_read(name: str) -> None:
    """Their cases are checked, their formulas are of what is known, and they name a source."""
    benchmark = Benchmark.read(FOLDER / f"{name}.toml")
    assert benchmark.problem.source
    assert benchmark.problem.figure


@pytest.mark.slow
@pytest.mark.parametrize("name", names())
def test_figures_are_within_their_tolerances(name: str) -> None:
    benchmark = Benchmark.read(FOLDER / f"{name}.toml")
    judged = judge(benchmark)
    wrong = [one for one in judged if one.within == bool(one.figure.missed)]
    assert not wrong, "\n".join(lines_of(benchmark, judged))


@pytest.mark.parametrize(
    ("at", "after", "before", "value"),
    [
        ("end", None, None, -1.0),
        ("start", None, None, 5.0),
        ("largest", None, None, 9.0),
        ("smallest", None, None, -1.0),
        ("end", None, 2.5, 9.0),
        ("start", 0.5, None, 9.0),
        ("largest", None, 1.5, 5.0),
    ],
)
def test_what_is_taken(at: str, after: float | None, before: float | None, value: float) -> None:
    assert taken(Take(column="speed", at=at, after=after, before=before), TABLE) == value


def test_what_cannot_be_taken() -> None:
    with pytest.raises(CaseError, match=r'is no column of history\.csv; did you mean "speed"'):
        taken(Take(column="sped"), TABLE)
    with pytest.raises(CaseError, match="has no number of speed between those times"):
        taken(Take(column="speed", after=0.5, before=1.5), TABLE)


@pytest.mark.parametrize(
    ("text", "value"),
    [("2 / 3 * v", -2.0), ("v^2", 9.0), ("-v", 3.0), ("abs(v) * sin(pi / 2)", 3.0), ("1e-3", 1e-3)],
)
def test_formulas(text: str, value: float) -> None:
    assert value_of(text, {"v": -3.0}) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize("text", ["w", "v +", "__import__('os')", "v.real", "[v]"])
def test_what_is_no_formula(text: str) -> None:
    with pytest.raises(CaseError, match="is no formula of v"):
        value_of(text, {"v": 1.0})


def figure(**more: Any) -> Figure:
    return Figure(
        **{"title": "speed", "value": "v", "answer": 2.0, "tolerance": "5 %", "why": "x", **more}
    )


@pytest.mark.parametrize("tolerance", ["five", "5", "-1 %", "0 %"])
def test_a_tolerance_that_is_none(tolerance: str) -> None:
    with pytest.raises(CaseError, match=r'tolerance = .* must be a number or a share .* "2 %"'):
        figure(tolerance=tolerance)


@pytest.mark.parametrize(
    ("value", "missed", "word"),
    [
        (2.05, "", "ok"),
        (2.2, "", "MISSED"),
        (2.2, "few cells", "missed"),
        (2.05, "few cells", "reached now"),
        (math.nan, "", "MISSED"),
    ],
)
def test_words(value: float, missed: str, word: str) -> None:
    one = Judged("", figure(missed=missed), value, 2.0, 0.1)
    assert one.word == word
    problem = Problem(
        title="A ball", source="Newton", case={}, take={}, figure=[one.figure], about="It falls."
    )
    benchmark = Benchmark("ball", problem)
    lines = lines_of(benchmark, [one])
    assert lines[0] == "ball: A ball (Newton)"
    assert lines[2].endswith(word)
    assert (f"  speed: {missed}" in lines) == (word == "missed")
    assert ("MISSED" in last_line([one])) == (word == "MISSED")
    page = page_of([(benchmark, [one])])
    assert "## A ball" in page
    assert f"| 0.1 | {word} |" in page
    assert ("Missed: speed: few cells." in page) == bool(missed)


def test_the_command(tmp_path: Path) -> None:
    """It prints a table, writes a page, and ends with 0; mistakes are one sentence."""
    done = mpm3dpp("validate", "spun_disc", "--out", "page.md", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "2 of 2 figures within their tolerances" in done.stdout
    assert "## A disc that spins comes down on a floor" in (tmp_path / "page.md").read_text()
    listed = mpm3dpp("validate", "--list", cwd=tmp_path)
    assert [line.split()[0] for line in listed.stdout.splitlines()] == names()
    lost = mpm3dpp("validate", "taylor_bar", "--out", "none/page.md", cwd=tmp_path)
    assert lost.returncode == 2
    assert "is no folder; make it, or choose another --out" in lost.stderr
    wrong = mpm3dpp("validate", "spun_disk", cwd=tmp_path)
    assert wrong.returncode == 2
    assert 'is no benchmark; did you mean "spun_disc"?' in wrong.stderr
