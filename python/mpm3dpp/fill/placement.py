# SPDX-License-Identifier: BSD-3-Clause
"""Whether filled bodies stand where they may: inside the box, and not in one another."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.errors import Path as KeyPath
from mpm3dpp.base.neighbours import overlapping_boxes
from mpm3dpp.case.case import Case
from mpm3dpp.case.grid import FARTHEST
from mpm3dpp.ranks.world import World
from mpm3dpp.shapes.shells import SHELLS

from .parts import FilledPart
from .slices import number_of_all, of_one, strips

if TYPE_CHECKING:
    from .parts import Filled

CUT = "leave out what lies beyond with cut_at_box = true"
CLOSE = 0.25  # Particles of two bodies nearer than this share of their spacing overlap.
_SLACK = 1e-9  # How far, in cells, a particle may stand outside the box by rounding.


def box_mistakes(case: Case, part: FilledPart, world: World | None = None) -> Iterator[CaseError]:
    """Yield where particles stand outside the box, or the region that is kept, or any grid.

    Of the grains of an entry the first that is wrong speaks for all.

    Args:
        case: what is filled.
        part: an entry.
        world: processes that have slices of it; each calls this.
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
            yield from _outside(case, _OneBody(part, k), region, corners, world)


def _outside(
    case: Case,
    body: _OneBody,
    region: str,
    corners: tuple[tuple[float, ...], tuple[float, ...]],
    world: World | None,
) -> Iterator[CaseError]:
    slack = _SLACK * case.grid.cell_size
    what = "box" if region == "box" else "region"
    positions, (lower, upper) = body.positions(world), body.bounds()
    part_count = body.part.count
    for d, axis in enumerate("xyz"[: case.grid.dimension]):
        x = positions[:, d]
        for sign, limit, end in ((-1, corners[0][d], lower[d]), (1, corners[1][d], upper[d])):
            if sign * end > sign * limit + slack:
                count = number_of_all(int((sign * x > sign * limit + slack).sum()), world)
                side = f"{axis} {'>' if sign > 0 else '<'} {limit:g} m"
                path, filling = _key(case, body.part.name)
                who = "its particles"
                if body.name != body.part.name:
                    who = f"the particles of {body.name}"
                rule = f"reaches out of grid.{region}: {count} of {who} are at {side}"
                cut = ""
                if region == "box" and count < part_count and body.part.name in case.body:
                    cut = _cut(case, body.part.name)
                yield case.error(path, rule, f"move the {filling}, {cut}or enlarge the {what}")


def _cut(case: Case, name: str) -> str:
    """Return the remedy for a shape that lies across a face, as one across a plane of symmetry."""
    body = case.body[name]
    if body.shape is None:
        return ""
    lattice = ' and fill = "lattice"' if body.fill == SHELLS else ""
    return f"{CUT}{lattice}, "


def _key(case: Case, part: str) -> tuple[KeyPath, str]:
    """Return the path of what gives an entry its particles, and that key alone."""
    filling = case.parts()[part].filling
    return (*case.part_path(part), filling), filling


def overlap_mistakes(case: Case, bodies: Filled, world: World | None = None) -> Iterator[CaseError]:
    """Yield which two bodies overlap by more than a quarter spacing; of grains the first only.

    Grains are judged as balls: where those touch, particles may be as near as chance has it.

    Args:
        case: what is filled.
        bodies: its bodies, filled.
        world: processes that have slices of them; each calls this.
    """
    if len(bodies) < 2:
        return
    parts = list(bodies.parts.values())
    sizes = [len(part.names) for part in parts]
    part_of = np.repeat(np.arange(len(parts)), sizes)
    first_of = np.cumsum([0, *sizes])
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
        one = _OneBody(parts[pair[0]], int(a[k] - first_of[pair[0]]))
        other = _OneBody(parts[pair[1]], int(b[k] - first_of[pair[1]]))
        how = f"by {depths[k]:.4g} m"
        if np.isnan(depths[k]):
            count = _close(one, other, CLOSE * min(one.part.spacing, other.part.spacing), world)
            if not count:
                continue
            how = (
                f"{count} of the particles of {other.name} are closer than a quarter spacing to "
                f"particles of {one.name}"
            )
        who = f"body.{one.name}" if one.name == one.part.name else one.name
        if other.name == other.part.name:
            rule = f"overlaps {who}: {how}"
            remedy = "move one of the two, or cut one out of the other with difference"
        else:
            rule = f"has {other.name} overlap {who}: {how}"
            remedy = "move the grains, or make them smaller"
        told.add(pair)
        yield case.error(_key(case, other.part.name)[0], rule, remedy)


class _OneBody(NamedTuple):
    """One of the bodies of an entry, by its place there."""

    part: FilledPart
    place: int

    @property
    def name(self) -> str:
        return self.part.names[self.place]

    def positions(self, world: World | None) -> NDArray[np.float64]:
        """Return the particles' positions [m]: each is had by one of the processes."""
        if self.part.own is not None:
            return self.part.own.particles.positions
        whole = self.part.make(self.place, self.place + 1).positions
        return whole if world is None else of_one(whole, world)

    def bounds(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        return self.part.survey.lower[self.place], self.part.survey.upper[self.place]


def _close(one: _OneBody, other: _OneBody, distance: float, world: World | None) -> int:
    """Return how many particles of the other are closer than a distance to one of the first."""
    points = [body.positions(world) for body in (one, other)]
    if world is not None:
        lower = np.maximum(one.bounds()[0], other.bounds()[0]) - distance
        upper = np.minimum(one.bounds()[1], other.bounds()[1]) + distance
        if np.any(lower > upper):
            return 0
        points = [p[np.all((p >= lower) & (p <= upper), axis=1)] for p in points]
        points = [*strips(points[0], points[1], (lower, upper), distance, world)]
    return number_of_all(close_particles(points[0], points[1], distance), world)


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
    if len(others) == 0:  # A process may have none of them.
        return points[:0]
    lower, upper = others.min(axis=0) - distance, others.max(axis=0) + distance
    return points[np.all((points >= lower) & (points <= upper), axis=1)]
