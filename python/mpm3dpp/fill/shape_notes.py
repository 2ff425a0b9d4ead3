# SPDX-License-Identifier: BSD-3-Clause
"""Bodies whose particles show their shape less well than a user may think."""

from __future__ import annotations

from mpm3dpp.case.case import Case
from mpm3dpp.shapes.shells import LATTICE


def shape_notes(case: Case) -> list[str]:
    """Return a sentence for each body that was round, and is cut so that no shells fill it."""
    return [
        f"body.{name} was round before it was cut, and shells fill only what is whole, bored about "
        "its axis or cut through its middle: a lattice fills it, so that what is left of its round "
        "surface has steps, and contact there is stiffer than that of a whole one; cut it through "
        f'its middle, give more particles_per_cell, or fill = "{LATTICE}" if that is meant'
        for name, body in case.body.items()
        if body.is_weighted(case.preset)
    ]
