# SPDX-License-Identifier: BSD-3-Clause
"""The share of a box's cells that are in use, over time."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .labels import prefix
from .style import PALETTE, new_figure, save, styled


def save_used_cells(curves: dict[str, tuple[np.ndarray, np.ndarray]], path: Path) -> Path:
    """Draw curves and write them as PNG.

    Args:
        curves: by label, times [s] and shares of the box's cells (0 to 1), both (rows,).
        path: the picture.
    """
    factor, unit = prefix(max(float(time.max()) for time, _ in curves.values()), "s")
    with styled():
        figure = new_figure(6.0, 3.4)
        axes = figure.add_subplot()
        for colour, (label, (time, share)) in zip(PALETTE, curves.items(), strict=False):
            marker = "o" if len(time) < 60 else None
            axes.plot(factor * time, 100 * share, color=colour, label=label, marker=marker, ms=3)
        axes.set_xlabel(f"time [{unit}]")
        axes.set_ylabel("share of the box's cells [%]")
        axes.set_ylim(bottom=0.0)
        axes.margins(x=0.0)
        axes.grid(True)
        axes.legend(loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=2)
        return save(figure, path)
