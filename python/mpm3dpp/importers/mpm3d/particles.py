# SPDX-License-Identifier: BSD-3-Clause
"""Particles of `part` statements: exactly the points of the language, or a box that has them."""

from __future__ import annotations

import math
from decimal import Decimal
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import MOST_PARTICLES
from mpm3dpp.case.particles import Particles

from .deck import Array, Deck, Part
from .units import UnitSystem

if TYPE_CHECKING:
    from .box import Bounds

_SAME = 1e-9  # Of the spacing: how far points that count as the same may be apart.


def points_of(part: Part) -> Array:
    """Return the points of a body in the units and in the order of the file, shape (n, 3)."""
    if part.points is not None:
        return part.points
    n, dp = part.numbers, part.numbers["dp"]
    if part.kind in ("block", "blod"):
        steps = [np.arange(int(n[f"n{a}"])) + 0.5 for a in "xyz"]
        z, y, x = np.meshgrid(*reversed(steps), indexing="ij")  # x fastest
        lattice = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
        points = np.array([n["ox"], n["oy"], n["oz"]]) + dp * lattice
        if part.kind == "block":
            return points
        distance = np.hypot(points[:, 0] - n["hx"], points[:, 1] - n["hy"])
        return points[distance >= n["nr"] * dp]
    around = np.arange(-int(n["nr"]), int(n["nr"])) + 0.5
    deep = around if part.kind == "sphere" else np.array([0.5])
    x, y, z = np.meshgrid(around, around, deep, indexing="ij")  # z fastest
    lattice = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    plane = lattice if part.kind == "sphere" else lattice[:, :2]
    lattice = lattice[np.sqrt((plane**2).sum(axis=1)) < n["nr"]]
    return np.array([n["cx"], n["cy"], n["cz"]]) + dp * lattice


def extent(part: Part) -> tuple[list[float], list[float]]:
    """Return the least and the largest coordinates of a body's points, by axis; those of a lattice
    without its holes and corners."""
    if part.points is not None:
        return part.points.min(axis=0).tolist(), part.points.max(axis=0).tolist()
    n, dp = part.numbers, part.numbers["dp"]
    if part.kind in ("block", "blod"):
        spans = [(n[f"o{a}"] + 0.5 * dp, n[f"o{a}"] + (n[f"n{a}"] - 0.5) * dp) for a in "xyz"]
    else:
        reach = (n["nr"] - 0.5) * dp
        spans = [(n[f"c{a}"] - reach, n[f"c{a}"] + reach) for a in "xyz"]
        if part.kind == "cicl":
            spans[2] = (n["cz"] + 0.5 * dp,) * 2
    return [low for low, _ in spans], [high for _, high in spans]


def check_counts(deck: Deck) -> None:
    """Refuse more particles than nbmp says, or than there is memory for, before they are made.

    Raises:
        CaseError: there are too many.
    """
    total = 0
    for part in deck.parts:
        least, lattice = _counts(part)
        total += least
        if part.kind != "block" and lattice > MOST_PARTICLES:
            rule = f"needs a lattice of some {lattice:.0e} particles"
            raise deck.error("part", rule, "give smaller numbers; memory is too small", part.line)
    if deck.particles and total > deck.particles:
        rule = f"is {deck.particles} but the part statements have at least {total} particles"
        raise deck.error("nbmp", rule, "correct one of the two")


def _counts(part: Part) -> tuple[int, float]:
    """Return how many particles a body has at least, and the points of the lattice it is cut of."""
    n = part.numbers
    if part.masses is not None:
        return len(part.masses), len(part.masses)
    if part.kind in ("block", "blod"):
        lattice = n["nx"] * n["ny"] * n["nz"]
        return int(lattice) if part.kind == "block" else 0, lattice
    # Cubes or squares of the lattice that are wholly within the radius have their points in it.
    if part.kind == "sphere":
        inner = max(n["nr"] - math.sqrt(3.0), 0.0)
        return int(4.0 / 3.0 * math.pi * inner**3), (2 * n["nr"]) ** 3
    inner = max(n["nr"] - math.sqrt(2.0), 0.0)
    return int(math.pi * inner**2), (2 * n["nr"]) ** 2


def one_part(parts: list[Part]) -> Part:
    """Return the body that has all particles of some bodies of one material."""
    first = parts[0]
    if len(parts) == 1:
        return first
    points = [points_of(part) for part in parts]
    masses = [_masses(part, len(x)) for part, x in zip(parts, points, strict=True)]
    return Part(
        "point", first.component, first.material, first.line,
        masses=np.concatenate(masses), points=np.concatenate(points),
    )  # fmt: skip


def _masses(part: Part, count: int) -> Array:
    if part.masses is not None:
        return part.masses
    return np.full(count, part.numbers["density"] * part.numbers["dp"] ** 3)


def particle_mass(part: Part) -> float | None:
    """Return the mass that all particles of a body have, in the units of the file; else None."""
    if part.masses is None:
        return float(part.numbers["density"] * part.numbers["dp"] ** 3)
    masses = part.masses
    return float(masses[0]) if np.ptp(masses) <= _SAME * masses.max() else None


def body_table(deck: Deck, part: Part, bounds: Bounds, units: UnitSystem) -> dict[str, Any]:
    """Return the keys of a body that give its particles: `shape`, `spacing`, or `particles`.

    Args:
        deck: gives the density of the material.
        part: the body.
        bounds: of the grid; particles beyond its walls are left out.
        units: of the file.

    Raises:
        CaseError: there is no particle, or none within the walls.
    """
    density = deck.materials[part.material].values["rho"]
    inside = not bounds.beyond(np.array(extent(part))).any()
    lattice = part.kind == "block" and inside and _on_lattice(part, bounds.lower)
    if lattice and _same(part.numbers, density):
        n, dp = part.numbers, Decimal(repr(part.numbers["dp"]))
        low = [Decimal(repr(n[f"o{a}"])) for a in "xyz"]
        high = [o + int(n[f"n{a}"]) * dp for o, a in zip(low, "xyz", strict=True)]
        length = units.factor("length")
        box = {
            "lower": [float(x * length) for x in low],
            "upper": [float(x * length) for x in high],
        }
        return {"shape": {"box": box}, "spacing": units.si(n["dp"], "length")}
    if _counts(part)[1] > MOST_PARTICLES:  # A block that no box can stand for.
        rule = f"has some {_counts(part)[1]:.0e} particles"
        raise deck.error("part", rule, "give smaller numbers; memory is too small", part.line)
    points = points_of(part)
    masses = _masses(part, len(points))
    if part.masses is None and not _same(part.numbers, density):
        share = part.numbers["density"] / density - 1
        deck.note(
            f"line {part.line}: the density of the part statement is not that of its material "
            f"({share:+.1%}): like in MPM3D-F90 its particles are that much larger"
        )
    if len(points) == 0:
        raise deck.error("part", "holds no particle", "change its numbers", part.line)
    if not inside:
        points, masses = _within(deck, part, bounds, points, masses)
    volumes = units.array(masses / density, "volume")
    try:
        return {"particles": Particles(units.array(points, "length"), volumes)}
    except CaseError as error:
        rule = f"has numbers that cannot be: {error.rule}"
        raise deck.error("part", rule, "correct them", part.line) from None


def _within(
    deck: Deck, part: Part, bounds: Bounds, points: Array, masses: Array
) -> tuple[Array, Array]:
    """Return the points and masses of those that do not stand beyond a wall."""
    beyond = bounds.beyond(points)
    count = int(beyond.sum())
    if count == len(points):
        rule = "lies wholly beyond a wall of the grid"
        remedy = "correct its place, or the bounds; MPM3D-F90 would never move it"
        raise deck.error("part", rule, remedy, part.line)
    if count:
        deck.note(
            f"line {part.line}: {count} of {len(points)} particles lie beyond a wall (fixe) and "
            "are left out: MPM3D-F90 never moves them, and a wider box would move the wall"
        )
    return points[~beyond], masses[~beyond]


def half_cells(deck: Deck) -> bool:
    """Are all particles cubes of half a cell, to a thousandth of the edge?"""
    for part in deck.parts:
        density = deck.materials[part.material].values["rho"]
        if part.masses is not None:
            edges = np.cbrt(part.masses / density)
        else:
            edges = part.numbers["dp"] * np.cbrt([part.numbers["density"] / density])
        if np.abs(edges / (0.5 * deck.cell) - 1).max() > 1e-3:
            return False
    return True


def _on_lattice(part: Part, lower: list[Decimal]) -> bool:
    """Is the block a whole number of spacings from the corner of the grid?"""
    dp = part.numbers["dp"]
    for axis, start in zip("xyz", lower, strict=True):
        away = (Decimal(repr(part.numbers[f"o{axis}"])) - start) / Decimal(repr(dp))
        if abs(away - round(away)) > Decimal(_SAME):
            return False
    return True


def _same(numbers: dict[str, float], density: float) -> bool:
    return abs(numbers["density"] / density - 1) < 1e-9
