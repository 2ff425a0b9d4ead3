# SPDX-License-Identifier: BSD-3-Clause
"""The table of bases, transfers, schemes and steps: it goes on where it was, and reports."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from verification.table import __main__ as table
from verification.table import fields, report
from verification.table.measures import Watched, noise


def run(monkeypatch: pytest.MonkeyPatch, *words: str) -> None:
    monkeypatch.setattr(sys, "argv", ["table", *words])
    table.main()


def test_rows_are_run_once_and_a_cut_one_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "table.csv"
    asked = ("--out", str(out), "--problems", "vibration,two_bars", "--pairs", "gimp,linear",
             "--schemes", "musl", "--factors", "0.8", "--workers", "1")  # fmt: skip
    run(monkeypatch, *asked)
    assert len(capsys.readouterr().out.splitlines()) == 4
    rows = report.read(out)
    assert abs(float(rows["two_bars", "gimp", "musl", "0.8"]["error"])) < 0.02  # E2's tolerance
    text = out.read_text()
    out.write_text(text[: text.rindex(",")])  # a kill within the last line
    run(monkeypatch, *asked)
    assert capsys.readouterr().out.startswith("1 of 1: ")
    assert {key: row["error"] for key, row in report.read(out).items()} == {
        key: row["error"] for key, row in rows.items()
    }


def test_the_page_and_the_picture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = Path(__file__).parent / "table" / "table.csv"
    run(monkeypatch, "--out", str(file), "--report", str(tmp_path / "choices.md"))
    text = (tmp_path / "choices.md").read_text()
    assert "| quadratic_bspline+aflip=0.97, usf | " in text
    assert (tmp_path / "choices.png").stat().st_size > 10_000
    assert "| mean of all | 0.0" in text
    everything = len(table.PAIRS) * len(table.SCHEMES) * len(table.FACTORS) + 2  # of the frames
    assert len(report.means(report.read(file))) == everything


def test_noise_is_what_a_plane_leaves() -> None:
    x = np.random.default_rng(1).uniform(0.0, 1.0, (400, 2))
    plane = 3.0 + x @ [1.0, -2.0]
    assert noise(x, plane, 0.1) < 1e-13
    assert 0.05 < noise(x, plane + np.resize([0.3, -0.3], 400), 0.1) < 0.15


def test_the_forces_of_the_vortex_hold_it() -> None:
    """At a quarter of the turn the error is of the second order in the cells."""
    errors = []
    for cell in (0.1, 0.05):
        case = fields.vortex(cell, turn=0.25)
        run = Watched(case, "quadratic_bspline+apic@0.25", "musl")
        wrong = run.position("body") - run.start["body"]
        errors.append(np.sqrt((wrong**2).sum(1).mean()))
    assert errors[0] / errors[1] > 3.0, errors
