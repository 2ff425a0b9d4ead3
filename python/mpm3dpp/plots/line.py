# SPDX-License-Identifier: BSD-3-Clause
"""Bodies about one cell high and wide: a value over the one coordinate that matters."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .labels import choose, length_unit, prefix
from .style import MOST_NAMES, PALETTE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_THIN = 1.5  # cells: no higher and no wider than this is a line ...
_LONG = 8.0  # ... if it is so many times longer


def line_axis(lower: np.ndarray, upper: np.ndarray, cell_size: float, dimension: int) -> int | None:
    """Return the axis along which the bodies make a line, None if they are more than a line.

    Args:
        lower, upper: corners of the region that holds all particles [m], shape (3,).
        cell_size: [m].
        dimension: 2 or 3.
    """
    extent = (upper - lower)[:dimension]
    along = int(np.argmax(extent))
    across = float(np.delete(extent, along).max())
    thin = across <= _THIN * cell_size and extent[along] >= _LONG * across
    return along if thin else None


def draw_line(
    results: Any, arrays: dict[str, np.ndarray], colour: str, view: Any, figure: Figure
) -> Figure:
    """Draw each particle as a point at its place and value, in the colour of its body.

    Args:
        results: of `open_results`.
        arrays: of a frame.
        colour: the array that is drawn, see `labels.choose`.
        view: region and range of values; `view.along` is the axis.
        figure: empty.
    """
    along = view.along
    axes = figure.add_subplot()
    values, name, unit = choose(arrays, results.units, colour)
    low, high = (view.low, view.high) if np.isfinite(view.high - view.low) else (0.0, 1.0)
    stretch, length = length_unit(float(view.upper[along] - view.lower[along]))
    factor, unit = prefix(max(abs(low), abs(high)), unit)
    for body in np.unique(arrays["body"]):
        mine = arrays["body"] == body
        axes.plot(
            stretch * arrays["position"][mine, along].astype(float),
            factor * values[mine].astype(float),
            linestyle="none",
            marker="o",
            markeredgewidth=0.0,
            markersize=float(np.clip(700.0 / max(1, len(values)), 1.6, 5.0)),
            color=PALETTE[int(body) % len(PALETTE)],
            label=results.bodies[int(body)],
        )
    slack = 0.04 * (high - low) or 0.04 * abs(high) or 1.0
    axes.set_xlim(stretch * view.lower[along], stretch * view.upper[along])
    axes.set_ylim(factor * (low - slack), factor * (high + slack))
    axes.set_xlabel(f"{'xyz'[along]} [{length}]")
    axes.set_ylabel(f"{name} [{unit}]" if unit else name)
    axes.grid(True)
    if 1 < len(results.bodies) <= MOST_NAMES:
        axes.legend(
            loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=6, markerscale=2.0, handlelength=1.0
        )
    return figure
