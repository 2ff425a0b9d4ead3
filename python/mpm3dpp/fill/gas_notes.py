# SPDX-License-Identifier: BSD-3-Clause
"""Gases without artificial viscosity."""

from __future__ import annotations

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case


def gas_notes(case: Case) -> list[str]:
    """Return a sentence for each gas without viscosity: a shock in it is noise that grows."""
    gases = [name for name in case.materials_used if case.material[name].matter() == "gas"]
    bare = [name for name in gases if case.viscosity_of(name) == (0.0, 0.0)]
    return [
        f"{key_text(('material', name))} is a gas without artificial viscosity: a shock in it "
        "becomes noise that may grow without limit; leave factors of 0 out"
        for name in bare
    ]
