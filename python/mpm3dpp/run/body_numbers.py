# SPDX-License-Identifier: BSD-3-Clause
"""The core's numbers of bodies, by their names."""

from __future__ import annotations

from collections.abc import Sequence

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError, nearest
from mpm3dpp.case.case import Case


def number_of(body: str, bodies: Sequence[str]) -> int:
    """Return the number of a single body.

    Args:
        body: its name.
        bodies: the names of all, in the order of their numbers.

    Raises:
        CaseError: there is none of that name.
    """
    if arguments.text("body", body) not in bodies:
        raise CaseError("is not a body of the case", nearest(body, bodies), value=body)
    return bodies.index(body)


def numbers_of(name: str, bodies: Sequence[str], case: Case) -> list[int]:
    """Return the numbers of the bodies that a name stands for.

    Args:
        name: of a body, or of an entry of `grains` for all of them.
        bodies: the names of all, in the order of their numbers.
        case: of them.

    Raises:
        CaseError: it stands for none.
    """
    if arguments.text("body", name) in case.grains:
        first = case.first_bodies()[name]
        return list(range(first, first + case.grains[name].count))
    if name not in bodies:
        known = [*bodies, *case.grains]
        raise CaseError("is not a body of the case", nearest(name, known), value=name)
    return [bodies.index(name)]
