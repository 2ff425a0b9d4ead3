# SPDX-License-Identifier: BSD-3-Clause
"""Bodies given point by point: points that do not fit the cells, each other or other bodies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case

from .parts import Filled, FilledBody, FilledPart

Array = NDArray[np.float64]

# Around the middle of a body, so that neither its surface nor its size matters.
_LOOKED_AT, _AMONG = 500, 4000
_SAME = 1e-6  # Points nearer than this share of their distance are one point given twice.
_DENSE = 10.0  # Points in a cell along an axis from which lengths are rather in another unit.
_VOLUME = 2.0  # How far volumes may be from those of cubes between the points, as a length.


def point_warnings(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence for everything about points that a run takes, but that is hardly meant.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
    """
    found = []
    for part in bodies.parts.values():
        if part.shape_volumes is None:
            body = part.body(0)
            found += _of_points(body, case.grid.cell_size) + _inside_others(case, body, bodies)
    return found


def neighbour_distance(points: Array) -> float:
    """Return the median distance of a point to its nearest neighbour [m], near the middle.

    Args:
        points: [m], shape (n, D); 0 for one point alone.
    """
    if len(points) < 2:
        return 0.0
    centre = np.median(points, axis=0)
    reach = np.abs(points - centre).max(axis=1)
    near = points[np.argsort(reach, kind="stable")[:_AMONG]]
    gaps = near[:_LOOKED_AT, None, :] - near[None, :, :]
    squares = np.einsum("ijk,ijk->ij", gaps, gaps)
    own = np.arange(len(squares))
    squares[own, own] = np.inf
    return float(np.sqrt(np.median(squares.min(axis=1))))


def _of_points(body: FilledBody, cell: float) -> list[str]:
    apart, found = neighbour_distance(body.positions), []
    who = f"body.{body.name}: its points"
    if apart > cell * (1.0 + _SAME):
        found.append(
            f"{who} stand {apart:.3g} m apart, {apart / cell:.3g} cells: a body with less than one "
            "in a cell along each axis falls apart; name their unit, or give more points or larger "
            "cells"
        )
    elif 0.0 < apart < cell / _DENSE:
        found.append(
            f"{who} stand {apart:.3g} m apart, {cell / apart:.3g} in a cell along each axis: 2 or "
            "3 are enough; name their unit, or give fewer points or smaller cells"
        )
    if apart > 0.0 and not 1.0 / _VOLUME < body.spacing / apart < _VOLUME:
        found.append(
            f"{who} stand {apart:.3g} m apart, but their volumes are on average those of "
            f"cubes with edges of {body.spacing:.3g} m; look at volume, or at spacing or "
            "particles_per_cell"
        )
    twice = _given_twice(body.positions, _SAME * max(apart, body.spacing))
    if twice is not None:
        count, (first, second) = twice
        found.append(
            f"{who}: {count:,} stand where another one does, the first of them number {second + 1} "
            f"where number {first + 1} is; their mass counts twice; leave them out"
        )
    return found


def _given_twice(points: Array, distance: float) -> tuple[int, tuple[int, int]] | None:
    """Return how many points stand on an earlier one, and the numbers of the first such two."""
    rounded = np.round((points - points.min(axis=0)) / distance)
    _, first, group = np.unique(rounded, axis=0, return_index=True, return_inverse=True)
    earlier = first[group.ravel()]
    again = np.flatnonzero(earlier != np.arange(len(points)))
    if len(again) == 0:
        return None
    return len(again), (int(earlier[again[0]]), int(again[0]))


def _inside_others(case: Case, body: FilledBody, bodies: Filled) -> list[str]:
    """Return a sentence for every body by a shape, or entry of grains, that points stand in."""
    counts: dict[str, int] = {}
    points = body.positions[np.argsort(body.positions[:, 0], kind="stable")]
    for name, other in bodies.parts.items():
        if name == body.part or (case.is_rigid(name) and case.is_rigid(body.part)):
            continue
        shape = None if name in case.grains else case.body[name].shape
        if other.balls is not None:
            counts[name] = _in_balls(points, other)
        elif shape is not None:
            counts[name] = int(shape.contains(_within(points, *shape.bounds())).sum())
    return [
        f"body.{body.name}: {count:,} of its points stand inside {key_text(case.part_path(part))}"
        ", which fills the same place then; move one of the two, or leave these points out"
        for part, count in counts.items()
        if count
    ]


def _in_balls(points: Array, grains: FilledPart) -> int:
    """Return how many of some points, sorted by x, stand in grains."""
    assert grains.balls is not None
    centres, radii = grains.balls
    lowers, uppers = centres - radii[:, None], centres + radii[:, None]
    near = np.all((lowers < points.max(axis=0)) & (uppers > points.min(axis=0)), axis=1)
    count = 0
    for k in np.flatnonzero(near).tolist():
        some = _within(points, lowers[k], uppers[k])
        count += int((((some - centres[k]) ** 2).sum(axis=1) < radii[k] ** 2).sum())
    return count


def _within(points: Array, lower: Array, upper: Array) -> Array:
    """Return those of some points, sorted by x, that stand between two corners."""
    begin, end = np.searchsorted(points[:, 0], (lower[0], upper[0]))
    some = points[begin:end]
    return some[np.all((some > lower) & (some < upper), axis=1)]
