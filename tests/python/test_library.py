# SPDX-License-Identifier: BSD-3-Clause
"""Named materials in a case: what they resolve to, what overrides them, what is said when wrong."""

from __future__ import annotations

import pytest
from typer.testing import CliRunner

from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.case import Case, Material
from mpm3dpp.cli.app import app
from mpm3dpp.fill.build import build
from mpm3dpp.materials import catalogue, library, listing, named
from mpm3dpp.run.summary import echo

CASE = """
grid = { dimension = 3, cell_size = "100 mm" }
run = { end_time = 1 }
material.plate = { MATERIAL }
body.cube = { material = "plate", shape.box = { lower = [0, 0, 0], upper = [1, 1, 1] } }
"""


def case(material: str) -> Case:
    return Case.from_text(CASE.replace("MATERIAL", material))


def test_a_case_holds_the_numbers() -> None:
    found = case('library = "copper_ofhc"')
    copper = found.table()["material"]["plate"]
    assert copper["density"] == 8960.0
    assert copper["strength"]["johnson_cook"]["A"] == 90e6
    assert copper["eos"]["mie_gruneisen"]["c0"] == 3940.0
    assert "library" not in copper and "without" not in copper
    assert Case.model_validate(found.table()).case_hash == found.case_hash


def test_the_hash_is_that_of_the_numbers() -> None:
    by_name = case('library = "water"')
    spelled = case(
        'density = "998.2 kg/m^3", strength.fluid.viscosity = "1.002 mPa*s", '
        'eos.tait = { c0 = "1482 m/s", n = 7.15 }'
    )
    assert by_name.case_hash == spelled.case_hash


def test_a_part_beside_it_replaces_the_whole_part() -> None:
    soft = Material(library="copper_ofhc", strength={"elastic": {"E": "1 GPa", "nu": 0.3}})
    assert soft.strength.model == "elastic"
    assert soft.eos is not None and soft.eos.parameters["c0"] == 3940.0
    assert Material(library="copper_ofhc", density="8.93 g/cm^3").density == 8930.0


def test_a_number_beside_it_replaces_that_number_alone() -> None:
    steel = Material(library="steel_4340")
    hard = Material(library="steel_4340", strength={"johnson_cook": {"A": "900 MPa"}})
    assert hard.strength.parameters == {**steel.strength.parameters, "A": 900e6}
    assert hard.eos == steel.eos
    fast = Material(library="water", eos={"tait": {"c0": "30 m/s"}})
    assert fast.eos is not None and fast.eos.parameters == {"c0": 30.0, "n": 7.15}
    found = case('library = "steel_4340", strength = { johnson_cook = { A = "900 MPa" } }')
    assert found.table()["material"]["plate"]["strength"]["johnson_cook"]["A"] == 900e6
    shown = " ".join(echo(found, build(found)).split())
    assert "strength johnson_cook E 205 GPa, nu 0.29, A 900 MPa, B 510 MPa, n 0.26" in shown
    assert "eos mie_gruneisen c0 4578 m/s" in shown
    with pytest.raises(CaseError, match="AA is not a parameter of johnson_cook"):
        case('library = "steel_4340", strength.johnson_cook = { AA = 1 }')
    # Nothing is merged from one model into another: the first parameter that lacks is named.
    with pytest.raises(CaseError, match=r"swift.E is missing"):
        case('library = "steel_4340", strength.swift = { n = 0.2 }')


def test_the_detail_says_how_to_change_a_number() -> None:
    text = " ".join(listing("steel_4340").split())
    assert 'strength = { johnson_cook = { A = "792 MPa" } } replaces that number alone' in text


def test_without_leaves_a_part_out() -> None:
    assert Material(library="copper_ofhc", without=["eos"]).eos is None


def test_failure_only_where_it_is_asked_for() -> None:
    assert Material(library="steel_4340").failure == []
    [taken] = Material(library="steel_4340", failure="library").failure
    assert (taken.model, taken.action) == ("johnson_cook_damage", "no_tension")
    assert taken.parameters["D3"] == -2.12
    erode = {"library": {"action": "erode"}, "plastic_strain": {"limit": 2}}
    both = Material(library="steel_4340", failure=erode)
    assert [f.action for f in both.failure] == ["erode", "no_tension"]
    assert both.failure[0].parameters == taken.parameters
    assert Material(**both.table()).table() == both.table()


def test_the_detail_says_that_failure_is_on_request() -> None:
    text = listing("steel_4340")
    assert 'failure johnson_cook_damage (only with failure = "library")' in text
    assert "Engineering Fracture Mechanics 21 (1985)" in text


@pytest.mark.parametrize(
    ("material", "sentence"),
    [
        ('library = "coper_ofhc"', 'is not a material of the library; did you mean "copper_ofhc"'),
        ("library = 3", "is not a material of the library"),
        ('library = "tnt", without = ["strength"]', "cannot be left out; valid here: eos"),
        ('library = "tnt", without = "eos"', "must be a list"),
        ('density = 1, without = ["eos"]', "has a meaning beside library only"),
        ('library = "tnt", without = ["eos"], eos.linear.K = 1', "is left out by without"),
        ('library = "tnt", densty = 3', "is not a known key"),
        ('library = "tnt", failure = "library"', "is not in the library for tnt"),
        ('density = 1, failure = "library"', 'is "library" without a library'),
        ('library = "steel_4340", failure.library = "erode"', "must be a table"),
        ('library = "steel_4340", failure.library = { D9 = 1 }', "is not a parameter of johnson"),
    ],
)
def test_mistakes_are_one_sentence(material: str, sentence: str) -> None:
    with pytest.raises(CaseError) as caught:
        case(material)
    assert sentence in str(caught.value)
    assert "material.plate" in str(caught.value)
    assert "\n" not in str(caught.value)


def test_assignment_keeps_the_rest() -> None:
    copper = Material(library="copper_ofhc")
    copper.density = "8.93 g/cm^3"
    assert (copper.density, copper.strength.model) == (8930.0, "johnson_cook")


def test_the_overview_has_one_line_each() -> None:
    lines = listing().splitlines()
    names = [*library(), *(name for kind in ("strength", "eos") for name in catalogue(kind))]
    for name in names:
        assert sum(line.startswith(f"  {name} ") for line in lines) == 1
    assert max(map(len, lines)) <= 100


def test_the_detail_says_what_is_not_confirmed() -> None:
    text = listing("lead")
    assert "Y0" in text and "8 MPa" in text and 'library = "lead"' in text
    assert "NOT CONFIRMED" in text
    assert "strength.Y0" in named("lead").unconfirmed
    assert "NOT CONFIRMED" not in listing("copper_ofhc")


def test_command() -> None:
    run = CliRunner().invoke
    assert run(app, ["materials"]).exit_code == 0
    assert "sources:" in run(app, ["materials", "tnt"]).output
    found = run(app, ["materials", "swif"])
    assert isinstance(found.exception, CaseError)
    assert 'did you mean "swift"?' in str(found.exception)
    with pytest.raises(CaseError, match='did you mean "lead"'):
        named("lea")
