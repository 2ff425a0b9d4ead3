# SPDX-License-Identifier: BSD-3-Clause
"""Basis, transfer, scheme and step of a case that does not say them."""

from __future__ import annotations

import operator

import pytest

from mpm3dpp import Body, Case, CaseError, Grid, Material, Run, _core, shapes
from mpm3dpp.case.matter import have_springs, liquids_that_meet
from mpm3dpp.fill.response_notes import response_notes
from mpm3dpp.run.core_settings import core_settings

CASE = """
{preset}
[grid]
dimension = 2
cell_size = "1 mm"
{grid}
[run]
end_time = "1 ms"
{run}
[material.soft]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[body.disc]
material = "soft"
shape = {{ disc = {{ centre = [0, 0], radius = "5 mm" }} }}
"""
BODY = ("aflip", "usf", 0.4)  # Nodes in the body: of these, it is the step alone that counts.
AFLIP, FLIP = ("aflip", "usf", 0.5), ("flip", "musl", 0.25)


@pytest.mark.parametrize(
    ("preset", "grid", "run", "basis", "chosen"),
    [
        ("", "", "", "quadratic_bspline", BODY),
        ("", 'basis = "gimp"', "", "gimp", FLIP),
        ("", 'basis = "linear"', "", "linear", FLIP),
        ("", "", 'transfer = "flip"', "quadratic_bspline", FLIP),
        ("", "", "transfer = { flip = 0.98 }", "quadratic_bspline", ({"flip": 0.98}, "musl", 0.25)),
        ("", "", 'transfer = "pic"', "quadratic_bspline", ("pic", "musl", 0.25)),
        ("", "", 'transfer = "apic"', "quadratic_bspline", ("apic", "usf", 0.5)),
        ("", "", 'scheme = "musl"', "quadratic_bspline", ("aflip", "musl", 0.5)),
        ("", "", "cfl = 0.1", "quadratic_bspline", ("aflip", "usf", 0.1)),
        ("", 'basis = "gimp"', 'scheme = "usf"\ncfl = 0.1', "gimp", ("flip", "usf", 0.1)),
        ('preset = "paper"', "", "", "linear", FLIP),
        ('preset = "paper"', 'basis = "quadratic_bspline"', "", "quadratic_bspline", AFLIP),
    ],
)
def test_what_is_not_said_follows_what_is(preset, grid, run, basis, chosen) -> None:
    case = Case.from_text(CASE.format(preset=preset, grid=grid, run=run))
    assert case.grid.basis == basis
    assert (case.run.transfer.table(), case.run.scheme, case.run.cfl) == chosen


def test_the_settings_of_the_core_begin_as_those_of_a_case_in_space() -> None:
    """One set of defaults: the core's structs have them, and the tables of a case read them."""
    text = CASE.format(preset="", grid="", run="").replace("shape =", 'frame = "updated"\nshape =')
    case = core_settings(Case.from_text(text), threads=1)
    core = _core.Settings()
    for table in ("grid", "run", "run.transfer", "contact"):
        ours, theirs = (operator.attrgetter(table)(settings) for settings in (core, case))
        rows = _core.settings[table]
        names = [key for key, row in rows.items() if not row["required"] and key != "gravity"]
        for key in [*names, "word"] if table == "run.transfer" else names:
            assert getattr(ours, key) == getattr(theirs, key), f"{table}.{key}"


@pytest.mark.parametrize(
    ("run", "contact", "chosen"),
    [
        ("", "", "springs"),
        ('transfer = "apic"', "friction = 0.1", "springs"),
        ('transfer = "flip"', "", "impulses"),
        ("", 'detection = "velocity"', "impulses"),
        ("", 'normal = "pair"', "impulses"),
        ("", "normal_refresh_distance = 0.1", "impulses"),
        ("", 'response = "impulses"', "impulses"),
        ('transfer = "flip"', 'response = "springs"', "springs"),
    ],
)
def test_the_response_of_contact_follows_the_transfer(run, contact, chosen) -> None:
    text = CASE.format(preset="", grid="", run=run) + f"[contact]\n{contact}\n"
    assert Case.from_text(text).contact.response == chosen


@pytest.mark.parametrize(
    ("run", "contact", "chosen"),
    [
        ("", "", "by_matter"),
        ('transfer = "flip"', "", "impulses"),
        ("", 'normal = "pair"', "impulses"),
        ("", 'response = "springs"', "springs"),
    ],
)
def test_what_flows_is_stopped_at_the_nodes(run, contact, chosen) -> None:
    text = CASE.format(preset="", grid="", run=run) + f"[contact]\n{contact}\n"
    water = "density = 1000\nstrength = { fluid = {} }\neos = { tait = { c0 = 10 } }\n"
    body = '[body.wet]\nmaterial = "wet"\nshape = { disc = { centre = [1, 1], radius = 0.1 } }\n'
    assert Case.from_text(f"{text}[material.wet]\n{water}{body}").contact.response == chosen


WET = """
[material.wet]
density = 1000
strength = { fluid = {} }
eos = { tait = { c0 = 10 } }
[material.air]
density = 1.2
strength = { fluid = {} }
eos = { ideal_gas = { gamma = 1.4, E0 = 2.5e5 } }
[grains.drops]
material = "wet"
lattice = { lower = [1, 1], count = [2, 1], radius = "2 mm" }
"""


@pytest.mark.parametrize(
    ("first", "second", "springs"),
    [("disc", "drops", True), ("drops", "drops", False), ("disc", "air", False)],
)
def test_pairs_that_have_springs(first: str, second: str, springs: bool) -> None:
    air = '[body.air]\nmaterial = "air"\nshape = { disc = { centre = [2, 1], radius = 0.1 } }\n'
    case = Case.from_text(CASE.format(preset="", grid="", run="") + WET + air)
    assert case.contact.response == "by_matter"
    assert have_springs(case, first, second) is springs
    assert liquids_that_meet(case) == ["drops"]


def test_drops_of_one_entry_are_told_of_springs() -> None:
    text = CASE.format(preset="", grid="", run="") + WET + '[contact]\nresponse = "springs"\n'
    (told,) = response_notes(Case.from_text(text))
    assert "makes energy where the liquid bodies of grains.drops meet each other" in told


def test_the_response_follows_a_transfer_that_is_assigned() -> None:
    case = Case.from_text(CASE.format(preset="", grid="", run=""))
    case.run.transfer = "flip"
    case.complete_and_check()
    assert case.contact.response == "impulses"


def test_a_run_that_serves_two_cases_is_chosen_for_each() -> None:
    run = Run(end_time=1.0)
    body = Body(material="soft", shape=shapes.Disc(centre=[0.0, 0.0], radius=0.005))
    soft = Material(density=1000.0, strength={"elastic": {"E": 1e6, "nu": 0.3}})

    def case(**grid: str) -> Case:
        return Case(
            grid=Grid(dimension=2, cell_size=1e-3, **grid),
            run=run,
            material={"soft": soft},
            body={"disc": body},
        )

    first, second = case(basis="gimp"), case()
    assert (first.run.scheme, second.run.scheme) == ("musl", "usf")
    assert (first.run.cfl, second.run.cfl) == (0.25, 0.4)


def test_an_affine_transfer_on_another_basis_is_refused() -> None:
    text = CASE.format(preset="", grid='basis = "gimp"', run='transfer = "aflip"')
    with pytest.raises(CaseError, match="does not go with grid"):
        Case.from_text(text)


def test_a_picture_is_of_the_pressure_where_all_that_deforms_flows() -> None:
    """A plate that does not deform, as its motion is given, has no stress to be seen."""
    text = CASE.format(preset="", grid="", run="") + WET
    assert Case.from_text(text).output.picture == "von_mises"
    fixed = text.replace(
        '[body.disc]\nmaterial = "soft"', '[body.disc]\nmotion = "fixed"\nmaterial = "soft"'
    )
    assert fixed != text
    assert Case.from_text(fixed).output.picture == "pressure"
