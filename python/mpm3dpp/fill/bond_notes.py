# SPDX-License-Identifier: BSD-3-Clause
"""What a user should know of bonds: where one of the two does not deform, they hold so far only."""

from __future__ import annotations

from mpm3dpp import _core
from mpm3dpp.base.frames import MATERIAL
from mpm3dpp.case.case import Case


def bond_notes(case: Case) -> list[str]:
    """Return a sentence for each body that is bonded to one that does not deform."""
    found: dict[str, list[str]] = {}
    parts = case.parts()
    for pair in case.contact.pair:
        if not pair.bonded or not case.contact_enabled:
            continue
        names = pair.bodies or [n for n, p in parts.items() if p.material in (pair.materials or [])]
        for soft in (name for name in names if not _holds(case, name)):
            held = found.setdefault(soft, [])
            held += [name for name in names if case.is_rigid(name) and name not in held]
    affine = _core.transfers[case.run.transfer.word]["affine"]
    free = [
        f"{soft} is bonded to {' and '.join(loose)}, which is rigid and free: with "
        f'run.transfer = "{case.run.transfer.word}" such a bond takes the energy of what vibrates '
        'beside it; give run.transfer = "flip", which keeps it, or an elastic material'
        for soft, rigid in found.items()
        if affine and (loose := [name for name in rigid if not _is_driven(case, name)])
    ]
    return free + [
        f"{soft} is bonded to {' and '.join(rigid)}, which {_does(rigid)} not deform: such a bond "
        "(contact.pair.bonded) holds what is stretched beside it to 1.8 times its length at most, "
        "or sheared by 1.1, and lets go then without a word; for more hold it by a fixed face of "
        "grid.box.walls, or pull it by a traction on its side ([load.NAME])"
        for soft, rigid in found.items()
        if rigid
    ]


def _holds(case: Case, name: str) -> bool:
    """Return whether what is bonded to it holds, or it is no body that deforms."""
    return case.is_rigid(name) or case.parts()[name].frame == MATERIAL


def _is_driven(case: Case, name: str) -> bool:
    return getattr(case.parts()[name], "motion", None) is not None


def _does(names: list[str]) -> str:
    return "does" if len(names) == 1 else "do"
