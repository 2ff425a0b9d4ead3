# SPDX-License-Identifier: BSD-3-Clause
"""What a user should look at again of the walls of the box."""

from __future__ import annotations

from mpm3dpp.base.errors import key_text
from mpm3dpp.base.time_functions import TimeFunction
from mpm3dpp.case.box import CONTACT, FACES
from mpm3dpp.case.case import Case


def wall_notes(case: Case) -> list[str]:
    """Return a sentence for each thing: walls that hold no weight, and what `contact` lacks."""
    found = []
    for d, g in enumerate(case.run.gravity):
        if isinstance(g, TimeFunction):
            continue
        face = 2 * d + (g > 0.0)
        if g != 0.0 and case.grid.walls[face] == "absorbing":
            found.append(
                f"grid.box.walls.{FACES[face]} absorbs waves but holds no weight, and run.gravity "
                "presses on it: what stands there sinks; give slip or fixed unless that is meant"
            )
    if CONTACT not in case.grid.walls:
        return found
    pressed = [name for name, b in case.body.items() if b.initial and b.initial.stress is not None]
    if pressed and case.run.settle is None:
        found.append(
            f"body.{pressed[0]} begins with a stress, and faces of the box that are contact push "
            'only as it moves into them: give run.settle = { longest = "5 s" }, which begins from '
            "this stress"
        )
    frictions = case.grid.wall_friction(case.contact.friction)
    rigid = [name for name in case.parts() if case.is_rigid(name)]
    moves = [name for name in rigid if name not in case.body or case.body[name].motion is None]
    if moves and any(frictions):
        found.append(
            f"{key_text(case.part_path(moves[0]))} is rigid and slides on walls of the box without "
            'friction: for that give a body with motion = "fixed" in place of the wall, or a '
            "strength that deforms"
        )
    if not any(frictions) and any(pair.friction for pair in case.contact.pair):
        found.append(
            "grid.box.walls touch without friction, though pairs of bodies have some: contact.pair "
            "is of bodies; give grid.box.friction = 0.3, or 0 if that is meant"
        )
    return found
