# SPDX-License-Identifier: BSD-3-Clause
"""Simple shear and stretches of single models, whose stresses have closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from motions import EPS, MODULUS, drive, falls_with_order, increments, tangled, worst

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


@pytest.mark.parametrize("lanes", [False, True])
def test_uniaxial_strain_cycle_of_a_perfectly_plastic_point(lanes: bool) -> None:
    """Load to 1 % and back: elastic with K + 4 G/3, then K eps +- 2/3 Y (Wilkins 1964).

    Strains are logarithmic. The gradient's reference to the middle of a step errs by a third of the
    cube of its strain: with 4,000 steps to 1 % that is 1e-12 of the strain.
    """
    K, G, Y = 1.3e11, 13e10 / 3, 157e6
    metal = {"E": 9 * K * G / (3 * K + G), "nu": (3 * K - 2 * G) / (6 * K + 2 * G), "Y0": Y}
    top, steps = 0.01, 8_000
    strain = np.concatenate(
        [np.linspace(0, top, steps // 2 + 1), np.linspace(top, 0, steps // 2 + 1)[1:]]
    )
    moves = np.zeros((steps, 3, 3))
    moves[:, 0, 0] = np.expm1(-np.diff(strain))
    axial = -drive("j2", moves, lanes, metal)[:, 0, 0]
    limit, stiff = Y / (2 * G), K + 4 / 3 * G
    loading = np.arange(steps + 1) <= steps // 2
    load = np.where(strain < limit, stiff * strain, K * strain + 2 / 3 * Y)
    fall = top - strain
    unload = np.where(fall < 2 * limit, K * top + 2 / 3 * Y - stiff * fall, K * strain - 2 / 3 * Y)
    exact = np.where(loading, load, unload)
    assert np.abs(axial - exact).max() < 1e-8 * exact.max()
    assert axial[steps // 2] == pytest.approx(1.404667e9, rel=1e-6)
    assert axial[-1] == pytest.approx(-1.046667e8, rel=1e-6)


@pytest.mark.parametrize("lanes", [False, True])
def test_pure_shear_of_a_linearly_hardening_point(lanes: bool) -> None:
    """tau sqrt 3 = Y0 + H ep with gamma = tau / G + sqrt 3 ep, stretched along fixed axes."""
    K, G, Y0, H = 1.3e11, 13e10 / 3, 157e6, 425e6
    metal = {
        "E": 9 * K * G / (3 * K + G),
        "nu": (3 * K - 2 * G) / (6 * K + 2 * G),
        "Y0": Y0,
        "H": H,
    }
    gamma, steps = 0.5, 20_000
    stretch = gamma / 2 / steps
    moves = np.zeros((steps, 3, 3))
    moves[:, 0, 0], moves[:, 1, 1] = np.expm1(stretch), np.expm1(-stretch)
    stress = drive("j2", moves, lanes, metal)[-1]
    plastic = (gamma - Y0 / (np.sqrt(3) * G)) / (np.sqrt(3) + H / (np.sqrt(3) * G))
    assert plastic == pytest.approx(0.28653071, rel=1e-7)
    tau = (Y0 + H * plastic) / np.sqrt(3)
    assert tau == pytest.approx(1.609511e8, rel=1e-6)
    assert np.allclose(np.diag(stress), [tau, -tau, 0.0], rtol=0, atol=1e-8 * tau)


def test_the_yield_stress_is_met_after_every_step() -> None:
    """von Mises' stress never exceeds the yield stress by more than rounding, on any path."""
    soft = {"E": MODULUS, "nu": 0.3, "Y0": 1e-3 * MODULUS}
    stress = drive("j2", increments(tangled, 500), False, soft)
    deviator = stress - np.trace(stress, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    mises = np.sqrt(1.5 * np.einsum("kij,kij->k", deviator, deviator)) / soft["Y0"]
    assert mises.max() < 1.0 + 1e-12
    assert mises[-1] > 1.0 - 1e-12
