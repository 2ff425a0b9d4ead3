# SPDX-License-Identifier: BSD-3-Clause
"""Numbers of a study over the size of the cells, with what they converge to: a panel for each."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from mpm3dpp.plots.style import PALETTE, save, styled

from .picture import panels_of
from .richardson import MOST, Converged
from .runs import Outcome


def save_study(
    sizes: Sequence[float],
    outcomes: Sequence[Outcome],
    told: dict[str, Converged],
    dimension: int,
    path: Path,
) -> Path:
    """Draw each number on each grid, and at cells of no size the extrapolated one; write a PNG.

    The bar is the uncertainty of the value on the finest grid.
    """
    h = 1e3 * np.array(sizes)
    with styled():
        figure, panels = panels_of(list(told), dimension)
        for name, axes in panels.items():
            found = told[name]
            y = [outcome.numbers[name] for outcome in outcomes]
            axes.plot(h, y, "o", color=PALETTE[0], markersize=4, label="runs")
            if found.uncertainty is not None:
                axes.errorbar(h[-1], y[-1], found.uncertainty, color=PALETTE[0], capsize=3)
            if found.extrapolated is not None and found.order is not None:
                fine = np.linspace(0.0, h[0], 100)
                along = (fine / h[-1]) ** min(found.order, MOST)
                curve = found.extrapolated + (y[-1] - found.extrapolated) * along
                label = f"order {found.order:.2f}"
                if found.order > MOST:
                    label = f"order {MOST:g} (found {found.order:.2f})"
                axes.plot(fine, curve, "-", color=PALETTE[1], linewidth=1, label=label)
                axes.plot(0.0, found.extrapolated, "x", color=PALETTE[1], label="extrapolated")
            axes.set_xlim(left=0.0)
            axes.set_xlabel("cells [mm]")
            axes.legend(title=found.said or None)
        return save(figure, path)
