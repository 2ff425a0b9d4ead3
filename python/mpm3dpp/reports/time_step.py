# SPDX-License-Identifier: BSD-3-Clause
"""The section on the time step: its course, and what limits it."""

from __future__ import annotations

from typing import Any

import numpy as np

from mpm3dpp.base.markup import joined, paragraph
from mpm3dpp.plots.energies import draw_panel
from mpm3dpp.plots.labels import scaled

from .document import Section
from .figures import curves
from .found import Found
from .numbers import number

_FITTED = 2  # last steps of a run that has come to its end time


def time_step(found: Found) -> Section:
    """Return the section on the time step."""
    parts = [paragraph(_range(found)), paragraph(limit_in_words(found))]
    if found.history is not None:
        drawing = draw_panel("steps", found.history, found.dimension)
        if drawing is not None:
            parts.append(curves(drawing, "steps", "Length of the time step over time."))
    return Section("time-step", "Time step", joined(parts))


def _lengths(found: Found) -> np.ndarray:
    """Return the lengths of steps in the history [s], without those fitted to the end time."""
    if found.history is None:
        return np.zeros(0)
    steps = found.history["dt"]
    if found.manifest is not None and found.manifest.status == "completed":
        is_early = found.history["step"] <= found.manifest.steps - _FITTED
        steps = steps[is_early] if np.any(steps[is_early] > 0.0) else steps
    return np.asarray(steps[steps > 0.0])


def _range(found: Found) -> str:
    steps = _lengths(found)
    if not len(steps):
        return "No step is in the history."
    low, high = float(steps.min()), float(steps.max())
    made = f"{found.steps:,} steps" if found.steps is not None else "Steps"
    if high - low <= 1e-9 * high:
        return f"{made}, all of {scaled(high, 's')}."
    return (
        f"{made} of {scaled(low, 's')} to {scaled(high, 's')}, with a median of {_middle(steps)}; "
        f"the last in the history {scaled(float(steps[-1]), 's')}."
    )


def _middle(steps: np.ndarray) -> str:
    return scaled(float(np.median(steps)), "s")


def limit_in_words(found: Found) -> str:
    """Return what limits the time step, as far as the case and the manifest tell."""
    run: dict[str, Any] = found.case.get("run", {})
    if run.get("time_step") is not None:
        text = f"The case sets all steps to {scaled(run['time_step'], 's')} (run.time_step)."
        return f"{text} {_limiter(found, run)}".strip()
    largest, steps, text = run.get("largest_time_step"), _lengths(found), ""
    if largest is not None and len(steps):
        share = float(np.mean(steps >= largest * (1 - 1e-9)))
        text = (
            f"In {share:.0%} of the rows of the history run.largest_time_step = "
            f"{scaled(largest, 's')} set the step. "
        )
    return text + (_limiter(found, run) or _unknown(found))


def _limiter(found: Found, run: dict[str, Any]) -> str:
    who = found.manifest.limiter if found.manifest is not None else None
    if who is None or found.manifest is None:
        return ""
    cell, wave, speed = _cell(found), who["sound_speed"], who["speed"]
    if not wave + speed > 0.0:
        return ""
    text = (
        f"At the end the fastest was particle {who['particle']:,} of {who['body']}: waves in it go "
        f"at {number(wave, 5)} m/s and it moves at {number(speed, 5)} m/s, so that a cell of "
        f"{scaled(cell, 'm')} is passed in {scaled(cell / (wave + speed), 's')}"
    )
    if run.get("time_step") is None and run.get("cfl") is not None:
        step = run["cfl"] * cell / (wave + speed)
        text += f"; with run.cfl = {run['cfl']:g} that allows steps of {scaled(step, 's')}"
    return f"{text}. Who was the fastest before is not recorded."


def _cell(found: Found) -> float:
    """Return the edge of a cell at the end [m]."""
    if found.history is not None and "cell_size" in found.history:
        return float(found.history["cell_size"][-1])
    return found.manifest.cell_size if found.manifest is not None else 0.0


def _unknown(found: Found) -> str:
    if found.manifest is None:
        return "What limits it is recorded when the run ends."
    return "No particle limits it: no body deforms."
