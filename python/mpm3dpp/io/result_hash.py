# SPDX-License-Identifier: BSD-3-Clause
"""One number for the whole outcome of a run: equal hashes mean bitwise equal results."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np


def result_hash(simulation: Any) -> str:
    """SHA-256 (hexadecimal) of the final positions and velocities of all particles.

    The bytes are those of the little-endian float64 arrays (n, D), body by body in the order
    of the case, particles in their original order, positions before velocities.
    """
    digest = hashlib.sha256()
    for body in range(simulation.body_count):
        for name in ("position", "velocity"):
            digest.update(np.ascontiguousarray(simulation.column(body, name), dtype="<f8").data)
    return digest.hexdigest()
