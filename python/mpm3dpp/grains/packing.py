# SPDX-License-Identifier: BSD-3-Clause
"""Random packing of discs or spheres without overlap: the same for the same seed."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.neighbours import near_pairs
from mpm3dpp.shapes.base import Shape

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
_DIRECTIONS = {2: 64, 3: 400}  # in which a grain is looked at, whether it lies in a shape
_AT_A_TIME = 2000  # grains
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


def fitting(shape: Shape, centres: Array, radii: Array) -> NDArray[np.bool_]:
    """Return which grains lie in a shape with all of their surface, shape (n,).

    Args:
        shape: of as many dimensions as the grains.
        centres: [m], shape (n, D).          radii: [m], shape (n,).
    """
    directions, beyond = _directions(centres.shape[1])
    found = np.ones(len(centres), dtype=bool)
    for first in range(0, len(centres), _AT_A_TIME):
        some = slice(first, first + _AT_A_TIME)
        around = beyond * radii[some, None, None] * directions
        points: Array = (centres[some, None, :] + around).reshape(-1, centres.shape[1])
        found[some] = shape.contains(points).reshape(-1, len(directions)).all(axis=1)
    return found


def _directions(dimension: int) -> tuple[Array, float]:
    """Return unit vectors, and how many times the radius a ball is held by points along these.

    Between neighbours a flat wall could cut what they do not tell: 1 / cos of half their angle.
    """
    k = np.arange(_DIRECTIONS[dimension], dtype=float)
    if dimension == 2:
        angle = 2.0 * math.pi * k / len(k)
        return np.column_stack([np.cos(angle), np.sin(angle)]), 1.0 / math.cos(math.pi / len(k))
    # A spiral of equal areas; no place is farther than 2.65 / sqrt(n) from all of them (measured).
    z = 1.0 - (2.0 * k + 1.0) / len(k)
    angle = math.pi * (3.0 - math.sqrt(5.0)) * k
    ring = np.sqrt(1.0 - z * z)
    points = np.column_stack([ring * np.cos(angle), ring * np.sin(angle), z])
    return points, 1.0 / math.cos(2.7 / math.sqrt(len(k)))


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
