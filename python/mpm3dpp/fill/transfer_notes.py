# SPDX-License-Identifier: BSD-3-Clause
"""A transfer that is given where no body has nodes in space."""

from __future__ import annotations

from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.case.case import Case
from mpm3dpp.case.choices import usual_transfer
from mpm3dpp.case.frame import all_in_bodies


def transfer_notes(case: Case) -> list[str]:
    """Return a sentence if `run.transfer` is given and does nothing."""
    if "transfer" not in case.run.model_fields_set or not all_in_bodies(case):
        return []
    if case.run.transfer.word == usual_transfer(case.grid.basis):
        return []  # as whole tables of a case have it
    return [
        "run.transfer does nothing here: it is of nodes in space, and all bodies that deform have "
        f'frame = "{MATERIAL}"; leave it out'
    ]
