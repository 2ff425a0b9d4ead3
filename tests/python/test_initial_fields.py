# SPDX-License-Identifier: BSD-3-Clause
"""Stresses and states from a CSV file: `initial.fields`."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from commands import CASE
from mpm3dpp import Case, CaseError, Simulation, open_results, run_case
from mpm3dpp.case.initial_fields import InitialFields
from mpm3dpp.run.summary_conditions import condition_lines

METAL = (
    'johnson_cook = { E = "124 GPa", nu = 0.34, A = "90 MPa", B = "292 MPa", n = 0.31, '
    'C = 0.025, m = 1.09, rate0 = 1, T_room = "300 K", T_melt = "1356 K", cp = 383 }'
)


SOFT = 'elastic = { E = "1 MPa", nu = 0.3 }'


def case_of(
    folder: Path, lines: str, initial: str = 'fields = "hot.csv"', strength: str = METAL
) -> Case:
    """Return the case of two blocks, the left one with an `initial`, beside a file of fields."""
    text = CASE.replace(SOFT, strength)
    text = text.replace("[body.right]", f"initial = {{ {initial} }}\n[body.right]")
    (folder / "hot.csv").write_text(lines)
    (folder / "case.toml").write_text(text)
    return Case.from_file(folder / "case.toml")


def test_a_profile_and_its_units(tmp_path: Path) -> None:
    """Places on a line along an axis: constant across it; lengths in mm; the nearest beyond."""
    lines = "x [mm],y [mm],temperature [K],plastic_strain\n0,0,300,0\n0,20,400,0.1\n0,10,310,0.02\n"
    case = case_of(tmp_path, lines, 'fields = { file = "hot.csv", unit = "mm" }')
    sim = Simulation(case, threads=1)
    y = sim.column("left", "position")[:, 1]
    expected = np.interp(y, [0, 0.01, 0.02], [300, 310, 400])
    np.testing.assert_allclose(sim.column("left", "temperature")[:, 0], expected, rtol=1e-14)
    expected = np.interp(y, [0, 0.01, 0.02], [0, 0.02, 0.1])
    np.testing.assert_allclose(sim.column("left", "plastic_strain")[:, 0], expected, atol=1e-14)
    assert (sim.column("right", "temperature") == 298.0).all()
    [line] = [line for line in condition_lines(case) if line.startswith("at the start of left")]
    assert line.endswith("temperature and plastic_strain by 3 places of hot.csv")


def test_a_stress(tmp_path: Path) -> None:
    names = ["stress_xx", "stress_yy", "stress_zz", "stress_xy"]
    lines = f"x,y,{','.join(names[::-1])}\n0,0,4,3,2,1\n"
    sim = Simulation(case_of(tmp_path, lines), threads=1)
    assert (sim.column("left", "stress") == [1.0, 2.0, 3.0, 0.0, 0.0, 4.0]).all()


@pytest.mark.parametrize("D", [2, 3])
def test_linear_fields_are_exact(D: int) -> None:
    """On a grid of axes and between places anywhere, whatever the order of the lines."""
    random = np.random.default_rng(1)
    slope = np.array([3.0, -2.0, 5.0])[:D]
    axes = [np.array([0.0, 0.3, 1.0]), np.array([-1.0, 2.0]), np.array([0.0, 1.0])][:D]
    grid = np.stack(np.meshgrid(*axes), axis=-1).reshape(-1, D)
    anywhere = np.concatenate([grid, random.uniform(0, 1, (20, D))])
    low, high = grid.min(axis=0), grid.max(axis=0)
    places = random.uniform(low, high, (50, D))
    for points in (random.permutation(grid), random.permutation(anywhere)):
        fields = InitialFields(points, {"a": 7.0 + points @ slope})
        np.testing.assert_allclose(fields.at(places)["a"], 7.0 + places @ slope, rtol=1e-12)
    beyond = InitialFields(grid, {"a": grid @ slope}).at(places + 10.0)["a"]
    assert (beyond == (high @ slope)).all()


def test_coordinates_of_single_precision_are_a_profile() -> None:
    """Not slivers of triangles beyond which all is."""
    points = np.array([[0.1, 0.0], [0.1 + 1e-9, 1.0], [0.1, 2.0]])
    fields = InitialFields(points, {"a": np.array([0.0, 1.0, 4.0])})
    found = fields.at(np.array([[0.0, 0.5], [3.0, 1.5]]))["a"]
    assert found == pytest.approx([0.5, 2.5], rel=1e-12)


def test_a_grid_has_no_diagonals() -> None:
    """A mirrored and a turned table give the same, which triangles of a grid would not."""
    grid = np.stack(np.meshgrid(np.arange(4.0), np.arange(3.0)), axis=-1).reshape(-1, 2)
    values = np.random.default_rng(2).uniform(size=len(grid))
    places = np.random.default_rng(3).uniform(0, 2, (40, 2))
    here = InitialFields(grid, {"a": values}).at(places)["a"]
    for q in (np.diag([-1.0, 1.0]), np.array([[0.0, -1.0], [1.0, 0.0]])):
        there = InitialFields(grid @ q.T, {"a": values}).at(places @ q.T)["a"]
        np.testing.assert_allclose(there, here, rtol=0, atol=1e-14)


def test_the_hash_follows_the_numbers(tmp_path: Path) -> None:
    hashes = [
        case_of(tmp_path, f"x,y,temperature\n0,0,{degrees}\n").case_hash
        for degrees in ("300", "310", "300.0")
    ]
    assert hashes[0] == hashes[2] != hashes[1]


def test_a_run_that_goes_on_does_not_begin_again(tmp_path: Path) -> None:
    """A stress that lets the body ring, from its checkpoint; with another file it is another case.

    To 3 %: a run that ended there has a shorter last step, and other steps after it.
    """
    lines = "x,y,stress_xx,stress_yy,stress_zz,stress_xy\n0,0,5e4,0,0,0\n0,0.05,-2e4,0,0,0\n"
    short = {"run.end_time": "3 ms", "output.frames": 2}
    case = case_of(tmp_path, lines, strength=SOFT).with_(short)
    straight, halves = tmp_path / "straight", tmp_path / "halves"
    run_case(case, straight, quiet=True, pictures=False)
    half = case.with_({"run.end_time": "1.5 ms"})
    run_case(half, halves, quiet=True, pictures=False)
    run_case(case, halves, quiet=True, pictures=False, resume=True)
    with open_results(straight) as a, open_results(halves) as b:
        before, there, here = (
            found["stress"] for found in (a.arrays(0), a.arrays(-1), b.arrays(-1))
        )
    largest = np.abs(there).max()
    assert np.abs(there - before).max() > 0.5 * largest
    assert np.abs(here - there).max() < 0.03 * largest
    other = case_of(tmp_path, lines.replace("5e4", "4e4"), strength=SOFT).with_(short)
    with pytest.raises(CaseError, match=r"body\.left\.initial\.fields"):
        run_case(other, halves, quiet=True, pictures=False, resume=True)


MISTAKES = [
    ("x,y\n0,0\n", "must name its columns x,y,z and then some of .*temperature.*, which is: "),
    ("x,y,heat\n0,0,1\n", "must name its columns x,y,z and then some of"),
    ("x,y,damage,damage\n0,0,1,1\n", "each once"),
    ("x,y,z,temperature\n0,0,0,300\n", "has 3 coordinates, and grid.dimension = 2"),
    ("x,y,burn_fraction\n0,0,1\n", "has the column burn_fraction, which is no state of this"),
    ("x,y,temperature\n0,0,-1\n", "gives temperature from -1 to -1; it must be >= 0"),
    ("x,y,temperature\n0,0,nan\n", "must have finite numbers, in line 2"),
    ("x,y,temperature [C]\n0,0,20\n", r"gives temperature in \[C\] in line 1 but must be in K"),
    ("x,y,stress_xx\n0,0,1\n", "must have all components of the stress in 2D, or none; they are"),
    ("x,y,temperature\n0,0,1\n0,1,2\n0,1,3\n", "has one place twice, in lines 3 and 4; leave one"),
    ("x,y,temperature\n0,0,1\n0,1e-9,1\n0,1,3\n", "has one place twice, in lines 2 and 3"),
    ("x,y,temperature\n0,0,1\n1,1,2\n2,2,1\n", "on a line or in a plane that is along no axis"),
]


@pytest.mark.parametrize(("lines", "message"), MISTAKES)
def test_mistakes(tmp_path: Path, lines: str, message: str) -> None:
    with pytest.raises(CaseError, match=message) as caught:
        Simulation(case_of(tmp_path, lines))
    assert "body.left.initial.fields" in str(caught.value)


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ("state = { temperature = 400 }", "gives temperature, and so does the key state"),
        ("stress = [1, 2, 3, 4]", "gives the stress, and so does the key stress"),
    ],
)
def test_given_twice(tmp_path: Path, keys: str, message: str) -> None:
    lines = "x,y,temperature,stress_xx,stress_yy,stress_zz,stress_xy\n0,0,300,1,2,3,4\n"
    with pytest.raises(CaseError, match=message):
        case_of(tmp_path, lines, f'{keys}, fields = "hot.csv"')
