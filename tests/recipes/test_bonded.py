# SPDX-License-Identifier: BSD-3-Clause
"""Bonded bodies: one velocity at every node that they share."""

from __future__ import annotations

import numpy as np
import pytest

from cases import BASES, CELL, SCHEMES, cut_block, in_free_fall
from mpm3dpp import Contact, Simulation


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_parts_move_like_the_whole(dimension: int, scheme: str, basis: str) -> None:
    """A block cut into three bonded parts is the uncut block, to rounding (a pull opens no cut)."""
    whole, parts = (
        Simulation(in_free_fall(dimension, scheme, basis, Contact(bonded=True), bodies), threads=1)
        for bodies in cut_block(dimension)
    )
    x = whole.core.column(0, "position")
    cuts = parts.bodies
    ends = np.cumsum([0, *(len(parts.column(name, "position")) for name in cuts)])
    for k, name in enumerate(cuts):  # Filled along x first: the parts one after another.
        assert np.array_equal(parts.column(name, "position"), x[ends[k] : ends[k + 1]])
    whole.advance(100)
    parts.advance(100)
    for column, scale in (("velocity", 0.1), ("position", CELL), ("stress", 1e4)):
        bonded = np.concatenate([parts.column(name, column) for name in cuts])
        error = np.abs(bonded - whole.column("all", column)).max()
        assert error < 1e-10 * scale  # some 1e5 roundings, amplified where mass is small
    rows = parts.core.history()
    residual = rows[:, parts.core.history_columns.index("residual")]
    assert np.abs(residual).max() < 1e-12 * np.abs(rows[:, 3:5]).max()
    assert not parts.core.contact_pairs()
