# SPDX-License-Identifier: BSD-3-Clause
"""Filling a shape with particles by a lattice: the points of its planes that lie inside."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import MOST_PARTICLES
from mpm3dpp.base.parts import equal_part

from .base import SURFACE_TOLERANCE, Points, Shape

_CHUNK = 1 << 18  # Points looked at together: some 20 MB of temporary arrays.
LENGTHS_REMEDY = (
    "write lengths with their unit (a plain number is in metres), or give a larger grid.cell_size"
)
# Lattice points in the bounds of one shape: four times as many, for shapes that fill their bounds
# badly.
_MOST = 4 * MOST_PARTICLES


class Lattice:
    """The points of a lattice about a shape: all that places along the axes make.

    Of several processes each looks at a part of them.
    """

    def __init__(self, shape: Shape, axes: list[Points], least: float) -> None:
        self.axes = axes
        reach = max(float(np.abs(axis).max(initial=0.0)) for axis in axes)
        self.tolerance = max(SURFACE_TOLERANCE * least, 8 * np.finfo(float).eps * reach)
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


def too_many(shape: Shape, points: float) -> CaseError:
    lower, upper = shape.bounds()
    size = " x ".join(f"{x:.3g} m" for x in upper - lower)
    rule = f"is {size} in size and would need some {points:.0e} particles"
    return CaseError(rule, LENGTHS_REMEDY, key="shape")


def lattice_axes(shape: Shape, origin: Points, spacing: Points, parts: int = 1) -> list[Points]:
    """Return the places origin + (k + 1/2) spacing along each axis within the bounds of a shape.

    Raises:
        CaseError: they would not fit into the memory of this machine, a part of so many of them.
    """
    lower, upper = shape.bounds()
    first = np.floor((lower - origin) / spacing - 0.5)
    count = np.ceil((upper - origin) / spacing - 0.5) - first + 1
    points = float(np.prod(np.maximum(count, 0.0)))
    if not points / parts < _MOST:
        raise too_many(shape, points)
    return [
        origin[d] + (first[d] + np.arange(int(count[d])) + 0.5) * spacing[d]
        for d in range(len(lower))
    ]


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
    axes = lattice_axes(shape, start, np.full(len(start), float(spacing)), parts)
    return points_inside(Lattice(shape, axes, spacing), part, parts)


def points_inside(lattice: Lattice, part: int = 0, parts: int = 1) -> Points:
    """Return a part of the points of a lattice inside its shape, in lexicographic order [m]."""
    kept = [(slab, np.packbits(mask), len(mask)) for slab, mask in lattice.slabs(part, parts)]
    counts = [int(np.unpackbits(bits, count=size).sum()) for _, bits, size in kept]
    positions = np.empty((sum(counts), len(lattice.axes)))
    at = 0
    for (slab, bits, size), count in zip(kept, counts, strict=True):
        chosen = np.flatnonzero(np.unpackbits(bits, count=size))
        indices = np.unravel_index(chosen, tuple(len(axis) for axis in slab))
        for d, axis in enumerate(slab):
            positions[at : at + count, d] = axis[indices[d]]
        at += count
    return positions
