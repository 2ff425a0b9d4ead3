# SPDX-License-Identifier: BSD-3-Clause
"""Shapes with flat faces filled from these: by a lattice whose cells end at them.

Between two faces across an axis there are as many cells of equal width as come next to the
spacing, so that the surface of the particles is the drawn surface, a gap as wide as it is drawn,
and the mass of a box exact. Where few cells lie across a thin body the others take their width: a
surface of particles that are wider than high is not where bodies are felt to touch. Where all faces
along an axis lie on planes of the lattice of the grid its points are taken, to the bit. What is
turned is filled before it is turned.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from .base import Points, Shape
from .booleans import Difference, Intersection, Union
from .circles import nearest_count
from .inclined import Frustum, Polygon
from .lattice import Lattice, lattice_axes, points_inside
from .ogive import OgiveRod
from .primitives import AXES, Box, Cylinder, Tube
from .transforms import Rotate, Translate
from .turns import turned

FACES = "faces"
"""The way of filling."""

ON_PLANE = 1e-6  # Of a spacing: so near to a plane of the lattice a face lies on it.
_NARROW = 0.5  # Spacings: faces that are nearer are one; what is narrower holds no particle.
_SAME = 1e-12  # Spacings.
_MOST_CELLS = 1 << 20  # Between faces, for a volume.
_OBLONG = 1.05  # Widths over heights, up to which cells count as squares or cubes.
# Spacings: wider and narrower cells are for the one layer of a thin plate alone.
_FINE, _COARSE = 0.75 - ON_PLANE, 1.25


class Axis(NamedTuple):
    """Cells along an axis.

    Attributes:
        places: of their middles [m], shape (n,).
        widths: [m], shape (n,).
    """

    places: Points
    widths: Points


def has_faces(shape: Shape) -> bool:
    """Return whether a shape has flat faces across the axes, before it is turned obliquely."""
    return any(faces_of(upright(shape)))


def upright(shape: Shape) -> Shape:
    """Return a shape as it was before it was turned obliquely, if flat faces are turned with it."""
    inner = shape
    while isinstance(inner, Translate | Rotate):
        if isinstance(inner, Rotate) and not quarter_turn(inner):
            below = upright(inner.shape)
            return below if any(faces_of(below)) else shape
        inner = inner.shape
    return shape


def quarter_turn(shape: Rotate) -> bool:
    """Return whether axes are turned onto axes."""
    matrix = shape.matrix()
    return bool(np.abs(matrix - np.round(matrix)).max() < 1e-12)


def faces_of(shape: Shape) -> list[set[float]]:
    """Return for each axis where flat faces lie across it [m]: of boxes, the ends of rods, and
    sides of polygons along the axes."""
    lower, upper = shape.bounds()
    found: list[set[float]] = [set() for _ in lower]
    if isinstance(shape, Box):
        return [{float(a), float(b)} for a, b in zip(lower, upper, strict=True)]
    if isinstance(shape, Union | Difference | Intersection):
        for one in shape.shapes:
            found = [a | b for a, b in zip(found, faces_of(one), strict=True)]
    elif isinstance(shape, Translate):
        found = [{x + by for x in a} for a, by in zip(faces_of(shape.shape), shape.by, strict=True)]
    elif isinstance(shape, Rotate) and quarter_turn(shape):
        about, matrix = shape.centre(), np.round(shape.matrix())
        for d, faces in enumerate(faces_of(shape.shape)):
            to = int(np.argmax(np.abs(matrix[:, d])))
            found[to] = {float(matrix[to, d] * (x - about[d]) + about[to]) for x in faces}
    elif isinstance(shape, Polygon):
        corners = np.array(shape.points)
        for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            for d in (0, 1):
                if a[d] == b[d] and (a != b).any():
                    found[d].add(float(a[d]))
    elif isinstance(shape, Cylinder | Tube | Frustum):
        axis = AXES[shape.axis]
        found[axis] = {float(lower[axis]), float(upper[axis])}
    elif isinstance(shape, OgiveRod):
        axis, sign = shape.axis()
        found[axis] = {float(upper[axis] if sign > 0 else lower[axis])}
    return found


def fitted_axes(shape: Shape, origin: Points, spacing: float) -> list[Axis | None]:
    """Return the cells along each axis, None where those of the grid's lattice end at all faces.

    Args:
        shape: upright.
        origin: a corner of the grid [m], D numbers.
        spacing: about the width of the cells [m].
    """
    lower, upper = shape.bounds()
    slack = ON_PLANE * spacing
    faces = [
        [x for x in sorted(all_faces) if lower[d] - slack <= x <= upper[d] + slack]
        for d, all_faces in enumerate(faces_of(shape))
    ]
    found = [
        None if _on_planes(x, origin[d], spacing) else _axis(x, lower[d], upper[d], spacing)
        for d, x in enumerate(faces)
    ]
    thin = _thin(found, upper - lower, spacing)
    if thin is None or not all(faces):
        return found
    width = float(thin.widths[0])
    alike: list[Axis | None] = [
        one if one is thin else _axis(faces[d], lower[d], upper[d], width)
        for d, one in enumerate(found)
    ]
    widths = np.concatenate([one.widths for one in alike if one is not None])
    return alike if widths.max() <= _OBLONG * widths.min() else found


def _thin(axes: list[Axis | None], lengths: Points, spacing: float) -> Axis | None:
    """Return the cells along the axis that has the fewest, if others are longer or shorter there.

    None where cells are squares or cubes, of several widths, or far from the spacing.
    """
    widths = [np.array([spacing]) if axis is None else axis.widths for axis in axes]
    if any(not len(w) or np.ptp(w) > _SAME * spacing for w in widths):
        return None
    each = np.array([w[0] for w in widths])
    fewest = int(np.argmin(np.round(lengths / each)))
    oblong = each.max() > _OBLONG * each.min()
    fits = _FINE * spacing <= each[fewest] <= _COARSE * spacing
    return axes[fewest] if oblong and fits else None


def _on_planes(faces: list[float], origin: float, spacing: float) -> bool:
    """Return whether all faces lie on planes of the lattice of the grid."""
    off = [(x - origin) / spacing - round((x - origin) / spacing) for x in faces]
    return all(abs(x) < ON_PLANE for x in off)


def _axis(faces: list[float], low: float, high: float, spacing: float) -> Axis:
    # The ends of the shape are kept, of faces between them those that are far enough from others.
    near = ON_PLANE * spacing
    kept = [x for x, end in ((faces[0], low), (faces[-1], high)) if abs(x - end) <= near]
    for x in faces:
        if all(abs(x - y) >= _NARROW * spacing for y in kept):
            kept.append(x)
    kept.sort()
    pieces = [_between(a, b, nearest_count((b - a) / spacing)) for a, b in pairwise(kept)]
    # Beyond the first and the last face, as of a disc that sticks out of a box.
    before = math.ceil(max(kept[0] - low, 0.0) / spacing - ON_PLANE)
    after = math.ceil(max(high - kept[-1], 0.0) / spacing - ON_PLANE)
    pieces.insert(0, _between(kept[0] - before * spacing, kept[0], before))
    pieces.append(_between(kept[-1], kept[-1] + after * spacing, after))
    return Axis(*(np.concatenate(parts) for parts in zip(*pieces, strict=True)))


def _between(a: float, b: float, count: int) -> Axis:
    """Return so many cells of equal width; those of mirror images are mirror images."""
    width = (b - a) / max(count, 1)
    steps = np.arange(count, dtype=np.float64) + 0.5 - 0.5 * count
    return Axis(0.5 * (a + b) + steps * width, np.full(count, width))


def volume_of_boxes(shape: Shape) -> float | None:
    """Return the exact volume of a shape that is made of boxes along its axes; None for others."""
    shape = upright(shape)
    if not _all_boxes(shape):
        return None
    bounds = zip(faces_of(shape), *shape.bounds(), strict=True)
    edges = [np.array(sorted(x for x in faces if a <= x <= b)) for faces, a, b in bounds]
    if math.prod(len(x) for x in edges) > _MOST_CELLS or min(len(x) for x in edges) < 2:
        return None
    mesh = np.meshgrid(*(0.5 * (x[1:] + x[:-1]) for x in edges), indexing="ij")
    inside = shape.inside(np.stack([x.ravel() for x in mesh], axis=1), 0.0)
    sizes = np.meshgrid(*(np.diff(x) for x in edges), indexing="ij")
    return float(np.prod([x.ravel() for x in sizes], axis=0)[inside].sum())


def _all_boxes(shape: Shape) -> bool:
    if isinstance(shape, Union | Difference | Intersection):
        return all(_all_boxes(one) for one in shape.shapes)
    if isinstance(shape, Translate) or (isinstance(shape, Rotate) and quarter_turn(shape)):
        return _all_boxes(shape.shape)
    return isinstance(shape, Box)


def fill_from_faces(
    shape: Shape, origin: Points, spacing: float, part: int = 0, parts: int = 1
) -> tuple[Points, Points]:
    """Return the particles of a shape that has flat faces.

    Args:
        shape: what to fill.
        origin: a corner of the grid [m], D numbers.
        spacing: about the distance of the particles [m].
        part, parts: one of so many parts of all particles, which follow one another.

    Returns:
        Positions [m], shape (n, D), and volumes [m^3; in 2D m^2], shape (n,): of one number if
        `cells_are_alike`.

    Raises:
        CaseError: the particles would not fit into the memory of this machine.
    """
    if upright(shape) is not shape:
        assert isinstance(shape, Translate | Rotate)
        points, volumes = fill_from_faces(shape.shape, origin, spacing, part, parts)
        if isinstance(shape, Translate):
            return points + np.array(shape.by), volumes
        return turned(points - shape.centre(), shape.matrix()) + shape.centre(), volumes
    start = np.asarray(origin, dtype=np.float64)
    usual = lattice_axes(shape, start, np.full(len(start), float(spacing)), parts)
    axes = [
        Axis(places, np.full(len(places), spacing)) if axis is None else axis
        for places, axis in zip(usual, fitted_axes(shape, start, spacing), strict=True)
    ]
    positions = points_inside(Lattice(shape, [axis.places for axis in axes], spacing), part, parts)
    if cells_are_alike(shape, start, spacing):
        each = math.prod(float(axis.widths[0]) if len(axis.widths) else 0.0 for axis in axes)
        if all(len(axis.widths) and axis.widths[0] == spacing for axis in axes):
            each = spacing ** len(axes)
        return positions, np.broadcast_to(each, (len(positions),))
    volumes = np.ones(len(positions))
    for d, axis in enumerate(axes):
        volumes *= axis.widths[np.searchsorted(axis.places, positions[:, d])]
    return positions, volumes


def fits_the_lattice(shape: Shape, origin: Any, spacing: float) -> bool:
    """Return whether a shape is filled from its faces as by the lattice of the grid."""
    inner = upright(shape)
    start = np.asarray(origin, dtype=np.float64)
    return inner is shape and all(axis is None for axis in fitted_axes(inner, start, spacing))


def cells_are_alike(shape: Shape, origin: Any, spacing: float) -> bool:
    """Return whether all particles of a shape that is filled from its faces have one volume."""
    axes = fitted_axes(upright(shape), np.asarray(origin, dtype=np.float64), spacing)
    return all(
        axis is None or not len(axis.widths) or bool(np.ptp(axis.widths) <= _SAME * spacing)
        for axis in axes
    )
