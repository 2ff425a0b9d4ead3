# SPDX-License-Identifier: BSD-3-Clause
"""What a user should look at again of the walls of the box."""

from __future__ import annotations

from collections.abc import Iterator

from mpm3dpp.base.errors import key_text
from mpm3dpp.base.time_functions import TimeFunction
from mpm3dpp.case.box import CONTACT, FACES, HOLDING
from mpm3dpp.case.case import Case
from mpm3dpp.case.frame import in_body
from mpm3dpp.shapes.contact_points import ON_PLANE, lies_on

from .parts import Filled


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


def crossed_walls(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence for each body that a wall holds and that begins with a speed across it.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
    """
    return [
        f"{key_text(case.part_path(name))} lies on grid.box.walls.{FACES[face]}, which is "
        f"{case.grid.walls[face]} and holds it there, and begins with {abs(speed):.3g} m/s across "
        "it: what lies there begins at rest, so that its momentum and energy are off by a share of "
        f'a cell; make the wall "{CONTACT}" if it is to be hit'
        for name, face, speed in _crossings(case, bodies)
    ]


def _crossings(case: Case, bodies: Filled) -> Iterator[tuple[str, int, float]]:
    """Yield bodies on nodes of their own, the walls that hold them, and their speeds across."""
    box = case.grid.box
    if box is None:
        return
    for name in in_body(case):
        body = case.body.get(name)  # No wall holds grains.
        if body is None or not body.velocity:
            continue
        part = bodies.parts[name]
        for face, wall in enumerate(case.grid.walls):
            axis, at_end = divmod(face, 2)
            if wall not in HOLDING:
                continue
            speed, plane = body.velocity[axis], (box.lower, box.upper)[at_end][axis]
            if not isinstance(speed, int | float) or speed == 0.0:
                continue
            if body.shape is not None:
                on = lies_on(body.shape, part.spacing, (axis, plane))
            else:
                seen = (part.survey.lower, part.survey.upper)[at_end][0, axis]
                off = abs(float(seen) - plane) - 0.5 * part.spacing
                on = abs(off) < ON_PLANE * part.spacing
            if on:
                yield name, face, float(speed)
