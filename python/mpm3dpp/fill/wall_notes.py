# SPDX-License-Identifier: BSD-3-Clause
"""What a user should look at again of the walls of the box."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mpm3dpp.base.errors import CaseError, key_text
from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.base.time_functions import TimeFunction
from mpm3dpp.case.case import Case
from mpm3dpp.case.frame import HOLDING, in_body
from mpm3dpp.case.grid import CONTACT, FACES

from .parts import Filled

_ON_WALL = 0.25  # Spacings from a wall within which a body on it begins.
_AWAY = 2.0  # Cells from a wall from which no node beyond it belongs to a body.


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


def _off_walls(case: Case, bodies: Filled) -> Iterator[tuple[str, str, str, float]]:
    """Yield entries on nodes of their own that begin off a wall that would hold them there.

    Of each the body that is nearest, the wall's key, and how far off it is [m].
    """
    if case.grid.box is None:
        return
    corners = case.grid.box.lower, case.grid.box.upper
    for face, wall in enumerate(case.grid.walls):
        d, at_end = divmod(face, 2)
        for name in in_body(case) if wall in HOLDING else ():
            part = bodies.parts[name]
            seen = part.survey.upper if at_end else part.survey.lower
            # Particles begin half a spacing behind the faces of bodies.
            off = np.abs(seen[:, d] - corners[at_end][d]) - 0.5 * part.spacing
            off = np.where(off > _ON_WALL * part.spacing, off, np.inf)
            if np.isfinite(off[k := int(off.argmin())]):
                yield name, part.names[k], f"grid.box.walls.{FACES[face]}", float(off[k])


def wall_mistakes(case: Case, bodies: Filled) -> Iterator[CaseError]:
    """Yield the first body of an entry whose nodes reach beyond a wall that it does not start on.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
    """
    for entry, body, wall, off in _off_walls(case, bodies):
        if off < _AWAY * case.grid.cell_size:
            rule = (
                f"does not go with {wall} {off:.3g} m from where {body} begins: slip and fixed "
                "walls hold nodes in bodies that begin on them"
            )
            remedy = f'move it there or {_AWAY:g} cells away, or make the wall "{CONTACT}"'
            yield case.error((*case.part_path(entry), "frame"), rule, remedy)


def off_walls(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence for each entry on nodes of its own that a wall will not stop.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
    """
    return [
        f"{body} begins {off:.3g} m from {wall}, which will not stop it: with frame = "
        f'"{MATERIAL}" slip and fixed walls hold bodies that begin on them; make it "{CONTACT}" if '
        "the body gets there"
        for _, body, wall, off in _off_walls(case, bodies)
    ]
