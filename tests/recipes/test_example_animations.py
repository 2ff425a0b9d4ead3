# SPDX-License-Identifier: BSD-3-Clause
"""Examples 02 to 05 end their run with an animation: the cases made small, by one command."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from mpm3dpp import Case, load_case, plots
from mpm3dpp.plots import space
from mpm3dpp.run.run import run_case
from recipes.test_paper_examples import penetration, spheres
from recipes.test_shaking_grains import short

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CASES = (
    "02_penetration/case.toml",
    "03_thousand_spheres/case.toml",
    "04_shaking_grains/case.toml",
    "04_shaking_grains/case_coarse.toml",
    "05_hopper/case.toml",
    "05_hopper/case_small.toml",
)


def few_grains() -> Case:
    """Return the small hopper with 20 grains."""
    case = load_case(EXAMPLES / "05_hopper" / "case_small.toml")
    packing = case.grains["sand"].packing
    assert packing is not None
    packing.count = 20
    return case


def ends_soon(case: Case, duration: float) -> Case:
    """Return the case with one frame after the first."""
    case.run.end_time = duration
    for name, value in (("interval", None), ("frames", 1)):  # only one of them may be set
        setattr(case.output, name, value)
    return case


@pytest.mark.parametrize("name", CASES)
def test_the_case_wants_an_animation_of_some_frames(name: str) -> None:
    case = load_case(EXAMPLES / name)
    assert case.output.animation
    assert len(case.frame_times()) > 10


@pytest.mark.parametrize(
    ("make", "duration"),
    [
        pytest.param(lambda: penetration(3), 2e-6, marks=pytest.mark.slow),
        pytest.param(lambda: spheres(1), 1e-6, marks=pytest.mark.slow),
        pytest.param(short, 2e-4, marks=pytest.mark.slow),
        pytest.param(few_grains, 2e-3, marks=pytest.mark.slow),
    ],
    ids=["02", "03", "04", "05"],
)
def test_a_run_ends_with_an_animation(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    make: Callable[[], Case],
    duration: float,
) -> None:
    monkeypatch.setattr(space, "_pyvista_works", lambda: False)  # seconds a frame
    monkeypatch.setattr(space, "PIXELS", 300)
    case = ends_soon(make(), duration)
    run_case(case, tmp_path, threads=1)
    with Image.open(tmp_path / "animation.gif") as animation:
        assert animation.n_frames >= 2  # start and end, and where bodies first touch
        assert min(animation.size) > 200


def test_it_may_be_left_out(tmp_path: Path) -> None:
    case = ends_soon(few_grains(), 1e-3)
    run_case(case, tmp_path, threads=1, pictures=False)
    made = plots.plot_results(tmp_path, animation=False)
    assert "animation.gif" not in [path.name for path in made]
