# SPDX-License-Identifier: BSD-3-Clause
"""What is allowed in a case but perhaps not meant: the notes of `mpm3dpp check` and `run`."""

from __future__ import annotations

import numpy as np

from .build import FilledBody
from .case import Case
from .detonation import EXPLOSIVE


def notes(case: Case, bodies: list[FilledBody]) -> list[str]:
    """Return one sentence for each thing that a user should look at again.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
    """
    return _detonations(case, bodies)


def _detonations(case: Case, bodies: list[FilledBody]) -> list[str]:
    """Explosives that nothing lights, and points that light nothing before the end of the run."""
    explosives = {
        body.name: body
        for body in bodies
        if case.material[body.material].strength.model == EXPLOSIVE
    }
    found = []
    for name in explosives:
        if not any(not d.bodies or name in d.bodies for d in case.detonation):
            found.append(
                f"body.{name} is of an explosive that nothing lights, so that it stays unburned; "
                "add [[detonation]] with a point"
            )
    for index, detonation in enumerate(case.detonation):
        first = np.inf
        for body in (explosives[name] for name in detonation.bodies or explosives):
            distance = np.linalg.norm(body.positions - np.asarray(detonation.point), axis=1).min()
            speed = case.material[body.material].strength.parameters["D"]
            first = min(first, detonation.time + float(distance) / speed)
        if first > case.run.end_time:
            found.append(
                f"detonation[{index}] lights nothing before the end of the run: it reaches an "
                f"explosive at {first:.4g} s, and run.end_time = {case.run.end_time:.4g} s; "
                "move the point, or give a later end"
            )
    return found
