# SPDX-License-Identifier: BSD-3-Clause
"""Forces of a deck as tables of a case: gravity, and loads on single particles."""

from __future__ import annotations

import itertools
from typing import Any

from .box import Bounds
from .deck import Deck
from .particles import particle_mass, points_of
from .units import UnitSystem

_MOST = 100  # Loads at points: each is looked for in all patches of its body in every step.


def gravity_vector(deck: Deck, units: UnitSystem) -> list[Any]:
    """Return the acceleration that acts on all bodies: gravity, and a force on each particle over
    its mass, which rises as QuLo says. Empty if there is none.

    Raises:
        CaseError: it differs from body to body.
    """
    if not deck.parts or not (deck.gravity or deck.force):  # No particles are told elsewhere.
        return []
    numbers = range(1, len(deck.parts) + 1)
    both = [(deck.gravity.get(k, ([0.0] * 3, 0))[0], _over_mass(deck, k)) for k in numbers]
    # What rises with QuLo and what does not must each be the same.
    values = [
        [*g, *a] if deck.rise else [x + y for x, y in zip(g, a, strict=True)] for g, a in both
    ]
    apart = [abs(x - y) for g in values for x, y in zip(g, values[0], strict=True)]
    if max(apart, default=0.0) > 1e-12 * max(abs(x) for g in values for x in g or [0.0]):
        what = "different loads" if deck.force else "different gravity"
        rule = f"gives the bodies {what} (those not named have none)"
        line = min(line for _, line in [*deck.gravity.values(), *deck.force.values()])
        raise deck.error("load", rule, "give every body the same acceleration", line)
    steady, pushed = both[0]
    if not any(values[0]):
        return []
    pairs = zip(steady, pushed, strict=True)
    return [_rising(deck, units, "acceleration", *pair) for pair in pairs]


def load_tables(
    deck: Deck, groups: list[list[int]], bounds: Bounds, units: UnitSystem
) -> tuple[dict[str, dict[str, Any]], dict[str, int]]:
    """Return the loads at the places of particles, and the lines that they come from.

    Args:
        deck: of the loads.
        groups: the indices of the parts that are one body of the case.
        bounds: of the grid; particles beyond its walls are left out.
        units: of the file.

    Raises:
        CaseError: there is no such particle, its body has a force on every particle too, or there
            are too many loads.
    """
    given = {number: of for number, of in deck.particle_force.items() if any(of[0])}
    if not given:
        return {}, {}
    points = [points_of(part) for part in deck.parts]
    ends = list(itertools.accumulate(map(len, points)))
    first = {k: group[0] + 1 for group in groups for k in group}
    loads: dict[str, dict[str, Any]] = {}
    lines: dict[str, int] = {}
    if len(given) > _MOST:
        rule = f"pushes {len(given)} single particles, and {_MOST} at most can be honoured"
        remedy = "push all particles of a body with body, or its side with [load.NAME] of the case"
        raise deck.error("load", rule, remedy, next(iter(given.values()))[1])
    for number, (force, line) in given.items():
        k = next((k for k, end in enumerate(ends) if 1 <= number <= end), None)
        if k is None:
            rule = f"names particle {number} but there are {ends[-1]}"
            raise deck.error("load", rule, "particles are numbered from 1", line)
        if k + 1 in deck.force:
            rule = f"gives particle {number} a force, and its body {k + 1} one on every particle"
            raise deck.error("load", rule, "keep one of the two, or use grav for the body", line)
        point = points[k][number - 1 - (ends[k] - len(points[k]))]
        if bounds.beyond(point[None, :])[0]:
            deck.note(f"line {line}: particle {number} is left out, and the load on it")
            continue
        name = f"particle_{number}"
        loads[name] = {
            "body": f"body_{first[k]}",
            "point": [units.si(float(x), "length") for x in point],
            "force": [_rising(deck, units, "force", 0.0, f) for f in force],
        }
        lines[name] = line
    return loads, lines


def _over_mass(deck: Deck, number: int) -> list[float]:
    """Return the force on each particle of a body per mass, in units of the file."""
    force, line = deck.force.get(number, ([0.0] * 3, 0))
    if not any(force):
        return [0.0] * 3
    mass = particle_mass(deck.parts[number - 1])
    if mass is None:
        rule = f"gives all particles of body {number} one force, but they have different masses"
        raise deck.error("load", rule, "use grav, an acceleration", line)
    deck.note(
        f"line {line}: the force on every particle of body {number} is gravity here, the force "
        f"over a particle's mass of {mass:g}"
    )
    return [f / mass for f in force]


def _rising(deck: Deck, units: UnitSystem, kind: str, steady: float, force: float) -> Any:
    """Return a quantity in SI units, of which a part rises from 0 over the time of QuLo."""
    whole = units.si(steady + force, kind)
    if not deck.rise or not force:
        return whole
    ramp = {"to": whole, "end": units.si(deck.rise, "time")}
    return {"ramp": {"from": units.si(steady, kind)} | ramp if steady else ramp}
