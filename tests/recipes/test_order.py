# SPDX-License-Identifier: BSD-3-Clause
"""Bits depend on the case alone, not on where the particles' rows lie in memory."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from cases import each_numerics, everything
from mpm3dpp import Simulation
from mpm3dpp.bench import BENCHES, Numerics
from mpm3dpp.io.result_hash import result_hash

DISORDERS = {"never sorted": math.inf, "sorted when it pays": None, "sorted every step": 0.0}


def digest(core: Any, steps: int) -> str:
    assert core.advance(steps, 1.0) == steps
    return result_hash(core) + core.history().tobytes().hex()


@each_numerics
@pytest.mark.parametrize("dimension", [2, 3])
def test_everything(tmp_path: Path, dimension: int, scheme: str, basis: str) -> None:
    case = everything(tmp_path, dimension, scheme, basis, "slip")
    steps = 12 if scheme == "usl" else 60
    digests = {
        name: digest(Simulation(case, threads=1, disorder=share).core, steps)
        for name, share in DISORDERS.items()
    }
    assert len(set(digests.values())) == 1, digests


@pytest.mark.parametrize("scheme", ["usf", "musl"])
@pytest.mark.parametrize(
    ("name", "size"), [("spheres", 12), ("elastic3d", 6), ("jc", 6), ("debris", 6)]
)
@pytest.mark.parametrize("basis", [None, "gimp"])
def test_benchmarks(name: str, size: int, basis: str | None, scheme: str) -> None:
    """Contact of many bodies, cells that all particles cross, a plastic law with a search."""
    case = BENCHES[name].case(size, Numerics(basis=basis, scheme=scheme))
    digests = {
        disorder: digest(Simulation(case, threads=1, disorder=share).core, 80)
        for disorder, share in DISORDERS.items()
    }
    assert len(set(digests.values())) == 1, digests
