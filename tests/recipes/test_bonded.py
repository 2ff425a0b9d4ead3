# SPDX-License-Identifier: BSD-3-Clause
"""Bonded bodies: one velocity at every node that they share."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, SCHEMES, block, materials
from mpm3dpp import Case, Contact, Grid, Run, Simulation


def simulation(dimension: int, scheme: str, basis: str, **bodies: Any) -> Simulation:
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis=basis),
        run=Run(
            end_time=1.0,
            scheme=scheme,
            cfl=0.2,
            gravity=(0.0, 0.0, -2.0)[3 - dimension :],
            energy_growth_limit=1e9,
        ),
        contact=Contact(bonded=True),
        material=materials(),
        body=bodies,
    )
    return Simulation(case, threads=1)


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_parts_move_like_the_whole(dimension: int, scheme: str, basis: str) -> None:
    """A block cut into three bonded parts is the uncut block, to rounding (a pull opens no cut)."""
    d = dimension
    # By formulas: the gradient of velocities that are set one by one is that of a part alone.
    field = [{"expression": e} for e in ("0.1 * x", f"0.1 * y^2 / {CELL}", "0.1 * z")][:d]
    common: dict[str, Any] = {"material": "solid", "velocity": field}
    whole = simulation(d, scheme, basis, all=block((3,) * d, (6, 4, 4)[:d], **common))
    x = whole.core.column(0, "position")
    cuts = {"a": (3, 2), "b": (5, 1), "c": (6, 3)}
    parts = simulation(
        d,
        scheme,
        basis,
        **{
            name: block((at, *(3,) * (d - 1)), (wide, 4, 4)[:d], **common)
            for name, (at, wide) in cuts.items()
        },
    )
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
