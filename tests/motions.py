# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed motions of one material point, for the laws that every model obeys."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from mpm3dpp import _core

DENSITY, MODULUS = 1000.0, 1e8
EPS = np.finfo(float).eps
MODELS = [
    m.name
    for m in _core.catalogue()
    if m.kind == "strength" and m.eos != "must" and m.name != "rigid"
]
"""The strength models that give a whole stress by themselves; a rigid body has none."""

CHOSEN = {"nu": 0.3, "T_melt": 1000.0, "cp": 1000.0, "n": 0.5, "e0": 0.5, "q_phi": 0.5}
CHOSEN["tension"] = MODULUS
CHOSEN["friction_angle"] = 0.5

Motion = Callable[[float], np.ndarray]


def parameters(name: str) -> dict[str, float]:
    """Return parameters of a model: moduli and yield stresses 1e8 Pa, else CHOSEN, default or 1."""
    model = next(m for m in _core.catalogue() if m.name == name)
    values = {}
    for p in model.parameters:
        if p.default is not None and p.name not in CHOSEN:
            continue
        values[p.name] = MODULUS if p.unit == "Pa" else CHOSEN.get(p.name, 1.0)
    return values


def increments(motion: Motion, steps: int) -> np.ndarray:
    """Return velocity gradient x time step of each step, shape (steps, 3, 3).

    Args:
        motion: deformation gradient F(t) for t in [0, 1], with F(0) = 1.
        steps: of equal length.
    """
    gradients = np.array([motion(k / steps) for k in range(steps + 1)])
    return gradients[1:] @ np.linalg.inv(gradients[:-1]) - np.eye(3)


def drive(
    name: str,
    moves: np.ndarray,
    lanes: bool = False,
    constants: dict[str, float] | None = None,
) -> np.ndarray:
    """Return the Cauchy stress after each step as matrices, shape (steps + 1, 3, 3) [Pa]."""
    moves = np.ascontiguousarray(moves)
    s, _ = _core.drive_material(DENSITY, name, constants or parameters(name), moves, lanes)
    return s[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]


def rotation(axis: tuple[float, float, float], angle: float) -> np.ndarray:
    """Return the matrix of a rotation by `angle` [rad] about an axis (Rodrigues)."""
    n = np.array(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -n[2], n[1]], [n[2], 0, -n[0]], [-n[1], n[0], 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def tangled(t: float) -> np.ndarray:
    """Stretch, shear and some rotation at once, up to strains of 0.3; no symmetry."""
    a, b = np.sin(2.0 * t), 1.0 - np.cos(3.0 * t)
    return np.eye(3) + np.array(
        [
            [0.20 * a, 0.15 * b, -0.05 * a],
            [0.05 * a, -0.1 * b, 0.10 * b],
            [-0.10 * b, 0.08 * a, 0.15 * a],
        ]
    )


def worst(difference: np.ndarray) -> float:
    """Return the largest error of a stress as a share of the modulus."""
    return float(np.abs(difference).max() / MODULUS)


def falls_with_order(errors: list[float], order: float, floor: float) -> bool:
    """Tell whether each halving of the step divides the error by 2**order, or it is below `floor`.

    A tenth of the order is left for terms of higher order.
    """
    factor = 2 ** (0.9 * order)
    return all(b <= floor or a >= factor * b for a, b in pairwise(errors))
