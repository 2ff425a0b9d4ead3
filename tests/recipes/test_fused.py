# SPDX-License-Identifier: BSD-3-Clause
"""Stages that are fused give the same bits as the list of the scheme, one by one."""

from __future__ import annotations

from pathlib import Path

import pytest

from cases import BASES, SCHEMES, each_numerics, everything, three_blocks
from mpm3dpp import Case, Simulation
from mpm3dpp.io.result_hash import result_hash


def hashes(case: Case, steps: int, threads: int = 1) -> list[str]:
    """Return the hash of the state after some steps, fused and one by one, and of the history."""
    found = []
    for fused in (True, False):
        simulation = Simulation(case, threads=threads, fused=fused)
        assert simulation.advance(steps) == steps
        found.append(result_hash(simulation.core) + simulation.core.history().tobytes().hex())
    return found


@each_numerics
@pytest.mark.parametrize("dimension", [2, 3])
def test_everything(tmp_path: Path, dimension: int, scheme: str, basis: str) -> None:
    for left in ("absorbing", "slip"):
        case = everything(tmp_path, dimension, scheme, basis, left)
        one, other = hashes(case, 12 if scheme == "usl" else 40)
        assert one == other, left


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_three_blocks(dimension: int, scheme: str, basis: str) -> None:
    one, other = hashes(three_blocks(dimension, scheme, grid={"basis": basis}), 60, threads=2)
    assert one == other


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_bonded(dimension: int, scheme: str) -> None:
    case = three_blocks(dimension, scheme)
    case.contact.friction, case.contact.bonded = 0.0, True
    one, other = hashes(case, 40)
    assert one == other


def test_the_stages_differ() -> None:
    """Lest the tests above compare a list with itself."""
    case = three_blocks(2)
    fused, listed = (set(Simulation(case, fused=f).core.timers()) for f in (True, False))
    assert {"map momentum", "map forces", "move particles"} <= listed - fused
