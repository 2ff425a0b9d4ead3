# SPDX-License-Identifier: BSD-3-Clause
"""Arrows that show the velocities of particles, one for those of a body in a place."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_ACROSS = 20  # Places along the longer side of a picture.
_LENGTH = 1.25  # Places that the arrow of the fastest is long.
_LEAST = 0.12  # Of the fastest: slower ones have no arrow, which would be a dot.
_SHARE = 99.0  # Of the particles [%]: these are no faster than what counts as the fastest.


def fastest_of(velocities: np.ndarray) -> float:
    """Return the speed that has the longest arrow [m/s], without a few that are faster."""
    speeds = np.linalg.norm(velocities, axis=1)
    speeds = speeds[np.isfinite(speeds)]
    return float(np.percentile(speeds, _SHARE)) if len(speeds) else 0.0


def draw_arrows(
    axes: Axes,
    places: np.ndarray,
    velocities: np.ndarray,
    bodies: np.ndarray,
    fastest: float,
    depths: np.ndarray | None = None,
) -> None:
    """Draw the mean velocity of each body in each place, and an arrow of a round speed as a key.

    Args:
        axes: with limits set.
        places: of the particles (n, 2), in the unit of the axes.
        velocities: across and up in the picture (n, 2) [m/s].
        bodies: number of each particle's body (n,).
        fastest: speed of the longest arrow [m/s].
        depths: how near the viewer they are (n,), in the unit of the axes: those behind others
            have no arrow; None where all are seen.
    """
    left, right = axes.get_xlim()
    low, high = axes.get_ylim()
    side = max(right - left, high - low) / _ACROSS
    seen = np.isfinite(velocities).all(axis=1) & np.isfinite(places).all(axis=1)
    if fastest <= 0.0 or not seen.any():
        return
    cells = np.zeros((len(places), 2), dtype=int)
    cells[seen] = np.floor((places[seen] - [left, low]) / side).astype(int)
    if depths is not None:
        seen &= _in_front(cells, depths, seen, side)
    _, which = np.unique(np.column_stack([cells[seen], bodies[seen]]), axis=0, return_inverse=True)
    which = which.reshape(-1)
    many = np.bincount(which)
    x, y, u, v = (
        np.bincount(which, column) / many for column in (*places[seen].T, *velocities[seen].T)
    )
    speeds = np.hypot(u, v)
    told = speeds >= _LEAST * fastest
    shorter = np.minimum(1.0, fastest / np.maximum(speeds, 1e-300))
    x, y, u, v = (column[told] for column in (x, y, u * shorter, v * shorter))
    style: Any = {"angles": "xy", "scale_units": "xy", "units": "dots", "zorder": 6, "minlength": 0}
    width = 0.003 * float(axes.get_figure().bbox.width)  # type: ignore[union-attr]
    arrows = axes.quiver(
        *(x, y, u, v), scale=fastest / (_LENGTH * side), width=width,
        color="black", edgecolor="white", linewidth=0.4, **style,
    )  # fmt: skip
    key = _round(fastest)
    axes.quiverkey(
        arrows, 0.93, 1.02, key, f"{key:g} m/s ", labelpos="W", fontproperties={"size": 8}
    )


def _in_front(cells: np.ndarray, depths: np.ndarray, seen: np.ndarray, side: float) -> np.ndarray:
    """Return which particles are no farther than a place behind the nearest one in theirs."""
    _, which = np.unique(cells, axis=0, return_inverse=True)
    which = which.reshape(-1)
    front = np.full(int(which.max()) + 1, -np.inf)
    np.maximum.at(front, which[seen], depths[seen])
    return depths >= front[which] - side


def _round(about: float) -> float:
    """Return the largest of 1, 2, 5 x 10^k that is not above a number."""
    power = 10.0 ** np.floor(np.log10(about))
    return float(max(m * power for m in (1, 2, 5) if m * power <= about * (1 + 1e-9)))
