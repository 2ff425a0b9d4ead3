# SPDX-License-Identifier: BSD-3-Clause
"""Contact points of a body: points of its drawn surface, evenly spread, a depth inside it.

They lie on the shape and not on its filling: a ball filled by a lattice is round. Where two faces
meet each of them has a point at the edge, which pushes for half of its share.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .base import Shape
from .particle_faces import faces
from .surface_parts import Surface, circle, sphere
from .surfaces import surface

Array = NDArray[np.float64]
Plane = tuple[int, float]
"""The axis that it lies across, and its place along it [m]."""
FacesOf = Callable[[Array, Array, float], NDArray[np.int64]]
"""Of the places of points [m], their normals and their distance [m]."""

ON_PLANE = 0.25
"""Edges of particles from a plane within which their faces lie on it."""
_SAME_POINT = 0.4  # Spacings: two points of different faces that are nearer are one.
_BESIDE = 1.6  # Spacings: points of one face that are nearer lie beside each other.
_ONE_FACE = 0.9  # Cosine of the angle up to which two normals are those of one face.


class ContactPoints(NamedTuple):
    """Points under a surface.

    Attributes:
        places: [m], shape (n, D).
        normals: unit vectors out of the body, shape (n, D).
        areas: that they push for, shape (n,) [m^2; in 2D m times 1 m]; where points of several
            faces lie at one place each has its share, and 0 are those of points only felt.
        felt_areas: of their faces, by which others feel them, shape (n,); 0 of points that push
            only.
        faces: numbers of the faces of the body, shape (n,).
    """

    places: Array
    normals: Array
    areas: Array
    felt_areas: Array
    faces: NDArray[np.int64]


def points_of_shape(
    shape: Shape, spacing: float, depth: float, planes: Sequence[Plane] = ()
) -> tuple[ContactPoints, list[Plane]]:
    """Return the contact points of a shape, and the planes on which a face of it lies.

    Args:
        shape: any.
        spacing: about the distance of the points [m].
        depth: how far they lie behind the surface [m].
        planes: those on which a face is no surface: a body goes on there.
    """
    drawn, on = _off_planes(surface(shape, "all", spacing), planes, 1e-3 * spacing)
    return _inside(drawn, spacing, depth, _beside_each_other), on


def lies_on(shape: Shape, spacing: float, plane: Plane) -> bool:
    """Return whether a face of a shape lies on a plane, by points of about that distance [m]."""
    return bool(_off_planes(surface(shape, "all", spacing), [plane], 1e-3 * spacing)[1])


def _off_planes(
    drawn: Surface, planes: Sequence[Plane], within: float
) -> tuple[Surface, list[Plane]]:
    """Return what of a surface lies on none of some planes, and those on which a face of it lies.

    Args:
        drawn: the surface.
        planes: those on which a face is no surface.
        within: how near to a plane a face lies on it [m].
    """
    found = []
    for axis, place in planes:
        along = abs(drawn.areas[:, axis]) > _ONE_FACE * np.linalg.norm(drawn.areas, axis=1)
        there = along & (abs(drawn.points[:, axis] - place) < within)
        # A ball touches a plane by a point.
        if there.sum() < drawn.points.shape[1]:
            continue
        found.append((axis, place))
        drawn = Surface(drawn.points[~there], drawn.areas[~there])
    return drawn, found


def points_of_ball(centre: Array, radius: float, spacing: float, depth: float) -> ContactPoints:
    """Return those of a disc or a ball.

    Args:
        centre: [m], shape (D,).
        radius: [m].
        spacing: about the distance of the points [m].
        depth: how far they lie behind the surface [m].
    """
    drawn = (circle if len(centre) == 2 else sphere)(radius, spacing)
    return _inside(Surface(drawn.points + centre, drawn.areas), spacing, depth)


def points_of_particles(
    positions: Array, edge: float, spacing: float, depth: float, planes: Sequence[Plane] = ()
) -> tuple[ContactPoints, list[Plane]]:
    """Return those of a body that is known by its particles alone, and the planes that it lies on.

    Args:
        positions: of its particles [m], shape (n, D).
        edge: of the particles' cubes [m].
        spacing: about the distance of the points [m].
        depth: how far they lie behind the surface [m].
        planes: as of a shape; faces of particles lie on one to a quarter of their edge.
    """
    drawn, on = _off_planes(faces(positions, edge, "all"), planes, ON_PLANE * edge)
    each = max(1, math.ceil(edge / spacing - 1e-6))
    steps = (np.arange(each) + 0.5) / each - 0.5
    points, areas = [drawn.points], [drawn.areas]
    if each > 1:
        points, areas = [], []
        axes = np.argmax(np.abs(drawn.areas), axis=1)
        dimension = positions.shape[1]
        for shift in np.stack(
            [x.ravel() for x in np.meshgrid(*[steps] * (dimension - 1), indexing="ij")], axis=1
        ):
            moved = drawn.points.copy()
            for k in range(dimension):
                across = [d for d in range(dimension) if d != k]
                own = axes == k
                for d, by in zip(across, shift, strict=True):
                    moved[own, d] += by * edge
            points.append(moved)
            areas.append(drawn.areas / each ** (dimension - 1))
    drawn = Surface(np.concatenate(points), np.concatenate(areas))
    return _inside(drawn, spacing, depth, _by_axes), on


def _inside(
    drawn: Surface, spacing: float, depth: float, faces_of: FacesOf | None = None
) -> ContactPoints:
    """Return points behind a surface; faces that meet share what they push for at one place.

    Points push from where they lie as deep behind all faces; they are felt where they lie behind
    their own, as a face would bulge or sink beside its edges if its points were not where drawn.

    Args:
        drawn: the surface.
        spacing: about the distance of the points [m].
        depth: how far they lie behind the surface [m].
        faces_of: gives the numbers of the faces of points; default one face for all.
    """
    from scipy.spatial import cKDTree

    areas = np.linalg.norm(drawn.areas, axis=1)
    normals = drawn.areas / areas[:, None]
    behind = drawn.points - depth * normals
    faces = np.zeros(len(behind), dtype=np.int64)
    if faces_of is not None:
        faces = faces_of(behind, normals, spacing)
    places = _behind_all_faces(behind, drawn.points, normals, depth)
    own, others = cKDTree(places).query_pairs(_SAME_POINT * spacing, output_type="ndarray").T
    own, others = np.concatenate([own, others]), np.concatenate([others, own])
    apart = np.einsum("ij,ij->i", normals[own], normals[others]) < _ONE_FACE
    # Of each point the other faces there, however many points they have.
    met = np.unique(np.stack([own[apart], faces[others[apart]]], axis=1), axis=0)
    at_one_place = 1 + np.bincount(met[:, 0], minlength=len(places))
    moved = (places != behind).any(axis=1)
    return ContactPoints(
        np.concatenate([places, behind[moved]]),
        np.concatenate([normals, normals[moved]]),
        np.concatenate([areas / at_one_place, np.zeros(moved.sum())]),
        np.concatenate([np.where(moved, 0.0, areas), areas[moved]]),
        np.concatenate([faces, faces[moved]]),
    )


def _beside_each_other(places: Array, normals: Array, spacing: float) -> NDArray[np.int64]:
    """Return the numbers of faces that end where normals turn at once."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    one, other = cKDTree(places).query_pairs(_BESIDE * spacing, output_type="ndarray").T
    alike = np.einsum("ij,ij->i", normals[one], normals[other]) >= _ONE_FACE
    beside = (np.ones(alike.sum()), (one[alike], other[alike]))
    graph = coo_array(beside, shape=(len(places), len(places)))
    return np.asarray(connected_components(graph, directed=False)[1], dtype=np.int64)


def _by_axes(_places: Array, normals: Array, _spacing: float) -> NDArray[np.int64]:
    """Return the numbers of faces of cubes: those that look one way are one, steps or not."""
    axes, ways = np.argmax(np.abs(normals), axis=1), normals.sum(axis=1) > 0.0
    return np.asarray(2 * axes + ways, dtype=np.int64)


def _behind_all_faces(places: Array, drawn: Array, normals: Array, depth: float) -> Array:
    """Return points as deep behind the face beside an edge as behind their own.

    Args:
        places: behind their own faces [m], shape (n, D).
        drawn: the points of the surface that they are behind [m], shape (n, D).
        normals: unit vectors out of the body there, shape (n, D).
        depth: [m].
    """
    from scipy.spatial import cKDTree

    own, others = cKDTree(drawn).query_pairs(1.5 * depth, output_type="ndarray").T
    own, others = np.concatenate([own, others]), np.concatenate([others, own])
    aside = np.einsum("ij,ij->i", normals[own], normals[others]) < _ONE_FACE
    own, others = own[aside], others[aside]
    moved = places.copy()
    for _ in range(places.shape[1] - 1):  # Beside a corner there are two other faces.
        lie = np.einsum("ij,ij->i", drawn[others] - moved[own], normals[others])
        shallow = np.flatnonzero((lie > 1e-9 * depth) & (lie < (1.0 - 1e-9) * depth))
        # Of each point the last stands: the one that it lies least behind.
        shallow = shallow[np.argsort(-lie[shallow], kind="stable")]
        moved[own[shallow]] -= (depth - lie[shallow])[:, None] * normals[others[shallow]]
    return moved
