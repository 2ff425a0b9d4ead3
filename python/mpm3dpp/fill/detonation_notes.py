# SPDX-License-Identifier: BSD-3-Clause
"""Explosives that nothing lights, and points that light nothing before the end of the run."""

from __future__ import annotations

from functools import partial

import numpy as np

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case
from mpm3dpp.case.detonation import EXPLOSIVE
from mpm3dpp.ranks.world import World, together

from .parts import Filled


def detonation_notes(case: Case, bodies: Filled, world: World | None) -> list[str]:
    """Return a sentence for each.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
        world: processes that have slices of them; each calls this.
    """
    explosives = {
        name: part
        for name, part in bodies.parts.items()
        if case.material[part.material].strength.model == EXPLOSIVE
    }
    found = []
    for name in explosives:
        if not any(not d.bodies or name in d.bodies for d in case.detonation):
            found.append(
                f"{key_text(case.part_path(name))} is of an explosive that nothing lights, so that "
                "it stays unburned; add [[detonation]] with a point"
            )
    for index, detonation in enumerate(case.detonation):
        first = np.inf
        for part in (explosives[name] for name in detonation.bodies or explosives):
            speed = case.material[part.material].strength.parameters["D"]
            for some in part.chunks():
                distance = np.linalg.norm(some.positions - np.asarray(detonation.point), axis=1)
                near = float(distance.min(initial=np.inf))
                first = min(first, detonation.time + near / speed)
        first = min(together(partial(float, first), world))
        if first > case.run.end_time:
            found.append(
                f"detonation[{index}] lights nothing before the end of the run: it reaches an "
                f"explosive at {first:.4g} s, and run.end_time = {case.run.end_time:.4g} s; "
                "move the point, or give a later end"
            )
    return found
