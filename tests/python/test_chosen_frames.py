# SPDX-License-Identifier: BSD-3-Clause
"""Where the nodes of bodies lie whose case leaves that to us, as by default."""

from __future__ import annotations

import pytest

from mpm3dpp import Body, Case, CaseError, Particles
from mpm3dpp.case.choose_frames import all_in_space
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import echo

CASE = """
{preset}
[grid]
dimension = 2
cell_size = "1 mm"
{grid}
[run]
end_time = "1 ms"
{run}
[contact]
{contact}
[material.soft]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
{soft}
[material.water]
density = 1000
strength = {{ fluid = {{}} }}
eos = {{ tait = {{ c0 = 10 }} }}
[material.air]
density = 1.2
strength = {{ fluid = {{}} }}
eos = {{ ideal_gas = {{ gamma = 1.4, E0 = "0.25 MPa" }} }}
[material.sand]
density = 1600
strength = {{ mohr_coulomb = {{ E = "1 MPa", nu = 0.3, cohesion = 0, friction_angle = "33 deg" }} }}
[material.steel]
density = 7800
strength = {{ rigid = {{}} }}
[body.block]
material = "soft"
shape = {{ box = {{ lower = [0, 0], upper = ["8 mm", "8 mm"] }} }}
frame = "auto"
{block}
{bodies}
"""
OTHER = """
[body.{0}]
material = "{0}"
shape = {{ box = {{ lower = ["20 mm", 0], upper = ["28 mm", "8 mm"] }} }}
frame = "{1}"
"""
BOND = """
[[contact.pair]]
bodies = ["{0}", "{1}"]
bonded = true
"""
TEXT = CASE.format(preset="", grid="", run="", contact="", soft="", block="", bodies="")
KEYS = ("preset", "grid", "run", "contact", "soft", "block", "bodies")


def case_of(**given: str) -> Case:
    return Case.from_text(CASE.format(**{key: given.get(key, "") for key in KEYS}))


def box(walls: str, lower: int = 0) -> str:
    return f"box = {{ lower = [{lower}e-3, 0], upper = [0.04, 0.02], walls = {{ {walls} }} }}"


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"soft": "volume_averaging = true"},
        {"soft": "failure = { principal_stress = { limit = 1e4 } }"},
        {"contact": "friction = 0.3\nrestitution = 0.5"},
        {"bodies": OTHER.format("steel", "updated")},
        {"bodies": OTHER.format("water", "auto")},
        {"bodies": OTHER.format("sand", "auto"), "contact": "friction = 0.3"},
        {"bodies": OTHER.format("soft", "updated")},
        {"bodies": OTHER.format("air", "auto"), "contact": "enabled = false"},
        {"grid": box('y_min = "contact", x_max = "contact"')},
        {"grid": box('x_min = "slip", y_min = "fixed"')},
        {"grid": box('x_min = "slip"', -4)},
        {"grid": box('x_min = "slip"', 4), "block": "cut_at_box = true"},
        {"block": "velocity = [7, 0]", "bodies": OTHER.format("soft", "auto")},
        {"block": "velocity = [8, 0]", "contact": "enabled = false"},
        {"block": "velocity = [0, 8]", "grid": box('y_min = "contact"')},
        {"run": 'time_step = "13 us"'},
    ],
)
def test_in_the_body(given) -> None:
    case = case_of(**given)
    assert case.body["block"].frame == "material"
    assert case.why_in_space["block"] == ""


def test_it_is_the_default() -> None:
    auto, silent = (Case.from_text(text) for text in (TEXT, TEXT.replace('frame = "auto"', "")))
    assert auto.content() == silent.content() and silent.body["block"].frame == "material"


def test_a_device_has_them_in_space() -> None:
    """Of those alone that are left to us; the case that was given stays as it is."""
    case = case_of(bodies=OTHER.format("water", "auto"))
    there = all_in_space(case, "a device makes the steps")
    assert case.body["block"].frame == "material"
    assert there.body["block"].frame == "updated" and there.run.cfl == 0.5
    assert there.why_in_space == dict.fromkeys(("block", "water"), "a device makes the steps")
    said = case.with_({"body.block.frame": "material"})
    assert all_in_space(said, "a device makes the steps").body["block"].frame == "material"


def test_a_mistake_is_told_where_it_is_looked_for() -> None:
    with pytest.raises(CaseError, match=r"body\.block\.velocity"):
        case_of(block="velocity = [0, 0, 0]", bodies=OTHER.format("soft", "auto"))


def test_the_step_follows_the_frame() -> None:
    assert case_of().run.cfl == 0.4
    assert case_of(bodies=OTHER.format("sand", "auto")).run.cfl == 0.4
    assert case_of(bodies=OTHER.format("air", "auto")).run.cfl == 0.5


@pytest.mark.parametrize(
    ("given", "why"),
    [
        ({"preset": 'preset = "paper"'}, 'preset = "paper" is of nodes in space'),
        ({"grid": 'basis = "linear"'}, 'grid.basis = "linear" is given'),
        ({"grid": 'basis = "gimp"'}, 'grid.basis = "gimp" is given'),
        ({"grid": box('x_min = "absorbing"')}, "walls of grid.box that absorb"),
        ({"run": 'transfer = "apic"'}, "run.transfer is given"),
        ({"run": 'scheme = "musl"'}, "run.scheme is given"),
        (
            {"contact": 'detection = "velocity"', "bodies": OTHER.format("steel", "updated")},
            "contact.detection is given",
        ),
        (
            {"soft": 'failure = { principal_stress = { limit = 1e4, action = "erode" } }'},
            'material.soft.failure whose action is "erode"',
        ),
        ({"bodies": OTHER.format("air", "auto")}, "it may touch air, a gas, whose nodes lie"),
        (
            {"bodies": OTHER.format("sand", "auto") + BOND.format("block", "sand")},
            "block is bonded to sand, whose nodes lie in space",
        ),
        (
            {
                "bodies": OTHER.format("sand", "auto")
                + OTHER.format("steel", "updated").replace("20", "30").replace("28", "38")
                + BOND.format("steel", "sand")
            },
            "steel is bonded to sand, whose nodes lie in space",
        ),
        (  # Waves have 36.7 m/s.
            {"block": "velocity = [8, 0]", "bodies": OTHER.format("soft", "auto")},
            "it meets soft at 0.22 of the speed of its waves, more than 0.2",
        ),
        (
            {"block": "velocity = [0, -8]", "grid": box('y_min = "contact"')},
            "it meets grid.box.walls.y_min at 0.22 of the speed of its waves",
        ),
        ({"run": 'time_step = "15 us"'}, "lets its waves pass 0.55 of a cell, more than the 0.5"),
    ],
)
def test_in_space(given, why) -> None:
    case = case_of(**given)
    assert case.body["block"].frame == "updated"
    assert why in case.why_in_space["block"]


def test_particles_with_velocities_of_their_own_meet_too() -> None:
    places = [[x, y] for x in (0.0195, 0.0205) for y in (0.0005, 0.0015)]
    particles = Particles(places, volumes=[1e-6] * 4, velocities=[[-8.0, 0.0]] * 4)
    case = case_of(bodies=OTHER.format("soft", "auto"))
    case.body["soft"] = Body(material="soft", particles=particles)
    case.complete_and_check()
    assert "it meets soft at 0.22" in case.why_in_space["block"]
    assert case.body["soft"].frame == "updated"


def test_what_yields_is_in_space_at_half_the_speed() -> None:
    strength = "strength = { j2 = { E = 1e6, nu = 0.3, Y0 = 1e4, H = 0 } }"
    text = TEXT.replace('strength = { elastic = { E = "1 MPa", nu = 0.3 } }', strength)
    floor = box('y_min = "contact"')
    for speed, frame in ((3.5, "material"), (4.0, "updated")):
        moving = text.replace('frame = "auto"', f"velocity = [0, -{speed}]")
        assert (
            Case.from_text(moving.replace("[run]", f"{floor}\n[run]", 1)).body["block"].frame
            == frame
        )


def test_a_restitution_without_surfaces_says_why() -> None:
    with pytest.raises(CaseError, match=r'there is none, as frame = "material" does not go with'):
        case_of(contact="restitution = 0.5", grid=box('x_min = "slip"'))


def test_a_pair_with_a_restitution_alone_is_told() -> None:
    bodies = OTHER.format("soft", "auto")
    pair = '[[contact.pair]]\nbodies = ["block", "soft"]\nrestitution = 0.7\n'
    case = case_of(bodies=bodies + pair)
    assert "restitution: 0.7 between block and soft" in echo(case, build(case))


def test_what_flows_says_by_which_model() -> None:
    case = case_of(bodies=OTHER.format("sand", "auto"))
    assert "material.sand, which flows by its strength mohr_coulomb" in (case.why_in_space["sand"])


def test_no_frame_of_what_does_not_deform() -> None:
    case = case_of(bodies=OTHER.format("steel", "auto"))
    assert set(case.why_in_space) == {"block"}
    assert case.body["steel"].frame == "updated"


def test_what_is_said_is_kept() -> None:
    case = case_of(bodies=OTHER.format("soft", "material"))
    assert set(case.why_in_space) == {"block"}
    case = case_of(run='transfer = "apic"', bodies=OTHER.format("soft", "material"))
    assert [body.frame for body in case.body.values()] == ["updated", "material"]
    with pytest.raises(CaseError, match="between both frames: it may touch air, a gas"):
        case_of(bodies=OTHER.format("soft", "material") + OTHER.format("air", "auto"))


def test_grains_likewise() -> None:
    grains = """
[grains.balls]
material = "soft"
lattice = { lower = ["20 mm", 0], count = [2, 1], radius = "3 mm" }
frame = "auto"
"""
    case = case_of(bodies=grains)
    assert case.grains["balls"].frame == case.body["block"].frame == "material"
    # Balls of few cells have three particles along each direction in this frame.
    assert case.grains["balls"].particle_spacing(case.grid) == pytest.approx(1e-3 / 3.0)
    case = case_of(bodies=grains, grid=box('x_max = "absorbing"'))
    assert case.grains["balls"].frame == "updated"
    assert case.grains["balls"].particle_spacing(case.grid) == pytest.approx(1e-3 / 2.0)


def test_the_choice_is_as_if_it_had_been_said() -> None:
    for chosen, given in (("material", {}), ("updated", {"grid": 'basis = "linear"'})):
        auto = case_of(**given)
        said = auto.with_({"body.block.frame": chosen})
        assert said.case_hash == auto.case_hash
        assert said.content() == auto.content()


def test_it_is_chosen_anew_where_the_case_changes() -> None:
    case = case_of()
    case.grid.basis = "linear"
    case.complete_and_check()
    assert case.body["block"].frame == "updated"
    assert case.body["block"].particles_per_cell == 2
    case.grid.basis = "quadratic_bspline"
    case.complete_and_check()
    assert case.body["block"].frame == "material"
    case.body["block"].frame = "updated"
    case.complete_and_check()
    assert case.body["block"].frame == "updated"
    assert case.why_in_space == {}


def test_a_body_that_serves_two_cases_is_chosen_for_each() -> None:
    first = case_of()
    second = case_of(grid='basis = "linear"')
    shared = second.body["block"].model_copy(update={"frame": "auto"})
    made = [
        Case(grid=of.grid, run=of.run, material=of.material, body={"block": shared})
        for of in (first, second)
    ]
    assert [one.body["block"].frame for one in made] == ["material", "updated"]
    assert shared.frame == "auto"


def test_the_echo_says_which_and_why() -> None:
    case = case_of(bodies=OTHER.format("sand", "auto"))
    lines = [line for line in echo(case, build(case)).splitlines() if line.startswith("frame: ")]
    assert lines[0].startswith('frame: "material" for block: nodes lie in each body')
    assert lines[1].startswith('frame: "updated" for sand, as frame = "material" does not go with')
    alone = case_of()
    said = alone.with_({"body.block.frame": "updated"})
    told = 'frame: "material" for block: nodes lie in each body and keep its motion'
    assert told in echo(alone, build(alone)).splitlines()
    assert "frame: " not in echo(said, build(said))
