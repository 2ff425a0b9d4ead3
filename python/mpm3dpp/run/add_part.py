# SPDX-License-Identifier: BSD-3-Clause
"""The filled bodies of an entry of a case, and what acts on bodies, handed to the core."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.settings import functions
from mpm3dpp.case.case import Case
from mpm3dpp.case.dampings import dampings_of
from mpm3dpp.case.detonation import lighting_times
from mpm3dpp.case.forces import force_programs
from mpm3dpp.case.load_pieces import add_load, pieces
from mpm3dpp.case.motion import Motion
from mpm3dpp.case.pairs import bonds_of, laws_of
from mpm3dpp.fill.initial import Overburden, start_columns
from mpm3dpp.fill.parts import FilledPart, Particles
from mpm3dpp.fill.slices import near_points
from mpm3dpp.fill.surface_points import Sharing, add_surfaces
from mpm3dpp.ranks.world import World, share_of


def add_part(
    core: Any,
    case: Case,
    part: FilledPart,
    materials: Mapping[tuple[str, str], int],
    above: Overburden | None,
    point_spacing: float | None,
    world: World | None,
) -> None:
    """Add the bodies of an entry, with their motion, loads, and what they begin with.

    Args:
        core: the core's simulation.
        case: of which the entry is.
        part: the entry.
        materials: their numbers in the core, by `kind_of`.
        above: what presses on them, where a stress is geostatic.
        point_spacing: of contact points [m]; None where bodies need none.
        world: processes that each give a share of the grains, or a slice of a body.
    """
    material = materials[kind_of(case, part)]
    if part.balls is not None:
        leader, own = _add_grains(core, case, part, material, world)
        if point_spacing is not None:
            sharing = Sharing(world, share_of(len(part.names), world)[0])
            add_surfaces(core, case, part, leader, own, point_spacing, sharing)
        return
    particles = part.own.particles if part.own else part.make(0, 1)
    positions, volumes = particles.positions, particles.volumes
    number = _add_body(core, part, particles, material)
    shared, near = None, None
    if part.own is not None and world is not None:
        shared, near = world, partial(near_points, part.own, world=world)
    motion = case.body[part.name].motion
    if motion is not None:
        _set_motion(core, number, motion, motion.middle(positions, volumes, shared))
    for name, values in start_columns(case, part, positions, volumes, above, shared).items():
        core.set_state(number, name, values)
    arrival = lighting_times(case, part.name, positions)
    if arrival is not None:
        core.set_state(number, "lighting_time", arrival)
    for name, load in case.load.items():
        if load.body == part.name:
            add_load(core, case, name, number, pieces(case, name, positions, part.spacing, near))
    if point_spacing is not None:
        add_surfaces(core, case, part, number, particles, point_spacing, Sharing(shared, 0, near))


def kind_of(case: Case, part: FilledPart) -> tuple[str, str]:
    """Return the material and the frame of an entry, which particles of one pool share."""
    return part.material, case.parts()[part.name].frame


def _add_body(core: Any, part: FilledPart, particles: Particles, material: int) -> int:
    """Hand over the particles, or those that this process has; return the body's number."""
    velocities, volumes = np.ascontiguousarray(particles.velocities), particles.volumes
    if part.own is not None:
        positions, own = np.ascontiguousarray(particles.positions), part.own
        about = (part.name, material, part.count, own.first)
        return int(core.add_slice(*about, positions, velocities, own.volume))
    equal = bool(np.all(volumes == volumes[0]))
    volumes = volumes[:1].copy() if equal else np.ascontiguousarray(volumes)
    return int(core.add_body(part.name, material, particles.positions, velocities, volumes))


def _add_grains(
    core: Any, case: Case, grains: FilledPart, material: int, world: World | None
) -> tuple[int, Particles]:
    """Hand over the grains that this process has; return these, and the number of the first."""
    first, last = share_of(len(grains.names), world)
    own = grains.share(first, last)
    counts, volumes = grains.survey.counts, grains.volumes
    leader = core.add_bodies(
        grains.names, material, counts, volumes, first, own.positions, own.velocities
    )
    arrival = lighting_times(case, grains.name, own.positions)
    if arrival is None:
        return leader, own
    begin = np.cumsum(own.counts) - own.counts
    for k in range(last - first):
        times = arrival[begin[k] : begin[k] + own.counts[k]].copy()
        core.set_state(leader + first + k, "lighting_time", times)
    return leader, own


def _set_motion(core: Any, number: int, motion: Motion, centre: np.ndarray) -> None:
    spin = motion.angular_velocity
    spin = (0.0, 0.0, *spin) if len(spin) == 1 else spin
    place = [*centre.tolist(), 0.0][:3]
    core.set_motion(number, functions(motion.velocity), functions(spin), place)


def add_actions(
    core: Any,
    case: Case,
    numbers_of: Callable[[str], list[int]],
    masses: Mapping[str, float],
    forced: Sequence[str],
) -> None:
    """Give the core the forces, dampings and frictions of a case, and what its fields need.

    Args:
        core: of the simulation.
        case: of it.
        numbers_of: the bodies that a name stands for.
        masses: of each body, and of all the grains of an entry, at the start [kg].
        forced: names of those that the program gives forces.
    """
    asked = [case.output.fields, *(probe.fields for probe in case.probe.values())]
    if any("displacement" in fields for fields in asked):
        core.keep_start_positions()
    for name in forced:
        try:
            core.add_body_force(numbers_of(name), [])
        except ValueError as error:
            raise CaseError(str(error), "leave it out of forced", key="forced") from None
    for name, part in case.parts().items():
        if programs := force_programs(part, masses[name]):
            core.add_body_force(numbers_of(name), programs)
    for damping, names in dampings_of(case):
        numbers = [number for name in names for number in numbers_of(name)]
        mass, local, _ = functions((damping.mass, damping.local))
        core.add_damping(numbers, mass, local)
    for a, b, friction, restitution in laws_of(case):
        core.set_friction(a, b, friction, restitution)
    for a, b in bonds_of(case):
        core.bond(a, b)
