# SPDX-License-Identifier: BSD-3-Clause
"""Contact does not care which way the world is turned, nor how bodies and particles are numbered.

Bodies are filled as a case file fills them, and the particles so placed are then mirrored or
turned: where a lattice fills a shape it may differ there, but not what contact makes of it.
The runs are longer than contact needs to act everywhere, and shorter than it takes the rounding of
sums, 1e-16, to grow to what is tolerated: bodies that collide with friction are chaotic.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp import Case, Simulation
from mpm3dpp.case.loads import Load
from worlds import COMPOSED, GENERATING, World, check_worlds

RINGS = """
[grid]
dimension = 2
cell_size = "2 mm"
box = { lower = ["-100 mm", "-52 mm"], upper = ["100 mm", "52 mm"] }
[run]
end_time = "3.5 ms"
[material.rubber]
density = "1010 kg/m^3"
strength = { neo_hookean = { K = "121.7 MPa", G = "26.1 MPa" } }
[body.left]
material = "rubber"
shape = { ring = { centre = [-0.041, 0.0], inner_radius = "30 mm", outer_radius = "40 mm" } }
particles_per_cell = 3
velocity = ["30 m/s", 0]
[body.right]
material = "rubber"
shape = { ring = { centre = [0.0413, 0.0077], inner_radius = "30 mm", outer_radius = "40 mm" } }
particles_per_cell = 3
velocity = ["-30 m/s", 0]
"""

GRAINS = """
[grid]
dimension = 2
cell_size = "2 mm"
box = { lower = ["-64 mm", "-64 mm"], upper = ["64 mm", "64 mm"], walls = "contact" }
[run]
end_time = "1 s"
gravity = [0, "-9.81 m/s^2"]
[contact]
friction = 0.4
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[grains.sand]
material = "soft"
velocity = ["1 m/s", "-2 m/s"]
[grains.sand.packing]
lower = ["-60 mm", "-62 mm"]
upper = ["60 mm", "40 mm"]
radius = ["4 mm", "8 mm"]
count = 50
"""

IMPACT = """
[grid]
dimension = 3
cell_size = "1 mm"
box = { lower = ["-16 mm", "-16 mm", "-16 mm"], upper = ["16 mm", "16 mm", "16 mm"] }
[run]
end_time = "50 us"
[contact]
friction = 0.2
[material.copper]
library = "copper_ofhc"
failure = { plastic_strain = { limit = 1.2, action = "erode" } }
[body.ball]
material = "copper"
shape = { sphere = { centre = ["1 mm", "0.5 mm", "5 mm"], radius = "4 mm" } }
velocity = ["300 m/s", "200 m/s", "-300 m/s"]
[body.plate]
material = "copper"
shape = { box = { lower = ["-10 mm", "-10 mm", "-2 mm"], upper = ["10 mm", "10 mm", "0 mm"] } }
"""


def slow(*values: Any) -> Any:
    """What has been the default, and what generates or is part of another row."""
    return pytest.param(*values, marks=pytest.mark.slow)


@pytest.mark.parametrize(
    ("text", "steps"),
    [(RINGS, 1300), (GRAINS, 800), (IMPACT, 600)],
    ids=["two rings", "fifty grains", "impact with erosion"],
)
@pytest.mark.parametrize("basis", [slow("gimp"), "quadratic_bspline"])
@pytest.mark.parametrize(
    "worlds",
    [COMPOSED, slow(GENERATING)],
    ids=["composed", "generating"],
)
def test_another_world_is_the_same_to_rounding(
    text: str, steps: int, basis: str, worlds: dict[int, list[World]]
) -> None:
    given = f'basis = "{basis}"\n[run]\ntransfer = "flip"'
    check_worlds(Case.from_text(text.replace("[run]", given)), steps, text, worlds=worlds)


def test_another_world_is_the_same_with_pic() -> None:
    """One ring, thrown at two walls: PIC does not go with contact."""
    text = RINGS.replace("[run]", '[run]\ntransfer = "pic"').partition("[body.right]")[0]
    text = text.replace('"52 mm"] }', '"52 mm"], walls = "slip" }')
    text = text.replace('velocity = ["30 m/s", 0]', 'velocity = ["-30 m/s", "20 m/s"]')
    check_worlds(Case.from_text(text), 1800, text, meet=False)


@pytest.mark.parametrize(
    ("text", "steps"),
    [slow(RINGS, 1800), slow(IMPACT, 600)],
    ids=["two rings", "impact with erosion"],
)
def test_another_world_is_the_same_with_xpic(text: str, steps: int) -> None:
    given = "[run]\ntransfer = { xpic = 3, every = 2 }"
    # Less noise, less plastic strain: so that particles erode all the same.
    case = Case.from_text(text.replace("[run]", given).replace("limit = 1.2", "limit = 0.6"))
    check_worlds(case, steps, text)


@pytest.mark.parametrize(
    ("text", "steps"),
    [slow(RINGS, 900), slow(GRAINS, 750), (IMPACT, 500)],
    ids=["two rings", "fifty grains", "impact with erosion"],
)
@pytest.mark.parametrize(
    "given",
    [slow('{ aflip = 0.97 }\nscheme = "usf"'), '"apic"'],
    ids=["aflip, usf", "apic, musl"],
)
def test_another_world_is_the_same_with_affine_transfers(text: str, steps: int, given: str) -> None:
    text = text.replace(
        "[run]", f'basis = "quadratic_bspline"\n[run]\ncfl = 0.5\ntransfer = {given}'
    )
    # Less noise, less plastic strain: so that particles erode all the same.
    check_worlds(Case.from_text(text.replace("limit = 1.2", "limit = 0.6")), steps, text)


@pytest.mark.parametrize(
    ("text", "steps"),
    [slow(RINGS, 1500), slow(GRAINS, 750), (IMPACT, 500)],
    ids=["two rings", "fifty grains", "impact with erosion"],
)
@pytest.mark.parametrize(
    "given",
    [
        '"quadratic_bspline"\n[run]\nscheme = "usf"\ncfl = 0.25\ntransfer = { aflip = 0.97 }',
        slow('"gimp"\n[run]'),
    ],
    ids=["aflip, usf", "gimp, musl"],
)
def test_another_world_is_the_same_with_averaged_volumes(text: str, steps: int, given: str) -> None:
    text = text.replace("[run]", f"basis = {given}").replace("limit = 1.2", "limit = 0.6")
    case = Case.from_text(text)
    for material in case.material.values():
        material.volume_averaging = True
    check_worlds(case, steps, text)


@pytest.mark.parametrize(
    ("text", "steps"),
    [slow(RINGS, 900), (GRAINS, 750), (IMPACT, 500)],
    ids=["two rings", "fifty grains", "impact with erosion"],
)
def test_another_world_is_the_same_with_springs(text: str, steps: int) -> None:
    given = 'basis = "quadratic_bspline"\n[run]\nscheme = "usf"\ncfl = 0.5'
    text = text.replace("[run]", f"{given}\ntransfer = {{ aflip = 0.97 }}")
    text = text.replace("limit = 1.2", "limit = 0.6")
    case = Case.from_text(text)
    case.contact.response = "springs"
    check_worlds(case, steps, text)


def in_space(text: str) -> str:
    """Return a case whose bodies have their nodes in space."""
    return text.replace("shape = ", 'frame = "updated"\nshape = ')


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_field_of_velocities_is_the_same_in_another_world(dimension: int) -> None:
    """Formulas here, and there the velocities that they give, particle by particle."""
    text = in_space(RINGS if dimension == 2 else IMPACT)
    for given in ('["30 m/s", 0]', '["300 m/s", "200 m/s", "-300 m/s"]'):
        field = ", ".join(
            f'{{ expression = "{text}", length = "mm" }}'
            for text in ("-60 * sin(x / 50)", "5 * sin(r / 20) - y", "-200 + z")[:dimension]
        )
        text = text.replace(f"velocity = {given}", f"velocity = [{field}]")
    assert "expression" in text
    check_worlds(Case.from_text(text), 600 if dimension == 2 else 300, "")


@pytest.mark.parametrize("dimension", [2, 3])
def test_body_forces_are_the_same_in_another_world(dimension: int) -> None:
    """Of every variable, large enough to be seen beside the impact."""
    text = in_space(RINGS if dimension == 2 else IMPACT)
    size = 2e3 if dimension == 2 else 1e7
    forces = [
        f"{size} * sin(40 * X + 30 * y)",
        f"{size} * x / (0.1 + Y)",
        f"-{size} * cos(8e4 * t)",
    ]
    field = ", ".join(f'{{ expression = "{force}" }}' for force in forces[:dimension])
    text = text.replace("shape = ", f"body_force = [{field}]\nshape = ")
    check_worlds(Case.from_text(text), 900 if dimension == 2 else 150, "")


@pytest.mark.parametrize("dimension", [2, 3])
def test_damping_is_the_same_in_another_world(dimension: int) -> None:
    """Local damping too, as these worlds have the axes of this one."""
    text = in_space(RINGS if dimension == 2 else IMPACT)
    text = text.replace("shape = ", "damping = { mass = 30, local = 0.1 }\nshape = ")
    check_worlds(Case.from_text(text), 900 if dimension == 2 else 150, "")


@pytest.mark.parametrize("dimension", [2, 3])
def test_forces_at_points_are_the_same_in_another_world(dimension: int) -> None:
    """On a particle, and on two or four that are as near."""
    case = Case.from_text(in_space(RINGS if dimension == 2 else IMPACT))
    body = next(iter(case.body))
    position = Simulation(case).column(body, "position")
    spacing = case.grid.cell_size / 2
    size = 2e4 if dimension == 2 else 2e3
    on, between = position[0] + 0.2 * spacing, position[len(position) // 2]
    force = np.array([size, -0.5 * size, 0.3 * size])[:dimension]
    loads = {
        "on": Load(body=body, point=tuple(on), force=tuple(force)),
        "between": Load(body=body, point=tuple(between + 0.5 * spacing), force=tuple(-force)),
    }
    case = case.model_copy(update={"load": loads})
    check_worlds(case, 900 if dimension == 2 else 150, "")
