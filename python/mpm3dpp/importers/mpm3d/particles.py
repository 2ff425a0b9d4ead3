# SPDX-License-Identifier: BSD-3-Clause
"""Particles of `part` statements: exactly the points of the language, or a box that has them."""

from __future__ import annotations

from decimal import Decimal
from typing import Any

import numpy as np

from mpm3dpp.particles import Particles

from .deck import Array, Deck, Part
from .units import UnitSystem

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


def body_table(deck: Deck, part: Part, lower: list[Decimal], units: UnitSystem) -> dict[str, Any]:
    """Return the keys of a body that give its particles: `shape`, `spacing`, or `particles`.

    Args:
        deck: gives the density of the material.
        part: the body.
        lower: corner of the grid, in units of the file.
        units: of the file.
    """
    density = deck.materials[part.material].values["rho"]
    if part.kind == "block" and _on_lattice(part, lower) and _same(part.numbers, density):
        n, dp = part.numbers, Decimal(repr(part.numbers["dp"]))
        low = [Decimal(repr(n[f"o{a}"])) for a in "xyz"]
        high = [o + int(n[f"n{a}"]) * dp for o, a in zip(low, "xyz", strict=True)]
        length = units.factor("length")
        box = {
            "lower": [float(x * length) for x in low],
            "upper": [float(x * length) for x in high],
        }
        return {"shape": {"box": box}, "spacing": units.si(n["dp"], "length")}
    points = points_of(part)
    if part.masses is not None:
        masses = part.masses
    else:
        masses = np.full(len(points), part.numbers["density"] * part.numbers["dp"] ** 3)
        if not _same(part.numbers, density):
            share = part.numbers["density"] / density - 1
            deck.note(
                f"line {part.line}: the density of the part statement is not that of its material "
                f"({share:+.1%}): like in MPM3D-F90 its particles are that much larger"
            )
    if len(points) == 0:
        raise deck.error("part", "holds no particle", "change its numbers", part.line)
    volumes = units.array(masses / density, "volume")
    return {"particles": Particles(units.array(points, "length"), volumes)}


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
