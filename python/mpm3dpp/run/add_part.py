# SPDX-License-Identifier: BSD-3-Clause
"""The filled bodies of an entry of a case, handed to the core."""

from __future__ import annotations

from typing import Any

import numpy as np

from mpm3dpp.base.settings import functions
from mpm3dpp.case.case import Case
from mpm3dpp.case.detonation import lighting_times
from mpm3dpp.case.loads import add_load, pieces
from mpm3dpp.case.motion import Motion
from mpm3dpp.fill.parts import FilledPart
from mpm3dpp.ranks.world import World, share_of


def add_part(
    core: Any, case: Case, part: FilledPart, materials: dict[str, int], world: World | None
) -> None:
    """Add the bodies of an entry, with their motion, loads and times at which they are lit.

    Args:
        core: the core's simulation.
        case: of which the entry is.
        part: the entry.
        materials: their numbers in the core.
        world: processes that each give a share of the grains.
    """
    material = materials[part.material]
    if part.balls is None:
        _add_body(core, case, part, material)
    else:
        _add_grains(core, case, part, material, world)


def _add_body(core: Any, case: Case, part: FilledPart, material: int) -> None:
    body = part.body(0)
    volumes = body.volumes
    equal = bool(np.all(volumes == volumes[0]))
    number = core.add_body(
        body.name,
        material,
        body.positions,
        np.ascontiguousarray(body.velocities),
        volumes[:1].copy() if equal else np.ascontiguousarray(volumes),
    )
    motion = case.body[part.name].motion
    if motion is not None:
        _set_motion(core, number, motion, motion.middle(body.positions, volumes))
    arrival = lighting_times(case, part.name, body.positions)
    if arrival is not None:
        core.set_state(number, "lighting_time", arrival)
    for name, load in case.load.items():
        if load.body == part.name:
            found = pieces(case, name, body.positions, body.spacing)
            add_load(core, case, name, number, found)


def _add_grains(
    core: Any, case: Case, grains: FilledPart, material: int, world: World | None
) -> None:
    first, last = share_of(len(grains.names), world)
    own = grains.share(first, last)
    counts, volumes = grains.survey.counts, grains.volumes
    leader = core.add_bodies(
        grains.names, material, counts, volumes, first, own.positions, own.velocities
    )
    arrival = lighting_times(case, grains.name, own.positions)
    if arrival is None:
        return
    begin = np.cumsum(own.counts) - own.counts
    for k in range(last - first):
        times = arrival[begin[k] : begin[k] + own.counts[k]].copy()
        core.set_state(leader + first + k, "lighting_time", times)


def _set_motion(core: Any, number: int, motion: Motion, centre: np.ndarray) -> None:
    spin = motion.angular_velocity
    spin = (0.0, 0.0, *spin) if len(spin) == 1 else spin
    place = [*centre.tolist(), 0.0][:3]
    core.set_motion(number, functions(motion.velocity), functions(spin), place)
