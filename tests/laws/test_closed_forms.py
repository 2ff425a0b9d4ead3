# SPDX-License-Identifier: BSD-3-Clause
"""Simple shear and stretches of single models, whose stresses have closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from motions import EPS, MODULUS, drive, falls_with_order, increments, worst

E, NU = 1e8, 0.3
LAMBDA, G = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
ELASTIC = {"E": E, "nu": NU}
RUBBER = {"K": 2.5e8, "G": 1e8}
RUBBER_LAMBDA = RUBBER["K"] - 2 / 3 * RUBBER["G"]
SHEAR = 2 * np.pi


def shear(steps: int) -> tuple[np.ndarray, np.ndarray]:
    """Simple shear to gamma = 2 pi: gamma after each step, and the increments."""
    moves = np.zeros((steps, 3, 3))
    moves[:, 0, 1] = SHEAR / steps
    return np.linspace(0, SHEAR, steps + 1), moves


@pytest.mark.parametrize("lanes", [False, True])
def test_simple_shear_with_the_jaumann_rate(lanes: bool) -> None:
    """sigma_xy = G sin gamma, sigma_xx = -sigma_yy = G (1 - cos gamma) (Dienes 1979)."""

    def error(steps: int) -> float:
        gamma, moves = shear(steps)
        stress = drive("elastic", moves, lanes, ELASTIC)
        exact = np.zeros_like(stress)
        exact[:, 0, 1] = exact[:, 1, 0] = G * np.sin(gamma)
        exact[:, 0, 0] = G * (1 - np.cos(gamma))
        exact[:, 1, 1] = -exact[:, 0, 0]
        return worst(stress - exact)

    assert error(10_000) < 1e-6
    errors = [error(steps) for steps in (250, 500, 1000)]
    assert falls_with_order(errors, 2.0, 0.0), errors


@pytest.mark.parametrize("lanes", [False, True])
def test_simple_shear_of_neo_hookean_rubber(lanes: bool) -> None:
    """sigma = G (b - 1) with b_xx = 1 + gamma^2, b_xy = gamma (Bonet & Wood 2008, eq. 6.28)."""
    steps = 10_000
    gamma, moves = shear(steps)
    stress = drive("neo_hookean", moves, lanes, RUBBER)
    exact = np.zeros_like(stress)
    exact[:, 0, 1] = exact[:, 1, 0] = RUBBER["G"] * gamma
    exact[:, 0, 0] = RUBBER["G"] * gamma**2
    # Two roundings a step of b_xx, which grows to 40; 1e-6 was asked for.
    assert worst(stress - exact) < 2 * steps * EPS * SHEAR**2 < 1e-6


def test_stretch_of_neo_hookean_rubber() -> None:
    """J sigma = lambda ln J + G (b - 1), whatever the path."""
    stretch = np.array([1.5, 0.8, 1.1])
    stress = drive("neo_hookean", increments(lambda t: np.diag(stretch**t), 300), False, RUBBER)
    jacobian = stretch.prod()
    exact = RUBBER_LAMBDA * np.log(jacobian) + RUBBER["G"] * (stretch**2 - 1)
    assert worst(stress[-1] - np.diag(exact / jacobian)) < 20 * 300 * EPS


def test_stretch_of_the_hypoelastic_model() -> None:
    """Along fixed axes: lambda tr(e) + 2 G e with the logarithmic strain e."""
    strain = np.array([0.4, -0.2, 0.1])
    exact = np.diag(LAMBDA * strain.sum() + 2 * G * strain)
    errors = []
    for steps in (50, 100, 200):
        moves = increments(lambda t: np.diag(np.exp(strain * t)), steps)
        errors.append(worst(drive("elastic", moves, False, ELASTIC)[-1] - exact))
    assert errors[-1] < 1e-5
    assert falls_with_order(errors, 2.0, 0.0), errors


def test_the_example_moduli() -> None:
    assert pytest.approx(MODULUS) == E
    assert pytest.approx(E / (3 * (1 - 2 * NU))) == LAMBDA + 2 / 3 * G
