# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that are drawn into each other: which, how deep, and what becomes of it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations
from typing import NamedTuple

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.box import FACES as FACES_OF_BOX
from mpm3dpp.case.case import Case
from mpm3dpp.case.matter import have_springs
from mpm3dpp.case.pairs import is_bonded, is_pressed
from mpm3dpp.case.parts import PRESSED
from mpm3dpp.shapes.base import Points, Shape
from mpm3dpp.shapes.surfaces import surface

_SEEN = 1e-4  # Spacings: lengths are often written to four digits.
_MOST = 0.75  # Spacings: outermost layers are then nearer than a quarter spacing.
_STEPS = 24  # Halvings of the depth.
_FINER = {2: 32, 3: 4}  # Points of a surface for a spacing,
_POINTS = 200_000  # and about how many at most.


class Interference(NamedTuple):
    """Two bodies that are drawn into each other.

    Attributes:
        first, second: their names.
        depth: the largest distance by which one's surface lies within the other [m]; of such as are
            deeper than a spacing that.
        pressed: whether they push each other apart for it.
    """

    first: str
    second: str
    depth: float
    pressed: bool


def interferences(case: Case) -> list[Interference]:
    """Return the bodies with shapes that are drawn into each other, but for rigid and bonded pairs.

    Args:
        case: a checked case.
    """
    if not case.contact_enabled:
        return []
    shapes = {name: body.shape for name, body in case.body.items() if body.shape is not None}
    found = []
    for first, second in combinations(shapes, 2):
        one, other = shapes[first], shapes[second]
        assert one is not None and other is not None
        if case.is_rigid(first) and case.is_rigid(second):
            continue
        if is_bonded(case, first, second) or _are_apart(one, other):
            continue
        least = min(case.body[name].particle_spacing(case.grid) for name in (first, second))
        depth = max(_depth(one, other, least), _depth(other, one, least))
        if depth > _SEEN * least:
            found.append(Interference(first, second, depth, is_pressed(case, first, second)))
    return found


def _are_apart(one: Shape, other: Shape) -> bool:
    (low_a, high_a), (low_b, high_b) = one.bounds(), other.bounds()
    return bool(np.any(high_a <= low_b) or np.any(high_b <= low_a))


def _depth(shape: Shape, other: Shape, spacing: float) -> float:
    """Return how deep the surface of a shape lies within another [m], a spacing at most."""
    points = _surface_points(shape, spacing)
    low, high = _SEEN * spacing, spacing
    points = points[other.inside(points, -low)]
    if not len(points):
        return 0.0
    if other.inside(points, -high).any():
        return high
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        deeper = other.inside(points, -middle)
        if deeper.any():
            low, points = middle, points[deeper]
        else:
            high = middle
    return 0.5 * (low + high)


def _surface_points(shape: Shape, spacing: float) -> Points:
    lower, upper = shape.bounds()
    size = float(np.max(upper - lower))
    fewest = size / _POINTS if len(lower) == 2 else size * (6.0 / _POINTS) ** 0.5
    return surface(shape, "all", max(spacing / _FINER[len(lower)], fewest)).points


def beyond_walls(case: Case) -> list[str]:
    """Return a sentence for each body that is drawn beyond a face of the box and not cut there."""
    grid, found = case.grid, []
    if grid.box is None:
        return []
    for name, body in case.body.items():
        if body.shape is None:
            continue
        spacing = body.particle_spacing(grid)
        lower, upper = body.shape.bounds()
        near = _SEEN * spacing
        if np.all(lower >= np.array(grid.box.lower) - near) and np.all(
            upper <= np.array(grid.box.upper) + near
        ):
            continue
        points = _surface_points(body.shape, spacing)
        for face, wall in enumerate(grid.walls[: 2 * grid.dimension]):
            d, at_end = divmod(face, 2)
            limit = (grid.box.lower, grid.box.upper)[at_end][d]
            depth = float((points[:, d] - limit).max() if at_end else (limit - points[:, d]).max())
            if depth > near and wall != "free":
                found.append(
                    f"body.{name} is drawn {depth:.3g} m beyond grid.box.walls.{FACES_OF_BOX[face]}"
                    ", which makes no stress: it is taken to touch there; give cut_at_box = true, "
                    "or draw it inside"
                )
    return found


def too_deep(case: Case, found: list[Interference]) -> Iterator[CaseError]:
    """Yield which bodies are so deep in each other that their particles fill the same place."""
    for one in found:
        spacings = [case.body[name].particle_spacing(case.grid) for name in (one.first, one.second)]
        if one.depth > _MOST * min(spacings):
            rule = (
                f"overlaps body.{one.first} by {one.depth:.3g} m or more, which is more than "
                f"{_MOST:g} of the distance of particles, {min(spacings):.3g} m: both fill the "
                "same place"
            )
            remedy = "move one of the two, or cut one out of the other with difference"
            yield case.error(("body", one.second, "shape"), rule, remedy)


def interference_notes(case: Case, found: list[Interference]) -> list[str]:
    """Return a sentence for each interference of which no stress comes, and for those pressed."""
    points = [name for name, body in case.body.items() if body.shape is None]
    sentences = [
        f'contact.interference = "pressed" does not hold for body.{name}, which has particles one '
        "by one: where it is drawn into others surfaces are set back, without stress"
        for name in (points if case.contact.interference == PRESSED else [])
    ]
    for one in found:
        who = f"body.{one.second} is drawn {one.depth:.3g} m into body.{one.first}"
        if one.pressed:
            sentences.append(f"{who}: they are pressed into each other while the case settles")
        elif have_springs(case, one.first, one.second):
            sentences.append(
                f"{who}, which makes no stress: their surfaces are set back until they touch; give "
                'contact.interference = "pressed" with run.settle, or draw them apart'
            )
        elif case.has_springs:
            sentences.append(
                f"{who}, which makes no stress: one of them flows, and their approach is stopped "
                "where they are; draw them apart, or cut one out of the other with difference"
            )
        else:
            sentences.append(
                f"{who}, which makes no stress with contact.response = impulses; give springs and "
                'contact.interference = "pressed" with run.settle, or draw them apart'
            )
    return sentences
