# SPDX-License-Identifier: BSD-3-Clause
"""How the particles of a body share the side, or the point, that a load acts on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.model import plain
from mpm3dpp.base.settings import functions
from mpm3dpp.shapes.faces import FACES
from mpm3dpp.shapes.particle_faces import faces
from mpm3dpp.shapes.shells import LATTICE, SHELLS
from mpm3dpp.shapes.surface_parts import Surface
from mpm3dpp.shapes.surfaces import surface

if TYPE_CHECKING:
    from .case import Case

Array = NDArray[np.float64]
# Points of a surface for each spacing of the particles: on a circle the more the evener its load.
_FINER = {(2, LATTICE): 8, (2, FACES): 8, (2, SHELLS): 64}  # In 3D 4.
_REACH = 2.5  # spacings, from a point of a surface to the particle that carries it at most
_REACH_OF_POINT = 1.5  # the same of a point, whose arm should not leave the nodes around
_SAME = 1e-9  # Distances that differ by less than this share of the spacing are equal.


@dataclass(frozen=True)
class Pieces:
    """The pieces of a surface, each carried by the particle nearest to it.

    Attributes:
        particles: their numbers in the order of filling, shape (n,).
        areas: outward area vectors [m^2; in 2D m times 1 m], shape (n, D); 0 at a point.
        sizes: areas [the same], shape (n,); more than the length of the vector where a particle
            carries parts of the side that are not parallel; at a point the shares of the force.
        arms: from the particle to the middle of its piece [m], shape (n, D).
    """

    particles: NDArray[np.uint32]
    areas: Array
    sizes: Array
    arms: Array

    @property
    def area(self) -> float:
        """Sum of the areas [m^2; in 2D m times 1 m]; of a point no area, but 1."""
        return float(self.sizes.sum())


Near = Callable[[Array, float], tuple[NDArray[np.int64], Array]]
"""Gives numbers and positions of a body's particles within reach of points [m]."""


def pieces(
    case: Case, name: str, positions: Array, spacing: float, near: Near | None = None
) -> Pieces:
    """Share the side or the point that a load acts on among the particles of its body.

    Each point of the side belongs to the particle nearest to it, or in equal parts to those that
    are, so that the particles' areas add up to that of the side as it is drawn, and the pieces lie
    on it.

    Args:
        case: a checked case.
        name: of the load.
        positions: of the body's particles [m], shape (n, D).
        spacing: distance of neighbouring particles [m].
        near: gives those that may carry the side, where nobody has all.

    Raises:
        CaseError: a part of the side has no particle within two and a half spacings, or the point
            within one and a half.
    """
    load = case.load[name]
    if load.at_point:
        return _at_point(case, name, positions, spacing, near)
    dimension = positions.shape[1]
    shape = case.body[load.body].shape
    finer = _FINER.get((dimension, case.filled_by(load.body)), 4)
    if shape is not None:
        side = surface(shape, load.side, spacing / finer)
    else:
        side = faces(positions, spacing, load.side)
    if not len(side.points):
        rule = "is nowhere on the surface: the other shapes cover it or cut it off"
        raise case.error(("load", name, "side"), rule, "load another side", value=load.side)
    numbers, positions = candidates(side.points, positions, spacing, near)
    points, owner = nearest_particles(positions, side.points, spacing)
    lost = np.bincount(points, minlength=len(side.points)) == 0
    if lost.any():
        share = np.linalg.norm(side.areas[lost], axis=1).sum()
        share /= np.linalg.norm(side.areas, axis=1).sum()
        rule = (
            f"has no particles near {share:.0%} of it: the body is too thin there for its spacing"
        )
        remedy = "give a smaller grid.cell_size or more particles_per_cell"
        raise case.error(("load", name, "side"), rule, remedy, value=load.side)
    parts = np.bincount(points)[points][:, None]
    found = _share(Surface(side.points[points], side.areas[points] / parts), owner, positions)
    return replace(found, particles=numbers[found.particles].astype(np.uint32))


def candidates(
    points: Array, positions: Array, spacing: float, near: Near | None
) -> tuple[NDArray[np.int64], Array]:
    """Return numbers and positions [m] of the particles that may carry what is at points."""
    if near is None:
        return np.arange(len(positions)), positions
    return near(points, _REACH * spacing)


def _at_point(case: Case, name: str, positions: Array, spacing: float, near: Near | None) -> Pieces:
    """Return the pieces of a force: of no area, their sizes the particles' shares of it."""
    load = case.load[name]
    point = np.array([load.point], dtype=float)
    numbers, positions = candidates(point, positions, spacing, near)
    away = np.linalg.norm(positions - point, axis=1)
    if not (away <= _REACH_OF_POINT * spacing).any():
        rule = f"is farther than {_REACH_OF_POINT:g} spacings from all particles of {load.body}"
        remedy = f"give a point of the body; its particles are {spacing:.4g} m apart"
        raise case.error(("load", name, "point"), rule, remedy, value=plain(load.point))
    owner = np.flatnonzero(away <= away.min() + _SAME * spacing)
    owner = owner[np.argsort(numbers[owner])]
    carriers = positions[owner]
    sizes = np.full(len(owner), 1.0 / len(owner))
    return Pieces(
        numbers[owner].astype(np.uint32), np.zeros_like(carriers), sizes, point - carriers
    )


def _share(side: Surface, owner: NDArray[np.int64], positions: Array) -> Pieces:
    particles, place = np.unique(owner, return_inverse=True)
    size = np.linalg.norm(side.areas, axis=1)

    def added(values: Array) -> Array:
        columns = [np.bincount(place, v, len(particles)) for v in values.T]
        return np.stack(columns, axis=1)

    sizes = np.asarray(np.bincount(place, size), dtype=np.float64)
    middle = added(size[:, None] * side.points) / sizes[:, None]
    arms = middle - positions[particles]
    return Pieces(particles.astype(np.uint32), added(side.areas), sizes, arms)


def nearest_particles(
    positions: Array, points: Array, spacing: float
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Return pairs of a point and the particle nearest to it; none if that is out of reach.

    Args:
        positions: of particles [m], shape (n, D).
        points: [m], shape (m, D).
        spacing: distance of neighbouring particles [m].

    Returns:
        Numbers of points and of particles, shape (pairs,) each. A point that is as near to two
        particles or more has a pair with each, so that a symmetric body is loaded symmetrically.
        The reach is two and a half spacings.
    """
    from scipy.spatial import cKDTree

    if not len(positions):
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    most = min(2 ** positions.shape[1], len(positions))
    away, owner = cKDTree(positions).query(
        points, k=range(1, most + 1), distance_upper_bound=_REACH * spacing
    )
    near = np.isfinite(away) & (away <= away[:, :1] + _SAME * spacing)
    numbers, _ = np.nonzero(near)
    return numbers, owner[near]


def add_load(core: Any, case: Case, name: str, body: int, found: Pieces) -> None:
    """Hand a load over to the core; `body` is the number of its body there.

    Raises:
        CaseError: the core refuses it.
    """
    load = case.load[name]
    kind, value = load.value()
    areas = np.ascontiguousarray(found.areas)
    arms, particles = np.ascontiguousarray(found.arms), found.particles.tolist()
    try:
        core.add_load(name, body, kind, functions(value), particles, areas, found.sizes, arms)
    except ValueError as error:
        raise case.error(("load", name), f"is refused: {error}") from None
