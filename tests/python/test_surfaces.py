# SPDX-License-Identifier: BSD-3-Clause
"""Named sides of shapes: their areas, normals and places, and how particles share them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mpm3dpp import Body, Case, CaseError, Grid, Material, Run, shapes
from mpm3dpp.case.load_pieces import nearest_particles, pieces
from mpm3dpp.case.loads import Load
from mpm3dpp.fill.build import build
from mpm3dpp.shapes.surfaces import sides, surface

BOX2 = shapes.Box(lower=(0.1, 0.2), upper=(0.5, 0.9))
BOX3 = shapes.Box(lower=(0.1, 0.2, 0.0), upper=(0.5, 0.9, 1.0))
DISC = shapes.Disc(centre=(0.1, 0.2), radius=0.3)
RING = shapes.Ring(centre=(0.1, 0.2), inner_radius=0.2, outer_radius=0.3)
SPHERE = shapes.Sphere(centre=(0.1, 0.2, 0.3), radius=0.3)
CYLINDER = shapes.Cylinder(centre=(0.1, 0.2, 0.3), radius=0.3, height=0.7, axis="y")
TUBE = shapes.Tube(centre=(0.1, 0.2, 0.3), inner_radius=0.2, outer_radius=0.3, height=0.7, axis="x")
END = math.pi * (0.3**2 - 0.2**2)
WEDGE = shapes.Polygon(points=[(0.1, 0.2), (0.5, 0.2), (0.5, 0.9), (0.3, 0.5)])
CLOCKWISE = shapes.Polygon(points=WEDGE.points[::-1])
FRUSTUM = shapes.Frustum(
    centre=(0.1, 0.2, 0.3), height=0.4, axis="y", lower_radius=0.2, upper_radius=0.5
)
CONE = shapes.Frustum(
    centre=(0.1, 0.2, 0.3), height=0.4, axis="x", lower_radius=0.3, upper_radius=0.0
)
# Its wall leans by 4 to 3: 0.05 thick is 0.0625 along the radius.
FUNNEL = shapes.Funnel(
    centre=(0.1, 0.2, 0.3),
    outlet_radius=0.1,
    inlet_radius=0.4,
    height=0.4,
    thickness=0.05,
    stem=0.2,
)
HOPPER = shapes.Funnel(
    centre=(0.1, 0.2), outlet_radius=0.1, inlet_radius=0.4, height=0.4, thickness=0.05, axis="x"
)
ROD = shapes.OgiveRod(tip=(0.1, 0.2, 0.3), radius=0.2, length=0.9, crh=0.5, towards="-y")
SHARP = shapes.OgiveRod(tip=(0.1, 0.2, 0.3), radius=0.2, length=0.9, crh=1.5, towards="x")
# The arc of 0.6 m turned about the axis by Pappus: its length times the way of its centroid.
OGIVE = 2 * math.pi * 0.6 * (SHARP.nose_length - 0.4 * math.asin(SHARP.nose_length / 0.6))
WHOLE = [BOX2, BOX3, DISC, RING, SPHERE, CYLINDER, TUBE, WEDGE, CLOCKWISE, FRUSTUM, CONE]
WHOLE += [FUNNEL, HOPPER, ROD, SHARP]
SIDES = [
    (BOX2, "x_min", 0.7, (-1, 0)),
    (BOX2, "y_max", 0.4, (0, 1)),
    (BOX3, "x_max", 0.7, (1, 0, 0)),
    (BOX3, "z_min", 0.28, (0, 0, -1)),
    (DISC, "outer", 0.6 * math.pi, None),
    (RING, "outer", 0.6 * math.pi, None),
    (RING, "inner", 0.4 * math.pi, None),
    (SPHERE, "outer", 0.36 * math.pi, None),
    (CYLINDER, "outer", 0.42 * math.pi, None),
    (CYLINDER, "upper", 0.09 * math.pi, (0, 1, 0)),
    (CYLINDER, "lower", 0.09 * math.pi, (0, -1, 0)),
    (TUBE, "outer", 0.42 * math.pi, None),
    (TUBE, "inner", 0.28 * math.pi, None),
    (TUBE, "upper", END, (1, 0, 0)),
    (TUBE, "lower", END, (-1, 0, 0)),
    (WEDGE, "side_0", 0.4, (0, -1)),
    (WEDGE, "side_1", 0.7, (1, 0)),
    (CLOCKWISE, "side_1", 0.7, (1, 0)),
    (CLOCKWISE, "side_2", 0.4, (0, -1)),
    (FRUSTUM, "outer", 0.35 * math.pi, (0, -0.6, 0)),
    (FRUSTUM, "lower", 0.04 * math.pi, (0, -1, 0)),
    (FRUSTUM, "upper", 0.25 * math.pi, (0, 1, 0)),
    (CONE, "outer", 0.15 * math.pi, (0.6, 0, 0)),
    (CONE, "lower", 0.09 * math.pi, (-1, 0, 0)),
    (FUNNEL, "inner", 0.29 * math.pi, (0, 0, 0.15 / 0.29)),
    (FUNNEL, "outer", 0.3775 * math.pi, (0, 0, -0.1875 / 0.3775)),
    (FUNNEL, "lower", 0.0625 * 0.2625 * math.pi, (0, 0, -1)),
    (FUNNEL, "upper", 0.0625 * 0.8625 * math.pi, (0, 0, 1)),
    (HOPPER, "inner", 1.0, (0.6, 0)),
    (HOPPER, "outer", 1.0, (-0.6, 0)),
    (HOPPER, "lower", 0.125, (-1, 0)),
    (HOPPER, "upper", 0.125, (1, 0)),
    (ROD, "nose", 0.08 * math.pi, (0, -0.5, 0)),
    (ROD, "outer", 0.28 * math.pi, None),
    (ROD, "end", 0.04 * math.pi, (0, 1, 0)),
    (SHARP, "nose", OGIVE, (0.04 * math.pi / OGIVE, 0, 0)),
    (shapes.Translate(shape=BOX2, by=(1.0, 2.0)), "x_min", 0.7, (-1, 0)),
    (shapes.Rotate(shape=BOX2, angle=math.pi / 2), "x_min", 0.7, (0, -1)),
    (shapes.Rotate(shape=BOX3, angle=math.pi / 2, axis=(1, 0, 0)), "y_max", 0.4, (0, 0, 1)),
]


@pytest.mark.parametrize(("shape", "side", "area", "normal"), SIDES)
def test_a_side_has_its_area_and_its_normal(
    shape: Any, side: str, area: float, normal: Any
) -> None:
    found = surface(shape, side, 0.02)
    size = np.linalg.norm(found.areas, axis=1)
    assert size.sum() == pytest.approx(area, rel=1e-12)
    if normal is not None:
        assert found.areas.sum(axis=0) == pytest.approx(area * np.array(normal), abs=1e-12)
    else:
        assert np.abs(found.areas.sum(axis=0)).max() < 1e-13
    # The points lie on the surface, and their normals lead out of the shape.
    step = 1e-6 * found.areas / size[:, None]
    assert not shape.contains(found.points + step).any()
    assert shape.contains(found.points - step).all()


@pytest.mark.parametrize("shape", WHOLE)
def test_all_sides_close_the_shape(shape: Any) -> None:
    """The divergence theorem: sum of a is zero, sum of x . a is D times the volume."""
    dimension = len(shape.bounds()[0])
    found = surface(shape, "all", 0.005)
    assert np.abs(found.areas.sum(axis=0)).max() < 1e-12
    volume = np.sum(found.points * found.areas) / dimension
    assert volume == pytest.approx(shape.volume(), rel=1e-4)  # (step / radius)^2
    assert sides(shape)[-1] == "all"


def test_every_shape_has_sides() -> None:
    known = {type(shape) for shape in WHOLE}
    combine = {"union", "difference", "intersection", "translate", "rotate"}
    assert {shape.kind for shape in known} | combine == set(shapes.KINDS)


def case(shape: Any, side: str, spacing: float, cell: float) -> Case:
    return Case(
        grid=Grid(dimension=len(shape.bounds()[0]), cell_size=cell),
        run=Run(end_time=1.0),
        material={"m": Material(density=1.0, strength={"elastic": {"E": 1.0, "nu": 0.3}})},
        body={"b": Body(material="m", shape=shape, spacing=spacing)},
        load={"l": Load(body="b", side=side, pressure=1.0)},
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_end_of_an_aligned_block_is_shared_evenly(dimension: int) -> None:
    """Each particle of the outer layer has its own square, half a spacing before it."""
    shape = shapes.Box(lower=(0.0,) * dimension, upper=(1.0, 0.5, 0.25)[:dimension])
    problem = case(shape, "x_max", 0.125, 0.25)
    [body] = build(problem)
    found = pieces(problem, "l", body.positions, body.spacing)
    assert len(found.particles) == (4 if dimension == 2 else 8)
    assert np.allclose(body.positions[found.particles][:, 0], 1.0 - 0.0625)
    normal, arm = np.zeros(dimension), np.zeros(dimension)
    normal[0], arm[0] = 0.125 ** (dimension - 1), 0.0625
    assert np.abs(found.areas - normal).max() < 1e-15
    assert np.abs(found.arms - arm).max() < 1e-15


def test_a_rim_is_shared_among_the_particles_next_to_it() -> None:
    problem = case(DISC, "outer", 0.02, 0.04)
    [body] = build(problem)
    found = pieces(problem, "l", body.positions, body.spacing)
    assert found.area == pytest.approx(0.6 * math.pi, rel=1e-12)
    assert np.abs(found.areas.sum(axis=0)).max() < 1e-14
    places = body.positions[found.particles] + found.arms - np.array(DISC.centre)
    radius = np.linalg.norm(places, axis=1)
    assert (radius < 0.3).all() and (radius > 0.3 - 0.002).all()
    assert np.linalg.norm(found.arms, axis=1).max() < 1.5 * 0.02


def test_a_side_without_particles_is_refused() -> None:
    problem = case(RING, "inner", 0.02, 0.04)
    [body] = build(problem)
    half = body.positions[body.positions[:, 0] > 0.1]
    with pytest.raises(CaseError, match=r"load\.l\.side = \"inner\" has no particles near 44%"):
        pieces(problem, "l", half, body.spacing)


def test_the_nearest_particle_is_the_nearest() -> None:
    rng = np.random.default_rng(1)
    lattice = np.stack(np.meshgrid(*[np.arange(6)] * 3, indexing="ij"), -1).reshape(-1, 3)
    positions = 0.1 * (lattice + 0.5)
    points = rng.uniform(0.0, 0.6, (200, 3))
    numbers, found = nearest_particles(positions, points, 0.1)
    assert (numbers == np.arange(200)).all()
    gaps = np.linalg.norm(points[:, None] - positions[None], axis=2)
    assert (found == gaps.argmin(axis=1)).all()
    far = nearest_particles(positions, np.array([[2.0, 0.0, 0.0]]), 0.1)
    assert [len(part) for part in far] == [0, 0]
    # Half way between two particles, and in the middle of a cube of eight.
    middles = np.array([[0.1, 0.05, 0.05], [0.1, 0.1, 0.1]])
    numbers, found = nearest_particles(positions, middles, 0.1)
    assert np.bincount(numbers).tolist() == [2, 8]
    assert found[:2].tolist() == [0, 36]
