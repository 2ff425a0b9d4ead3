# SPDX-License-Identifier: BSD-3-Clause
"""AFLIP at fixed walls (docs/decisions/0052-aflip-at-fixed-walls.md)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import SCHEMES, box
from mpm3dpp import Simulation
from turning import GRAVITY, balance, one, size, stirred


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_thin_layer_has_apic_s_bits_and_balance(dimension: int, scheme: str) -> None:
    """All of a layer of a cell reaches the wall; what that gives it beyond forces is counted."""
    found = []
    for transfer in ("apic", "aflip", {"aflip": 1.0}):
        grid = box(dimension, 12, {"y_min": "fixed"})
        run: dict[str, Any] = {"transfer": transfer, "scheme": scheme}
        sizes = (4, 1, 4)[:dimension]
        case = one(dimension, grid, (3, 0, 3), gravity=GRAVITY[:dimension], sizes=sizes, **run)
        sim = stirred(Simulation(case, 1))
        sim.advance(20)
        terms = balance(sim)
        assert np.abs(terms["walls"]).max() > 1e-4 * size(sim)
        assert np.abs(terms["numerical"]).max() < 1e-12 * size(sim)
        found.append(sim.column("body", "velocity"))
    assert np.array_equal(found[0], found[1]) and np.array_equal(found[0], found[2])
