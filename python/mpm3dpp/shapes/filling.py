# SPDX-License-Identifier: BSD-3-Clause
"""Filling a body with particles, in one of the ways that there are; volumes without a formula."""

from __future__ import annotations

from typing import Any

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import MOST_PARTICLES

from .base import Points, Shape
from .cut_round import round_of
from .faces import FACES, fill_from_faces, volume_of_boxes
from .lattice import Lattice, fill_shape, lattice_axes, too_many
from .shells import SHELLS, shell_count, shell_points, shell_total

_QUADRATURE = {2: 1 << 21, 3: 1 << 22}  # Lattice points for a volume without a formula.


def fill_round(shape: Shape, spacing: float, part: int = 0, parts: int = 1) -> Points:
    """Return the particles that fill a round shape in shells, of equal volume, shape (n, D) [m].

    Args:
        shape: one that takes shells.
        spacing: about the distance of the particles [m].
        part, parts: one of so many parts of all particles, which follow one another.

    Raises:
        CaseError: the particles would not fit into the memory of this machine.
    """
    points = shell_count(shape, spacing)
    if not points / parts < MOST_PARTICLES:
        raise too_many(shape, points)
    return shell_points(shape, spacing, part, parts)


def fill(
    body: Any, grid: Any, way: str = "", part: int = 0, parts: int = 1
) -> tuple[Points, Points]:
    """Return the particles of a body.

    Args:
        body: a `case.Body`: its shape or particles, and `particles_per_cell` or `spacing`.
        grid: a `case.Grid`: its dimension, origin and cell size.
        way: "shells", "faces" or "lattice"; by default what the body says.
        part, parts: of a shape, one of so many parts of all particles.

    Returns:
        Positions [m], shape (n, D), and volumes [m^3; in 2D m^2 times 1 m], shape (n,) (if
        all are equal a read-only view of one number).

    Raises:
        CaseError: the shape does not suit the dimension, or holds no particle; of one part of
            several that is for the others to tell.
    """
    if body.particles is not None:
        positions, volumes = body.particles.positions, body.particles.volumes
        if volumes is None:
            cube = body.particle_spacing(grid) ** grid.dimension
            volumes = np.broadcast_to(cube, (len(positions),))
        return positions, volumes
    wrong = body.shape.wrong_dimension(grid.dimension, ("shape",))
    if wrong is not None:
        from mpm3dpp.base.errors import key_text

        raise CaseError(wrong[1], wrong[2], key=key_text(wrong[0]))
    spacing, way = body.particle_spacing(grid), way or body.filled_by()
    if way == SHELLS:
        positions = fill_round(body.shape, spacing, part, parts)
        count = shell_total(body.shape, spacing)
        found = round_of(body.shape)
        each = found.volume() / count if found is not None and count else 0.0
        volumes = np.broadcast_to(each, (len(positions),))
    elif way == FACES:
        positions, volumes = fill_from_faces(body.shape, grid.origin, spacing, part, parts)
    else:
        positions = fill_shape(body.shape, grid.origin, spacing, part, parts)
        volumes = np.broadcast_to(spacing**grid.dimension, (len(positions),))
    if len(positions) == 0 and parts == 1:
        raise holds_none(body.shape, spacing)
    return positions, volumes


def holds_none(shape: Shape, spacing: float) -> CaseError:
    """Return the mistake that a shape holds no particle."""
    lower, upper = shape.bounds()
    edges = " x ".join(f"{edge:.4g}" for edge in upper - lower)
    rule = f"holds no particle: it measures {edges} m and particles are {spacing:.4g} m apart"
    remedy = "give a smaller grid.cell_size, more particles_per_cell, or a larger shape"
    return CaseError(rule, remedy, key="shape")


def reference_volume(shape: Shape) -> tuple[float, bool]:
    """Return the volume of a shape [m^3; 2D: m^2] and whether it is exact.

    Without a formula it is the share of a fine lattice over the bounds (two million points in 2D,
    four million in 3D) that lies inside; its relative error is then about 1e-4 in 2D and 1e-3 in
    3D for a compact shape.
    """
    exact, found = shape.volume(), round_of(shape)
    if exact is not None:
        return exact, True
    exact = found.volume() if found is not None else volume_of_boxes(shape)
    if exact is not None:
        return exact, True
    lower, upper = shape.bounds()
    edges = upper - lower
    if not np.all(edges > 0):
        return 0.0, True
    points = _QUADRATURE[len(edges)]
    counts = np.maximum(8, np.round(edges * (points / np.prod(edges)) ** (1 / len(edges))))
    spacing = edges / np.minimum(counts, points // 64)
    lattice = Lattice(shape, lattice_axes(shape, lower, spacing), spacing.min())
    inside = sum(int(mask.sum()) for _, mask in lattice.slabs())
    return inside * float(np.prod(spacing)), False
