# SPDX-License-Identifier: BSD-3-Clause
"""How fast bodies meet at the start, as far as a case says it in numbers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .box import CONTACT, FACES, HOLDING

if TYPE_CHECKING:
    from .case import Case

FASTEST = 0.2
"""Speed of meeting over that of waves above which surfaces of bodies on nodes of their own go
through each other: points lie as deep as their springs reach (docs/decisions/0076-deep-contact.md).
"""
FASTEST_IF_IT_YIELDS = 0.1
"""The same of what yields, where no frame is said: it flows far, and into what it meets."""
_ELASTIC = ("elastic", "neo_hookean")


def velocity_at_start(case: Case, name: str) -> NDArray[np.float64] | None:
    """Return how an entry moves at the start [m/s], particles with velocities of their own in the
    mean; None where no numbers say so."""
    part: Any = case.parts()[name]
    particles = getattr(part, "particles", None)
    if particles is not None and particles.velocities is not None:
        return np.asarray(particles.velocities.mean(axis=0), dtype=float)
    motion = getattr(part, "motion", None)
    given = part.velocity if motion is None else motion.velocity
    dimension = case.grid.dimension
    if not given:
        return np.zeros(dimension)
    if len(given) != dimension or not all(isinstance(v, int | float) for v in given):
        return None
    return np.array(given, dtype=float)


def meets_too_fast(case: Case, name: str) -> str:
    """Return what an entry meets too fast for contact of surfaces, and how fast; "" if nothing.

    By speeds alone: whether their ways cross is not asked.
    """
    own = velocity_at_start(case, name)
    if own is None:
        return ""
    material = case.material[case.parts()[name].material]
    waves, yields = material.sound_speed(), material.strength.model not in _ELASTIC
    most = FASTEST_IF_IT_YIELDS if yields else FASTEST
    for other, speed in _speeds(case, name, own):
        if speed > most * waves:
            return (
                f"it meets {other} at {speed / waves:.2g} of the speed of its waves, more than "
                f"{most:g}"
            )
    return ""


def _speeds(case: Case, name: str, own: NDArray[np.float64]) -> Iterator[tuple[str, float]]:
    """Yield what an entry may meet, and the speed between both [m/s]."""
    for other in case.parts() if case.contact.enabled else ():
        theirs = velocity_at_start(case, other)
        if other != name and theirs is not None:
            yield other, float(np.linalg.norm(own - theirs))
    for face, wall in enumerate(case.grid.walls):
        axis, at_end = divmod(face, 2)
        if wall == CONTACT or wall in HOLDING:
            yield f"grid.box.walls.{FACES[face]}", float(own[axis]) * (1.0 if at_end else -1.0)
