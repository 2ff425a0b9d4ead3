# SPDX-License-Identifier: BSD-3-Clause
"""Filling round shapes with particles on circles and spheres, in place of a lattice.

All particles of a body have the same volume; volume, centre of mass and inertia tensor are those of
the shape to rounding (decision 45). The set is mapped onto itself by every reflection and quarter
turn that maps the shape onto itself and axes of the grid onto axes, and does not depend on where
the grid's points are.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from .base import Points, Shape
from .circles import circles, layer_places
from .primitives import AXES, Cylinder, Disc, Ring, Sphere, Tube
from .spheres import ball_shells
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


def shell_points(shape: Shape, spacing: float) -> Points:
    """Return the particles that fill a round shape, shape (n, D) [m]; each has the n-th part of it.

    Args:
        shape: one that takes shells.
        spacing: about the distance of the particles [m].

    Returns:
        None at all if the shape is thinner than half a spacing somewhere.
    """
    if isinstance(shape, Translate):
        return shell_points(shape.shape, spacing) + np.array(shape.by)
    if isinstance(shape, Rotate):
        about = shape.centre()
        return turned(shell_points(shape.shape, spacing) - about, shape.matrix()) + about
    assert isinstance(shape, Disc | Ring | Cylinder | Tube)
    centre = np.array(shape.centre)
    if isinstance(shape, Sphere):
        return ball_shells(shape.radius, spacing) + centre
    layer = circles(*_radii(shape), spacing)
    if not isinstance(shape, Cylinder | Tube):
        return layer + centre
    places = layer_places(shape.height, spacing)
    points = np.tile(layer, (len(places), 1))
    along = np.repeat(places, len(layer))
    return np.insert(points, AXES[shape.axis], along, axis=1) + centre


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
