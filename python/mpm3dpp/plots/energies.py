# SPDX-License-Identifier: BSD-3-Clause
"""Energies, ledger, momentum and contact force of a run over time, in one picture or each alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mpm3dpp.io.history import ENERGIES, ERROR_PARTS, TERMS
from mpm3dpp.io.pair_columns import FORCE, pairs_of

from .labels import prefix, short
from .style import PALETTE, new_figure, save, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MAIN = ("kinetic", "internal")
_OTHERS = [n for n in ENERGIES if n not in (*_MAIN, "numerical", "residual")]
_MOST_PAIRS = 8
_NAME = 15  # Letters of a body's name in the legend of pairs.


def draw_energies(
    history: dict[str, np.ndarray], dimension: int = 3, bodies: list[str] | None = None
) -> Figure:
    """Draw the curves; the caller saves them.

    Args:
        history: of `read_history`.
        dimension: 2 (per metre of thickness) or 3.
        bodies: their names, which tell where in the name of a column one ends and the next begins.
    """
    run = _Run(history, dimension, _forces(history, bodies or []))
    with styled():
        figure = new_figure(10.0, 5.6)
        grid = figure.subplots(2, 2, sharex=True)
        names = ("energies", "ledger", "momentum", "contact" if run.forces else "steps")
        for axes, name in zip(grid.flat, names, strict=True):
            _PANELS[name](axes, run)
            axes.grid(True)
            axes.margins(x=0.0)
        for axes in grid[1]:
            axes.set_xlabel(f"time [{run.unit}]")
        figure.align_ylabels()
    return figure


def draw_panel(
    name: str,
    history: dict[str, np.ndarray],
    dimension: int = 3,
    bodies: list[str] | None = None,
) -> Figure | None:
    """Draw one of "energies", "ledger", "residual", "momentum", "contact" and "steps" alone.

    Arguments are those of `draw_energies`. None where bodies have not touched, for "contact".
    """
    run = _Run(history, dimension, _forces(history, bodies or []))
    if name == "contact" and not run.forces:
        return None
    with styled():
        figure = new_figure(7.2, 3.0)
        axes = figure.add_subplot()
        _PANELS[name](axes, run)
        axes.grid(True)
        axes.margins(x=0.0)
        axes.set_xlabel(f"time [{run.unit}]")
    return figure


def save_energies(
    history: dict[str, np.ndarray],
    path: Path,
    dimension: int = 3,
    bodies: list[str] | None = None,
) -> Path:
    """Draw the curves and write them as PNG; arguments of `draw_energies`."""
    figure = draw_energies(history, dimension, bodies)
    with styled():
        return save(figure, path)


@dataclass
class _Run:
    """What is drawn: the history of a run, and the contact force of each pair.

    How bodies came to rest before the time 0 is left out, unless nothing has followed.
    """

    history: dict[str, np.ndarray]
    dimension: int
    forces: dict[str, np.ndarray]
    colours: dict[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        begun = self.history["time"] >= 0.0
        if begun.any() and not begun.all():
            self.history = {name: rows[begun] for name, rows in self.history.items()}
            self.forces = {name: rows[begun] for name, rows in self.forces.items()}
        factor, self.unit = prefix(float(np.nanmax(self.history["time"], initial=0.0)), "s")
        self.time = self.history["time"] * factor
        self.per = "/m" if self.dimension == 2 else ""

    def colour_of(self, name: str) -> str:
        """Return the colour of a term of the ledger, the same in all panels."""
        return self.colours.setdefault(name, PALETTE[len(self.colours) % len(PALETTE)])


def _energies(axes: Axes, run: _Run) -> None:
    time, history, unit = run.time, run.history, f"J{run.per}"
    scale = _scale(history)
    curves = {name: history[name] for name in _MAIN}
    for name in _OTHERS:
        if np.abs(history[name]).max(initial=0.0) > 1e-4 * scale:
            curves[name] = history[name]
    factor, unit = prefix(max(np.abs(c).max(initial=0.0) for c in curves.values()), unit)
    for label, curve in curves.items():
        axes.plot(time, factor * curve, color=run.colour_of(label), label=label)
    total = factor * _total(history)
    axes.plot(time, total, color="black", lw=1.0, ls=(0, (4, 2)), label="total")
    axes.set_ylabel(f"energy [{unit}]")
    axes.set_title("Energies", loc="left")
    _key(axes)


def _total(history: dict[str, np.ndarray]) -> np.ndarray:
    """All energy, less the work from outside: constant but for what numerics made or lost."""
    held, supplied = (
        np.sum([history[n] for n, term in TERMS.items() if term["role"] == role], axis=0)
        for role in ("energy", "supply")
    )
    return held - supplied


def _ledger(axes: Axes, run: _Run) -> None:
    """Size of every term that is not kinetic or internal, as a share of the largest energy."""
    time, history = run.time, run.history
    scale = _scale(history)
    least = 1e-18
    parts = [name for name in ERROR_PARTS if name in history]  # Older tables have fewer.
    for name in (*_OTHERS, "numerical", *parts):
        curve = np.abs(history[name]) / scale
        if curve.max(initial=0.0) > least:
            style = (0, (1, 1)) if name in ERROR_PARTS else "-"
            label = name.replace("_", ", ")
            axes.plot(time, _positive(curve), color=run.colour_of(name), ls=style, label=label)
    residual = np.abs(history["residual"]) / scale
    if residual.max(initial=0.0) > least:
        axes.plot(time, _positive(residual), color="black", lw=0.7, label="residual")
    if axes.lines:
        axes.set_yscale("log")
        low, high = axes.get_ylim()
        axes.set_ylim(max(low, 1e-18), min(high, 10.0))
        _key(axes)
    else:
        axes.text(0.5, 0.5, "all terms are zero", transform=axes.transAxes, ha="center")
    axes.set_ylabel("share of the largest energy")
    axes.set_title("Ledger: where energy went", loc="left")


def _residual(axes: Axes, run: _Run) -> None:
    curve = run.history["residual"]
    factor, unit = _small(np.abs(curve).max(initial=0.0), f"J{run.per}")
    axes.plot(run.time, factor * curve, color="black", lw=0.8)
    axes.set_ylabel(f"residual [{unit}]")
    axes.set_title("Residual of the ledger", loc="left")


def _small(largest: float, unit: str) -> tuple[float, str]:
    """Return `prefix`; of rounding there is none, the axis shows the power of ten."""
    factor, prefixed = prefix(largest, unit)
    return (1.0, unit) if factor >= 1e12 else (factor, prefixed)


def _momentum(axes: Axes, run: _Run) -> None:
    parts = {x: run.history[f"momentum_{x}"] for x in "xyz"[: run.dimension]}
    changes = {x: part - part[0] if len(part) else part for x, part in parts.items()}
    largest = max(np.abs(c).max(initial=0.0) for c in changes.values())
    factor, unit = _small(largest, f"N s{run.per}")
    for colour, (x, change) in zip(PALETTE, changes.items(), strict=False):
        axes.plot(run.time, factor * change, color=colour, lw=0.8, label=x)
    axes.set_ylabel(f"change of momentum [{unit}]")
    axes.set_title("Total momentum", loc="left")
    _key(axes)


def _contact(axes: Axes, run: _Run) -> None:
    time, forces, unit = run.time, run.forces, f"N{run.per}"
    factor, unit = prefix(max(float(np.nanmax(f)) for f in forces.values()), unit)
    order = sorted(forces, key=lambda name: -np.nansum(forces[name]))
    for colour, name in zip(PALETTE, order[:_MOST_PAIRS], strict=False):
        known = np.isfinite(forces[name])
        axes.plot(time[known], factor * forces[name][known], color=colour, lw=1.0, label=name)
    axes.set_ylabel(f"force [{unit}]")
    axes.set_title("Contact force of each pair", loc="left")
    if len(order) > _MOST_PAIRS:
        axes.set_title(f"largest {_MOST_PAIRS} of {len(order)}", loc="right", fontsize=8)
    _key(axes)


def _steps(axes: Axes, run: _Run) -> None:
    dt = run.history["dt"]
    factor, unit = prefix(float(dt.max(initial=0.0)), "s")
    axes.plot(run.time, factor * dt, color=PALETTE[0])
    axes.set_ylabel(f"step [{unit}]")
    axes.set_ylim(bottom=0.0)
    axes.set_title("Time step", loc="left")


_PANELS: dict[str, Callable[[Axes, _Run], None]] = {
    "energies": _energies,
    "ledger": _ledger,
    "residual": _residual,
    "momentum": _momentum,
    "contact": _contact,
    "steps": _steps,
}


def _key(axes: Axes) -> None:
    axes.legend(loc="upper left", bbox_to_anchor=(1.0, 1.02), handlelength=1.4, labelspacing=0.4)


def _scale(history: dict[str, np.ndarray]) -> float:
    largest = float(np.abs(history["kinetic"] + history["internal"]).max(initial=0.0))
    return largest or 1.0


def _positive(curve: np.ndarray) -> np.ndarray:
    """Zeros as gaps, because a logarithmic axis has no place for them."""
    return np.where(curve > 0.0, curve, np.nan)


def _forces(history: dict[str, np.ndarray], bodies: list[str]) -> dict[str, np.ndarray]:
    """Size of the contact force of each pair that ever touched, "a \N{EN DASH} b" -> (rows,)."""
    forces = {}
    known = {column: (a, b) for a, b, column in pairs_of(history, bodies)}
    for name in history:
        if name.startswith(FORCE) and name.endswith("_x"):
            column = name[: -len("_x")]
            parts = [history[f"{column}_{x}"] for x in "xyz"]
            size = np.sqrt(sum(part**2 for part in parts))
            if np.nansum(size) > 0.0:
                names = known.get(column, (column[len(FORCE) :],))
                label = " \N{EN DASH} ".join(short(each, _NAME) for each in names)
                if label in forces:  # Cut to the same: their whole names.
                    label = " \N{EN DASH} ".join(names)
                forces[label] = size
    return forces
