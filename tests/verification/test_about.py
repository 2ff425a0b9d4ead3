# SPDX-License-Identifier: BSD-3-Clause
"""What the words beside the tables say, held to the figures."""

import re
from pathlib import Path

import pytest

from verification import bars, matrix
from verification.runs import RUNS

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize(
    ("cells", "speed", "passes"), [(50, 0.1, True), (100, 0.03, True), (100, 0.1, False)]
)
def test_two_bars_at_small_speeds(cells: int, speed: float, passes: bool) -> None:
    """about.md: the linear basis is right where no stressed point crosses a cell."""
    figures = bars.two_bars("musl", 2, "linear", cells, speed)
    judged = {figure.name: figure for figure in figures if figure.judged}
    assert all(figure.passed for figure in judged.values()) == passes
    stress = judged["contact stress"]
    assert stress.ours / stress.answer - 1 == pytest.approx(0.0 if passes else -0.025, abs=5e-3)


def test_the_dam_s_front_is_that_of_the_page() -> None:
    page = (ROOT / "docs" / "verification.md").read_text()
    [told] = re.findall(r"W1 dam_break usf 2D updated.*?at most \((.*?)\)", page)
    found = dict(part.split(": ") for part in told.split(", "))
    rows = (ROOT / "examples" / "15_dam_break" / "README.md").read_text().splitlines()
    [times] = [row.split("|")[2:-1] for row in rows if row.startswith("| T ")]
    [ours] = [row.split("|")[2:-1] for row in rows if row.startswith("| here ")]
    assert {t.strip(): z.strip() for t, z in zip(times, ours, strict=True)}.items() <= found.items()


def test_the_page_is_what_its_rows_and_about_md_give() -> None:
    text = (ROOT / "docs" / "verification.md").read_text()
    remedy = "run  python -m verification --again ../docs/verification.md  in tests/"
    assert text == matrix.page(matrix.rows_of(text)), remedy


def test_every_problem_has_a_row_in_the_summary() -> None:
    assert {run.problem for run in RUNS} == set(matrix.SUBJECTS)
    verdicts = [("2D", "pass"), ("2D", "**FAIL**"), ("3D", "pass"), ("3D", "reported")]
    line = "| E1 vibration usf {} default | - | drift | 1 | 1 | ± 1 | {} |\n"
    rows = [("E1", [line.format(*verdict) for verdict in verdicts])]
    said = matrix.summary(rows)
    assert said.startswith("2 of 3 figures")
    assert "| [E1](#e1) vibration of a bar | 2D 1/2, 3D 1/1 |\n" in said


def test_rows_of_runs_made_again_take_the_old_ones_place() -> None:
    def line(problem: str, options: str, ours: int) -> str:
        return (
            f"| {problem} vibration usf 2D default | {options} | drift | {ours} | 1 | - | pass |\n"
        )

    old = [("E1", [line("E1", "cells 8", 1), line("E1", "cells 8", 2), line("E1", "cells 16", 3)])]
    again = [("E1", [line("E1", "cells 8", 7)]), ("E2", [line("E2", "default", 9)])]
    assert matrix.updated(old, again) == [
        ("E1", [line("E1", "cells 8", 7), line("E1", "cells 16", 3)]),
        ("E2", [line("E2", "default", 9)]),
    ]
