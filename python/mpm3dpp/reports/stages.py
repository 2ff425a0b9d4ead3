# SPDX-License-Identifier: BSD-3-Clause
"""The section on where the time of the steps went."""

from __future__ import annotations

from mpm3dpp.base.markup import joined, paragraph, table

from .document import Section
from .figures import bar_cell
from .found import Found
from .numbers import counted, duration, number


def stages(found: Found) -> Section:
    """Return the section on stages: a bar for each, in the order of the step."""
    manifest, name, title = found.manifest, "stages", "Stage times"
    if manifest is None:
        return Section(name, title, paragraph("They are recorded when the run ends."))
    total = sum(manifest.stages.values())
    used = {stage: ns for stage, ns in manifest.stages.items() if ns > 0.0}
    if not used:
        return Section(name, title, paragraph("No step was made."))
    most = max(used.values())
    rows = [
        [stage, bar_cell(ns / most), number(ns, 4), f"{ns / total:.1%}"]
        for stage, ns in used.items()
    ]
    seconds = 1e-9 * total * manifest.particles * manifest.steps
    on = counted(manifest.threads, "thread") if manifest.device == "cpu" else manifest.device
    text = (
        f"{number(total, 4)} ns per particle-step on {on}, in all {duration(seconds)} of the "
        f"{duration(manifest.wall_time)} that the run took; the rest went into frames, the "
        "history, checkpoints and the start."
    )
    head = ["stage", "", "ns per particle-step", "share"]
    return Section(name, title, joined([paragraph(text), table(head, rows, words=2)]))
