# SPDX-License-Identifier: BSD-3-Clause
"""The faces of a case's box that do something: planes of symmetry, other walls."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .space import Camera

# By the word of a wall: colour, line, hatch, and what the legend says.
_STYLES: dict[str, tuple[str, Any, str, str]] = {
    "slip": ("#A0307A", (0, (9, 2, 2, 2)), "", "slip wall (symmetry)"),
    "fixed": ("#1a1a1a", "-", "////", "fixed wall"),
    "contact": ("#7A4B1E", "-", "\\\\\\\\", "contact wall"),
    "absorbing": ("#009E73", (0, (1.5, 1.5)), "....", "absorbing wall"),
}
_THICK = 0.02  # Share of the box's longer side that a hatched wall is thick.


def draw_walls(axes: Axes, walls: tuple[str, ...], corners: np.ndarray) -> list[Any]:
    """Draw the walls of a 2D box; return what a legend shows for each kind.

    Args:
        axes: with limits set.
        walls: words for the faces x- x+ y- y+ z- z+.
        corners: lower and upper of the box, in the unit of the axes, shape (2, 2).
    """
    from matplotlib.patches import Rectangle

    lower, upper = corners
    thick = _THICK * float((upper - lower).max())
    for face, word in enumerate(walls[:4]):
        if word not in _STYLES:
            continue
        colour, dashes, hatch, _ = _STYLES[word]
        axis, side = divmod(face, 2)
        ends = np.array([lower, upper])
        ends[:, axis] = corners[side, axis]
        axes.plot(*ends.T, color=colour, ls=dashes, lw=1.8, zorder=5, clip_on=False)
        if hatch:
            corner, size = ends[0].copy(), ends[1] - ends[0]
            corner[axis] -= 0.0 if side else thick
            size[axis] = thick
            strip = Rectangle(tuple(corner), *size, fill=False, lw=0.0, hatch=hatch, ec=colour)
            axes.add_patch(strip)
    return _legend(walls[:4])


def draw_walls_in_view(
    axes: Axes, walls: tuple[str, ...], box: np.ndarray, lower: np.ndarray, upper: np.ndarray
) -> None:
    """Draw those of the walls of a 2D box that cross a region, as far as they lie in it.

    Args:
        axes: with limits set.
        walls: as for `draw_walls`.
        box: lower and upper of the box, in the unit of the axes, shape (2, 2).
        lower, upper: of the region, likewise.
    """
    seen = [
        word if lower[face // 2] <= box[face % 2, face // 2] <= upper[face // 2] else "free"
        for face, word in enumerate(walls[:4])
    ]
    draw_walls(axes, tuple(seen), np.clip(box, lower, upper))


def draw_walls_in_space(
    axes: Axes,
    camera: Camera,
    walls: tuple[str, ...],
    lower: np.ndarray,
    upper: np.ndarray,
    factor: float,
) -> list[Any]:
    """Draw the walls of a 3D box on axes of `space.draw_box_axes`; see `draw_walls`.

    Those behind the bodies are tinted; of those before them the edges are seen alone.
    """
    for face, word in enumerate(walls):
        if word not in _STYLES:
            continue
        colour, dashes, hatch, _ = _STYLES[word]
        axis, side = divmod(face, 2)
        square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]])
        places = np.insert(square, axis, side, axis=1)
        corners = factor * (lower + places * (upper - lower) - camera.centre)
        flat = np.column_stack([corners @ camera.right, corners @ camera.up])
        behind = camera.towards[axis] * (2 * side - 1) <= 0.0
        if behind:
            axes.fill(*flat.T, fc=colour, alpha=0.14, lw=0.0, zorder=0.5, hatch=hatch, ec="none")
        outline = np.vstack([flat, flat[:1]])
        axes.plot(*outline.T, color=colour, ls=dashes, lw=1.2, zorder=1 if behind else 3)
    return _legend(walls)


def _legend(walls: tuple[str, ...]) -> list[Any]:
    """Return a line for each kind of wall that is there."""
    from matplotlib.lines import Line2D

    found = []
    for word, (colour, dashes, _, label) in _STYLES.items():
        if word in walls:
            found.append(Line2D([], [], color=colour, ls=dashes, lw=1.8, label=label))
    return found
