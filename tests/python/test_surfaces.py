# SPDX-License-Identifier: BSD-3-Clause
"""Named sides of shapes: their areas, normals and places, and how particles share them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mpm3dpp import Body, Case, CaseError, Grid, Material, Run, shapes
from mpm3dpp.case.loads import Load, nearest_particles, pieces
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


@pytest.mark.parametrize("shape", [BOX2, BOX3, DISC, RING, SPHERE, CYLINDER, TUBE])
def test_all_sides_close_the_shape(shape: Any) -> None:
    """The divergence theorem: sum of a is zero, sum of x . a is D times the volume."""
    dimension = len(shape.bounds()[0])
    found = surface(shape, "all", 0.005)
    assert np.abs(found.areas.sum(axis=0)).max() < 1e-12
    volume = np.sum(found.points * found.areas) / dimension
    assert volume == pytest.approx(shape.volume(), rel=1e-4)  # (step / radius)^2
    assert sides(shape, dimension)[-1] == "all"


def test_a_combined_shape_has_no_sides() -> None:
    assert sides(BOX2 - DISC, 2) == []


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
    assert found.area == pytest.approx(0.6 * math.pi, rel=5e-3)  # chords in place of arcs
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
