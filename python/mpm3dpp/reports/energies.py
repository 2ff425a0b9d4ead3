# SPDX-License-Identifier: BSD-3-Clause
"""The section on energies: curves, the residual, and each term at the start and the end."""

from __future__ import annotations

import numpy as np

from mpm3dpp.base.markup import Html, element, escaped, joined, paragraph, table
from mpm3dpp.io.history import ENERGIES, TERMS
from mpm3dpp.plots.energies import draw_panel
from mpm3dpp.run.report import energies_made

from .document import Section
from .figures import curves
from .found import Found
from .numbers import number

_ROUNDING = 1e-9
"""Share of the largest energy up to which a residual is one of roundings over millions of steps;
with floats (MPM_FLOAT32) it is more."""

_CAPTIONS = {
    "energies": "Energies over time. The dashed total is all energy less the work from outside: "
    "it is straight but for what the method has made or lost.",
    "ledger": "Where energy went: the size of each other term, as a share of the largest energy.",
    "residual": "What the terms of the ledger leave unexplained.",
    "momentum": "Change of the momentum of all that takes part.",
}


def energies(found: Found) -> Section:
    """Return the section on energies."""
    manifest, history = found.manifest, found.history
    parts: list[str] = []
    if manifest is not None and manifest.energies:
        line = energies_made(manifest)[0]
        parts.append(paragraph(f"Errors of the method: {line}."))
    largest = _largest_residual(found)
    if largest is not None:
        parts.append(_residual(found, largest))
    if history is None:
        parts.append(paragraph("There is no history of energies over time to draw."))
    else:
        for name, caption in _CAPTIONS.items():
            drawing = draw_panel(name, history, found.dimension, found.bodies)
            if drawing is not None:
                parts.append(curves(drawing, name, caption))
    if history is not None or manifest is not None:
        parts.append(_terms(found))
    return Section("energies", "Energies", joined(parts))


def _largest_residual(found: Found) -> float | None:
    """Return the largest size of the residual [J]: of all steps, else of those written."""
    known = found.manifest.energies.get("residual_max") if found.manifest is not None else None
    if known is not None:
        return float(known)
    if found.history is None:
        return None
    return float(np.abs(found.history["residual"]).max())


def _residual(found: Found, largest: float) -> Html:
    size = element("strong", f"{number(largest, 3)} J{found.per}")
    energy = _largest_energy(found)
    if energy == 0.0:
        return element("p", joined(["Largest residual of the ledger: ", size, "."], ""))
    share = largest / energy
    means = "which is rounding: every term of the balance is known"
    if not share <= _ROUNDING:
        means = (
            "which is more than rounding leaves where numbers have double precision: energy came "
            "or went in a way that the ledger does not know"
        )
    text = f", {number(share, 2)} of the largest energy, {means}."
    return element("p", joined(["Largest residual of the ledger: ", size, text], ""))


def _largest_energy(found: Found) -> float:
    """Return the largest sum of kinetic and internal energy that is known [J]."""
    if found.history is not None:
        both = np.abs(found.history["kinetic"] + found.history["internal"])
        return float(np.nanmax(both, initial=0.0))
    told = found.manifest.energies if found.manifest is not None else {}
    ends = [told.get(which, {}) for which in ("initial", "final")]
    return max(abs(end.get("kinetic", 0.0) + end.get("internal", 0.0)) for end in ends)


def _terms(found: Found) -> Html:
    """Return the table of all terms that are not nil."""
    history = found.history
    told = found.manifest.energies if found.manifest is not None else {}
    rows = []
    for name in ENERGIES:
        if history is not None:
            start, end = float(history[name][0]), float(history[name][-1])
            used = bool(np.any(history[name] != 0.0))
        else:
            start, end = (told.get(w, {}).get(name, 0.0) for w in ("initial", "final"))
            used = start != 0.0 or end != 0.0
        if used or name == "residual":
            rows.append([name, _meaning(name), number(start), number(end)])
    unit = f"J{found.per}"
    return table(["term", "what it is", f"start [{unit}]", f"end [{unit}]"], rows, words=2)


def _meaning(name: str) -> Html:
    """Return the meaning of a term, with what stands between backquotes as code."""
    parts = TERMS[name]["meaning"].split("`")
    return joined([element("code", p) if k % 2 else escaped(p) for k, p in enumerate(parts)], "")
