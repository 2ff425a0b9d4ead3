# SPDX-License-Identifier: BSD-3-Clause
"""What is allowed in a case but perhaps not meant: the notes of `mpm3dpp check` and `run`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from mpm3dpp.base.errors import key_text
from mpm3dpp.base.frames import MATERIAL, UPDATED
from mpm3dpp.base.model import CaseModel
from mpm3dpp.case.box import CONTACT
from mpm3dpp.case.case import Case
from mpm3dpp.case.detonation import EXPLOSIVE
from mpm3dpp.case.frame import in_body
from mpm3dpp.case.initial import GEOSTATIC
from mpm3dpp.case.moduli import damping_viscosity, moduli_of
from mpm3dpp.ranks.world import World

from .bond_notes import bond_notes
from .detonation_notes import detonation_notes
from .explosive_notes import explosive_notes
from .friction_notes import friction_notes
from .gas_notes import gas_notes
from .initial import at_rest
from .interference import Interference, beyond_walls, interference_notes
from .parts import Filled, FilledPart
from .response_notes import response_notes
from .run_notes import run_notes
from .settling import settling_notes
from .shape_notes import shape_notes
from .size_notes import size_notes
from .stretch_notes import stretch_notes
from .surface_notes import surface_notes
from .surface_points import MOST_CFL, surfaces_touch
from .transfer_notes import transfer_notes
from .unit_notes import unit_notes
from .wall_notes import crossed_walls, wall_notes

_INCOMPRESSIBLE = 0.45
_STIFFEST = 0.499
_NARROW = 2.4  # Cells.
_SEEN = 0.1  # Cells: a fifth of an edge; a lattice stands out by less.
_STEEPEST = math.sqrt(3.0)  # q_phi = 6 sin(phi) / (sqrt(3) (3 - sin(phi))) at 90 degrees


def notes(case: Case, bodies: Filled, world: World | None = None) -> list[str]:
    """Return one sentence for each thing that a user should look at again.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
        world: processes that have slices of them; each calls this.
    """
    found = [
        *_renamed(case),
        *_materials(case),
        *_rigid(case),
        *bond_notes(case),
        *detonation_notes(case, bodies, world),
        *wall_notes(case),
        *crossed_walls(case, bodies),
        *surface_notes(case, bodies),
        *transfer_notes(case),
        *friction_notes(case),
        *gas_notes(case),
        *response_notes(case),
        *explosive_notes(case),
        *_beyond_strength(case),
        *_locking(case),
        *size_notes(case, bodies),
        *settling_notes(case, bodies),
        *interference_notes(case, bodies.interferences),
        *beyond_walls(case),
        *shape_notes(case),
        *_narrow(case, bodies),
        *stretch_notes(case, bodies),
    ]
    found += run_notes(case, bodies, fastest(case, bodies))
    return found + unit_notes(case, bodies)


def with_overlap(
    told: list[str], case: Case, contact: dict[str, Any], drawn: list[Interference]
) -> list[str]:
    """Return notes with one on bodies that overlapped at the start more than particles' places do.

    It takes the place of those on bodies that are drawn into each other.

    Args:
        told: the other notes.
        case: that which is run.
        contact: `contact_summary()` of the core, with the bodies in it.
        drawn: bodies that are drawn into each other.
    """
    count, most = contact["set_back_particles"], contact["set_back_most"]
    if most < _SEEN * case.grid.cell_size:
        return told
    loose = [one for one in drawn if not one.pressed]
    known = interference_notes(case, loose)
    frame = f'frame = "{UPDATED}" and ' if in_body(case) else ""
    who = "".join(
        f"; body.{one.second} is drawn {one.depth:.3g} m into body.{one.first}: give "
        f'{frame}contact.interference = "pressed" if that is a press fit'
        for one in loose
    )
    whose = "contact points" if in_body(case) else "particles"
    return [note for note in told if note not in known] + [
        f"bodies overlap at the start by up to {most:.3g} m; the surfaces of {count:,} {whose} "
        f"are set back by that, so that contact does not throw them apart{who}"
    ]


def fastest(case: Case, bodies: Filled) -> float:
    """Return the largest sum of the speeds of a wave and of a particle at the start [m/s].

    That of particles does not count where nodes lie in the body.
    """
    sound = {}
    for name, part in case.parts().items():
        material = case.material[part.material]
        c = 0.0 if case.is_rigid(name) else material.sound_speed()
        q = damping_viscosity(material, part.frame) / material.density / case.grid.cell_size
        sound[name] = q + float(np.hypot(q, c))
    found = 0.0
    for name, filled in bodies.parts.items():
        moves = case.parts()[name].frame != MATERIAL
        found = max(found, sound[name] + moves * float(filled.survey.speeds.max()))
    return found


def _renamed(case: Case) -> list[str]:
    """Keys by the names that they had in the release before."""
    tables: dict[str, CaseModel] = {"grid": case.grid, "run": case.run, "contact": case.contact}
    return [
        f"{name}.{before} is named {name}.{now} now; the next release will not know the old name"
        for name, table in tables.items()
        for before, now in table.renamed_keys().items()
    ]


def _materials(case: Case) -> list[str]:
    """Numbers that are allowed but mostly come from another convention."""
    found = []
    for name in case.materials_used:
        material = case.material[name]
        strength, key = material.strength, f"material.{name}"
        for failure in material.failure:
            third = failure.parameters.get("D3", 0.0)
            if failure.model == "johnson_cook_damage" and third > 0.0:
                found.append(
                    f"{key}.failure.johnson_cook_damage.D3 = {third:g} is > 0, so that tension "
                    "makes the metal tougher; here tension is positive, as Johnson and Cook write "
                    "it: give codes' numbers for pressure with the other sign"
                )
        friction = strength.parameters.get("q_phi", 0.0)
        if strength.model == "drucker_prager" and friction > _STEEPEST:
            found.append(
                f"{key}.strength.drucker_prager.q_phi = {friction:g} is more than any angle of "
                f"friction gives ({_STEEPEST:.3g} at 90 deg); it is a slope, not an angle"
            )
        if material.eos is not None and material.eos.model == "jwl" and strength.model != EXPLOSIVE:
            found.append(
                f"{key}.eos.jwl is of the products of an explosive, but its strength "
                f"{strength.model} does not detonate: the whole energy E0 presses from the start; "
                f"give strength = {{ {EXPLOSIVE} = ... }} unless that is meant"
            )
    return found


def _beyond_strength(case: Case) -> list[str]:
    """Geostatic stresses that a soil without cohesion yields under (Rankine 1857)."""
    found = []
    for name, body in case.body.items():
        given = case.material[body.material].strength.parameters
        if body.initial is None or body.initial.stress != GEOSTATIC:
            continue
        if "friction_angle" not in given or given.get("cohesion"):
            continue
        sine = math.sin(given["friction_angle"])
        least, K0 = (1.0 - sine) / (1.0 + sine), at_rest(case.material[body.material], body.initial)
        if not least <= K0 <= 1.0 / least:
            found.append(
                f"body.{name}.initial.K0 = {K0:.3g} is beyond the strength of {body.material}, "
                f"which yields at once; give one between {least:.3g} and {1.0 / least:.3g}"
            )
    return found


def _rigid(case: Case) -> list[str]:
    """Bodies that move by the laws of Newton and pass through others."""
    rigid = [name for name in case.body if case.is_rigid(name)]
    free = [name for name in rigid if case.body[name].motion is None]
    if not case.contact_enabled or not free or len(rigid) < 2:
        return []
    return [
        f"body.{free[0]} is rigid and passes through the other rigid bodies "
        f"({', '.join(name for name in rigid if name != free[0])}): bodies that do not deform do "
        "not act on each other; give one of the two a strength that deforms if they meet"
    ]


def _locking(case: Case) -> list[str]:
    """Solids that hardly change their volume, in cells that make them too stiff.

    Nodes that lie in the body do not: quadratic functions do not lock where they bend.
    """
    found = []
    bend = {
        part.material
        for part in case.parts().values()
        if part.frame != MATERIAL and getattr(part, "motion", None) is None
    }
    for name in case.materials_used:
        material = case.material[name]
        moduli = moduli_of(material)
        nu = moduli.nu if moduli else 0.0
        if nu > _INCOMPRESSIBLE and not material.volume_averaging and name in bend:
            found.append(
                f"material.{name} has nu = {nu:.9g}, nearly incompressible, and is too stiff where "
                f"it bends; give material.{name}.volume_averaging = true"
            )
        if nu > _STIFFEST:
            found.append(
                f"material.{name} has nu = {nu:.9g}: waves are {_wave(nu) / _wave(_STIFFEST):.3g} "
                f"times as fast as with {_STIFFEST:g}, steps that much shorter, and its volume "
                "changes hardly less; give that"
            )
    return found


def _wave(nu: float) -> float:
    """Return the speed of pressure waves over sqrt(E / rho)."""
    return math.sqrt((1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu)))


def refuse_time_step(case: Case, bodies: Filled) -> None:
    """Refuse a time step with which the run does not start.

    Raises:
        CaseError: it is larger than the largest stable step at the start.
    """
    touch = surfaces_touch(case, bodies.parts.values())
    most = MOST_CFL if touch else 1.0
    given, stable = case.run.time_step, most * case.grid.cell_size / fastest(case, bodies)
    if given is not None and given > stable:
        rule = f"is larger than the largest stable step, about {stable:.3g} s at the start"
        if touch:
            rule += f", {most:g} of a cell: contact between surfaces bears no more"
        raise case.error(
            ("run", "time_step"), rule, "give a smaller one, or leave it out", value=given
        )


def _narrow(case: Case, bodies: Filled) -> list[str]:
    """Bodies of so few cells that they neither bend nor rebound as they should."""
    found = []
    for name, part in bodies.parts.items():
        width = math.inf if case.is_rigid(name) else _width(case, part)
        if width < _NARROW:
            found.append(
                f"{key_text(case.part_path(name))} is {width:.2g} cells wide, too stiff and "
                "a poor rebound; give smaller cells"
            )
    return found


def _width(case: Case, part: FilledPart) -> float:
    """Return the least extent of a body [cells], but along axes where walls hold both ends."""
    least = math.inf
    for axis in range(case.grid.dimension):
        if {"free", CONTACT} & set(case.grid.walls[2 * axis : 2 * axis + 2]):
            extents = part.survey.upper[:, axis] - part.survey.lower[:, axis]
            least = min(least, (float(extents.min()) + part.spacing) / case.grid.cell_size)
    return least
