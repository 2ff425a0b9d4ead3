# SPDX-License-Identifier: BSD-3-Clause
"""`mpm3dpp study`: numbers on several grids, and what they converge to."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import pytest

from commands import CASE, mpm3dpp, one_sentence, write
from mpm3dpp.io import read_manifest
from mpm3dpp.sweep.richardson import CAREFUL, SAFETY, convergence

DOCS = Path(__file__).resolve().parents[2] / "docs" / "how-to"


@pytest.mark.parametrize("order", [0.7, 1.0, 2.0])
@pytest.mark.parametrize("ratio", [1.5, 2.0])
def test_a_power_of_the_cells_is_found(order: float, ratio: float) -> None:
    values = [3.0 - 0.5 * h**order for h in (ratio**2, ratio, 1.0)]
    found = convergence([77.0, *values], ratio)  # of more grids the finest three count
    assert found.order == pytest.approx(order, abs=1e-12)
    assert found.extrapolated == pytest.approx(3.0, abs=1e-12)
    assert found.uncertainty == pytest.approx(SAFETY * 0.5, abs=1e-12)
    assert found.said == ""


def test_a_higher_order_than_the_method_s_is_told_and_not_extrapolated_with() -> None:
    found = convergence([1.0 + h**4 for h in (4.0, 2.0, 1.0)], 2.0)
    assert found.order == pytest.approx(4.0)
    assert found.extrapolated == pytest.approx(2.0 - 15.0 / 3.0)
    assert found.uncertainty == pytest.approx(CAREFUL * 15.0 / 3.0)


@pytest.mark.parametrize(
    ("values", "said", "uncertainty"),
    [
        ([1.0, 2.0, 1.5], "oscillates", 0.5),
        ([1.0, 2.0, 2.0], "oscillates", 0.5),
        ([1.0, 2.0, 4.0], "does not converge", None),
        ([0.0, 1.0, -9.0], "does not converge", None),
        ([1.0, 1.0, 2.0], "does not converge", None),
        ([1.0, 2.0, math.nan], "no number", None),
        ([math.nan, 1.0, 1.0], "no number", None),
        ([1.0, 2.0, 2.9], "too slow to tell", None),
        ([5.0, 5.0, 5.0], "the same", 0.0),
        ([0.0, 0.0, 0.0], "the same", 0.0),
    ],
)
def test_what_tells_no_order(values: list[float], said: str, uncertainty: float | None) -> None:
    found = convergence(values, 2.0)
    assert (found.said, found.uncertainty) == (said, uncertainty)


def test_a_study(tmp_path: Path) -> None:
    """The case of the how-to: a wave runs up a column on which gravity has been put.

    At t = L / c it is at the top and v = -g y / c, so that K = rho A g^2 L^3 / (6 c^2), A the width
    (d'Alembert). The study's error bar holds that, and the extrapolated value is nearer to it; the
    strain, of a millionth, changes nothing that is seen here.
    """
    text = (DOCS / "study-convergence.md").read_text()
    write(tmp_path, text.partition("```toml\n")[2].partition("```")[0])
    words = ("study", "case.toml", "--cells", 3, "--number", "kinetic", "--out", "out")
    done = mpm3dpp(*words, "--jobs", 2, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "[3/3]" in done.stderr
    with open(tmp_path / "out" / "study.csv", newline="") as file:
        rows = {row["number"]: row for row in csv.DictReader(file)}
    row = rows["kinetic"]
    sizes = [name for name in row if name.startswith("cell_size=")]
    assert [float(name.partition("=")[2]) for name in sizes] == pytest.approx([0.08, 0.04, 0.02])
    for name in sizes:
        manifest = read_manifest(tmp_path / "out" / f"grid.{name}")
        assert float(row[name]) == manifest["energies"]["final"]["kinetic"]
    c2 = 1e9 * (1 - 0.3) / ((1 + 0.3) * (1 - 0.6)) / 1000
    answer = 1000 * 0.16 * 9.81**2 / (6 * c2)
    assert math.isclose(manifest["end_time"], 1 / math.sqrt(c2), rel_tol=1e-5)
    finest, bar = float(row[sizes[-1]]), float(row["uncertainty"])
    assert abs(finest - answer) < bar < 1e-3 * answer
    assert abs(float(row["extrapolated"]) - answer) < 0.5 * abs(finest - answer)
    assert 1.5 < float(row["order"]) < 2.5
    assert (tmp_path / "out" / "study.png").stat().st_size > 10_000
    again = mpm3dpp(*words, cwd=tmp_path)
    assert again.stdout == done.stdout and again.stderr.count("was there") == 3


@pytest.mark.slow
def test_other_keys_of_a_study(tmp_path: Path) -> None:
    """The same for all its runs, and one may be taken out."""
    words = ("--set", "run.end_time=50 us", "--set", "title=", "--number", "left.speed")
    done = mpm3dpp("study", write(tmp_path), "--out", "out", *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    folders = [path for path in (tmp_path / "out").iterdir() if path.is_dir()]
    cases = [read_manifest(folder)["case"] for folder in folders]
    assert len(cases) == 3 and len({case["grid"]["cell_size"] for case in cases}) == 3
    assert {case["run"]["end_time"] for case in cases} == {5e-5}
    assert {case["title"] for case in cases} == {""}
    assert "left.speed [m/s]" in done.stdout


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--cells", 2), "--cells = 2 is too few to tell an order; give 3 or more"),
        (("--ratio", 1), "--ratio = 1.0 must be between 1 and 100; give 2"),
        (("--finest", "1 kg"), '--finest = "1 kg" has the unit "kg" (a mass) but must be a length'),
        (("--finest", "-1"), '--finest = "-1" must be > 0'),
        (("--set", "grid.cell_size=1"), "grid.cell_size is what a study changes; give --finest"),
        (("--number", "wall_time"), '--number = "wall_time" converges to nothing; give another'),
        (("--number", "left.sped"), 'did you mean "left.speed"'),
    ],
)
def test_mistakes(tmp_path: Path, words: tuple[object, ...], sentence: str) -> None:
    done = mpm3dpp("study", write(tmp_path), "--out", "out", *words, cwd=tmp_path)
    assert done.returncode == 2 and sentence in one_sentence(done.stderr)
    assert not (tmp_path / "out").exists()


def test_a_run_that_fails_is_told(tmp_path: Path) -> None:
    """A step that the finer grids cannot make."""
    text = CASE.replace("cfl = 0.3", 'time_step = "0.1 ms"')
    words = ("study", write(tmp_path, text), "--out", "out", "--finest", "1 mm")
    done = mpm3dpp(*words, cwd=tmp_path)
    assert done.returncode == 1
    assert "grid.cell_size = 0.001: " in done.stdout and "no order is told" in done.stdout


def test_a_box_that_is_no_whole_cells_of_each_size(tmp_path: Path) -> None:
    box = 'box = { lower = [0, 0], upper = ["160 mm", "80 mm"] }'
    text = CASE.replace("[run]", f"{box}\n[run]")
    words = ("study", write(tmp_path, text), "--out", "out", "--ratio", 1.5)
    done = mpm3dpp(*words, cwd=tmp_path)
    said = one_sentence(done.stderr)
    assert done.returncode == 2 and "does not go with cells of 0.0225 m and 0.015 m" in said
    assert "choose another --ratio" in said


@pytest.mark.slow
def test_a_coarse_grid_that_fails_is_left_out(tmp_path: Path) -> None:
    """The finer ones tell the order all the same; the command ends as one that has failed."""
    words = ("study", write(tmp_path), "--out", "out", "--cells", 5, "--finest", "25 mm")
    done = mpm3dpp(*words, "--number", "left.speed", cwd=tmp_path)
    assert done.returncode == 1
    first, head, *_ = done.stdout.splitlines()
    assert first.startswith("grid.cell_size = 0.4: error: ") and "holds no particle" in first
    assert head.split()[:6] == ["cells", "[mm]", "200", "100", "50", "25"]
