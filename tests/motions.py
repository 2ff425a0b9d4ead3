# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed motions of one material point, for the laws that every model obeys."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from mpm3dpp import _core
from mpm3dpp.materials.point import drive_point

DENSITY, MODULUS = 1000.0, 1e8
HARD, SOFT = MODULUS, 1e-3 * MODULUS
"""A yield stress that no motion here reaches, and one that soon is reached."""
DURATION = 1e-3
"""Of a motion [s]; strains of 0.1 then have rates that models with rates feel."""
EPS = np.finfo(float).eps
_STRENGTH = [
    m for m in _core.catalogue() if m.kind == "strength" and m.eos != "must" and m.name != "rigid"
]
MODELS = [m.name for m in _STRENGTH]
"""The strength models that give a whole stress by themselves; a rigid body has none."""
PLASTIC = [m.name for m in _STRENGTH if "plastic_strain" in [s.name for s in m.state]]
CASES = [(name, HARD) for name in MODELS] + [(name, SOFT) for name in PLASTIC]
"""Every model while it is elastic, and those that yield while they flow."""

CHOSEN = {"nu": 0.3, "T_melt": 1000.0, "cp": 1.0, "n": 0.5, "e0": 0.5, "q_phi": 0.5}
CHOSEN |= {"tension": HARD, "friction_angle": 0.5, "C": 0.05}

Motion = Callable[[float], np.ndarray]


def parameters(name: str, strength: float = HARD) -> dict[str, float]:
    """Return parameters of a model: moduli 1e8 Pa, yield stresses, else CHOSEN, default or 1."""
    model = next(m for m in _core.catalogue() if m.name == name)
    values = {}
    for p in model.parameters:
        if p.default is not None and p.name not in CHOSEN:
            continue
        stress = MODULUS if p.name in ("E", "K", "G") else strength
        values[p.name] = stress if p.unit == "Pa" else CHOSEN.get(p.name, 1.0)
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
    return columns(name, moves, lanes, constants)["stress"]


def columns(
    name: str, moves: np.ndarray, lanes: bool = False, constants: dict[str, float] | None = None
) -> dict[str, np.ndarray]:
    """Return all columns of a point by name, and `stress` as matrices."""
    given, time_step = constants or parameters(name), DURATION / len(moves)
    rows, names, _ = drive_point(DENSITY, name, given, moves, lanes, time_step=time_step)
    stress = rows[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2]]]
    return dict(zip(names, rows.T, strict=True)) | {"stress": stress}


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


def deviator(stress: np.ndarray) -> np.ndarray:
    """Return the deviators of stresses of shape (n, 3, 3)."""
    return stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)


def worst(difference: np.ndarray) -> float:
    """Return the largest error of a stress as a share of the modulus."""
    return float(np.abs(difference).max() / MODULUS)


def falls_with_order(errors: list[float], order: float, floor: float) -> bool:
    """Tell whether each halving of the step divides the error by 2**order, or it is below `floor`.

    A tenth of the order is left for terms of higher order.
    """
    factor = 2 ** (0.9 * order)
    return all(b <= floor or a >= factor * b for a, b in pairwise(errors))
