# SPDX-License-Identifier: BSD-3-Clause
"""What a user should look at again of what a run writes: frames, pictures, probes."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mpm3dpp.case.case import Case
from mpm3dpp.case.choices import PRESSED, SHEARED, has_fluids_alone

from .parts import Filled

_ODD = 50.0  # Times the median radius, or one over that.


def run_notes(case: Case, bodies: Filled, fastest: float) -> list[str]:
    """Return a sentence for each thing.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
        fastest: the largest sum of the speeds of a wave and of a particle at the start [m/s].
    """
    found = [*_frames(case, fastest), *_picture(case), *_probes(case, bodies)]
    return found + _odd_grains(case, bodies)


def _frames(case: Case, fastest: float) -> list[str]:
    run, frames = case.run, len(case.frame_times()) - 1
    step = run.time_step or run.cfl * case.grid.cell_size / fastest
    steps = math.ceil(run.end_time / min(step, run.largest_time_step or math.inf))
    asked = {"frames", "interval"} & case.output.model_fields_set  # No number of them is a default.
    if frames <= steps or not asked:
        return []
    key = "frames" if case.output.interval is None else "interval"
    return [
        f"output.{key} asks for {frames:,} frames in about {steps:,} steps, and there is one at a "
        "step at most; give fewer, or a smaller run.largest_time_step"
    ]


def _picture(case: Case) -> list[str]:
    strengths = (case.material[name].strength for name in case.materials_used)
    viscous = any(strength.parameters.get("viscosity") for strength in strengths)
    if case.output.picture != SHEARED or viscous or not has_fluids_alone(case):
        return []
    return [
        f'output.picture = "{SHEARED}" is a stress that the fluids of this case do not bear: the '
        f'picture has one colour; give "{PRESSED}" or "body"'
    ]


def _probes(case: Case, bodies: Filled) -> list[str]:
    """Probes that are farther from all bodies than these reach, and than they come in the run."""
    found = []
    for name, probe in case.probe.items():
        if probe.kind == "bodies":
            continue
        parts = [part for part in bodies.parts.values() if probe.body in ("", part.name)]
        lower = np.min([part.survey.lower.min(axis=0) for part in parts], axis=0)
        upper = np.max([part.survey.upper.max(axis=0) for part in parts], axis=0)
        speed = max(float(part.survey.speeds.max()) for part in parts)
        way = speed * case.run.end_time
        way += 0.5 * float(np.linalg.norm(_gravity(case))) * case.run.end_time**2
        low, high = _corners(probe)
        apart = float(np.linalg.norm(np.maximum(0.0, np.maximum(lower - high, low - upper))))
        extent = float(np.max(upper - lower))
        if apart > extent and (apart > way or probe.kind == "particle"):
            sees = "follows one far away" if probe.kind == "particle" else "may see nothing"
            found.append(
                f"probe.{name}.{probe.kind} is {apart:.4g} m from the particles that it looks at, "
                f"which reach over {extent:.4g} m, and {sees}; look at its unit (a plain number is "
                "in m)"
            )
    return found


def _odd_grains(case: Case, bodies: Filled) -> list[str]:
    """Grains of which one is so much larger or smaller than most that it is rather a slip."""
    found = []
    for name in case.grains:
        balls = bodies.parts[name].balls
        radii = case.grains[name].radii() if balls is None else balls[1]
        middle = float(np.median(radii))
        k = int(np.argmax(np.abs(np.log(radii / middle))))
        ratio = float(radii[k]) / middle
        if 1.0 / _ODD < ratio < _ODD:
            continue
        found.append(
            f"grains.{name}: {bodies.parts[name].names[k]} has a radius of {radii[k]:.4g} m, "
            f"{ratio:.3g} times the median of all; look at its unit (a plain number is in m)"
        )
    return found


def _corners(probe: object) -> tuple[np.ndarray, np.ndarray]:
    region = getattr(probe, "region", None)
    if region is not None:
        return np.asarray(region.lower), np.asarray(region.upper)
    place = np.asarray(getattr(probe, "point", ()) or getattr(probe, "particle", ()))
    return place, place


def _gravity(case: Case) -> Sequence[float]:
    return [g if isinstance(g, float) else 0.0 for g in case.run.gravity]
