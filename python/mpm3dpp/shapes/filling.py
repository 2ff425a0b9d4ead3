# SPDX-License-Identifier: BSD-3-Clause
"""Filling a shape with particles, on a lattice or in shells; its volume without a formula."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import MOST_PARTICLES
from mpm3dpp.base.parts import equal_part

from .base import SURFACE_TOLERANCE, Points, Shape
from .shells import SHELLS, shell_count, shell_points, shell_total

_CHUNK = 1 << 18  # Points looked at together: some 20 MB of temporary arrays.
LENGTHS_REMEDY = (
    "write lengths with their unit (a plain number is in metres), or give a larger grid.cell_size"
)
# Lattice points in the bounds of one shape: four times as many, for shapes that fill their bounds
# badly.
_MOST = 4 * MOST_PARTICLES
_QUADRATURE = {2: 1 << 21, 3: 1 << 22}  # Lattice points for a volume without a formula.


class _Lattice:
    """The lattice points origin + (k + 1/2) spacing within the bounds of a shape.

    Of several processes each looks at a part of them.
    """

    def __init__(self, shape: Shape, origin: Points, spacing: Points, parts: int = 1) -> None:
        lower, upper = shape.bounds()
        first = np.floor((lower - origin) / spacing - 0.5)
        count = np.ceil((upper - origin) / spacing - 0.5) - first + 1
        points = float(np.prod(np.maximum(count, 0.0)))
        if not points / parts < _MOST:
            raise _too_many(shape, points)
        self.axes = [
            origin[d] + (first[d] + np.arange(int(count[d])) + 0.5) * spacing[d]
            for d in range(len(lower))
        ]
        reach = max(float(np.abs(axis).max(initial=0.0)) for axis in self.axes)
        self.tolerance = max(SURFACE_TOLERANCE * spacing.min(), 8 * np.finfo(float).eps * reach)
        self.shape = shape

    def slabs(
        self, part: int = 0, parts: int = 1
    ) -> Iterator[tuple[list[Points], NDArray[np.bool_]]]:
        """Yield (axes of a slab, which of its points are strictly inside), about _CHUNK each.

        Args:
            part, parts: of the lines along the last axis one of so many equal parts.
        """
        for axes in self._blocks(part, parts):
            layer = max(1, int(np.prod([len(axis) for axis in axes[1:]])))
            step = max(1, _CHUNK // layer)
            for start in range(0, len(axes[0]), step):
                first = axes[0][start : start + step]
                if layer > 4 * _CHUNK:  # a layer alone is too large: cut it too
                    wide = max(1, _CHUNK // max(1, layer // len(axes[1])))
                    cuts = [axes[1][i : i + wide] for i in range(0, len(axes[1]), wide)]
                else:
                    cuts = [axes[1]]
                for cut in cuts:
                    slab = [first, cut, *axes[2:]]
                    mesh = np.meshgrid(*slab, indexing="ij", copy=False)
                    points = np.stack([x.ravel() for x in mesh], axis=1)
                    yield slab, self.shape.inside(points, -self.tolerance)

    def _blocks(self, part: int, parts: int) -> Iterator[list[Points]]:
        """Yield the axes of blocks, in order: those of a part of the lines along the last axis."""
        x, *others = self.axes
        width = len(others[0]) if len(others) == 2 else 1  # lines in a layer
        first, end = equal_part(len(x) * width, part, parts)
        if len(others) == 1:
            yield [x[first:end], *others]
            return
        y, z = others
        (a, i), (b, j) = divmod(first, max(width, 1)), divmod(end, max(width, 1))
        if a == b:  # within a layer
            yield [x[a : a + 1], y[i:j], z]
            return
        if i:
            yield [x[a : a + 1], y[i:], z]
            a += 1
        yield [x[a:b], y, z]
        if j:
            yield [x[b : b + 1], y[:j], z]


def _too_many(shape: Shape, points: float) -> CaseError:
    lower, upper = shape.bounds()
    size = " x ".join(f"{x:.3g} m" for x in upper - lower)
    rule = f"is {size} in size and would need some {points:.0e} particles"
    return CaseError(rule, LENGTHS_REMEDY, key="shape")


def fill_shape(shape: Shape, origin: Any, spacing: float, part: int = 0, parts: int = 1) -> Points:
    """Return the lattice points inside a shape, in lexicographic order.

    A point on the surface (to 1e-9 of the spacing) is outside: mirror images fill alike and
    bodies that touch share no point. The masks are kept as bits, so that the memory needed beyond
    the result stays small.

    Args:
        shape: what to fill.
        origin: a corner of the grid [m], D numbers; the points are at origin + (k + 1/2) spacing.
        spacing: distance of the points [m].
        part, parts: one of so many parts of all points, which follow one another.

    Returns:
        Positions [m], shape (n, D).

    Raises:
        CaseError: the particles would not fit into the memory of this machine.
    """
    start = np.asarray(origin, dtype=np.float64)
    lattice = _Lattice(shape, start, np.full(len(start), float(spacing)), parts)
    kept = [(slab, np.packbits(mask), len(mask)) for slab, mask in lattice.slabs(part, parts)]
    counts = [int(np.unpackbits(bits, count=size).sum()) for _, bits, size in kept]
    positions = np.empty((sum(counts), len(start)))
    at = 0
    for (slab, bits, size), count in zip(kept, counts, strict=True):
        chosen = np.flatnonzero(np.unpackbits(bits, count=size))
        indices = np.unravel_index(chosen, tuple(len(axis) for axis in slab))
        for d, axis in enumerate(slab):
            positions[at : at + count, d] = axis[indices[d]]
        at += count
    return positions


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
        raise _too_many(shape, points)
    return shell_points(shape, spacing, part, parts)


def fill(
    body: Any, grid: Any, way: str = "", part: int = 0, parts: int = 1
) -> tuple[Points, Points]:
    """Return the particles of a body.

    Args:
        body: a `case.Body`: its shape or particles, and `particles_per_cell` or `spacing`.
        grid: a `case.Grid`: its dimension, origin and cell size.
        way: "shells" or "lattice"; by default what the body says.
        part, parts: of a shape, one of so many parts of all particles.

    Returns:
        Positions [m], shape (n, D), and volumes [m^3; in 2D m^2 times 1 m], shape (n,) (of a
        shape all equal: a read-only view of one number).

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
    spacing = body.particle_spacing(grid)
    if (way or body.filled_by()) == SHELLS:
        positions = fill_round(body.shape, spacing, part, parts)
        count = shell_total(body.shape, spacing)
        each = body.shape.volume() / count if count else 0.0
    else:
        positions = fill_shape(body.shape, grid.origin, spacing, part, parts)
        each = spacing**grid.dimension
    if len(positions) == 0 and parts == 1:
        raise holds_none(body.shape, spacing)
    return positions, np.broadcast_to(each, (len(positions),))


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
    exact = shape.volume()
    if exact is not None:
        return exact, True
    lower, upper = shape.bounds()
    edges = upper - lower
    if not np.all(edges > 0):
        return 0.0, True
    points = _QUADRATURE[len(edges)]
    counts = np.maximum(8, np.round(edges * (points / np.prod(edges)) ** (1 / len(edges))))
    spacing = edges / np.minimum(counts, points // 64)
    inside = sum(int(mask.sum()) for _, mask in _Lattice(shape, lower, spacing).slabs())
    return inside * float(np.prod(spacing)), False
