# SPDX-License-Identifier: BSD-3-Clause
"""Whether filled bodies stand where they may: inside the box, and not in one another."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.errors import Path as KeyPath
from mpm3dpp.base.neighbours import overlapping_boxes
from mpm3dpp.case.case import Case
from mpm3dpp.case.grid import FARTHEST

if TYPE_CHECKING:
    from .parts import Filled, FilledBody, FilledPart

CLOSE = 0.25  # Particles of two bodies nearer than this share of their spacing overlap.
_SLACK = 1e-9  # How far, in cells, a particle may stand outside the box by rounding.


def box_mistakes(case: Case, part: FilledPart) -> Iterator[CaseError]:
    """Yield where particles stand outside the box, or the region that is kept, or any grid.

    Of the grains of an entry the first that is wrong speaks for all.
    """
    grid, seen = case.grid, part.survey
    regions = [("outflow_box", grid.kept)]
    if grid.box is not None:
        regions.insert(0, ("box", (grid.box.lower, grid.box.upper)))
    origin = np.asarray(grid.lower)
    reach = np.maximum(abs(seen.lower - origin), abs(seen.upper - origin)) / grid.cell_size
    wrong = ~(reach < FARTHEST).all(axis=1)
    slack = _SLACK * grid.cell_size
    for _, (lower, upper) in regions:
        inside = (seen.lower >= np.asarray(lower) - slack) & (
            seen.upper <= np.asarray(upper) + slack
        )
        wrong |= ~inside.all(axis=1)
    for k in np.flatnonzero(wrong)[:1].tolist():
        if not reach[k].max() < FARTHEST:
            most = f"{FARTHEST:,} is the most"
            rule = f"is {reach[k].max():.2e} cells from the grid's origin, and {most}"
            path, filling = _key(case, part.name)
            remedy = f"give larger cells, or move grid.origin to the {filling}"
            yield case.error(path, rule, remedy)
            return
        for region, corners in regions:
            yield from _outside(case, part.body(k), region, corners)


def _outside(
    case: Case,
    body: FilledBody,
    region: str,
    corners: tuple[tuple[float, ...], tuple[float, ...]],
) -> Iterator[CaseError]:
    slack = _SLACK * case.grid.cell_size
    what = "box" if region == "box" else "region"
    for d, axis in enumerate("xyz"[: case.grid.dimension]):
        x = body.positions[:, d]
        for limit, outside in ((corners[0][d], -x), (corners[1][d], x)):
            sign = 1 if limit == corners[1][d] else -1
            reach = float(outside.max())
            if reach > sign * limit + slack:
                count = int((outside > sign * limit + slack).sum())
                side = f"{axis} {'>' if sign > 0 else '<'} {limit:g} m"
                path, filling = _key(case, body.part)
                who = "its particles" if body.name == body.part else f"the particles of {body.name}"
                rule = f"reaches out of grid.{region}: {count} of {who} are at {side}"
                yield case.error(path, rule, f"move the {filling}, or enlarge the {what}")


def _key(case: Case, part: str) -> tuple[KeyPath, str]:
    """Return the path of what gives an entry its particles, and that key alone."""
    filling = case.parts()[part].filling
    return (*case.part_path(part), filling), filling


def overlap_mistakes(case: Case, bodies: Filled) -> Iterator[CaseError]:
    """Yield which two bodies overlap by more than a quarter spacing; of grains the first only.

    Grains are judged as balls: where those touch, particles may be as near as chance has it.
    """
    if len(bodies) < 2:
        return
    parts = list(bodies.parts.values())
    part_of = np.repeat(np.arange(len(parts)), [len(part.names) for part in parts])
    reach = CLOSE * np.concatenate([np.full(len(part.names), part.spacing) for part in parts])
    no_ball = (np.full((1, case.grid.dimension), np.nan), np.full(1, np.nan))
    centres, radii = (
        np.concatenate([(part.balls or no_ball)[which] for part in parts]) for which in (0, 1)
    )
    lowers = np.concatenate([part.survey.lower for part in parts])
    uppers = np.concatenate([part.survey.upper for part in parts])
    lowers = np.fmin(lowers, centres - radii[:, None]) - 0.5 * reach[:, None]
    uppers = np.fmax(uppers, centres + radii[:, None]) + 0.5 * reach[:, None]
    a, b = overlapping_boxes(lowers, uppers)
    depths = radii[a] + radii[b] - np.sqrt(((centres[a] - centres[b]) ** 2).sum(axis=1))
    near = ~(depths <= np.minimum(reach[a], reach[b]))  # With a body that is no ball: not a number.
    rigid = np.array([case.is_rigid(part.name) for part in parts])
    near &= ~(rigid[part_of[a]] & rigid[part_of[b]])  # They do not act on each other.
    told: set[tuple[int, int]] = set()
    for k in np.flatnonzero(near).tolist():
        pair = int(part_of[a[k]]), int(part_of[b[k]])
        if pair in told:
            continue
        first, second = bodies[int(a[k])], bodies[int(b[k])]
        how = f"by {depths[k]:.4g} m"
        if np.isnan(depths[k]):
            distance = CLOSE * min(first.spacing, second.spacing)
            count = close_particles(first.positions, second.positions, distance)
            if not count:
                continue
            how = (
                f"{count} of the particles of {second.name} are closer than a quarter spacing to "
                f"particles of {first.name}"
            )
        other = f"body.{first.name}" if first.name == first.part else first.name
        if second.name == second.part:
            rule = f"overlaps {other}: {how}"
            remedy = "move one of the two, or cut one out of the other with difference"
        else:
            rule = f"has {second.name} overlap {other}: {how}"
            remedy = "move the grains, or make them smaller"
        told.add(pair)
        yield case.error(_key(case, second.part)[0], rule, remedy)


def close_particles(
    first: NDArray[np.float64], second: NDArray[np.float64], distance: float
) -> int:
    """Count the points of one set that have a point of another closer than a distance.

    Args:
        first: positions [m], shape (n, D).
        second: positions [m], shape (m, D).
        distance: [m], > 0.

    Returns:
        Number of points of `second` that are closer than `distance` to a point of `first`.
    """
    from scipy.spatial import cKDTree

    first, second = _common(first, second, distance), _common(second, first, distance)
    if len(first) == 0 or len(second) == 0:
        return 0
    away, _ = cKDTree(first).query(second, distance_upper_bound=distance)
    return int(np.isfinite(away).sum())


def _common(
    points: NDArray[np.float64], others: NDArray[np.float64], distance: float
) -> NDArray[np.float64]:
    """Return the points within the bounds of the others, which are widened by a distance."""
    lower, upper = others.min(axis=0) - distance, others.max(axis=0) + distance
    return points[np.all((points >= lower) & (points <= upper), axis=1)]
