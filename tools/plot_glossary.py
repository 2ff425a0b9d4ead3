# SPDX-License-Identifier: BSD-3-Clause
"""Draw what a tile, a patch and a block are, into docs/images/tile_patch_block.png.

python tools/plot_glossary.py    (matplotlib must be installed)
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.patches import Rectangle

IMAGE = Path(__file__).resolve().parents[1] / "docs" / "images" / "tile_patch_block.png"
TILE = 8  # cells along an edge of a tile in 2D
TILES = (3, 2)
BODIES = (((9.2, 8.6), 5.7, "tab:blue"), ((19.0, 7.2), 3.6, "tab:orange"))  # centre, radius
SHOWN = (1, 0)  # the tile whose patch of the first body is shown


def disc(centre: tuple[float, float], radius: float) -> np.ndarray:
    """Particles of a disc, two along each edge of a cell; shape (n, 2) [cells]."""
    edge = 0.25 + 0.5 * np.arange(2 * TILE * max(TILES))
    x, y = np.meshgrid(edge, edge)
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    return points[np.linalg.norm(points - centre, axis=1) < radius]


def main() -> None:
    """Draw it."""
    figure, axes = plt.subplots(figsize=(7.6, 4.2), layout="constrained")
    width, height = TILES[0] * TILE, TILES[1] * TILE
    for k in range(width + 1):
        axes.axvline(k, color="0.35" if k % TILE == 0 else "0.88", lw=1.4 if k % TILE == 0 else 0.6)
    for k in range(height + 1):
        axes.axhline(k, color="0.35" if k % TILE == 0 else "0.88", lw=1.4 if k % TILE == 0 else 0.6)
    low = TILE * np.array(SHOWN)
    for number, (centre, radius, colour) in enumerate(BODIES):
        points = disc(centre, radius)
        here = np.all((points >= low) & (points < low + TILE), axis=1) & (number == 0)
        axes.plot(*points[~here].T, ".", ms=3.0, color=colour, alpha=0.45)
        axes.plot(*points[here].T, ".", ms=5.0, color=colour)
        if number == 0:
            cells = np.unique(np.floor(points[here]), axis=0)
    for cell in cells:
        axes.add_patch(Rectangle(cell, 1, 1, color="tab:blue", alpha=0.12, lw=0))
    first, end = cells.min(axis=0), cells.max(axis=0) + 2
    nodes = np.stack(np.meshgrid(*map(np.arange, first, end)), axis=-1).reshape(-1, 2)
    axes.plot(*nodes.T, "s", ms=5.0, mfc="none", mec="tab:red", mew=1.1)
    axes.add_patch(Rectangle(low, TILE, TILE, fill=False, ec="black", lw=2.6))
    arrow = {"arrowstyle": "->", "color": "black"}
    about = {"ha": "left", "va": "center", "arrowprops": arrow, "annotation_clip": False}
    side = width + 0.8
    axes.annotate("tile: 8 x 8 cells", (low[0] + TILE, 1.0), (side, 1.2), **about)
    axes.annotate(
        "block: the nodes that the\npatch's cells reach", (15.15, 3.1), (side, 4.6), **about
    )
    axes.annotate("patch: one body's\nparticles in the tile", (14.4, 6.75), (side, 8.2), **about)
    axes.annotate("another body", (20.5, 9.4), (side, 11.4), **about)
    axes.annotate(
        "other tiles of the body\nhave patches of their own", (8.2, 12.8), (side, 14.2), **about
    )
    axes.set(xlim=(-0.3, width + 0.3), ylim=(-0.3, height + 0.3), aspect="equal")
    axes.set_axis_off()
    figure.savefig(IMAGE, dpi=140)
    print(IMAGE)


if __name__ == "__main__":
    main()
