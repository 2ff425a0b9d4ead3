# SPDX-License-Identifier: BSD-3-Clause
"""Filling round shapes with particles on circles and spheres, in place of a lattice.

All particles of a body have the same volume; volume, centre of mass and inertia tensor are those of
the shape to rounding (decision 45). The set is mapped onto itself by every reflection and quarter
turn that maps the shape onto itself and axes of the grid onto axes, and does not depend on where
the grid's points are.
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
from .primitives import AXES, Cylinder, Disc, Ring, Sphere, Tube
from .spheres import ball_shell, shell_counts
from .transforms import Rotate, Translate
from .turns import turned

SHELLS, LATTICE = WAYS = ("shells", "lattice")
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
    return isinstance(unmoved(shape), Disc | Ring | Cylinder | Tube)


def default_way(shape: Shape) -> str:
    """Return how a shape is filled where the case does not say."""
    return DEFAULT if takes_shells(shape) else LATTICE


def shell_points(shape: Shape, spacing: float, part: int = 0, parts: int = 1) -> Points:
    """Return the particles that fill a round shape, shape (n, D) [m]; each has the same volume.

    Args:
        shape: one that takes shells.
        spacing: about the distance of the particles [m].
        part, parts: one of so many parts of all, which follow one another.

    Returns:
        None at all if the shape is thinner than half a spacing somewhere.
    """
    if isinstance(shape, Translate):
        return shell_points(shape.shape, spacing, part, parts) + np.array(shape.by)
    if isinstance(shape, Rotate):
        about = shape.centre()
        points = shell_points(shape.shape, spacing, part, parts)
        return turned(points - about, shape.matrix()) + about
    pieces = _pieces(shape, spacing)
    first, last = equal_part(sum(pieces.counts), part, parts)
    found, at = [np.zeros((0, len(shape.bounds()[0])))], 0
    for k, count in enumerate(pieces.counts):
        begin, end = max(first - at, 0), min(last - at, count)
        if begin < end:
            found.append(pieces.make(k)[begin:end])
        at += count
    return np.concatenate(found)


def shell_total(shape: Shape, spacing: float) -> int:
    """Return how many particles fill a round shape."""
    return sum(_pieces(unmoved(shape), spacing).counts)


class _Pieces(NamedTuple):
    """Points in pieces that follow one another, each made when it is asked for."""

    counts: list[int]
    make: Callable[[int], Points]


def _pieces(shape: Shape, spacing: float) -> _Pieces:
    """Return the shells of a sphere, the layers of a cylinder or tube, or a disc or ring."""
    assert isinstance(shape, Disc | Ring | Cylinder | Tube)
    centre = np.array(shape.centre)
    if isinstance(shape, Sphere):
        radius = shape.radius
        return _Pieces(
            shell_counts(radius, spacing), lambda k: ball_shell(radius, spacing, k) + centre
        )
    inner, outer = _radii(shape)
    until = circle_counts(inner, outer, spacing).astype(int)
    if not isinstance(shape, Cylinder | Tube):
        return _Pieces(np.diff(until).tolist(), lambda k: circle(inner, outer, spacing, k) + centre)
    axis, places = AXES[shape.axis], layer_places(shape.height, spacing)

    @functools.cache
    def layer() -> Points:
        return circles(inner, outer, spacing)

    return _Pieces(
        [int(until[-1])] * len(places),
        lambda k: np.insert(layer(), axis, places[k], axis=1) + centre,
    )


def shell_count(shape: Shape, spacing: float) -> float:
    """Return about how many particles would fill a round shape."""
    shape = unmoved(shape)
    if isinstance(shape, Sphere):
        return ball_count([shape.radius], 3, spacing)
    assert isinstance(shape, Disc | Ring | Cylinder | Tube)
    inner, outer = _radii(shape)
    layer = max(math.pi * (outer - inner) * (outer + inner) / spacing**2, FEWEST[2])
    layers = max(2.0, shape.height / spacing) if isinstance(shape, Cylinder | Tube) else 1.0
    return layer * layers


def ball_count(radii: Iterable[float], dimension: int, spacing: float) -> float:
    """Return about how many particles would fill discs or spheres of some radii [m]."""
    sizes = np.asarray(radii, dtype=np.float64) / spacing
    whole = math.pi * sizes**2 if dimension == 2 else 4.0 / 3.0 * math.pi * sizes**3
    return float(np.maximum(whole, FEWEST[dimension]).sum())


def _radii(shape: Disc | Ring | Cylinder | Tube) -> tuple[float, float]:
    if isinstance(shape, Ring | Tube):
        return shape.inner_radius, shape.outer_radius
    return 0.0, shape.radius
