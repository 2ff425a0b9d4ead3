# SPDX-License-Identifier: BSD-3-Clause
"""Whether filled bodies stand where they may: inside the box, and not in one another."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .case import Case
from .errors import Path as KeyPath
from .neighbours import overlapping_boxes
from .overlap import close_particles

if TYPE_CHECKING:
    from .build import FilledBody

CLOSE = 0.25  # Particles of two bodies nearer than this share of their spacing overlap.
_SLACK = 1e-9  # How far, in cells, a particle may stand outside the box by rounding.


def check_box(case: Case, body: FilledBody) -> None:
    """Raise if a particle stands outside the box, or the region that is kept."""
    grid = case.grid
    if grid.box is not None:
        _check_inside(case, body, "box", (grid.box.lower, grid.box.upper))
    _check_inside(case, body, "keep", grid.kept)


def _check_inside(
    case: Case,
    body: FilledBody,
    region: str,
    corners: tuple[tuple[float, ...], tuple[float, ...]],
) -> None:
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
                path, filling = _key(case, body)
                who = "its particles" if body.name == body.part else f"the particles of {body.name}"
                rule = f"reaches out of grid.{region}: {count} of {who} are at {side}"
                raise case.error(path, rule, f"move the {filling}, or enlarge the {what}")


def _key(case: Case, body: FilledBody) -> tuple[KeyPath, str]:
    """Return the path of what gives a body its particles, and that key alone."""
    filling = case.parts()[body.part].filling
    return (*case.part_path(body.part), filling), filling


def check_overlap(case: Case, bodies: list[FilledBody]) -> None:
    """Raise if two bodies overlap by more than a quarter spacing.

    Grains are judged as balls: where those touch, particles may be as near as chance has it.
    """
    if len(bodies) < 2:
        return
    reach = CLOSE * np.array([body.spacing for body in bodies])
    no_ball = (np.full(case.grid.dimension, np.nan), np.nan)
    centres = np.array([(body.ball or no_ball)[0] for body in bodies])
    radii = np.array([(body.ball or no_ball)[1] for body in bodies])
    lowers = np.array([body.positions.min(axis=0) for body in bodies])
    uppers = np.array([body.positions.max(axis=0) for body in bodies])
    lowers = np.fmin(lowers, centres - radii[:, None]) - 0.5 * reach[:, None]
    uppers = np.fmax(uppers, centres + radii[:, None]) + 0.5 * reach[:, None]
    a, b = overlapping_boxes(lowers, uppers)
    depths = radii[a] + radii[b] - np.sqrt(((centres[a] - centres[b]) ** 2).sum(axis=1))
    near = ~(depths <= np.minimum(reach[a], reach[b]))  # With a body that is no ball: not a number.
    rigid = {name: case.is_rigid(name) for name in case.parts()}
    for k in np.flatnonzero(near).tolist():
        first, second = bodies[a[k]], bodies[b[k]]
        if rigid[first.part] and rigid[second.part]:
            continue  # They do not act on each other.
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
        raise case.error(_key(case, second)[0], rule, remedy)
