# SPDX-License-Identifier: BSD-3-Clause
"""`preset = "paper"`: the paper's choices where a case says nothing."""

from __future__ import annotations

from pathlib import Path

import pytest

from mpm3dpp import Case, CaseError, Grid, load_case
from mpm3dpp.fill.build import build

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CASE = """
preset = "paper"
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 ms"
[material.soft]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.disc]
material = "soft"
shape = { disc = { centre = [0, 0], radius = "5 mm" } }
[grains.sand]
material = "soft"
lattice = { lower = ["20 mm", 0], count = [2, 1], radius = "5 mm" }
"""


def test_it_gives_the_linear_basis_and_lattices() -> None:
    case = Case.from_text(CASE)
    assert case.grid.basis == "linear"
    assert [case.filled_by(part) for part in case.parts()] == ["lattice", "lattice"]
    # By hand: points (i, j) + 1/2 with (i + 1/2)^2 + (j + 1/2)^2 < 100: 316 in a radius of 10.
    assert [len(body.positions) for body in build(case)] == [316] * 3


def test_what_the_case_says_goes_before_it() -> None:
    text = CASE.replace('"1 mm"\n', '"1 mm"\nbasis = "gimp"\n', 1)
    text = text.replace("[grains", 'fill = "shells"\n[grains')
    case = Case.from_text(text + 'fill = "shells"\n')
    assert case.grid.basis == "gimp"
    assert [case.filled_by(part) for part in case.parts()] == ["shells", "shells"]


def test_it_is_the_same_case_as_the_one_that_is_spelled_out() -> None:
    case = Case.from_text(CASE)
    spelled = CASE.replace('preset = "paper"\n', "").replace('"1 mm"\n', '"1 mm"\nbasis="linear"\n')
    spelled = spelled.replace("[grains", 'fill = "lattice"\n[grains') + 'fill = "lattice"\n'
    assert Case.from_text(spelled).case_hash == case.case_hash
    assert Case.model_validate(case.table()).case_hash == case.case_hash
    shells = spelled.replace('"lattice"\n[', '"shells"\n[')
    assert Case.from_text(shells).case_hash != case.case_hash


def test_in_python_it_completes_a_grid_without_a_basis() -> None:
    text = Case.from_text(CASE)
    tables = {"preset": "paper", "run": text.run, "material": text.material, "body": text.body}
    assert Case(grid=Grid(dimension=2, cell_size=0.1), **tables).grid.basis == "linear"
    given = Grid(dimension=2, cell_size=0.1, basis="gimp")
    assert Case(grid=given, **tables).grid.basis == "gimp"


def test_another_word_is_a_mistake() -> None:
    with pytest.raises(CaseError, match='preset = "papers" is not a known choice'):
        Case.from_text(CASE.replace('"paper"', '"papers"'))


def test_the_counts_are_those_of_the_paper() -> None:
    """Table 2 and section 4.3: 652,000 particles; grains of 1,821 and of 205."""
    spheres = load_case(EXAMPLES / "03_thousand_spheres" / "case_paper.toml")
    assert spheres.preset == "paper"
    assert sum(len(body.positions) for body in build(spheres)) == 652_000
    shaken = load_case(EXAMPLES / "04_shaking_grains" / "case_paper.toml")
    assert shaken.preset == "paper"
    counts = {len(body.positions) for body in build(shaken) if body.part in shaken.grains}
    assert counts == {205, 1821}
