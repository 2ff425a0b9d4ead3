# SPDX-License-Identifier: BSD-3-Clause
"""Sides of shapes that are made of shapes, and of bodies that are known by their particles."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from mpm3dpp import Body, Case, CaseError, Grid, Material, Particles, Run, shapes
from mpm3dpp.case.load_pieces import Pieces, pieces
from mpm3dpp.case.loads import Load
from mpm3dpp.fill.build import build
from mpm3dpp.shapes import Box, Cylinder, Disc, Ring
from mpm3dpp.shapes.particle_faces import faces
from mpm3dpp.shapes.surfaces import sides, surface

UNIT = Box(lower=(0.0, 0.0), upper=(1.0, 1.0))
CUBE = Box(lower=(0.0, 0.0, 0.0), upper=(1.0, 1.0, 1.0))
HOLE = Disc(centre=(0.5, 0.5), radius=0.3)
CORNER = Disc(centre=(1.0, 1.0), radius=0.3)
BORE = Cylinder(centre=(0.5, 0.5, 0.5), radius=0.2, height=3.0)
ROUND = 0.3 * math.pi
COMBINED = [
    # A hole leaves what is around it whole: exact. What is cut is good to a part of a point.
    (UNIT - HOLE, "0.all", 4.0, 1e-12),
    (UNIT - HOLE, "1.outer", 2 * ROUND, 1e-12),
    (UNIT - CORNER, "0.x_max", 0.7, 1e-3),
    (UNIT - CORNER, "1.outer", 0.5 * ROUND, 1e-3),
    (UNIT & CORNER, "0.x_max", 0.3, 1e-3),
    (UNIT & CORNER, "all", 0.6 + 0.5 * ROUND, 1e-3),
    (UNIT | CORNER, "1.outer", 1.5 * ROUND, 1e-3),
    (UNIT | CORNER, "all", 3.4 + 1.5 * ROUND, 1e-3),
    # Side by side, and one in the other: what lies between them is no surface, nothing twice.
    (UNIT | Box(lower=(1.0, 0.0), upper=(2.0, 1.0)), "all", 6.0, 1e-12),
    (UNIT | Box(lower=(0.5, 0.0), upper=(2.0, 1.0)), "all", 6.0, 1e-12),
    (UNIT - Box(lower=(0.5, 0.0), upper=(2.0, 1.0)), "all", 3.0, 1e-12),
    (UNIT - (HOLE & Disc(centre=(0.5, 0.8), radius=0.3)), "1.0.outer", 2 / 3 * ROUND, 2e-3),
    (shapes.Rotate(shape=UNIT - HOLE, angle=0.3), "1.outer", 2 * ROUND, 1e-12),
    (CUBE - BORE, "0.x_min", 1.0, 1e-12),
    (CUBE - BORE, "0.z_max", 1.0 - 0.04 * math.pi, 3e-3),
    (CUBE - BORE, "1.outer", 0.4 * math.pi, 1e-2),
]


@pytest.mark.parametrize(("shape", "side", "area", "tolerance"), COMBINED)
def test_what_is_left_of_a_side(shape: Any, side: str, area: float, tolerance: float) -> None:
    assert side in sides(shape)
    found = surface(shape, side, 0.023)
    size = np.linalg.norm(found.areas, axis=1)
    assert size.sum() == pytest.approx(area, rel=tolerance)
    outwards = 1e-6 * found.areas / size[:, None]
    assert shape.contains(found.points - outwards).all()
    assert not shape.contains(found.points + outwards).any()
    if side == "all":
        assert np.abs(found.areas.sum(axis=0)).max() < 1e-13


def loaded(body: dict[str, Any], side: str, dimension: int = 2) -> Case:
    return Case(
        grid=Grid(dimension=dimension, cell_size=0.1),
        run=Run(end_time=1.0),
        material={"m": Material(density=1.0, strength={"elastic": {"E": 1.0, "nu": 0.3}})},
        body={"b": Body(material="m", **body)},
        load={"l": Load(body="b", side=side, pressure=1.0)},
    )


def found_in(body: dict[str, Any], side: str, dimension: int = 2) -> Pieces:
    problem = loaded(body, side, dimension)
    [filled] = build(problem)
    return pieces(problem, "l", filled.positions, filled.spacing)


def test_a_ring_is_a_disc_without_a_disc() -> None:
    whole = Disc(centre=(0.0, 0.0), radius=0.5), Disc(centre=(0.0, 0.0), radius=0.2)
    ring = Ring(centre=(0.0, 0.0), inner_radius=0.2, outer_radius=0.5)
    one = found_in({"shape": ring, "fill": "lattice"}, "inner")
    other = found_in({"shape": whole[0] - whole[1], "fill": "lattice"}, "1.outer")
    for name in ("particles", "areas", "sizes", "arms"):
        assert np.array_equal(getattr(one, name), getattr(other, name)), name


@pytest.mark.parametrize("dimension", [2, 3])
def test_particles_on_a_lattice_have_the_sides_of_their_box(dimension: int) -> None:
    shape = Box(lower=(0.1,) * dimension, upper=(0.7, 0.5, 0.4)[:dimension])
    [filled] = build(loaded({"shape": shape}, "x_max", dimension))
    given = {"particles": Particles(filled.positions, filled.volumes)}
    for side in sides(shape):
        one = found_in({"shape": shape}, side, dimension)
        other = found_in(given, side, dimension)
        assert np.array_equal(one.particles, other.particles)
        assert np.abs(one.areas - other.areas).max() < 1e-16
        assert np.abs(one.arms - other.arms).max() < 1e-15
        assert other.area == pytest.approx(one.area, rel=1e-12)


@pytest.mark.parametrize("dimension", [2, 3])
def test_any_particles_have_a_closed_surface(dimension: int) -> None:
    """Their faces add up to nothing; those that look one way to what the body shows that way."""
    kind = Disc if dimension == 2 else shapes.Sphere
    [filled] = build(
        loaded({"shape": kind(centre=(0.0,) * dimension, radius=0.6)}, "all", dimension)
    )
    found = faces(filled.positions, filled.spacing, "all")
    assert np.abs(found.areas.sum(axis=0)).max() < 1e-14
    shown = faces(filled.positions, filled.spacing, "x_max").areas.sum(axis=0)
    silhouette = 1.2 if dimension == 2 else math.pi * 0.36
    assert shown[0] == pytest.approx(silhouette, rel=0.05) and not shown[1:].any()


@pytest.mark.parametrize(
    ("body", "side", "sentence"),
    [
        (
            {"shape": UNIT - HOLE},
            "outer",
            'load.l.side = "outer" is not a side of the difference body.b; did you mean "1.outer"? '
            "(valid here: 0.x_min, 0.x_max, 0.y_min, 0.y_max, 0.all, 1.outer, 1.all, all)",
        ),
        (
            {"particles": Particles([[0.0, 0.0], [0.1, 0.0]], [0.01, 0.01])},
            "outer",
            "is not a side of the set of particles body.b; valid here: x_min, x_max, y_min, y_max",
        ),
        (
            {"shape": UNIT | HOLE},
            "1.outer",
            'load.l.side = "1.outer" is nowhere on the surface: the other shapes cover it or cut '
            "it off; load another side",
        ),
    ],
)
def test_sides_that_are_not_there(body: dict[str, Any], side: str, sentence: str) -> None:
    with pytest.raises(CaseError) as error:
        found_in(body, side)
    assert sentence in str(error.value)
