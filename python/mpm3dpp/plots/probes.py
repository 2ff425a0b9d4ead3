# SPDX-License-Identifier: BSD-3-Clause
"""What the probes of a run saw over time: a panel for each field, a curve for each probe."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mpm3dpp.io.probe_tables import FIRST_COLUMNS

from .labels import prefix, short
from .style import PALETTE, new_figure, save, styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Tables = Mapping[str, Mapping[str, np.ndarray]]
_VECTOR = ("x", "y", "z")
_WAY = "way from the start"
_MOST = 6  # fields shown
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

    Of vectors the size is drawn, of positions the distance from the first; of regions and bodies
    the range from the least to the largest is shaded. Tensors are left to who reads the tables.

    Args:
        tables: columns of each probe, by its name (`mpm3dpp.io.probe_tables.read_probe`).
        units: of the fields.
    """
    curves: dict[str, dict[str, list[np.ndarray]]] = {}
    for name, table in tables.items():
        for field, lines in _curves(table).items():
            curves.setdefault(field, {})[name] = [table["time"], *lines]
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
            most = max(np.nanmax(np.abs(lines), initial=0.0) for _, *lines in found.values())
            factor, unit = prefix(
                float(most), units.get(field.strip("|"), "m" if field == _WAY else "")
            )
            for name, (time, *lines) in found.items():
                mean, *ends = [factor * line for line in lines]
                axes.plot(scale * time, mean, color=colours[name], label=short(name, _NAME))
                if ends:
                    axes.fill_between(scale * time, *ends, color=colours[name], alpha=0.15, lw=0)
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


def _curves(table: Mapping[str, np.ndarray]) -> dict[str, list[np.ndarray]]:
    """Return of each scalar the mean and, if there are, the ends; of each vector its size."""
    names = [name for name in table if name not in FIRST_COLUMNS]
    found: dict[str, list[np.ndarray]] = {}
    for name in names:
        base, _, end = name.rpartition("_")
        if end in ("min", "max") and base in table:
            continue
        if end == "x" and all(f"{base}_{axis}" in table for axis in ("x", "y")):
            parts = [table[f"{base}_{axis}"] for axis in _VECTOR if f"{base}_{axis}" in table]
            if base == "position":
                parts = [part - part[:1] for part in parts]
            size = np.sqrt(np.sum(np.square(parts), axis=0))
            found[_WAY if base == "position" else f"|{base}|"] = [size]
        elif not (end in _VECTOR and f"{base}_x" in table) and f"{base}_xx" not in table:
            ends = [table[f"{name}_{which}"] for which in ("min", "max") if f"{name}_min" in table]
            found[name] = [table[name], *ends]
    return found
