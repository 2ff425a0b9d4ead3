# SPDX-License-Identifier: BSD-3-Clause
"""Who shares a velocity field with whom: `nbco`, the components of the bodies, and `cont`."""

from __future__ import annotations

import itertools
from typing import Any

from .deck import Deck

_NORMALS = ("pair", "first", "second")


def contact_table(deck: Deck) -> dict[str, Any]:
    """Return the table of contact; empty for one body without.

    MPM3D-F90 looks at the components of bodies only if there is a `cont`. Without it all bodies are
    on grid 1, whatever nbco says: one velocity field, in which they stick together.

    Raises:
        CaseError: contact that cannot be honoured.
    """
    components = [part.component for part in deck.parts]
    if not deck.separate:
        if max(deck.components, *components) > 1:
            deck.note(
                "components (nbco) without cont: all bodies share one velocity field and stick "
                "together (contact.bonded), as in MPM3D-F90"
            )
        return {"bonded": True} if len(components) > 1 else {}
    if deck.components == 1 and deck.contact is not None:
        rule = "asks for contact but nbco is 1, so that all bodies share one grid"
        raise deck.error("cont", rule, "set nbco 2, or leave cont out")
    for part in deck.parts:
        if not 1 <= part.component <= deck.components:
            rule = f"is in component {part.component} but nbco is {deck.components}"
            raise deck.error("part", rule, "correct one of the two", part.line)
    if len(set(components)) == 1:
        return {"bonded": True} if len(components) > 1 else {}
    if deck.contact is None:
        deck.note("cont others: the bodies do not see each other, as in MPM3D-F90")
        return {"enabled": False}
    if max(components) > 2:
        rule = f"comes with component {max(components)}, and has contact of components 1 and 2 only"
        raise deck.error("cont", rule, "leave two bodies, or bodies of two components")
    friction, whose = deck.contact
    deck.note(
        "cont: the velocity rule of MPM3D-F90; bodies touch more than a cell before they meet, "
        'contact.detection = "gap" would be better'
    )
    return {"detection": "velocity", "normal": _NORMALS[whose], "friction": friction}


def joined(deck: Deck) -> list[list[int]]:
    """Return the indices of the parts that are one body here, in the order of the components.

    With `cont` the bodies of a component share a grid, as if they were one: so they are one here.

    Raises:
        CaseError: they have different materials or velocities.
    """
    order = sorted(range(len(deck.parts)), key=lambda k: deck.parts[k].component)
    groups = [list(g) for _, g in itertools.groupby(order, lambda k: deck.parts[k].component)]
    if not deck.separate or len(groups) == 1:
        return [[k] for k in order]
    for group in groups:
        component = deck.parts[group[0]].component
        velocities = [deck.velocity.get(k + 1, ([0.0] * 3, 0))[0] for k in group]
        same = all(deck.parts[k].material == deck.parts[group[0]].material for k in group)
        if not same or any(v != velocities[0] for v in velocities):
            what = "velocities" if same else "materials"
            rule = f"comes with bodies of different {what} in component {component}"
            remedy = "give them components of their own, of which cont knows two"
            raise deck.error("cont", rule, f"{remedy}, or leave cont out")
        if len(group) > 1:
            names = ", ".join(str(k + 1) for k in group)
            deck.note(f"cont: bodies {names} share the grid of component {component}, as one body")
    return groups
