# SPDX-License-Identifier: BSD-3-Clause
"""Filling round shapes with particles on circles and spheres, in place of a lattice.

All particles of a body have the same volume; volume, centre of mass and inertia tensor are those of
the shape to rounding (decision 45). The set is mapped onto itself by every reflection and quarter
turn that maps the shape onto itself and axes of the grid onto axes, and does not depend on where
the grid's points are. A half, quarter or eighth has that part of shells without points on the cuts.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np

from mpm3dpp.base.parts import equal_part

from .base import Points, Shape
from .circles import circle, circle_counts, circles, layer_places
from .cut_round import CutRound, Round, round_of, was_round
from .faces import FACES, has_faces
from .primitives import AXES, Cylinder, Ring, Sphere, Tube
from .spheres import ball_shell, shell_counts
from .transforms import Rotate, Translate
from .turns import turned

SHELLS, LATTICE = GRAIN_WAYS = ("shells", "lattice")
"""How particles may fill grains."""

LEAVE_OUT = f'write fill = "{LATTICE}", or leave it out'
WAYS = (*GRAIN_WAYS, FACES)
"""How particles may fill a shape."""

DEFAULT = SHELLS
"""What fills what is round where a case does not say."""

FEWEST = {2: 4, 3: 6}
"""Particles of the smallest disc or sphere that is filled."""


def unmoved(shape: Shape) -> Shape:
    """Return what a shape is before it was moved and turned."""
    while isinstance(shape, Translate | Rotate):
        shape = shape.shape
    return shape


def takes_shells(shape: Shape) -> bool:
    """Return whether a shape can be filled by shells: what is round, moved or turned if need be."""
    return round_of(shape) is not None


def no_shells(shape: Shape) -> str:
    """Return the rule that a shape breaks that is to be filled by shells, and is not."""
    cut = " (whole, bored about its axis or cut through its middle)" if was_round(shape) else ""
    kind = unmoved(shape).kind
    article = "an" if kind[0] in "aeiou" and kind != "union" else "a"
    return f"is for a disc, ring, sphere, cylinder or tube{cut}, and the shape is {article} {kind}"


def default_way(shape: Shape) -> str:
    """Return how a shape is filled where the case does not say."""
    if takes_shells(shape):
        return DEFAULT
    return FACES if has_faces(shape) else LATTICE


def shell_points(shape: Shape, spacing: float, part: int = 0, parts: int = 1) -> Points:
    """Return the particles that fill a round shape, shape (n, D) [m]; each has the same volume.

    Args:
        shape: one that takes shells.
        spacing: about the distance of the particles [m].
        part, parts: one of so many parts of all, which follow one another.

    Returns:
        None at all if the shape is thinner than half a spacing somewhere.
    """
    found = round_of(shape)
    assert found is not None
    pieces = _pieces(found, spacing)
    first, last = equal_part(sum(pieces.counts), part, parts)
    some, at = [np.zeros((0, len(found.kept)))], 0
    for k, count in enumerate(pieces.counts):
        begin, end = max(first - at, 0), min(last - at, count)
        if begin < end:
            some.append(pieces.make(k)[begin:end])
        at += count
    points = np.concatenate(some)
    for move in reversed(found.moves):
        if isinstance(move, Translate):
            points = points + np.array(move.by)
        else:
            points = turned(points - move.centre(), move.matrix()) + move.centre()
    return points


def shell_total(shape: Shape, spacing: float) -> int:
    """Return how many particles fill a round shape."""
    found = round_of(shape)
    assert found is not None
    return sum(_pieces(found, spacing).counts)


class _Pieces(NamedTuple):
    """Points in pieces that follow one another, each made when it is asked for."""

    counts: list[int]
    make: Callable[[int], Points]


def _pieces(found: CutRound, spacing: float) -> _Pieces:
    """Return the shells of a sphere, the layers of a cylinder or tube, or a disc or ring."""
    pieces = _pieces_about_zero(found.whole, spacing, found.parts > 1)
    centre, kept = np.array(found.whole.centre), np.array(found.kept)
    if found.parts == 1:
        return _Pieces(pieces.counts, lambda k: pieces.make(k) + centre)

    def part(k: int) -> Points:
        points = pieces.make(k)
        return points[np.all(points * kept >= 0.0, axis=1)] + centre

    return _Pieces([count // found.parts for count in pieces.counts], part)


def _pieces_about_zero(shape: Round, spacing: float, cut: bool) -> _Pieces:
    if isinstance(shape, Sphere):
        radius = shape.radius
        return _Pieces(
            shell_counts(radius, spacing, cut), lambda k: ball_shell(radius, spacing, k, cut)
        )
    inner, outer = _radii(shape)
    until = circle_counts(inner, outer, spacing).astype(int)
    if not isinstance(shape, Cylinder | Tube):
        return _Pieces(np.diff(until).tolist(), lambda k: circle(inner, outer, spacing, k, cut))
    axis, places = AXES[shape.axis], layer_places(shape.height, spacing)

    @functools.cache
    def layer() -> Points:
        return circles(inner, outer, spacing, cut)

    return _Pieces(
        [int(until[-1])] * len(places), lambda k: np.insert(layer(), axis, places[k], axis=1)
    )


def shell_count(shape: Shape, spacing: float) -> float:
    """Return about how many particles would fill a round shape."""
    found = round_of(shape)
    assert found is not None
    whole = found.whole
    if isinstance(whole, Sphere):
        return ball_count([whole.radius], 3, spacing) / found.parts
    inner, outer = _radii(whole)
    layer = max(math.pi * (outer - inner) * (outer + inner) / spacing**2, FEWEST[2])
    layers = max(2.0, whole.height / spacing) if isinstance(whole, Cylinder | Tube) else 1.0
    return layer * layers / found.parts


def ball_count(radii: Iterable[float], dimension: int, spacing: float) -> float:
    """Return about how many particles would fill discs or spheres of some radii [m]."""
    sizes = np.asarray(radii, dtype=np.float64) / spacing
    whole = math.pi * sizes**2 if dimension == 2 else 4.0 / 3.0 * math.pi * sizes**3
    return float(np.maximum(whole, FEWEST[dimension]).sum())


def _radii(shape: Round) -> tuple[float, float]:
    if isinstance(shape, Ring | Tube):
        return shape.inner_radius, shape.outer_radius
    return 0.0, shape.radius
