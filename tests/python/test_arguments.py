# SPDX-License-Identifier: BSD-3-Clause
"""A wrong call from Python is a `CaseError` in one sentence that names the argument."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import CASE, write
from mpm3dpp import Case, CaseError, Simulation, load_case, open_results, run_case
from mpm3dpp.plots import first_contact, plot_results, preview

NAN = float("nan")
NO_PATH = "must be the path of a file or folder; give text such as"


@pytest.fixture(scope="module")
def simulation() -> Simulation:
    return Simulation(Case.from_text(CASE), threads=1)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("arguments")
    run_case(write(folder), folder / "out", threads=1, pictures=False)
    return folder / "out"


def said(call: Callable[[], Any]) -> str:
    """Return what is said against a call."""
    with pytest.raises(CaseError) as error:
        call()
    assert "\n" not in str(error.value)
    return str(error.value)


@pytest.mark.parametrize(
    ("steps", "rule"),
    [
        (-5, "-5 must be >= 0"),
        (NAN, "NaN must be a whole number"),
        (2.5, "2.5 must be a whole number"),
        ("5", '"5" must be a whole number'),
        (True, "true must be a whole number"),
        (None, "null must be a whole number"),
        (np.ones(2), "must be a whole number"),
    ],
)
def test_steps(simulation: Simulation, steps: Any, rule: str) -> None:
    sentence = said(lambda: simulation.advance(steps))
    assert sentence.startswith("steps = ") and rule in sentence
    assert simulation.step == 0


def test_end_time(simulation: Simulation) -> None:
    for end, rule in (
        (NAN, "be finite"),
        (math.inf, "be finite"),
        (True, "be a time"),
        ([1], "be a time"),
        (np.ones(1), "be a time"),
        (np.array(True), "be a time"),
        ("1 m", "be a time"),
    ):
        sentence = said(lambda end=end: simulation.advance(1, end))
        assert sentence.startswith("end_time = ") and rule in sentence
    other = Simulation(simulation.case, threads=1)
    other.advance(np.int64(1000), "1 ms")
    assert other.time == 1e-3
    other.advance(1000, np.array(2e-3))
    assert other.time == 2e-3


@pytest.mark.parametrize("threads", [0, -1, 1.5, "2", NAN, 10**9])
def test_threads(threads: Any, tmp_path: Path) -> None:
    case = Case.from_text(CASE)
    assert "threads = " in said(lambda: Simulation(case, threads=threads))
    assert "threads = " in said(lambda: run_case(case, tmp_path / "out", threads=threads))
    assert not (tmp_path / "out" / "results.vtkhdf").exists()


def test_cases_and_names(simulation: Simulation) -> None:
    assert "must be a Case; give what mpm3dpp.load_case" in said(lambda: Simulation("case.toml"))
    for wrong in (None, 0, ["left"]):
        assert "body = " in said(lambda wrong=wrong: simulation.column(wrong, "mass"))
        assert "name = " in said(lambda wrong=wrong: simulation.column("left", wrong))
        assert "body = " in said(lambda wrong=wrong: simulation.set_velocity(wrong, []))


@pytest.mark.parametrize(
    "wrong",
    [
        None,
        "x",
        [1, 2],
        [[1], [1, 2]],
        np.full((100, 2), NAN),
        np.zeros((2, 100)),
        np.zeros(200),
        np.zeros((100, 3)),
    ],
)
def test_velocities(simulation: Simulation, wrong: Any) -> None:
    sentence = said(lambda: simulation.set_velocity("left", wrong))
    assert sentence == (
        "velocities must be finite numbers, shape (n, D); give an array of the shape (100, 2), "
        "a row for each particle"
    )
    simulation.set_velocity("left", np.asfortranarray(np.ones((100, 2), dtype=int)))


class InBytes:
    """A path whose text is bytes."""

    def __fspath__(self) -> bytes:
        return b"out"


@pytest.mark.parametrize("wrong", [None, 5, "", [], b"out", InBytes()])
def test_paths(simulation: Simulation, wrong: Any) -> None:
    case = simulation.case
    for name, call in (
        ("path", simulation.save),
        ("path", simulation.restore),
        ("path", load_case),
        ("path", open_results),
        ("case", lambda file: run_case(file, "out")),
        ("out", lambda out: run_case(case, out)),
        ("folder", plot_results),
        ("folder", first_contact),
        ("out", lambda out: preview(case, out)),
    ):
        sentence = said(lambda call=call: call(wrong))
        assert sentence.startswith(f"{name} = ") and NO_PATH in sentence
    assert "must be a file but is a folder" in said(lambda: simulation.save("."))


@pytest.mark.parametrize("wrong", [5, "", [], InBytes()])
def test_folders_of_pictures(finished: Path, wrong: Any) -> None:
    for plot in (plot_results, first_contact):
        sentence = said(lambda plot=plot: plot(finished, out=wrong))
        assert sentence.startswith("out = ") and NO_PATH in sentence


def test_frames(finished: Path) -> None:
    with open_results(finished) as results:
        for wrong in (NAN, 1.5, "a", None):
            for call in (results.arrays, lambda frame: plot_results(finished, frame)):
                assert "frame = " in said(lambda call=call, wrong=wrong: call(wrong))
        with pytest.raises(IndexError, match="it has 6 frames"):
            results.arrays(99)
    assert "has been closed; open it again" in said(lambda: results.arrays(0))
    assert "colour = 5 must be text" in said(lambda: plot_results(finished, colour=5))
