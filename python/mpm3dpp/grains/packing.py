# SPDX-License-Identifier: BSD-3-Clause
"""Random packing of discs or spheres without overlap: the same for the same seed."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.neighbours import near_pairs

Array = NDArray[np.float64]

DENSEST = {2: math.pi / math.sqrt(12.0), 3: math.pi / math.sqrt(18.0)}
"""Share of the plane or of space that equal discs or spheres fill at most (Thue; Kepler)."""

MOST_GRAINS = 10_000_000
"""Grains of one entry at most."""

_ROUNDS = 4000  # Rounds of pushing at most ...
_PATIENCE = 200  # ... and rounds in which the overlap must fall ...
_PROGRESS = 0.97  # ... to this share at least.
_EXTRA = 1e-3  # Grains are pushed this share of their distance farther than they need.
_PUSH = 0.6  # Share of an overlap that one round removes: more would shake dense packings.
_SKIN = 0.3  # Pairs are listed this share of the mean radius beyond touching, and kept a while.


def ball_volume(radii: Array, dimension: int) -> Array:
    """Return the areas of discs [m^2] or the volumes of spheres [m^3]."""
    return math.pi * radii**2 if dimension == 2 else 4.0 / 3.0 * math.pi * radii**3


@lru_cache(maxsize=16)
def draw_radii(
    least: float,
    most: float,
    count: int | None,
    volume: float,
    dimension: int,
    seed: int,
) -> Array:
    """Return radii [m] drawn evenly between two.

    Args:
        least, most: [m].
        count: how many; None for as many as fit into `volume` [m^3; in 2D m^2].
        volume: of all grains together, without `count`.
        dimension: 2 or 3.
        seed: a whole number >= 0.
    """
    random = np.random.default_rng([seed, 0])
    if count is None:
        fitting = volume / float(ball_volume(np.array(least), dimension))
        radii = least + (most - least) * random.random(int(min(fitting, MOST_GRAINS)) + 1)
        radii = radii[: int((np.cumsum(ball_volume(radii, dimension)) <= volume).sum())]
    else:
        radii = least + (most - least) * random.random(min(count, MOST_GRAINS + 1))
    radii.setflags(write=False)
    return radii


@lru_cache(maxsize=4)
def pack(
    lower: tuple[float, ...],
    upper: tuple[float, ...],
    least: float,
    most: float,
    count: int | None,
    volume: float,
    gap: float,
    seed: int,
) -> tuple[Array, Array]:
    """Place grains in a box at random so that none overlap.

    They start at random places and push each other away until all gaps are wide enough
    (after Jodrey & Tory 1985, without changing the radii).

    Args:
        lower, upper: corners of the box that holds the grains [m].
        least, most, count, volume, seed: see `draw_radii`.
        gap: least distance of two surfaces [m].

    Returns:
        Centres [m], shape (n, D), and radii [m], shape (n,).

    Raises:
        CaseError: they cannot be placed.
    """
    dimension = len(lower)
    radii = draw_radii(least, most, count, volume, dimension, seed)
    low = np.asarray(lower) + radii[:, None]
    high = np.asarray(upper) - radii[:, None]
    # With half the gap around each, grains fill a box that is half a gap larger on all sides.
    room = float(np.prod(np.asarray(upper) - np.asarray(lower) + gap))
    share = float(ball_volume(radii + 0.5 * gap, dimension).sum()) / room
    if share > DENSEST[dimension]:
        raise _cannot(radii, share, f"{DENSEST[dimension]:.0%} is the most that equal ones fill")
    centres = low + (high - low) * np.random.default_rng([seed, 1]).random(low.shape)
    left = _push_apart(centres, radii, gap, low, high)
    if left:
        raise _cannot(radii, share, f"{left:,} pairs are still too close after pushing them apart")
    centres.setflags(write=False)
    return centres, radii


def _cannot(radii: Array, share: float, reason: str) -> CaseError:
    rule = (
        f"cannot be placed without overlap: {len(radii):,} grains with their gaps fill "
        f"{share:.1%} of the region, and {reason}"
    )
    return CaseError(rule, "give fewer or smaller grains, or a larger region")


def _push_apart(centres: Array, radii: Array, gap: float, low: Array, high: Array) -> int:
    """Move the centres, in place, until no two grains are too close; return the pairs that are."""
    skin = _SKIN * float(radii.mean())
    listed = np.full_like(centres, np.inf)
    best, waited = math.inf, 0
    for _ in range(_ROUNDS):
        moved = ((centres - listed) ** 2).sum(axis=1)
        if not float(moved.max(initial=0.0)) < (0.5 * skin) ** 2:
            listed = centres.copy()
            reach = 2.0 * float(radii.max()) + gap + skin
            a, b = near_pairs(centres, reach)
            wanted = radii[a] + radii[b] + gap
            close = ((centres[a] - centres[b]) ** 2).sum(axis=1) < (wanted + skin) ** 2
            a, b, wanted = a[close], b[close], wanted[close]
        away = centres[a] - centres[b]
        distance = np.sqrt((away**2).sum(axis=1))
        touching = np.flatnonzero(distance < wanted)
        if len(touching) == 0:
            return 0
        overlap = float((wanted - distance)[touching].sum())
        if overlap < _PROGRESS * best:
            best, waited = overlap, 0
        waited += 1
        if waited > _PATIENCE:
            break
        near = np.flatnonzero(distance < (1.0 + _EXTRA) * wanted)
        away, distance = away[near], distance[near]
        away[distance == 0.0, 0] = 1.0
        push = 0.5 * _PUSH * ((1.0 + _EXTRA) * wanted[near] - distance)
        push = push / np.where(distance == 0.0, 1.0, distance)
        for d in range(centres.shape[1]):
            step = push * away[:, d]
            centres[:, d] += np.bincount(a[near], step, len(centres))
            centres[:, d] -= np.bincount(b[near], step, len(centres))
        np.clip(centres, low, high, out=centres)
    return len(touching)
