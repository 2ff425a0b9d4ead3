# SPDX-License-Identifier: BSD-3-Clause
"""The grid of a deck, and what stands outside its box."""

from __future__ import annotations

import math
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.case.box import FACES

from .deck import Array, Deck, Part
from .particles import extent, half_cells
from .units import UnitSystem

_WALLS = ("free", "fixed", "slip")
_SLACK = 1e-9  # Of a cell: how far a particle may stand outside by rounding.


@dataclass
class Bounds:
    """The box in units of the file, a whole number of cells along each axis.

    Attributes:
        lower, upper: its corners.
        closed: whether there is a wall at each face, in the order of `FACES`.
        cell: size of the cells.
    """

    lower: list[Decimal]
    upper: list[Decimal]
    closed: list[bool]
    cell: Decimal

    def beyond(self, points: Array) -> NDArray[np.bool_]:
        """Return which points, shape (n, 3), stand beyond a closed face, shape (n,)."""
        lower = np.where(self.closed[0::2], np.array(self.lower, float), -np.inf)
        upper = np.where(self.closed[1::2], np.array(self.upper, float), np.inf)
        slack = _SLACK * float(self.cell)
        out = (points < lower - slack) | (points > upper + slack)
        found: NDArray[np.bool_] = np.any(out, axis=1)
        return found


def bounds_of(deck: Deck) -> Bounds | None:
    """Return the box, widened at its free faces so that all bodies are in it.

    A free face does nothing but end the grid, beyond which MPM3D-F90 leaves particles where they
    are; here they go on. A wall stays where it is: to move it would change the motion. None if a
    body lies wholly outside, which is among `deck.source.problems` then.

    Raises:
        CaseError: the grid is incomplete.
    """
    if deck.cell <= 0:
        raise deck.error("dcel", "is missing", "add dcel, the cell size")
    cell = Decimal(repr(deck.cell))
    found = Bounds([], [], [bool(code) for code in deck.faces], cell)
    for axis, word in enumerate(("spx", "spy", "spz")):
        if axis not in deck.bounds:
            raise deck.error(word, "is missing", f"add {word}, the bounds of the grid")
        low, high = (Decimal(repr(x)) for x in deck.bounds[axis])
        cells = int((high - low) / cell + Decimal("0.5"))
        if cells < 1:
            raise deck.error(word, "is less than half a cell", "enlarge it")
        found.lower.append(low)
        found.upper.append(low + cells * cell)
        if abs(found.upper[-1] - high) > Decimal("1e-9") * cell:
            deck.note(
                f"{word}: the upper bound is moved to a whole number of cells, from {high} to "
                f"{float(found.upper[-1]):g}, as in MPM3D-F90"
            )
    return found if _take_in(deck, found) else None


def _take_in(deck: Deck, bounds: Bounds) -> bool:
    """Widen the free faces of a box by whole cells, so that all particles are within them; False if
    that cannot be."""
    good = True
    extents = [extent(part) for part in deck.parts]
    given = list(zip(bounds.lower, bounds.upper, strict=True))
    for number, (part, (least, most)) in enumerate(zip(deck.parts, extents, strict=True), 1):
        for axis, (low, high) in enumerate(given):
            if most[axis] < float(low) or least[axis] > float(high):
                rule = f"lies outside the grid: body {number} is beyond its {'xyz'[axis]} bounds"
                remedy = "correct its place, or the bounds; MPM3D-F90 would never move it"
                deck.refuse("part", rule, remedy, part.line)
                good = False
                break
            _widen(deck, bounds, axis, (number, part), (least[axis], most[axis]))
    return good


def _widen(
    deck: Deck, bounds: Bounds, axis: int, body: tuple[int, Part], span: tuple[float, float]
) -> None:
    number, part = body
    cell = bounds.cell
    for side, corner, sign in ((0, bounds.lower, -1), (1, bounds.upper, 1)):
        out = sign * (Decimal(repr(span[side])) - corner[axis]) / cell
        if bounds.closed[2 * axis + side] or not out > Decimal(_SLACK):
            continue
        cells = math.ceil(out)
        corner[axis] += sign * cells * cell
        count = "a cell" if cells == 1 else f"{cells} cells"
        deck.note(
            f"line {part.line}: body_{number} reaches out of the grid at {FACES[2 * axis + side]}, "
            f"so the box is widened there by {count}; MPM3D-F90 leaves particles outside its "
            "grid where they are"
        )


def grid_table(deck: Deck, bounds: Bounds, units: UnitSystem) -> dict[str, Any]:
    """Return the table `grid` of a case.

    Raises:
        CaseError: gimp with particles that are not half a cell wide.
    """
    length = units.factor("length")
    box: dict[str, Any] = {
        "lower": [float(x * length) for x in bounds.lower],
        "upper": [float(x * length) for x in bounds.upper],
    }
    if any(deck.faces):
        box["walls"] = {f: _WALLS[c] for f, c in zip(FACES, deck.faces, strict=True) if c}
    cell = float(bounds.cell * length)
    return {"dimension": 3, "cell_size": cell, "box": box, "basis": _basis(deck)}


def _basis(deck: Deck) -> str:
    if not deck.gimp:
        return "linear"
    known = all(part.material in deck.materials for part in deck.parts)
    if deck.parts and known and not half_cells(deck):
        rule = "takes every particle as half a cell wide, and here they are not"
        raise deck.error("gimp", rule, "leave it out, or give two particles to a cell's edge")
    return "gimp"
