# SPDX-License-Identifier: BSD-3-Clause
"""What a user should look at again of contact between surfaces: what meets too fast for it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError, key_text
from mpm3dpp.base.frames import UPDATED
from mpm3dpp.case.box import CONTACT, FACES, HOLDING
from mpm3dpp.case.case import Case
from mpm3dpp.case.frame import in_body
from mpm3dpp.case.meetings import FASTEST, velocity_at_start

from .parts import Filled


def surface_notes(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence for each entry on nodes of its own that meets something too fast."""
    found, told = [], set()
    for name in in_body(case):
        waves = case.material[case.parts()[name].material].sound_speed()
        for other, speed in _meetings(case, bodies, name):
            pair = frozenset((key_text(case.part_path(name)), other))
            if speed > FASTEST * waves and pair not in told:
                told.add(pair)
                found.append(
                    f"{key_text(case.part_path(name))} and {other} approach at "
                    f"{speed / waves:.2g} of the speed of its waves, {waves:.3g} m/s: above "
                    f"{FASTEST:g} of it surfaces may go through each other where they are round, "
                    'thin or fold; give frame = "updated" if a run warns of that'
                )
                break
    return found


def bond_mistakes(case: Case, bodies: Filled) -> Iterator[CaseError]:
    """Yield the bonded pairs on nodes of their own of which the boxes are too far apart to touch.

    What lies near by its boxes is judged by the core, which knows the surfaces.
    """
    own = in_body(case)
    for k, pair in enumerate(case.contact.pair):
        if not (pair.bonded and pair.bodies and set(own) & set(pair.bodies)):
            continue
        first, second = (bodies.parts[name] for name in pair.bodies)
        # Particles begin half a spacing behind the faces.
        behind = 0.5 * (first.spacing + second.spacing)
        one, other = first.survey, second.survey
        off = np.maximum(
            other.lower.min(axis=0) - one.upper.max(axis=0),
            one.lower.min(axis=0) - other.upper.max(axis=0),
        )
        if (gap := float(off.max()) - behind) > 0.25 * min(first.spacing, second.spacing):
            yield bond_of_nothing(case, k, f", {gap:.3g} m apart,")


def bond_of_nothing(case: Case, k: int, why: str = "") -> CaseError:
    """Return the mistake of a pair that is bonded, on nodes of its own, and touches nowhere."""
    pair = case.contact.pair[k]
    names = " and ".join(pair.bodies or pair.materials or [])
    rule = (
        f"of {names}{why} holds nothing: bodies on nodes of their own are bonded where they touch"
    )
    remedy = f'bring them together, or give frame = "{UPDATED}"'
    return case.error(("contact", "pair", k, "bonded"), f"{rule} at the start", remedy)


def _meetings(case: Case, bodies: Filled, name: str) -> Iterator[tuple[str, float]]:
    """Yield what an entry approaches, and how fast [m/s]; of motions that are numbers."""
    own = velocity_at_start(case, name)
    if own is None:
        return
    for other in bodies.parts if case.contact.enabled else ():
        theirs = velocity_at_start(case, other)
        if other == name or theirs is None:
            continue
        way = _middle(bodies, other) - _middle(bodies, name)
        approach = own - theirs
        closing = float(way @ approach) / max(float(np.linalg.norm(way)), 1e-300)
        if closing > 0.0:
            yield key_text(case.part_path(other)), closing
    for face, wall in enumerate(case.grid.walls):
        axis, at_end = divmod(face, 2)
        if wall == CONTACT or wall in HOLDING:
            yield f"grid.box.walls.{FACES[face]}", float(own[axis]) * (1.0 if at_end else -1.0)


def _middle(bodies: Filled, name: str) -> NDArray[np.float64]:
    """Return the middle of the box around an entry [m]."""
    seen = bodies.parts[name].survey
    return np.asarray(0.5 * (seen.lower.min(axis=0) + seen.upper.max(axis=0)))
