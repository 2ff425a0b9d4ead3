# SPDX-License-Identifier: BSD-3-Clause
"""Contact points of shapes: faces, what they push for and by what they are felt."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp.shapes import parse_shape
from mpm3dpp.shapes.contact_points import points_of_particles, points_of_shape

E = 0.25  # As in a case of cells of 1.


def points(shape: dict[str, Any], spacing: float) -> Any:
    return points_of_shape(parse_shape(shape), spacing, 0.5 * E)[0]


def box(*corners: list[float]) -> dict[str, Any]:
    return {"box": {"lower": corners[0], "upper": corners[1]}}


SHAPES = {
    "box in 2D": (box([0, 0], [3, 2]), 4, 10.0),
    "box in 3D": (box([0, 0, 0], [3, 2, 1]), 6, 22.0),
    "cylinder": ({"cylinder": {"centre": [0, 0, 0], "radius": 1.0, "height": 2.0}}, 3, 6 * np.pi),
    "ball": ({"sphere": {"centre": [0, 0, 0], "radius": 1.0}}, 1, 4 * np.pi),
    "L": ({"union": [box([0, 0], [3, 1]), box([0, 0], [1, 3])]}, 6, 12.0),
}


@pytest.mark.parametrize("name", SHAPES)
def test_faces_and_areas(name: str) -> None:
    """What is felt is the surface, to what cuts leave of finer points; at edges several points at
    one place push for less than their faces, by a row of points at most."""
    shape, faces, area = SHAPES[name]
    dimension = 3 if name in ("box in 3D", "cylinder", "ball") else 2
    spacing = E if dimension == 3 else E / 2
    found = points(shape, spacing)
    assert len(np.unique(found.faces)) == faces
    assert found.felt_areas.sum() == pytest.approx(area, rel=1e-3 if name == "L" else 1e-9)
    assert 0.7 * area < found.areas.sum() < (1 + 1e-9) * area
    assert ((found.areas > 0) | (found.felt_areas > 0)).all()


@pytest.mark.parametrize("angle", [0, 1, 90, 137, 180, 270])
def test_a_triangle_that_is_turned_has_the_same_points(angle: float) -> None:
    """One whose points lie on the planes of other faces, as far as rounding tells."""
    corners = [[0, 0], [4, 0], [0, 2]]
    shape = {"polygon": {"points": corners}}
    turned = {"rotate": {"shape": shape, "angle": np.radians(angle), "about": [0, 0]}}
    here, there = points(shape, E / 2), points(turned, E / 2)
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    assert there.places @ [[c, -s], [s, c]] == pytest.approx(here.places, abs=1e-9)
    assert there.areas == pytest.approx(here.areas)
    assert there.felt_areas == pytest.approx(here.felt_areas)


def test_bodies_of_particles_have_a_face_for_each_way() -> None:
    places = np.stack(np.meshgrid(*[np.arange(4.0)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    steps = places[places.sum(axis=1) < 6]
    found = points_of_particles(0.5 * steps, 0.5, E, 0.5 * E)[0]
    assert len(np.unique(found.faces)) == 6
    for face in range(6):
        normals = found.normals[found.faces == face]
        assert (normals == normals[0]).all()
