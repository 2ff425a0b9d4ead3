# SPDX-License-Identifier: BSD-3-Clause
"""One number for the whole outcome of a run: equal hashes mean bitwise equal results."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

Parts = Callable[[int, str], Iterable[np.ndarray]]
"""Gives a column of a body in parts that follow one another."""


def result_hash(simulation: Any, parts: Parts | None = None) -> str:
    """SHA-256 (hexadecimal) of the final positions and velocities of all particles.

    The bytes are those of the little-endian float64 arrays (n, D), body by body in the order
    of the case, particles in their original order, positions before velocities.

    Args:
        simulation: the core's.
        parts: where nobody has whole columns.
    """
    digest = hashlib.sha256()
    for body in range(simulation.body_count):
        for name in ("position", "velocity"):
            for part in parts(body, name) if parts else [simulation.column(body, name)]:
                digest.update(np.ascontiguousarray(part, dtype="<f8").data)
    return digest.hexdigest()
