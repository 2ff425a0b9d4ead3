# SPDX-License-Identifier: BSD-3-Clause
"""What the probes of a run saw over time: a panel for each field, a curve for each probe."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.io.probe_tables import FIRST_COLUMNS

from .labels import prefix, short
from .style import PALETTE, new_figure, save, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Tables = Mapping[str, Mapping[str, np.ndarray]]
Fields = dict[str, dict[str, list[np.ndarray]]]
"""Field -> component -> its curve and, of regions and bodies, the least and largest value."""

_SOLID, _DASHED, _DOTTED = "-", (0, (4, 2)), (0, (1, 1))
_STYLES: dict[str, Any] = {
    "": _SOLID,
    "x": _SOLID,
    "y": _DASHED,
    "z": _DOTTED,
    "xx": _SOLID,
    "yy": _DASHED,
    "zz": _DOTTED,
    "yz": (0, (6, 1)),
    "xz": (0, (4, 1, 1, 1)),
    "xy": (0, (4, 1, 1, 1, 1, 1)),
}
_FIRST = {0: "", 1: "x", 2: "xx"}
_WAY = "way from the start"
_MOST = 6  # fields shown
_MOST_NAMES = 16  # of a legend, which would hide what is drawn
_NAME = 18  # letters of a probe's name in the legend


def save_probes(tables: Tables, units: Mapping[str, str], path: Path) -> Path | None:
    """Draw the tables of probes and write the picture, a PNG; None if there is nothing to draw.

    Other arguments are those of `draw_probes`.
    """
    figure = draw_probes(tables, units)
    if figure is None:
        return None
    with styled():
        return save(figure, path)


def draw_probes(tables: Tables, units: Mapping[str, str]) -> Figure | None:
    """Draw the tables of probes; the caller saves them. None if there is nothing to draw.

    Each component that is not nil all the time has a curve, with its sign; of positions that is the
    way from the first. Of regions and bodies the range from the least to the largest is shaded.

    Args:
        tables: columns of each probe, by its name (`mpm3dpp.io.probe_tables.read_probe`).
        units: of the fields.
    """
    curves: dict[str, dict[str, tuple[np.ndarray, dict[str, list[np.ndarray]]]]] = {}
    for name, table in tables.items():
        for field, parts in _curves(table).items():
            curves.setdefault(field, {})[name] = (table["time"], parts)
    fields = list(curves)[:_MOST]
    colours = dict(zip(tables, cycle(PALETTE), strict=False))
    if not fields:
        return None
    with styled():
        columns = 1 if len(fields) == 1 else 2
        rows = -(-len(fields) // columns)
        figure = new_figure(5.0 * columns, 2.8 * rows)
        grid = figure.subplots(rows, columns, squeeze=False)
        last = max(float(table["time"].max(initial=0.0)) for table in tables.values())
        scale, time_unit = prefix(last, "s")
        for axes, field in zip(grid.flat, fields, strict=False):
            found = curves[field]
            every = [
                line for _, parts in found.values() for lines in parts.values() for line in lines
            ]
            most = max(float(np.nanmax(np.abs(line), initial=0.0)) for line in every)
            factor, unit = prefix(most, units.get(field, "m" if field == _WAY else ""))
            for name, (time, parts) in found.items():
                for end, lines in parts.items():
                    mean, *ends = [factor * line for line in lines]
                    style = {"color": colours[name], "ls": _STYLES[end]}
                    axes.plot(
                        scale * time, mean, label=f"{short(name, _NAME)} {end}".strip(), **style
                    )
                    if ends:
                        axes.fill_between(
                            scale * time, *ends, color=colours[name], alpha=0.15, lw=0
                        )
            if len(axes.lines) <= _MOST_NAMES:
                axes.legend()
            axes.set_ylabel(f"{field} [{unit}]" if unit else field)
            axes.grid(True)
            axes.margins(x=0.0)
        for axes in list(grid.flat)[len(fields) :]:
            axes.set_visible(False)
        for axes in list(grid.flat)[max(0, len(fields) - columns) : len(fields)]:
            axes.set_xlabel(f"time [{time_unit}]")
        figure.align_ylabels()
    return figure


def _curves(table: Mapping[str, np.ndarray]) -> Fields:
    """Return of each field its components, of which scalars have one without a name."""
    found: Fields = {}
    for name in table:
        base, _, end = name.rpartition("_")
        if name in FIRST_COLUMNS or (end in ("min", "max") and base in table):
            continue
        lines = [table[name]]
        if f"{name}_min" in table:
            lines += [table[f"{name}_min"], table[f"{name}_max"]]
        if end not in _STYLES or f"{base}_{_FIRST[len(end)]}" not in table:
            base, end = name, ""
        if base == "position":
            base, lines = _WAY, [line - table[name][:1] for line in lines]
        found.setdefault(base, {})[end] = lines
    for field, parts in found.items():  # Those that are nil all the time would hide others.
        moving = {end: lines for end, lines in parts.items() if np.nan_to_num(lines[0]).any()}
        found[field] = moving or dict(list(parts.items())[:1])
    return found
