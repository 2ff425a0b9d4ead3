# SPDX-License-Identifier: BSD-3-Clause
"""The dampings of motions that a case has."""

from __future__ import annotations

from typing import TYPE_CHECKING

from mpm3dpp.base.damping import Damping

if TYPE_CHECKING:
    from .case import Case


def dampings_of(case: Case) -> list[tuple[Damping, list[str]]]:
    """Return each damping of motions with the entries of `body` and `grains` that have it."""
    found: list[tuple[Damping, list[str]]] = []
    for name, part in case.parts().items():
        if part.damping is None:
            continue
        same = next((names for damping, names in found if damping == part.damping), None)
        if same is None:
            found.append((part.damping, [name]))
        else:
            same.append(name)
    return found
