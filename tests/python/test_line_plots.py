# SPDX-License-Identifier: BSD-3-Clause
"""Bodies about one cell high: the picture shows values over the coordinate along them."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from mpm3dpp import load_case, open_results, plots, run_case
from mpm3dpp.plots.frames import draw_frame, view_of

ROOT = Path(__file__).parents[2]
CELL, LENGTH = 1e-3, 40


def strip(shape: tuple[int, ...], axis: int = 0) -> SimpleNamespace:
    """Results of one frame: two bodies of so many particles along each axis, four to a cell."""
    lattice = np.stack(np.meshgrid(*[np.arange(n) for n in shape], indexing="ij"), -1)
    points = np.zeros((lattice[..., 0].size, 3))
    points[:, : len(shape)] = 0.5 * CELL * (lattice.reshape(-1, len(shape)) + 0.5)
    points = np.roll(points, axis, axis=1)
    half = points[:, axis] > 0.5 * points[:, axis].max()
    arrays = {
        "position": points,
        "body": half.astype(int),
        "pressure": np.where(half, 3e9, -1e9),
        "size": np.full(len(points), 0.5 * CELL),
    }
    return SimpleNamespace(
        arrays=lambda frame, names=None: arrays,
        fields=list(arrays),
        bodies=["left", "right"],
        materials=["soft", "hard"],
        units={"pressure": "Pa"},
        dimension=max(2, len(shape)),
        cell_size=CELL,
        times=np.array([1e-6]),
    )


@pytest.mark.parametrize(
    ("shape", "axis"), [((80, 2), 0), ((80, 2), 1), ((80, 3), 0), ((80, 2, 2), 0), ((80, 2, 2), 2)]
)
def test_a_line_is_drawn_as_values_over_it(shape: tuple[int, ...], axis: int) -> None:
    results = strip(shape, axis)
    axes = draw_frame(results, 0, "pressure").axes[0]
    assert axes.get_xlabel() == f"{'xyz'[axis]} [mm]"
    assert axes.get_ylabel() == "pressure [GPa]"
    left, right = axes.get_lines()
    assert [line.get_label() for line in (left, right)] == results.bodies
    assert left.get_color() != right.get_color()
    assert set(left.get_ydata()) == {-1.0} and set(right.get_ydata()) == {3.0}
    assert left.get_xdata().max() < 20.0 < right.get_xdata().min()
    low, high = axes.get_ylim()
    assert low < -1.0 and high > 3.0


@pytest.mark.parametrize("shape", [(80, 6), (10, 2), (80, 2, 6)])
def test_other_bodies_are_drawn_as_they_are(shape: tuple[int, ...]) -> None:
    assert view_of(strip(shape), [0], "pressure").along is None


def test_bodies_as_colours_are_drawn_as_they_are() -> None:
    assert view_of(strip((80, 2)), [0], "body").along is None


def test_an_example(tmp_path: Path) -> None:
    """The picture of a run, and of `mpm3dpp plot`, is as high as a curve needs."""
    from PIL import Image

    case = load_case(ROOT / "examples" / "13_sod_tube" / "case.toml")
    case.run.end_time, case.output.frames = 1e-3, 2
    run_case(case, tmp_path, threads=1)
    [again, *_] = plots.plot_results(tmp_path, frame=1, colour="internal_energy")
    for path in (tmp_path / "frame.png", again):
        with Image.open(path) as image:
            assert image.height > 0.4 * image.width
    with open_results(tmp_path) as results:
        axes = draw_frame(results, -1, "internal_energy").axes[0]
    assert axes.get_ylabel().startswith("internal energy [J")
