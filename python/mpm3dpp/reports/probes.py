# SPDX-License-Identifier: BSD-3-Clause
"""The section on what probes saw."""

from __future__ import annotations

import numpy as np

from mpm3dpp.base.markup import joined, paragraph
from mpm3dpp.io.probe_tables import probe_names, read_probe
from mpm3dpp.plots.probes import draw_probes

from .document import Section
from .figures import curves
from .found import Found
from .numbers import counted


def probes(found: Found) -> Section | None:
    """Return the section on probes; None for a run without any."""
    read = {name: _table(found, name) for name in probe_names(found.folder)}
    tables = {name: table for name, table in read.items() if table and len(table["time"])}
    if not read:
        return None
    names = ", ".join(f"probes/{name}.csv" for name in read)
    parts = [paragraph(f"{counted(len(read), 'probe')}: {names}.")]
    units = found.results.units if found.results is not None else {}
    drawing = draw_probes(tables, units) if tables else None
    if drawing is not None:
        caption = (
            "What probes saw over time, each component with its sign: of positions the way from "
            "the start, of regions and bodies also the range from the least to the largest."
        )
        parts.append(curves(drawing, "probes", caption))
    return Section("probes", "Probes", joined(parts))


def _table(found: Found, name: str) -> dict[str, np.ndarray] | None:
    return found.read(lambda: read_probe(found.folder, name))
