# SPDX-License-Identifier: BSD-3-Clause
"""What bodies on nodes of their own do not go with: a sentence each, that names the body's key."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import mpm3dpp
from mpm3dpp import Case, CaseError, Simulation
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build

CASE = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 ms"
gravity = [0, -9.81]
[contact]
enabled = false
[material.m]
density = 1000
strength = { elastic = { E = "10 MPa", nu = 0.3 } }
[body.a]
material = "m"
frame = "material"
shape = { disc = { centre = [0, 0], radius = "4 mm" } }
[body.b]
material = "m"
frame = "updated"
shape = { disc = { centre = ["20 mm", 0], radius = "4 mm" } }
"""
GRID, RUN, A = 'cell_size = "1 mm"\n', 'end_time = "1 ms"\n', 'frame = "material"\n'
BOX = 'lower = ["-50 mm", "-50 mm"], upper = ["50 mm", "50 mm"]'
SPACE = 'frame = "updated"\n'
MATTER = 'strength = { elastic = { E = "10 MPa", nu = 0.3 } }\n'
WATER = "strength = { fluid = {} }\neos = { tait = { c0 = 10 } }\n"
BOND = """enabled = true
[[contact.pair]]
bodies = ["a", "b"]
bonded = true"""
LOAD = '[load.push]\nbody = "a"\nside = "x_min"\npressure = "1 kPa"\n'


def test_a_case_without_them_is_one() -> None:
    case = Case.from_text(CASE)
    assert [body.frame for body in case.body.values()] == ["material", "updated"]


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (GRID, f'{GRID}basis = "linear"\n', "needs gradients without jumps"),
        (GRID, f'{GRID}box = {{ {BOX}, walls = "absorbing" }}\n', "walls of grid.box that absorb"),
        (GRID, f"{GRID}outflow_box = {{ {BOX} }}\n", "grid.outflow_box"),
        (GRID, f"{GRID}coarsening = {{ tiles = 9, times = 1 }}\n", "grid.coarsening"),
        ("enabled = false", BOND, "a is bonded to b, whose nodes lie in space"),
        ("enabled = false", "bonded = true", "contact.bonded, of bodies that share nodes"),
        ("enabled = false", "enabled = false\nbonded = true", "contact.bonded, of bodies that"),
        (RUN, f'{RUN}settle = {{ longest = "1 ms" }}\n', "run.settle yet"),
        (MATTER, WATER, "material.m, which flows by its strength"),
        (
            MATTER,
            MATTER + 'failure = { hydrostatic_tension = { limit = 1e5, action = "erode" } }\n',
            'failure whose action is "erode"',
        ),
        (A, f'{A}motion = "fixed"\n', "a body that does not deform"),
    ],
)
def test_what_they_do_not_go_with(before: str, after: str, said: str) -> None:
    assert before in CASE
    text = CASE.replace(before, after, 1)
    if "settle" in after:
        text = text.replace(A, f"{A}velocity = [1, 0]\n")
    with pytest.raises(CaseError) as told:
        Case.from_text(text)
    messages = [str(told.value), *map(str, getattr(told.value, "others", []))]
    [about] = [m for m in messages if 'body.a.frame = "material"' in m]
    rule = rf"(does not go with|goes with|needs) .*{re.escape(said.removeprefix('needs '))}"
    assert re.search(rule, about)
    assert ";" in about  # and a remedy


@pytest.mark.parametrize(
    ("given", "key", "said"),
    [
        ('normal = "pair"', "contact.normal", "is for contact at nodes"),
        ('gap_distance = "1 um"', "contact.gap_distance", "is for contact at nodes"),
        ('response = "impulses"', "contact.response", "is for contact at nodes"),
        ('interference = "pressed"', "body.a.frame", 'contact.interference = "pressed" yet'),
    ],
)
def test_what_is_for_contact_at_nodes_is_not_for_them(given: str, key: str, said: str) -> None:
    both = CASE.replace(SPACE, A)
    with pytest.raises(CaseError) as told:
        Case.from_text(both.replace("enabled = false", given))
    messages = [str(told.value), *map(str, getattr(told.value, "others", []))]
    assert any(f"{key} = " in m and said in m and ";" in m for m in messages)


def test_walls_that_hold_them_and_contact() -> None:
    walls = f'{GRID}box = {{ {BOX}, walls = "slip" }}\n'
    both = CASE.replace(SPACE, A)
    text = both.replace(GRID, walls)
    Case.from_text(text.replace("enabled = false", ""))
    with pytest.raises(CaseError, match="slip or fixed and a restitution, yet"):
        Case.from_text(text.replace("enabled = false", "restitution = 0.5"))


BLOCK = {"box": {"lower": [0.01, 0.0], "upper": [0.018, 0.008]}}


@pytest.mark.parametrize(
    ("shape", "velocity", "told"),
    [
        (BLOCK, (0.0, -3.0), True),
        (BLOCK, (0.0, 3.0), True),
        (BLOCK, (3.0, 0.0), False),
        ({"disc": {"centre": [0.01, 0.004], "radius": 0.004}}, (0.0, -3.0), False),
    ],
)
def test_what_lies_on_a_plane_of_symmetry_and_moves_across_it_is_told_of(
    shape: dict[str, Any], velocity: tuple[float, float], told: bool
) -> None:
    """Its nodes there are at rest from the start; a ball that touches it in a point is free."""
    box = {"lower": [0.0, 0.0], "upper": [0.04, 0.04], "walls": {"y_min": "slip"}}
    material = {"density": 1000.0, "strength": {"elastic": {"E": 1e6, "nu": 0.3}}}
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": 1e-3, "box": box},
            "run": {"end_time": 1e-3},
            "material": {"m": material},
            "body": {"b": {"material": "m", "frame": "material", "shape": shape}},
        }
    )
    case.body["b"].velocity = velocity
    found = [
        one for one in notes(case, build(case)) if "body.b lies on grid.box.walls.y_min" in one
    ]
    assert len(found) == told
    assert all("begins with 3 m/s across it" in one for one in found)


def test_short_waves_are_damped_of_them_alone() -> None:
    damped = f"{RUN}short_wave_damping = 0.01\n"
    assert Case.from_text(CASE.replace(RUN, damped)).run.short_wave_damping == 0.01
    with pytest.raises(CaseError, match="short_wave_damping is for bodies with frame ="):
        Case.from_text(CASE.replace(A, SPACE).replace(RUN, damped))
    text = CASE.replace(RUN, damped).replace(GRID, f'{GRID}basis = "gimp"\n')
    with pytest.raises(CaseError, match="has no affine part of a velocity"):
        Case.from_text(text)


def test_restitution_is_for_them() -> None:
    """Other bodies lose what their transfers take, and no more by it."""
    text = CASE.replace(A, SPACE).replace("enabled = false", "restitution = 0.5")
    with pytest.raises(CaseError, match=r"contact\.restitution is for bodies with frame ="):
        Case.from_text(text)
    with pytest.raises(CaseError, match=r"contact\.restitution = 1\.5 must"):
        Case.from_text(text.replace("0.5", "1.5"))


def test_balls_of_few_cells_have_more_particles() -> None:
    """Three a cell and direction, two where a case says it, or where their nodes lie in space."""
    case = Case.from_text(CASE)
    assert case.body["a"].particle_spacing(case.grid) == pytest.approx(1e-3 / 3)
    assert case.body["b"].particle_spacing(case.grid) == pytest.approx(1e-3 / 2)
    given = Case.from_text(CASE.replace(A, f"{A}particles_per_cell = 2\n"))
    assert given.body["a"].particle_spacing(given.grid) == pytest.approx(1e-3 / 2)
    large = Case.from_text(CASE.replace('radius = "4 mm"', 'radius = "9 mm"', 1))
    assert large.body["a"].particle_spacing(large.grid) == pytest.approx(1e-3 / 2)


def test_a_word_that_is_none() -> None:
    with pytest.raises(CaseError, match=r'body\.a\.frame = "materiel" .* did you mean "material"'):
        Case.from_text(CASE.replace(A, 'frame = "materiel"\n'))


def simulation_of(before: str = "", after: str = "", **options: Any) -> Simulation:
    return Simulation(Case.from_text(CASE.replace(before, after, 1)), **options)


def test_a_velocity_that_it_has_may_be_set() -> None:
    """Given at the end of a step, kept in its middle: a body goes on falling as it did."""
    simulation = simulation_of(RUN, 'end_time = "10 ms"\n')
    for _ in range(20):
        simulation.advance(5)
        simulation.set_velocity("a", simulation.column("a", "velocity"))
    fallen = simulation.column("a", "velocity")[:, 1]
    assert fallen == pytest.approx(-9.81 * simulation.time, rel=1e-10)
    assert simulation.column("b", "velocity")[:, 1] == pytest.approx(fallen[0], rel=1e-10)


def test_another_one_keeps_its_velocity_where_one_is_set() -> None:
    two = CASE.replace(SPACE, A)
    simulation = Simulation(Case.from_text(two))
    simulation.advance(20)
    before = simulation.column("b", "velocity")
    simulation.set_velocity("a", simulation.column("a", "velocity") + np.array([3.0, 0.0]))
    assert (simulation.column("b", "velocity") == before).all()
    assert simulation.column("a", "velocity")[:, 0] == pytest.approx(3.0)


def test_it_settles_from_rest() -> None:
    """Nothing holds it, so that it falls, damped; it is at rest at t = 0 and falls from there."""
    simulation = simulation_of(RUN, f'{RUN}settle = {{ longest = "0.1 ms" }}\n')
    while simulation.time < 0.0:
        simulation.advance(1)
    assert np.abs(simulation.column("a", "velocity")).max() == 0.0
    simulation.advance(10)
    fallen = simulation.column("a", "velocity")[:, 1]
    assert fallen == pytest.approx(-9.81 * simulation.time, rel=1e-9)


def test_a_load_on_another_body_is_none_of_its_own() -> None:
    load = LOAD.replace('"a"', '"b"').replace("x_min", "outer")
    simulation = simulation_of("[contact]", f"{load}[contact]")
    assert simulation.advance(3) == 3


def test_grains_of_such_bodies() -> None:
    lattice = "lattice = { lower = [1, 1], count = [2, 2], radius = 3e-3, spacing = 7e-3 }\n"
    grains = f'[grains.g]\nmaterial = "m"\n{A}{lattice}angular_velocity = 100\n'
    simulation = Simulation(Case.from_text(CASE + grains))
    simulation.advance(50)
    moving = simulation.column("g_0003", "velocity")
    moving -= moving.mean(axis=0)
    arm = simulation.column("g_0003", "position")
    arm -= arm.mean(axis=0)
    turned = np.stack([-arm[:, 1], arm[:, 0]], axis=1)
    assert np.abs(moving - 100.0 * turned).max() < 0.02 * 0.3


@pytest.mark.parametrize("fast", [False, True])
def test_bodies_that_meet_too_fast_are_told_of(fast: bool) -> None:
    """Waves go at 116 m/s; two discs that part are no matter, nor a wall that one flies from."""
    walls = f'{GRID}box = {{ {BOX}, walls = {{ x_max = "contact" }} }}\n'
    both = CASE.replace(SPACE, A)
    text = both.replace(GRID, walls).replace("enabled = false", "")
    speeds = (20.0, -12.0) if fast else (-60.0, -12.0)
    for name, speed in zip("ab", speeds, strict=True):
        text = text.replace(f"[body.{name}]\n", f"[body.{name}]\nvelocity = [{speed}, 0]\n")
    told = [note for note in Simulation(Case.from_text(text)).notes if "approach at" in note]
    assert len(told) == (1 if fast else 0)
    assert not fast or "body.a and body.b approach at 0.28 of the speed of its waves" in told[0]


def test_walls_that_are_met_too_fast_are_told_of_without_contact_of_bodies_too() -> None:
    walls = f'{GRID}box = {{ {BOX}, walls = {{ x_max = "contact" }} }}\n'
    text = CASE.replace(GRID, walls).replace("[body.a]\n", "[body.a]\nvelocity = [40, 0]\n")
    [told] = [note for note in Simulation(Case.from_text(text)).notes if "approach at" in note]
    assert "body.a and grid.box.walls.x_max approach at 0.34" in told


def test_an_estimate_of_bodies_with_a_restitution(tmp_path: Path) -> None:
    """It times a block, or a heap, of the same frame; `check` prints it."""
    text = CASE.replace(SPACE, A)
    (tmp_path / "case.toml").write_text(text.replace("enabled = false", "restitution = 0.5"))
    told = mpm3dpp("check", "case.toml", cwd=tmp_path)
    assert told.returncode == 0
    assert "estimate: " in told.stdout
    assert "contact: between surfaces, restitution 0.5" in told.stdout


@pytest.mark.parametrize(
    ("pair", "said"),
    [
        ("restitution = 0.5", ""),
        ("restitution = 0.5\nbonded = true", "is bonded, which goes without friction, restitution"),
        ("", "must have friction, restitution or bonded = true"),
    ],
)
def test_what_a_pair_has(pair: str, said: str) -> None:
    text = CASE.replace(SPACE, A)
    listed = f'[[contact.pair]]\nbodies = ["a", "b"]\n{pair}'
    text = text.replace("enabled = false", listed)
    if not said:
        Case.from_text(text)
        return
    with pytest.raises(CaseError, match=re.escape(said)):
        Case.from_text(text)
