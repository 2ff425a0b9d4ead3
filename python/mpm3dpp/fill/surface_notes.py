# SPDX-License-Identifier: BSD-3-Clause
"""What a user should look at again of contact between surfaces: what meets too fast for it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case
from mpm3dpp.case.frame import in_body
from mpm3dpp.case.grid import CONTACT, FACES

from .parts import Filled

_FASTEST = 0.25
"""Speed of meeting over that of waves above which points lie as deep as springs reach."""


def surface_notes(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence for each entry on nodes of its own that meets something too fast."""
    if not case.contact.enabled:
        return []
    found = []
    for name in in_body(case):
        waves = case.material[case.parts()[name].material].sound_speed()
        for other, speed in _meetings(case, bodies, name):
            if speed > _FASTEST * waves:
                found.append(
                    f"{key_text(case.part_path(name))} and {other} approach at "
                    f"{speed / waves:.2g} of the speed of its waves, {waves:.3g} m/s: above "
                    f"{_FASTEST:g} of it surfaces may go through each other where they are thin or "
                    'fold; give both frame = "updated" if a run warns of that'
                )
                break
    return found


def _meetings(case: Case, bodies: Filled, name: str) -> Iterator[tuple[str, float]]:
    """Yield what an entry approaches, and how fast [m/s]; of motions that are numbers."""
    own = _velocity(case, name)
    if own is None:
        return
    for other in bodies.parts:
        theirs = _velocity(case, other)
        if other == name or theirs is None:
            continue
        way = _middle(bodies, other) - _middle(bodies, name)
        approach = own - theirs
        if float(way @ approach) > 0.0:
            yield key_text(case.part_path(other)), float(np.linalg.norm(approach))
    for face, wall in enumerate(case.grid.walls):
        axis, at_end = divmod(face, 2)
        if wall == CONTACT:
            yield f"grid.box.walls.{FACES[face]}", float(own[axis]) * (1.0 if at_end else -1.0)


def _middle(bodies: Filled, name: str) -> NDArray[np.float64]:
    """Return the middle of the box around an entry [m]."""
    seen = bodies.parts[name].survey
    return np.asarray(0.5 * (seen.lower.min(axis=0) + seen.upper.max(axis=0)))


def _velocity(case: Case, name: str) -> NDArray[np.float64] | None:
    """Return how an entry moves at the start [m/s]; None where no numbers say so."""
    part: Any = case.parts()[name]
    motion = getattr(part, "motion", None)
    given = part.velocity if motion is None else motion.velocity
    dimension = case.grid.dimension
    if not given:
        return np.zeros(dimension)
    if not all(isinstance(v, int | float) for v in given):
        return None
    return np.array(given, dtype=float)
