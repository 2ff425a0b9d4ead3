# SPDX-License-Identifier: BSD-3-Clause
"""The section on contacts: pairs, forces over time, and grains in the last frame."""

from __future__ import annotations

from collections import Counter

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.markup import Html, joined, paragraph, table
from mpm3dpp.io.results import Results
from mpm3dpp.plots.energies import draw_panel
from mpm3dpp.run.report import contact_table

from .document import Section
from .figures import curves
from .found import Found
from .numbers import counted, number, vector
from .pictures import FORCES, embedded

_MOST = 60  # pairs


def contacts(found: Found) -> Section:
    """Return the section on contacts."""
    parts: list[str | None] = [*_pairs(found)]
    if found.history is not None:
        drawing = draw_panel("contact", found.history, found.dimension, found.bodies)
        if drawing is not None:
            parts.append(curves(drawing, "contact", "Contact force of each pair over time."))
    parts += [_grains(found), embedded(found, found.folder / FORCES)]
    whole = [part for part in parts if part]
    if not whole:
        whole = [paragraph("No bodies have touched each other, as far as is recorded.")]
    return Section("contacts", "Contacts", joined(whole))


def _pairs(found: Found) -> list[Html]:
    """Return a sentence on contact as a whole, and the table of pairs."""
    manifest = found.manifest
    lines = contact_table(manifest) if manifest is not None else []
    if manifest is None or not lines:
        return []
    said = [line for line in lines if not line.startswith("  ")]
    parts = [paragraph(_capital(line.removeprefix("contact: "))) for line in said]
    per, cells = found.per, manifest.cell_size
    head = [
        *("bodies", "pairs", "first touch [s]", "gap then [cells]", f"impulse [N s{per}]"),
        f"friction work [J{per}]",
    ]
    touched = [pair for pair in manifest.contact.pairs if pair.first_time is not None]
    rows = []
    for pair in touched[:_MOST]:
        gap = None if pair.first_gap is None else round(pair.first_gap / cells, 2)
        rows.append(
            [
                " \N{EN DASH} ".join(pair.bodies),
                f"{pair.pairs:,}",
                number(pair.first_time),
                number(gap),
                vector(pair.impulse, found.dimension),
                number(pair.friction_work, 5),
            ]
        )
    parts += [table(head, rows)] if rows else []
    if len(touched) > _MOST:
        parts.append(paragraph(f"The other {len(touched) - _MOST:,} are in manifest.json."))
    if rows:
        parts.append(
            paragraph(
                "Impulses are on the first of the two; that of grains among themselves is not "
                "counted."
            )
        )
    return parts


def _capital(text: str) -> str:
    return f"{text[:1].upper()}{text[1:]}."


def _grains(found: Found) -> Html | None:
    """Return what the last frame tells of the contacts of grains."""
    results = found.results
    if results is None or not len(results):
        return None
    return found.read(lambda: _in_last_frame(found, results))


def _in_last_frame(found: Found, results: Results) -> Html | None:
    if "contacts" not in results.tables(-1):
        return None
    acting = results.contacts(-1)
    force = np.sqrt(sum(np.asarray(acting[f"force_{x}"], dtype=float) ** 2 for x in "xyz"))
    sentences = []
    if len(force):
        sentences.append(
            f"In the last frame {counted(len(force), 'pair acts', 'pairs act')} on each other, "
            f"with {number(force.mean(), 4)} N{found.per} in the mean and {number(force.max(), 4)} "
            f"N{found.per} at most."
        )
    counts = Counter(results.grains(-1)["name"])
    for name in [name for name, count in counts.items() if count > 1]:
        try:
            mean = results.coordination_number(-1, name)
        except CaseError:
            continue
        sentences.append(
            f"{name}: {counts[name]:,} grains, coordination number {number(mean, 4)} (bodies that "
            "a grain acts on, in the mean)."
        )
    return paragraph(" ".join(sentences)) if sentences else None
