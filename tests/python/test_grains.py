# SPDX-License-Identifier: BSD-3-Clause
"""Many bodies from one entry of a case: where they stand, what fills them, what is reported."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mpm3dpp import (
    Case,
    CaseError,
    GrainCentres,
    Grains,
    Simulation,
    load_case,
    open_results,
    run_case,
)
from mpm3dpp.base.neighbours import overlapping_boxes
from mpm3dpp.case.pairs import laws_of
from mpm3dpp.fill.build import build
from mpm3dpp.grains.packing import ball_volume
from mpm3dpp.io import read_history
from mpm3dpp.plots import preview
from mpm3dpp.run.summary import echo

PAGE = Path(__file__).parents[2] / "docs/how-to/many-grains.md"

CASE = """\
[grid]
dimension = DIM
cell_size = "1 mm"
[run]
end_time = "20 us"
[material.glass]
density = "2500 kg/m^3"
strength = { elastic = { E = "60 GPa", nu = 0.2 } }
[material.steel]
density = "8000 kg/m^3"
strength = { elastic = { E = "200 GPa", nu = 0.3 } }
[grains.sand]
material = "glass"
frame = "updated"
"""
LATTICE = 'lattice = { lower = ["0 mm", "0 mm"], count = [3, 2], radius = "2.5 mm" }\n'
INSIDE = """\
packing = { inside = { disc = { centre = [0, 0], radius = 0.01 } }, radius = 0.001, fraction = 0.3 }
"""
PLATE = """\
[body.plate]
material = "steel"
shape = { box = { lower = ["0 mm", "-3 mm"], upper = ["15 mm", "0 mm"] } }
"""


def grains(way: str, dimension: int = 2, more: str = "", head: str = CASE) -> Case:
    return Case.from_text(head.replace("DIM", str(dimension)) + way + more)


def sphere_lattice(*count: int) -> str:
    return f'lattice = {{ lower = [0, 0, 0], count = {list(count)}, radius = "2.5 mm" }}\n'


def test_a_sphere_of_radius_five_spacings_holds_552_particles() -> None:
    # By hand: the points (i, j, k) + 1/2 with (i + 1/2)^2 + (j + 1/2)^2 + (k + 1/2)^2 < 25.
    odd = np.arange(-9, 10, 2)
    by_hand = int((odd[:, None, None] ** 2 + odd[:, None] ** 2 + odd**2 < 100).sum())
    [body] = build(grains(sphere_lattice(1, 1, 1) + 'fill = "lattice"\n', 3))
    assert len(body.positions) == by_hand == 552


def test_a_thousand_touching_spheres_hold_552000_particles() -> None:
    bodies = build(grains(sphere_lattice(10, 10, 10) + 'fill = "lattice"\n', 3))
    assert len(bodies) == 1000
    points = np.concatenate([body.positions for body in bodies])
    assert len(points) == 552_000
    assert points.min() > 0.0 and points.max() < 0.05  # The box of 50 x 50 x 50 cells.
    centres = np.array([body.positions.mean(axis=0) for body in bodies])
    gaps = np.linalg.norm(centres[1:] - centres[:-1], axis=1)
    assert gaps.min() == pytest.approx(0.005, rel=1e-12)  # They touch: two radii apart.


@pytest.mark.slow
def test_grains_that_are_poured_come_at_the_speed_of_the_feed() -> None:
    """The recipe of docs/how-to/many-grains.md: above the outlet they move evenly, below they fall.

    y = y0 - v s - g s^2 / 2 a time s after a grain's middle has passed the outlet. Its parts feel
    gravity one by one on a way of its diameter: its acceleration grows linearly there, so that it
    is as if it had begun when its middle passed, to second order: g (d / v)^2 / 24 = 1.5e-5 m.
    """
    section = PAGE.read_text().split("## Pour over time", 1)[1]
    text = section.split("```toml", 1)[1].split("```", 1)[0]
    outlet = 0.1005  # the middle of the way over which the force ends
    head = """
[grid]
dimension = 2
cell_size = "1 mm"
[material.glass]
density = 2500
strength = { elastic = { E = "10 MPa", nu = 0.2 } }
"""
    case = Case.from_text(text + head).with_({"grains.feed.packing.upper": [0.02, 0.2]})
    sim = Simulation(case, threads=1)
    names = sim.bodies

    def middles() -> np.ndarray:
        return np.array([sim.column(name, "position")[:, 1].mean() for name in names])

    before = middles()
    sim.advance(10**6, end_time=0.03)
    after = middles()
    above = after > outlet + 0.0035
    assert 5 < above.sum() < len(names) - 5
    np.testing.assert_allclose(after[above], before[above] - 0.03, atol=1e-6)
    fallen = after < outlet - 0.009
    s = 0.03 - (before[fallen] - outlet)
    expected = outlet - s - 0.5 * 9.81 * s**2
    np.testing.assert_allclose(after[fallen], expected, atol=2e-5)


def test_eight_thousand_grains_start_and_are_told_as_one() -> None:
    lattice = 'lattice = { lower = [0, 0, 0], count = [20, 20, 20], radius = "1.05 mm" }\n'
    case = grains(lattice + 'align = "particle"\n', 3)
    bodies = build(case)
    assert len(bodies) == 8000
    assert {len(body.positions) for body in bodies} == {33}  # |x| < 2.1 spacings, 0 included.
    shown = echo(case, bodies)
    assert "grains sand: 8,000 bodies, 264,000 particles (33 each)" in shown
    assert len(shown.splitlines()) < 12
    simulation = Simulation(case, threads=1)
    assert simulation.core.body_count == 8000
    assert simulation.column("sand", "mass").shape == (264_000, 1)
    assert simulation.column("sand_7999", "mass").shape == (33, 1)


def test_grains_that_fly_together_converge() -> None:
    """Up to twelve bodies at a node, and nothing but rounding passes between them."""
    lattice = 'lattice = { lower = [0, 0, 0], count = [4, 4, 4], radius = "1.05 mm" }\n'
    more = 'align = "particle"\nvelocity = [30, 20, 10]\n'
    simulation = Simulation(grains(lattice + more, 3), threads=1)
    simulation.advance(3)
    summary = simulation.core.contact_summary()
    assert summary["bodies_per_node_max"] >= 8
    assert summary["unconverged_nodes"] == 0
    v = simulation.column("sand", "velocity")
    assert np.abs(v / [30.0, 20.0, 10.0] - 1.0).max() < 1e-12


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_packing_overlaps_nowhere_and_is_that_of_its_seed(dimension: int) -> None:
    corner, box = [0.0] * dimension, ["40 mm"] * dimension if dimension == 2 else ["20 mm"] * 3
    fraction = 0.7 if dimension == 2 else 0.45
    way = (
        f"packing = {{ lower = {corner}, upper = {json.dumps(box)}, radius = ['1 mm', '2 mm'], "
        f"fraction = {fraction}, gap = '0.05 mm', seed = 7 }}\n"
    )
    one = grains(way, dimension).grains["sand"]
    centres, radii = one.place(dimension)
    edge = 0.04 if dimension == 2 else 0.02
    rounding = 4 * np.finfo(float).eps * edge
    assert (centres - radii[:, None]).min() >= -rounding
    assert (centres + radii[:, None]).max() <= edge + rounding
    apart = np.linalg.norm(centres[:, None] - centres[None], axis=2)
    apart -= radii[:, None] + radii[None] + 0.05e-3
    assert apart[~np.eye(len(radii), dtype=bool)].min() >= 0.0
    volumes = np.pi * radii**2 if dimension == 2 else 4 / 3 * np.pi * radii**3
    largest = volumes.max() / edge**dimension  # One more grain would be too many.
    assert fraction - largest < volumes.sum() / edge**dimension <= fraction
    # Radii drawn evenly: the mean of n is within 5 standard deviations of the middle.
    assert abs(radii.mean() - 1.5e-3) < 5 * 1e-3 / np.sqrt(12 * len(radii))
    assert radii.min() >= 1e-3 and radii.max() <= 2e-3
    again = grains(way, dimension).grains["sand"].place(dimension)
    assert np.array_equal(again[0], centres)
    other = grains(way.replace("seed = 7", "seed = 8"), dimension).grains["sand"]
    assert len(other.place(dimension)[0]) != len(centres) or not np.array_equal(
        other.place(dimension)[0], centres
    )


def test_a_file_gives_centres_and_radii(tmp_path: Path) -> None:
    (tmp_path / "sand.csv").write_text("x [m],y [m],radius [m]\n0,0,0.002\n0.01,0,0.003\n")
    path = tmp_path / "case.toml"
    path.write_text(CASE.replace("DIM", "2") + 'file = "sand.csv"\nvelocity = [3, 0]\n')
    case = load_case(path)
    small, large = build(case)
    assert (small.name, large.name) == ("sand_0000", "sand_0001")
    assert large.positions.mean(axis=0) == pytest.approx([0.01, 0], abs=1e-15)
    assert small.mass == pytest.approx(2500 * np.pi * 0.002**2, rel=1e-12)
    velocity = Simulation(case, threads=1).column("sand", "velocity")
    assert velocity.shape == (len(small.positions) + len(large.positions), 2)
    assert (velocity == [3.0, 0.0]).all()
    before = case.case_hash
    (tmp_path / "sand.csv").write_text("x,y,radius\n0,0,0.002\n0.01,0,0.0031\n")
    assert load_case(path).case_hash != before
    assert preview(case, tmp_path / "sand.png").exists()


def test_in_python_grains_are_arrays() -> None:
    case = grains(LATTICE)
    given = GrainCentres([[0, 0], [0.01, 0]], [2e-3, 2e-3])
    sand = Grains(material="glass", file=given, align="grid")
    assert [body.name for body in build(case.model_copy(update={"grains": {"sand": sand}}))] == [
        "sand_0000",
        "sand_0001",
    ]


def test_frictions_by_entry_and_by_material() -> None:
    pairs = """
[contact]
friction = 0.1
[[contact.pair]]
materials = ["glass", "steel"]
friction = 0.2
[[contact.pair]]
bodies = ["sand", "sand"]
friction = 0.5
[[contact.pair]]
materials = ["glass", "glass"]
friction = 0.4
"""
    more = LATTICE + PLATE + '[grains.dust]\nmaterial = "glass"\n'
    more += 'lattice = { lower = ["0 mm", "20 mm"], count = [2, 1], radius = "1 mm" }\n'
    case = grains(more, more=pairs)
    # The plate is body 0, sand 1 to 6, dust 7 and 8; bodies go before materials.
    assert case.first_bodies() == {"plate": 0, "sand": 1, "dust": 7}
    frictions = [(0, 1, 0.2), (0, 7, 0.2), (1, 1, 0.5), (1, 7, 0.4), (7, 7, 0.4)]
    expected = [(*one, 1.0) for one in frictions]
    assert laws_of(case) == expected
    Simulation(case, threads=1)


def test_the_friction_among_grains_is_that_which_acts() -> None:
    """Two discs pressed together that turn alike: Coulomb's impulse is mu times the normal one."""
    way = (
        'lattice = { lower = [0, 0], count = [2, 1], radius = "2.5 mm" }\nangular_velocity = 4000\n'
    )
    impulses, works = [], []
    for friction in (0.0, 0.1):
        pair = '[contact]\nfriction = 0.7\n[[contact.pair]]\nbodies = ["sand", "sand"]\n'
        simulation = Simulation(grains(way, more=f"{pair}friction = {friction}\n"), threads=1)
        for number, sign in ((0, 1.0), (1, -1.0)):
            v = simulation.core.column(number, "velocity") + np.array([sign * 5.0, 0.0])
            simulation.core.set_velocity(number, v)
        simulation.advance(100, 1.0)
        [found] = simulation.core.contact_pairs()
        impulses.append(found.impulse)
        works.append(found.friction_work)
    assert works[0] == 0.0 < works[1]
    # The rims slide at 20 m/s all the time. The few particles of a disc are no circle, and the
    # normal is not quite along x: what that gives without friction is taken off. Friction changes
    # the path of the rims by a few per cent.
    (_, tilt, _), (normal, tangential, _) = impulses
    assert abs(tangential - tilt) == pytest.approx(0.1 * abs(normal), rel=0.05)


def test_a_run_tells_the_grains_as_one(tmp_path: Path, capsys: Any) -> None:
    falling = LATTICE.replace("count = [3, 2]", "count = [3, 1]") + "velocity = [0, -20]\n"
    case = grains(falling + PLATE, more="[contact]\nfriction = 0.2\n")
    out = tmp_path / "out"
    manifest = run_case(case, out, threads=1, quiet=False, pictures=False)
    [pair] = [p for p in manifest.contact.pairs if p.bodies == ["plate", "sand"]]
    assert pair.pairs == 3
    assert manifest.contact.bodies == 4
    line = next(x for x in capsys.readouterr().out.splitlines() if x.startswith("contact:"))
    assert re.match(
        r"contact: 4 bodies, [\d,]+ overlapped nodes at the end, [\d,]+ at most, "
        r"points of surfaces that touch: [\d,]+ at the end, [\d,]+ at most, \d+ pairs, "
        r"\d bodies at a node at most, [\d.]+ MiB, [\d.]+% of the step's time",
        line,
    )
    history = read_history(out)
    columns = [name for name in history if name.startswith("contact_impulse")]
    assert columns == [f"contact_impulse_plate_sand_{x}" for x in "xyz"]
    # What the plate has got the grains have lost: their whole momentum's change.
    with open_results(out) as results:
        assert results.bodies == ["plate", "sand"]
        last = results.arrays(-1)
    assert last["grain"].max() == 2 and last["body"].max() == 1
    first = last["grain"][last["body"] == 0]
    assert first.max() == 0
    sand = last["body"] == 1
    mass = 2500 * np.pi * 2.5e-3**2 * 3 / sand.sum()  # Of a particle.
    change = mass * (last["velocity"][sand, 1].astype(float) + 20.0).sum()
    assert change == pytest.approx(-pair.impulse[1], rel=1e-5)  # float32 of velocities
    assert abs(manifest.energies["residual_max"]) < 1e-9 * manifest.energies["initial"]["kinetic"]


def test_the_sums_over_groups_are_those_of_their_pairs() -> None:
    simulation = Simulation(grains(LATTICE + "velocity = [3, -20]\n" + PLATE), threads=1)
    simulation.advance(200, 1.0)
    pairs, groups = simulation.core.contact_pairs(), simulation.core.contact_groups()
    assert [g.bodies for g in groups] == [(0, 1), (1, 1)]
    plate = [p for p in pairs if p.bodies[0] == 0]
    assert groups[0].pairs == len(plate) == 3
    assert groups[0].impulse == pytest.approx(np.sum([p.impulse for p in plate], axis=0))
    assert groups[0].first_time == min(p.first_time for p in plate)
    assert groups[1].impulse == [0.0, 0.0, 0.0]
    work = sum(p.friction_work for p in pairs)
    assert sum(g.friction_work for g in groups) == pytest.approx(work, rel=1e-12)


def test_pairs_are_kept_in_order_however_many_come() -> None:
    simulation = Simulation(grains(sphere_lattice(3, 3, 3), 3), threads=1)
    for body in range(27):  # All towards the middle, faster from farther away.
        x = simulation.core.column(body, "position")
        simulation.core.set_velocity(body, np.ascontiguousarray(-2000.0 * (x - 0.0075)))
    simulation.advance(30, 1.0)
    pairs = [pair.bodies for pair in simulation.core.contact_pairs()]
    assert pairs == sorted(set(pairs))
    assert len(pairs) == 3 * 3 * 3 * 2  # Of a lattice of 3 x 3 x 3, and none across edges.


def test_the_same_bits_with_two_threads() -> None:
    simulations = []
    for threads in (1, 2):
        simulation = Simulation(grains(LATTICE + "velocity = [3, -20]\n" + PLATE), threads=threads)
        simulation.advance(150, 1.0)
        simulations.append(simulation)
    one, two = simulations
    assert np.array_equal(one.column("sand", "velocity"), two.column("sand", "velocity"))
    forces = [[p.impulse for p in s.core.contact_pairs()] for s in simulations]
    assert forces[0] == forces[1]


@pytest.mark.parametrize("dimension", [2, 3])
def test_overlapping_boxes_are_all_found(dimension: int) -> None:
    random = np.random.default_rng(3)
    lower = random.random((200, dimension))
    upper = lower + 0.1 * random.random((200, dimension))
    upper[17] = lower[17] + 0.8  # One that is much larger.
    meet = np.all((lower[:, None] < upper[None]) & (upper[:, None] > lower[None]), axis=2)
    expected = sorted((b, a) for a, b in np.argwhere(np.triu(meet, 1)).tolist())
    a, b = overlapping_boxes(lower, upper)
    assert list(zip(b.tolist(), a.tolist(), strict=True)) == expected


MISTAKES = [
    ("", "grains.sand", "must have exactly one of lattice, packing and file"),
    (LATTICE.replace("[3, 2]", "[3]"), "grains.sand.lattice.count", "must have 2 numbers"),
    (LATTICE.replace(" }", ', spacing = "4 mm" }'), "lattice.spacing", "must be >= 2 radius"),
    (LATTICE.replace("2.5 mm", "0.1 mm"), "grains.sand.lattice", "holds no particle"),
    (LATTICE.replace("2.5 mm", "2500 m"), "grains.sand.lattice", "would need some"),
    (LATTICE.replace("[3, 2]", "[4294967296, 4294967296]"), "grains.sand", "more than 10,000,000"),
    ('file = "none.csv"\n', "grains.sand.file", "is not a file"),
    (LATTICE + PLATE.replace("plate", "sand"), "grains.sand", "has the name of a body"),
    (
        LATTICE + PLATE.replace('0 mm"] } }', '1 mm"] } }'),
        "grains.sand.lattice",
        "overlap body.plate",
    ),
    (LATTICE + PLATE.replace("plate", "sand_0001"), "grains.sand", "the name of another entry"),
    (
        "packing = { lower = [0, 0], upper = [0.01, 0.01], radius = 0.001, fraction = 0.95 }\n",
        "grains.sand.packing",
        "cannot be placed without overlap",
    ),
    (
        "packing = { lower = [0, 0], upper = [0.01, 0.01], radius = 0.001 }\n",
        "grains.sand.packing",
        "either count or fraction",
    ),
    (
        INSIDE.replace("fraction = 0.3", "count = 3"),
        "grains.sand.packing.count",
        "must not be given together with inside",
    ),
    (
        INSIDE.replace("disc", "ring")
        .replace("radius = 0.01", "inner_radius = 0.005, outer_radius = 0.01")
        .replace("0.001", "0.003"),
        "grains.sand.packing",
        "holds no whole grain",
    ),
    (
        INSIDE.replace("disc", "sphere").replace("[0, 0]", "[0, 0, 0]"),
        "grains.sand.packing.inside",
        "3D shape but grid.dimension = 2",
    ),
    ("packing = { radius = 0.001, fraction = 0.3 }\n", "grains.sand.packing.lower", "is missing"),
    (
        "packing = { lower = [0, 0], upper = [0.01, 0.01], radius = [0.002, 0.001], count = 3 }\n",
        "grains.sand.packing.radius",
        "the smaller first",
    ),
    (
        LATTICE + '[[contact.pair]]\nbodies = ["sand", "sandd"]\nfriction = 0.1\n',
        "contact.pair[0].bodies",
        "is not a body of this case",
    ),
    (
        LATTICE + PLATE + '[[contact.pair]]\nbodies = ["plate", "plate"]\nfriction = 0.1\n',
        "contact.pair[0].bodies",
        "two different bodies",
    ),
]


IN_SHAPES = {
    "{ disc = { centre = [0.1, 0.2], radius = 0.05 } }": (
        2,
        lambda x: np.hypot(*(x - [0.1, 0.2]).T) - 0.05,
    ),
    "{ sphere = { centre = [0.1, 0.2, 0], radius = 0.05 } }": (
        3,
        lambda x: np.linalg.norm(x - [0.1, 0.2, 0.0], axis=1) - 0.05,
    ),
    "{ ring = { centre = [0, 0], inner_radius = 0.03, outer_radius = 0.05 } }": (
        2,
        lambda x: np.abs(np.linalg.norm(x, axis=1) - 0.04) - 0.01,
    ),
}


@pytest.mark.parametrize("shape", IN_SHAPES)
def test_a_packing_fills_a_shape(shape: str) -> None:
    """Every grain lies in it as a whole, by the distance to its surface, and many do."""
    dimension, distance = IN_SHAPES[shape]
    text = f"packing = {{ inside = {shape}, radius = [0.003, 0.004], fraction = 0.5 }}\n"
    sand = grains(text, dimension).grains["sand"]
    centres, radii = sand.place(dimension)
    assert (distance(centres) + radii).max() < 1e-9
    assert len(radii) == sand.count == len(sand.names("sand"))
    np.testing.assert_array_equal(radii, sand.radii())
    room = np.pi * 0.05**2 if dimension == 2 else 4 / 3 * np.pi * 0.05**3
    room -= np.pi * 0.03**2 if "ring" in shape else 0.0
    # Half of the box is filled; a layer of about a radius at the surface of the shape stays empty.
    assert 0.2 < ball_volume(radii, dimension).sum() / room < 0.6


@pytest.mark.parametrize(("text", "key", "rule"), MISTAKES)
def test_a_mistake_is_a_sentence(text: str, key: str, rule: str) -> None:
    with pytest.raises(CaseError) as caught:
        build(grains(text))
    assert key in str(caught.value)
    assert rule in str(caught.value)


def test_grains_of_a_file_must_not_overlap() -> None:
    case = grains(LATTICE)
    near = GrainCentres([[0, 0], [0.0038, 0]], [2e-3, 2e-3])  # By 0.2 mm, the limit is 0.125 mm.
    sand = Grains(material="glass", file=near)
    with pytest.raises(CaseError, match=r"grains\.sand\.file has sand_0001 overlap sand_0000: by"):
        build(case.model_copy(update={"grains": {"sand": sand}}))


def test_a_wrong_line_of_a_file_is_named(tmp_path: Path) -> None:
    for line, rule in (("0,0,-1", "must have a radius > 0"), ("0,x,1", "is no number")):
        (tmp_path / "sand.csv").write_text(f"x,y,radius\n0,0,1\n{line}\n")
        (tmp_path / "case.toml").write_text(CASE.replace("DIM", "2") + 'file = "sand.csv"\n')
        with pytest.raises(CaseError, match=f"(?s){rule}.*line 3|line 3.*{rule}"):
            load_case(tmp_path / "case.toml")


def test_the_example_of_the_how_to_page_is_what_check_says() -> None:
    page = PAGE.read_text()
    text = re.findall(r"```toml\n(.*?)```", page, re.S)[0]
    [line] = re.findall(r"```text\n(.*?)\n```", page, re.S)
    case = Case.from_text(text)
    assert line in echo(case, build(case)).splitlines()
