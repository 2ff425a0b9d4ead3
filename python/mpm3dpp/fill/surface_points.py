# SPDX-License-Identifier: BSD-3-Clause
"""The contact points of a case's bodies on nodes of their own, each carried by a particle."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp import _core
from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.case.box import CONTACT, HOLDING
from mpm3dpp.case.load_pieces import Near, candidates, nearest_particles
from mpm3dpp.ranks.world import World, agreed
from mpm3dpp.shapes.contact_points import (
    ContactPoints,
    Plane,
    points_of_ball,
    points_of_particles,
    points_of_shape,
)

if TYPE_CHECKING:
    from mpm3dpp.case.case import Case

    from .parts import FilledPart, Particles

Array = NDArray[np.float64]

REACHES = 2.0
"""Reaches e of springs along the edge of a particle; contact points lie e / 2 behind surfaces."""
MOST_CFL: float = _core.most_cfl_of_surfaces
"""Of the time in which a wave passes a cell, what springs between surfaces bear as a step
(decision 0071)."""
ALONG = {2: 2.0, 3: 1.0}
"""Contact points along e, in 2D and 3D: rows have bumps that stop a roll."""


def point_spacing(case: Case, parts: Iterable[FilledPart]) -> float | None:
    """Return the reach e of the springs of all bodies [m]; None where nothing meets.

    That of the finest body.
    """
    own = [part.spacing for part in parts if case.parts()[part.name].frame == MATERIAL]
    touches = case.contact.enabled and not case.contact.bonded  # A body alone may touch itself.
    if not own or not (touches or {CONTACT, *HOLDING} & set(case.grid.walls)):
        return None
    return min(own) / REACHES


def surfaces_touch(case: Case, parts: Iterable[FilledPart]) -> bool:
    """Return whether bodies on nodes of their own touch each other, themselves or walls."""
    return point_spacing(case, parts) is not None


def add_surfaces(
    core: Any,
    case: Case,
    part: FilledPart,
    number: int,
    particles: Particles,
    spacing: float,
    sharing: Sharing,
) -> None:
    """Give the core the contact points of the bodies of an entry, if they touch others by them.

    Args:
        core: of the simulation.
        case: of which the entry is.
        part: the entry.
        number: of its first body in the core.
        particles: of all its bodies, or what this process has of them.
        spacing: e of the points [m].
        sharing: among processes, of which each calls this.

    Raises:
        CaseError: a part of the surface has no particle near it.
    """
    meets = case.contact_enabled and case.is_rigid(part.name)
    if not meets and case.parts()[part.name].frame != MATERIAL:
        return
    if part.balls is None:
        carried, held = _of_body(case, part, particles.positions, spacing, sharing)
        found = [(number, carried, held)]
    else:
        number, world = number + sharing.first, sharing.world
        own = agreed(
            lambda: list(_of_balls(case, part, number, particles, spacing, sharing)), world
        )
        found = own if world is None else [x for told in world.comm.allgather(own) for x in told]
    for of_body, carried, held in found:
        core.add_surface(of_body, *carried, spacing, held)


@dataclass(frozen=True)
class Sharing:
    """How processes share an entry.

    Attributes:
        world: all of them; None where there is one.
        first: of the grains that this process has, by their order in the entry.
        near: gives the particles of a body near points, where each has a slice of it.
    """

    world: World | None = None
    first: int = 0
    near: Near | None = None


Carried = tuple[list[int], Array, Array, Array, Array, list[int]]
"""Particles that carry points, the ways from them to the surface [m], its normals there, the areas
that they push for and by which they are felt [m^2; in 2D m], and the faces."""


def _of_body(
    case: Case, part: FilledPart, positions: Array, spacing: float, sharing: Sharing
) -> tuple[Carried, int]:
    """Return what carries the points of a body, and the faces of the box that hold it."""
    planes = _holding_planes(case)
    shape = case.body[part.name].shape
    along, depth = spacing / ALONG[case.grid.dimension], 0.5 * spacing
    near = sharing.near
    if shape is not None:
        points, lies_on = points_of_shape(shape, along, depth, list(planes.values()))
    else:
        if near is not None and sharing.world is not None:
            positions, near = np.concatenate(sharing.world.comm.allgather(positions)), None
        points, lies_on = points_of_particles(
            positions, part.spacing, along, depth, list(planes.values())
        )
    numbers, positions = candidates(points.places, positions, part.spacing, near)
    owners, *carried = _carried(case, part, positions, points, depth)
    held = sum(1 << face for face, plane in planes.items() if plane in lies_on)
    return (numbers[owners].tolist(), *carried), held


def _of_balls(
    case: Case,
    part: FilledPart,
    number: int,
    particles: Particles,
    spacing: float,
    sharing: Sharing,
) -> Iterable[tuple[int, Carried, int]]:
    """Yield the number of each ball here, what carries its points, and that no face holds it."""
    assert part.balls is not None
    ends = np.cumsum(particles.counts)
    for k, (begin, end) in enumerate(zip(ends - particles.counts, ends, strict=True)):
        along = spacing / ALONG[case.grid.dimension]
        centre, radius = (of_all[sharing.first + k] for of_all in part.balls)
        points = points_of_ball(centre, float(radius), along, 0.5 * spacing)
        yield (
            number + k,
            _carried(case, part, particles.positions[begin:end], points, 0.5 * spacing),
            0,
        )


def _carried(
    case: Case, part: FilledPart, positions: Array, points: ContactPoints, depth: float
) -> Carried:
    """Return the particles nearest to the points, and what each has of them."""
    which, owner = nearest_particles(positions, points.places, part.spacing)
    shared = np.bincount(which, minlength=len(points.places))
    if not shared.all():
        share = points.felt_areas[shared == 0].sum() / points.felt_areas.sum()
        rule = f"has no particles near {share:.0%} of its surface: it is too thin for its spacing"
        remedy = "give a smaller grid.cell_size or more particles_per_cell"
        raise case.error(case.part_path(part.name), rule, remedy)
    normals = np.ascontiguousarray(points.normals[which])
    offsets = points.places[which] + depth * normals - positions[owner]
    return (
        owner.tolist(),
        np.ascontiguousarray(offsets),
        normals,
        points.areas[which] / shared[which],
        points.felt_areas[which] / shared[which],
        points.faces[which].tolist(),
    )


def _holding_planes(case: Case) -> dict[int, Plane]:
    """Return the slip and fixed faces of the box: bodies that lie on them go on behind them."""
    box = case.grid.box
    if box is None:
        return {}
    faces = [face for face, wall in enumerate(case.grid.walls) if wall in HOLDING]
    return {face: (face // 2, (box.lower, box.upper)[face % 2][face // 2]) for face in faces}
