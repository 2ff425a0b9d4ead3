# SPDX-License-Identifier: BSD-3-Clause
"""Sizes of particles and grains that a response of contact does not go with."""

from __future__ import annotations

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case

from .parts import Filled

_COARSE = 0.75  # Cells.
# Of the edge of the other's particles: R - 1 and 2 R - 1 in 3D (decision 0054), and some less.
_WIDE_GAP, _UNEQUAL = 0.8, 2.5
_FEW, _NARROW_GRAIN = 20, 3.0  # Grains; cells over the diameter of one.


def size_notes(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence each, on springs and on impulses."""
    return [*_springs(case, bodies), *_crowds(case, bodies)]


def _springs(case: Case, bodies: Filled) -> list[str]:
    """Sizes of particles with which springs of contact are coarse, or see bodies too late."""
    if not case.has_set_back or case.contact.response == "impulses":
        return []
    sizes = {name: part.spacing for name, part in bodies.parts.items()}
    found = [
        f"{key_text(case.part_path(name))} has particles of {size / case.grid.cell_size:.2g} "
        "cells, and springs of contact want two a cell along each axis; give smaller particles, or "
        'contact.response = "impulses"'
        for name, size in sizes.items()
        if size > _COARSE * case.grid.cell_size
    ]
    fine, coarse = min(sizes, key=sizes.__getitem__), max(sizes, key=sizes.__getitem__)
    if sizes[coarse] > _UNEQUAL * sizes[fine]:
        found.append(
            f"{key_text(case.part_path(coarse))} has particles {sizes[coarse] / sizes[fine]:.3g} "
            f"times as large as {key_text(case.part_path(fine))}, and springs of contact between "
            f"them lack up to half of their stiffness beyond {_UNEQUAL:g} times; give sizes that "
            "are closer"
        )
    if case.contact.gap_distance > _WIDE_GAP * sizes[fine]:
        found.append(
            f"contact.gap_distance = {case.contact.gap_distance:g} m is more than {_WIDE_GAP:g} of "
            f"the particles of {key_text(case.part_path(fine))} ({sizes[fine]:.3g} m), and springs "
            "reach no further; give a smaller one, or larger particles"
        )
    return found


def _crowds(case: Case, bodies: Filled) -> list[str]:
    """Grains of so few cells that six to eight of them meet at a node, with impulses."""
    if not case.contact_enabled or case.contact.response != "impulses":
        return []
    return [
        f"{key_text(case.part_path(name))} has {len(part.names):,} grains of "
        f"{2.0 * float(part.balls[1].mean()) / case.grid.cell_size:.2g} cells: where they lie "
        "close, up to eight meet at a node, and impulses of so many take hundreds of sweeps, up to "
        '27 times the time of a step; give contact.response = "springs", or smaller cells'
        for name, part in bodies.parts.items()
        if part.balls is not None
        and len(part.names) > _FEW
        and 2.0 * float(part.balls[1].mean()) < _NARROW_GRAIN * case.grid.cell_size
    ]
