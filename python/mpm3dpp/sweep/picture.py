# SPDX-License-Identifier: BSD-3-Clause
"""What came out of a sweep over the first key: a panel for each number."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mpm3dpp.plots.labels import short
from mpm3dpp.plots.style import PALETTE, new_figure, save, styled

from .numbers import unit_of
from .plan import Planned
from .runs import Outcome

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST = 6  # panels


def save_sweep(
    plan: Sequence[Planned], outcomes: Sequence[Outcome], names: Sequence[str], path: Path
) -> Path | None:
    """Draw some numbers over the first key, a curve for each value of the others; write a PNG.

    Values that are no numbers stand side by side. None if no run has come to its end.
    """
    key, *others = plan[0].values
    values = list(dict.fromkeys(planned.values[key] for planned in plan))
    scale = _scale(values)
    places, unit = scale or ([float(k) for k in range(len(values))], "")
    curves: dict[str, list[tuple[float, dict[str, float]]]] = {}
    for planned, outcome in zip(plan, outcomes, strict=True):
        if not outcome.numbers:
            continue
        label = ", ".join(f"{name} = {planned.values[name]}" for name in others)
        place = places[values.index(planned.values[key])]
        curves.setdefault(label, []).append((place, outcome.numbers))
    if not curves:
        return None
    with styled():
        figure, panels = panels_of(names, plan[0].case.grid.dimension)
        for name, axes in panels.items():
            for (label, points), colour in zip(curves.items(), cycle(PALETTE), strict=False):
                there = sorted((x, numbers[name]) for x, numbers in points if name in numbers)
                x, y = np.array(there).reshape(-1, 2).T
                axes.plot(x, y, "o-", color=colour, markersize=3.5, label=short(label, 36))
            axes.set_xlabel(f"{key} [{unit}]" if unit else key)
            if scale is None:
                axes.set_xticks(places, [short(value, 14) for value in values])
        if len(curves) > 1:
            next(iter(panels.values())).legend()
        return save(figure, path)


def panels_of(names: Sequence[str], dimension: int) -> tuple[Figure, dict[str, Axes]]:
    """Return a figure with a panel for each of the first numbers, their axes named."""
    shown = list(names)[:_MOST]
    columns = 1 if len(shown) == 1 else 2
    rows = -(-len(shown) // columns)
    figure = new_figure(4.5 * columns, 2.7 * rows + 0.3)
    grid = list(figure.subplots(rows, columns, squeeze=False).flat)
    for axes, name in zip(grid, shown, strict=False):
        axes.set_ylabel(f"{name} [{of}]" if (of := unit_of(name, dimension)) else name)
        axes.grid(True)
    for axes in grid[len(shown) :]:
        axes.set_visible(False)
    return figure, dict(zip(shown, grid, strict=False))


def _scale(values: Sequence[str]) -> tuple[list[float], str] | None:
    """Return the places of values, and their unit; None for what are no numbers of one unit."""
    parts = [value.strip("\"' ").partition(" ")[::2] for value in values]
    try:
        places = [float(number) for number, _ in parts]
    except ValueError:
        return None
    units = {unit.strip() for _, unit in parts}
    return (places, units.pop()) if len(units) == 1 else None
