# SPDX-License-Identifier: BSD-3-Clause
"""Pressures and tractions on the surfaces of bodies, which follow the particles."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator
from pydantic_core import PydanticCustomError

from mpm3dpp import _core
from mpm3dpp.base.errors import nearest, violation
from mpm3dpp.base.model import Text
from mpm3dpp.base.settings import functions, table_of_rows
from mpm3dpp.base.time_functions import Timed, TimedVector, TimeFunction
from mpm3dpp.shapes.particle_faces import faces
from mpm3dpp.shapes.shells import LATTICE, SHELLS, unmoved
from mpm3dpp.shapes.surface_parts import Surface
from mpm3dpp.shapes.surfaces import AXIS_NAMES, sides, surface

if TYPE_CHECKING:
    from .body import Body
    from .case import Case

Array = NDArray[np.float64]
# Points of a surface for each spacing of the particles: on a circle the more the evener its load.
_FINER = {(2, LATTICE): 8, (2, SHELLS): 64, (3, LATTICE): 4, (3, SHELLS): 4}
_REACH = 2.5  # spacings, from a point of a surface to the particle that carries it at most
_SAME = 1e-9  # Distances that differ by less than this share of the spacing are equal.


def _kind_field(row: dict[str, Any]) -> tuple[Any, Any]:
    """Return type and default of the key of a kind of loads, a row of the core."""
    if row["vector"]:
        return Annotated[tuple[float | TimeFunction, ...], TimedVector("Pa")], ()
    return Annotated[float | TimeFunction | None, Timed("Pa")], None


_KINDS: dict[str, dict[str, Any]] = _core.load_kinds
_LoadValues: Any = table_of_rows("load", _KINDS, _kind_field)


class Load(_LoadValues):
    """A load on a side of a body that deforms; it follows the body's motion.

    One of the kinds of loads must be given.

    Attributes:
        body: its name.
        side: of the body's shape: `x_min` to `z_max` of a box, or of a body that is given by its
            particles; `outer` of what is round, `inner` of a ring, tube or funnel, `lower` and
            `upper` of a cylinder, tube, frustum or funnel; `nose`, `outer`, `end` of an ogive rod;
            `side_0`, from the first corner to the second, and so on of a polygon; `1.outer`, side
            `outer` of the shape with the number 1, from 0, of a union, difference or intersection,
            as far as it is on the surface of all; `all`.
    """

    body: Text
    side: Text

    @model_validator(mode="after")
    def _one_kind(self) -> Load:
        first, *others = _KINDS
        given = self.given()
        if len(given) > 1:
            rule = f"must not be given together with {given[0]}"
            raise violation(rule, "keep one of the two", path=(given[1],))
        if not given:
            remedy = f"add this key, or {' or '.join(others)}"
            raise violation("is missing", remedy, path=(first,))
        return self

    def given(self) -> list[str]:
        """Return the kinds of loads that have a value."""
        return [kind for kind in _KINDS if getattr(self, kind) not in (None, ())]

    def value(self) -> tuple[str, tuple[float | TimeFunction, ...]]:
        """Return the kind and its value, one number or D."""
        [kind] = self.given()
        found = getattr(self, kind)
        return kind, found if _KINDS[kind]["vector"] else (found,)


@dataclass(frozen=True)
class Pieces:
    """The pieces of a surface, each carried by the particle nearest to it.

    Attributes:
        particles: their numbers in the order of filling, shape (n,).
        areas: outward area vectors [m^2; in 2D m times 1 m], shape (n, D).
        sizes: areas [the same], shape (n,); more than the length of the vector where a particle
            carries parts of the side that are not parallel.
        arms: from the particle to the middle of its piece [m], shape (n, D).
    """

    particles: NDArray[np.uint32]
    areas: Array
    sizes: Array
    arms: Array

    @property
    def area(self) -> float:
        """Sum of the areas [m^2; in 2D m times 1 m]."""
        return float(self.sizes.sum())


def check_loads(case: Case) -> Iterator[PydanticCustomError]:
    """Yield the violations of loads against the bodies of a case, with their paths in it."""
    dimension = case.grid.dimension
    for name, load in case.load.items():
        path = ("load", name)
        if load.body not in case.body:
            rule, remedy = "is not a body of this case", nearest(load.body, case.body)
            yield violation(rule, remedy, value=load.body, path=(*path, "body"))
            continue
        body = case.body[load.body]
        if case.is_rigid(load.body):
            rule = "does not deform, and a load acts on bodies that do"
            remedy = "give its material another strength, remove its motion, or load another body"
            yield violation(rule, remedy, value=load.body, path=(*path, "body"))
        known = sides_of(body, dimension)
        if load.side not in known:
            rule = f"is not a side of the {_kind(body)} body.{load.body}"
            yield violation(rule, nearest(load.side, known), value=load.side, path=(*path, "side"))
        kind, value = load.value()
        if _KINDS[kind]["vector"] and len(value) != dimension:
            rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
            remedy = f"it has {len(value)}, give {dimension}"
            yield violation(rule, remedy, path=(*path, kind))


def sides_of(body: Body, dimension: int) -> list[str]:
    """Return the names of the sides of a body that can be loaded."""
    if body.shape is not None:
        return sides(body.shape)
    return [f"{a}_{end}" for a in AXIS_NAMES[:dimension] for end in ("min", "max")] + ["all"]


def _kind(body: Body) -> str:
    return unmoved(body.shape).kind if body.shape is not None else "set of particles"


Near = Callable[[Array, float], tuple[NDArray[np.int64], Array]]
"""Gives numbers and positions of a body's particles within reach of points [m]."""


def pieces(
    case: Case, name: str, positions: Array, spacing: float, near: Near | None = None
) -> Pieces:
    """Share the side that a load acts on among the particles of its body.

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
        CaseError: a part of the side has no particle within two spacings.
    """
    load = case.load[name]
    dimension = positions.shape[1]
    shape = case.body[load.body].shape
    finer = _FINER[dimension, case.filled_by(load.body)]
    if shape is not None:
        side = surface(shape, load.side, spacing / finer)
    else:
        side = faces(positions, spacing, load.side)
    if not len(side.points):
        rule = "is nowhere on the surface: the other shapes cover it or cut it off"
        raise case.error(("load", name, "side"), rule, "load another side", value=load.side)
    numbers: NDArray[np.int64] | None = None
    if near is not None:
        numbers, positions = near(side.points, _REACH * spacing)
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
    if numbers is None:
        return found
    return replace(found, particles=numbers[found.particles].astype(np.uint32))


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
