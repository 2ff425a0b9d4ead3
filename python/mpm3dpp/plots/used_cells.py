# SPDX-License-Identifier: BSD-3-Clause
"""The share of a box's cells that are in use, over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mpm3dpp.plots.labels import prefix
from mpm3dpp.plots.style import PALETTE, new_figure, save, styled


def save_used_cells(time: np.ndarray, share: np.ndarray, path: Path) -> Path:
    """Draw the curve and write it as PNG.

    Args:
        time: [s], shape (rows,).
        share: of the box's cells, 0 to 1, shape (rows,).
        path: the picture.
    """
    factor, unit = prefix(float(time.max(initial=0.0)), "s")
    with styled():
        figure = new_figure(6.0, 3.4)
        axes = figure.add_subplot()
        axes.plot(factor * time, 100.0 * share, color=PALETTE[0])
        axes.set_xlabel(f"time [{unit}]")
        axes.set_ylabel("cells in use [%]")
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.0)
        axes.grid(True)
        return save(figure, path)
