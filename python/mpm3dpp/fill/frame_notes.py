# SPDX-License-Identifier: BSD-3-Clause
"""Keys that do nothing where all bodies have nodes of their own."""

from __future__ import annotations

from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.case.case import Case


def frame_notes(case: Case) -> list[str]:
    """Return a sentence if `run.transfer` is given."""
    deform = [part for name, part in case.parts().items() if not case.is_rigid(name)]
    if not deform or any(part.frame != MATERIAL for part in deform):
        return []
    if "transfer" not in case.run.model_fields_set:
        return []
    return [
        "run.transfer does nothing here: it is of nodes in space, and all bodies that deform have "
        f'frame = "{MATERIAL}"; leave it out'
    ]
