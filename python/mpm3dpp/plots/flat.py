# SPDX-License-Identifier: BSD-3-Clause
"""Particles of a plane on matplotlib axes: true sizes, outlines that tell bodies apart."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .raster import FINER, tile

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_INK = "#1a1a1a"
_DISCS_FROM = 9.0  # pixels a particle must span to be drawn as a disc of its own
_GRAINS_FROM = 8.0  # Pixels across the median grain, from which grains get outlines.


def set_view(
    axes: Axes, lower: np.ndarray, upper: np.ndarray, unit: str, clean: bool = False
) -> None:
    """Equal axes over a rectangle, given in the unit of the picture."""
    axes.set_xlim(lower[0], upper[0])
    axes.set_ylim(lower[1], upper[1])
    axes.set_aspect("equal")
    axes.set_xlabel(f"x [{unit}]")
    axes.set_ylabel(f"y [{unit}]")
    if clean:
        axes.spines[["top", "right"]].set_visible(True)


def pixels_per_unit(axes: Axes) -> float:
    """Pixels per unit of length on axes with equal scales."""
    figure: Any = axes.figure
    if (engine := figure.get_layout_engine()) is not None:
        engine.execute(figure)
    axes.apply_aspect()
    left, right = axes.get_xlim()
    return float(axes.get_window_extent().width / (right - left))


def draw_particles(
    axes: Axes,
    points: np.ndarray,
    sizes: np.ndarray,
    bodies: np.ndarray,
    colours: np.ndarray,
    outline: bool = True,
    grains: np.ndarray | None = None,
) -> None:
    """Draw particles body by body, each with a thin dark outline around the whole body or grain.

    Small particles are drawn as squares of their volume, which tile the body without seams;
    large ones (a zoomed view) as discs, so that each can be seen. The view must be set before.

    Args:
        axes: with limits and equal aspect set.
        points: (n, 2), in the unit of the axes.
        sizes: edge of each particle's square (n,), same unit.
        bodies: number of each particle's body (n,).
        colours: (n, 3) or (n, 4), 0 to 1.
        outline: whether bodies get an outline.
        grains: number of each particle's grain in its body (n,), for outlines of their own where
            they are large enough in the picture.
    """
    left, right = sorted(axes.get_xlim())
    low, high = sorted(axes.get_ylim())
    x, y = points.T
    seen = (x > left - sizes) & (x < right + sizes) & (y > low - sizes) & (y < high + sizes)
    points, sizes, bodies, colours = points[seen], sizes[seen], bodies[seen], colours[seen]
    if len(points) == 0:
        return
    scale = pixels_per_unit(axes)
    if grains is not None:
        bodies = _parts(bodies, grains[seen], sizes * scale)
    figure: Any = axes.figure
    if float(np.median(sizes)) * scale > _DISCS_FROM:
        for body in np.unique(bodies):
            mine = bodies == body
            _discs(axes, points[mine], sizes[mine], colours[mine])
        return
    image = tile(
        (points - [left, low]) * scale,
        sizes * scale,
        bodies,
        colours,
        (round((high - low) * scale), round((right - left) * scale)),
        round(0.8 * FINER * figure.dpi / 100.0) if outline else 0,
        FINER,
    )
    axes.imshow(
        image, origin="lower", extent=(left, right, low, high), interpolation="hanning", zorder=2
    )


def _parts(bodies: np.ndarray, grains: np.ndarray, sizes: np.ndarray) -> np.ndarray:
    """Numbers that tell grains apart, or bodies alone where grains are but some pixels across."""
    parts: np.ndarray
    _, parts = np.unique(np.column_stack([bodies, grains]), axis=0, return_inverse=True)
    parts = parts.reshape(-1)
    across = np.sqrt(np.bincount(parts, weights=sizes**2))
    return parts if float(np.median(across)) >= _GRAINS_FROM else bodies


def _discs(axes: Axes, points: np.ndarray, sizes: np.ndarray, colours: np.ndarray) -> None:
    from matplotlib.collections import EllipseCollection

    axes.add_collection(
        EllipseCollection(
            sizes,
            sizes,
            np.zeros(len(sizes)),
            units="xy",
            offsets=points,
            offset_transform=axes.transData,
            facecolors=colours,
            edgecolors=_INK,
            linewidths=0.4,
        ),
        autolim=False,
    )


def draw_cells(
    axes: Axes, origin: np.ndarray, cell: float, lower: np.ndarray, upper: np.ndarray
) -> bool:
    """Thin lines of the grid's cells inside a rectangle; not when they would blur into grey.

    Returns whether the lines were drawn.
    """
    if cell * pixels_per_unit(axes) < 9.0:
        return False
    for axis, draw in ((0, axes.vlines), (1, axes.hlines)):
        first = np.ceil((lower[axis] - origin[axis]) / cell - 1e-9)
        last = np.floor((upper[axis] - origin[axis]) / cell + 1e-9)
        places = origin[axis] + cell * np.arange(first, last + 1)
        other = 1 - axis
        draw(places, lower[other], upper[other], colors="#cfcfcf", linewidths=0.4, zorder=0)
    return True
