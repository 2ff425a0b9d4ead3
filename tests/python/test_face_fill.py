# SPDX-License-Identifier: BSD-3-Clause
"""Boxes are filled from their faces: gaps close as they are drawn, and masses are exact.

A gap closes in the step in which the drawn surfaces meet, or in the next one, which sees it.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from mpm3dpp import Body, Case, Simulation
from mpm3dpp.case.grid import Grid
from mpm3dpp.fill.build import build
from mpm3dpp.shapes import (
    Box,
    Cylinder,
    Disc,
    Frustum,
    Polygon,
    Rotate,
    Shape,
    Translate,
    Union,
    fill,
)
from mpm3dpp.shapes.faces import cells_are_alike, fill_from_faces, fits_the_lattice
from mpm3dpp.shapes.lattice import fill_shape

BLOCKS = """
[grid]
dimension = 2
cell_size = "4 mm"
[run]
end_time = "4 ms"
[material.e]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.a]
material = "e"
shape = { box = { lower = ["-40 mm", "0 mm"], upper = ["0 mm", "20 mm"] } }
velocity = [1, 0]
[body.b]
material = "e"
shape = { box = { lower = ["GAP mm", "0 mm"], upper = ["END mm", "20 mm"] } }
"""
BAR = """
[grid]
dimension = 2
cell_size = "40 mm"
[run]
end_time = "2 ms"
[material.steel]
density = "7800 kg/m^3"
strength = { elastic = { E = "200 GPa", nu = 0.0 } }
[material.hard]
density = "7800 kg/m^3"
strength = { rigid = {} }
[body.wall]
material = "hard"
motion = "fixed"
shape = { box = { lower = [2.001, -0.2], upper = [2.201, 0.4] } }
[body.bar]
material = "steel"
shape = { box = { lower = [0, 0], upper = [2, 0.2] } }
velocity = [1.5, 0]
"""
# A block turned by 30 degrees flies along its long edge at another one, turned with it.
TURN = 'rotate = { angle = "30 deg", about = [0, 0], shape = { '
TURNED = (
    BLOCKS.replace("shape = { box", f"shape = {{ {TURN}box")
    .replace('"20 mm"] } }', '"20 mm"] } } } }')
    .replace("velocity = [1, 0]", f"velocity = [{math.cos(math.pi / 6)}, 0.5]")
)
SOLID = (
    BLOCKS.replace("dimension = 2", "dimension = 3")
    .replace('"0 mm"]', '"0 mm", "1 mm"]')
    .replace('"20 mm"]', '"20 mm", "13 mm"]')
    .replace("[1, 0]", "[1, 0, 0]")
)


def closes(text: str, gap: float, end: float) -> tuple[float, float]:
    """Return when the gap of two blocks is closed, and the length of a step [s]."""
    case = Case.from_text(text.replace("GAP", f"{gap:g}").replace("END", f"{end:g}"))
    simulation = Simulation(case, threads=1)
    while not simulation.core.contact_pairs():
        assert simulation.advance(1, case.run.end_time) == 1
    [pair] = simulation.core.contact_pairs()
    return pair.first_time, simulation.dt


@pytest.mark.parametrize("gap", [0.9, 1.1, 0.37])
def test_a_gap_closes_as_it_is_drawn(gap: float) -> None:
    time, step = closes(BLOCKS, gap, gap + 40.0)
    assert gap * 1e-3 <= time <= gap * 1e-3 + 1.5 * step


def test_a_gap_between_blocks_of_any_size_closes_as_it_is_drawn() -> None:
    """With 39.3 mm in 20 particles these are no squares: a gap is off by 0.8 (1 - w / edge)."""
    time, step = closes(BLOCKS, 0.9, 0.9 + 39.3)
    assert 0.0009 - 2e-5 <= time <= 0.0009 + 2e-5 + 1.5 * step


def test_a_gap_between_turned_blocks_closes_as_it_is_drawn() -> None:
    time, step = closes(TURNED, 0.9, 40.9)
    assert 0.0009 <= time <= 0.0009 + 1.5 * step


def test_a_gap_closes_as_it_is_drawn_in_3d() -> None:
    time, step = closes(SOLID, 0.9, 40.9)
    assert 0.0009 <= time <= 0.0009 + 1.5 * step


def test_a_bar_touches_its_wall() -> None:
    time, step = closes(BAR, 0.0, 0.0)
    assert 1e-3 / 1.5 <= time <= 1e-3 / 1.5 + 1.5 * step


def filled(shape: Shape, spacing: float = 1.0, **keys: object) -> tuple[np.ndarray, np.ndarray]:
    dimension = len(shape.bounds()[0])
    grid = Grid(dimension=dimension, cell_size=2.0)
    return fill(Body(material="m", shape=shape, spacing=spacing, **keys), grid)


ZERO = np.zeros(3)
ON_PLANES: list[Shape] = [
    Box(lower=(-3, 2), upper=(4, 7)),
    Box(lower=(-3, 2, 0), upper=(4, 7, 1)),
    Box(lower=(0, 0), upper=(9, 9)) - Box(lower=(3, 3), upper=(5, 6)),
    Union(shapes=[Box(lower=(0, 0), upper=(9, 3)), Disc(centre=(4.3, 5.1), radius=2.2)]),
    Rotate(shape=Box(lower=(0, 0), upper=(8, 4)), angle="90 deg"),
    Translate(shape=Box(lower=(0.5, 0.25), upper=(8.5, 3.25)), by=(0.5, 0.75)),
    Polygon(points=[(0, 0), (6, 0), (3, 5)]),
]


@pytest.mark.parametrize("shape", ON_PLANES, ids=lambda shape: shape.kind)
def test_faces_on_planes_of_the_lattice_have_its_points_to_the_bit(shape: Shape) -> None:
    positions, volumes = filled(shape)
    lattice = fill_shape(shape, ZERO[: positions.shape[1]], 1.0)
    assert np.array_equal(positions, lattice)
    assert (volumes == 1.0).all()
    assert fits_the_lattice(shape, ZERO[: positions.shape[1]], 1.0)


OFF_PLANES: list[tuple[Shape, float]] = [
    (Box(lower=(0.3, 0.2), upper=(7.9, 5.1)), 7.6 * 4.9),
    (Box(lower=(0.3, 0.2, 0.1), upper=(7.9, 5.1, 2.6)), 7.6 * 4.9 * 2.5),
    (Box(lower=(0.3, 0), upper=(9, 9)) - Box(lower=(3.4, 3.2), upper=(5, 6)), 8.7 * 9 - 1.6 * 2.8),
    (
        Union(shapes=[Box(lower=(0, 0), upper=(9.4, 3)), Box(lower=(0, 3), upper=(2.7, 8.6))]),
        9.4 * 3 + 2.7 * 5.6,
    ),
    (Box(lower=(0, 0), upper=(9, 9)) & Box(lower=(-1, 2.3), upper=(4.7, 20)), 4.7 * 6.7),
    (Rotate(shape=Box(lower=(0, 0), upper=(8.2, 4.1)), angle=0.4), 8.2 * 4.1),
    (
        Translate(
            shape=Rotate(
                shape=Box(lower=(0, 0, 0), upper=(8.2, 4.1, 3.3)), angle=0.4, axis=(1, 2, 0)
            ),
            by=(1.0, 2.0, 3.0),
        ),
        8.2 * 4.1 * 3.3,
    ),
    (Polygon(points=[(0, 0), (6.3, 0), (6.3, 4.2), (0, 4.2)]), 6.3 * 4.2),
]


@pytest.mark.parametrize(("shape", "volume"), OFF_PLANES, ids=lambda x: getattr(x, "kind", ""))
def test_the_mass_is_exact_and_the_middle_too(shape: Shape, volume: float) -> None:
    positions, volumes = filled(shape)
    assert volumes.sum() == pytest.approx(volume, rel=1e-12)
    assert shape.contains(positions).all()
    middle = (positions * volumes[:, None]).sum(axis=0) / volume
    width = 0.05 if len(middle) == 2 else 0.25
    fine, each = filled(shape, width, fill="lattice")
    assert np.abs(middle - (fine * each[:, None]).sum(axis=0) / each.sum()).max() < 0.5 * width


def test_cells_are_as_many_as_come_next_to_the_spacing() -> None:
    positions, volumes = filled(Box(lower=(0.3, 0.0), upper=(7.9, 4.0)))
    assert [len(np.unique(positions[:, d])) for d in (0, 1)] == [8, 4]
    assert np.ptp(volumes) == 0.0
    assert volumes[0] == pytest.approx(7.6 / 8)
    assert positions[:, 0].min() == pytest.approx(0.3 + 0.5 * 0.95)
    assert positions[:, 0].max() == pytest.approx(7.9 - 0.5 * 0.95)


def test_flat_ends_of_what_is_not_all_flat() -> None:
    cone = Frustum(centre=(0, 0, 0.3), lower_radius=4, upper_radius=2, height=5.3)
    positions, _ = filled(cone)
    width = 5.3 / 5
    assert positions[:, 2].min() == pytest.approx(0.3 + 0.5 * width)
    assert positions[:, 2].max() == pytest.approx(5.6 - 0.5 * width)
    bolt = Union(
        shapes=[
            Box(lower=(-4, -4, 0), upper=(4, 4, 2.6)),
            Cylinder(centre=(0, 0, 5.2), radius=2, height=5.2),
        ]
    )
    positions, _ = filled(bolt)
    assert positions[:, 2].max() == pytest.approx(7.8 - 0.5 * 5.2 / 5)


def test_what_is_thinner_than_half_a_spacing_holds_none() -> None:
    from mpm3dpp import CaseError

    for edge, fits in ((0.49, False), (0.51, True)):
        thin = Box(lower=(0, 0.1), upper=(9, 0.1 + edge))
        if fits:
            assert len(filled(thin)[0]) == 9
            continue
        with pytest.raises(CaseError, match="holds no particle"):
            filled(thin)


def test_mirror_images_are_filled_alike() -> None:
    one, _ = filled(Box(lower=(0.3, 0.2), upper=(7.9, 5.1)))
    other, _ = filled(Box(lower=(-7.9, 0.2), upper=(-0.3, 5.1)))
    mirrored = np.unique(np.round(other * (-1, 1), 12), axis=0)
    assert np.array_equal(np.unique(np.round(one, 12), axis=0), mirrored)


def test_neighbours_share_the_face_between_them() -> None:
    """Layers that are bonded along a face off the lattice leave neither a gap nor a dent."""
    left, right = Box(lower=(0, 0), upper=(4.3, 4)), Box(lower=(4.3, 0), upper=(9, 4))
    (a, u), (b, v) = filled(left), filled(right)
    assert a[:, 0].max() + 0.5 * 4.3 / 4 == pytest.approx(4.3)
    assert b[:, 0].min() - 0.5 * 4.7 / 5 == pytest.approx(4.3)
    assert u.sum() + v.sum() == pytest.approx(36.0)


def test_a_box_of_several_ranks_has_parts_of_one_volume() -> None:
    shape = Box(lower=(0.3, 0.2, 0.1), upper=(7.9, 5.1, 2.6))
    whole = filled(shape)[0]
    grid = Grid(dimension=3, cell_size=2.0)
    body = Body(material="m", shape=shape, spacing=1.0)
    parts = [fill(body, grid, part=k, parts=3) for k in range(3)]
    assert np.array_equal(np.concatenate([x for x, _ in parts]), whole)
    assert cells_are_alike(shape, ZERO, 1.0)
    assert not cells_are_alike(OFF_PLANES[2][0], ZERO[:2], 1.0)


def test_a_box_at_the_walls_ends_at_them() -> None:
    """Cut at the box, and resting on a floor with its upper face off the lattice."""
    text = BLOCKS.replace(
        '"4 mm"\n', '"4 mm"\nbox = { lower = [0, 0], upper = ["80 mm", "40 mm"] }\n'
    )
    text = text.replace(
        'upper = ["0 mm", "20 mm"] } }', 'upper = ["9 mm", "17 mm"] } }\ncut_at_box = true'
    )
    text = text.replace("GAP", "50.3").replace("END", "71.6")
    a, b = build(Case.from_text(text))
    assert a.mass == pytest.approx(1000 * 0.009 * 0.017, rel=1e-12)
    assert b.mass == pytest.approx(1000 * 0.0213 * 0.02, rel=1e-12)
    assert a.positions[:, 0].min() == pytest.approx(0.009 / 5 / 2)


@pytest.mark.parametrize(("thick", "width"), [(10.0, 10.0 / 3), (9.0, 4.5), (13.0, 13.0 / 3)])
def test_cells_of_a_thin_body_are_squares(thick: float, width: float) -> None:
    """Those along it take the width of the few across it, wherever these come to lie."""
    box = Box(lower=(-10.0, -thick), upper=(90.0, 0.0))
    points, _ = fill_from_faces(box, ZERO[:2], 4.0)
    along, across = (np.unique(np.round(points[:, d], 9)) for d in (0, 1))
    assert np.diff(across) == pytest.approx(width)
    assert np.diff(along) == pytest.approx(width, rel=0.03)


def test_a_block_slides_by_coulomb_on_a_thin_table() -> None:
    """Particles wider than high lay 0.04 of an edge too deep: the block hopped, and its friction
    was 1.026 times what it can be."""
    text = """
[grid]
dimension = 2
cell_size = "8 mm"
[run]
end_time = "0.1 s"
gravity = [0, -9.81]
[material.rubber]
density = 1000
strength = { elastic = { E = "0.5 MPa", nu = 0.3 } }
[body.block]
material = "rubber"
shape = { box = { lower = [0, 0], upper = ["40 mm", "20 mm"] } }
velocity = [0.4, 0]
initial = { stress = "geostatic" }
[body.table]
material = "rubber"
shape = { box = { lower = ["-10 mm", "-10 mm"], upper = ["90 mm", 0] } }
motion = "fixed"
[contact]
friction = 0.3
"""
    simulation = Simulation(Case.from_text(text))
    simulation.advance(100_000, 0.1)
    (pair,) = simulation.core.contact_pairs()
    ratio = -pair.impulse[0] / pair.impulse[1]
    assert ratio == pytest.approx(0.3, rel=2e-3)


def test_the_hash_is_that_of_before_where_nothing_changes() -> None:
    blocks = BLOCKS.replace("GAP", "2").replace("END", "42")
    same = Case.from_text(blocks)
    assert "fill" not in same.content()["body"]["b"]
    lattice = blocks + 'fill = "lattice"\n'
    assert Case.from_text(lattice).case_hash == same.case_hash
    off = BLOCKS.replace("GAP", "0.9").replace("END", "40.9")
    assert Case.from_text(off).case_hash != Case.from_text(off + 'fill = "lattice"\n').case_hash
