# SPDX-License-Identifier: BSD-3-Clause
"""Soils in the tests of a soil laboratory, whose failure has a closed form."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from motions import DENSITY
from mpm3dpp.materials.point import drive_point

E, NU = 2e7, 0.3
COHESION, ANGLE, CELL = 1e4, np.pi / 6, 1e5
N = 3.0  # tan^2(45 deg + angle / 2)
COULOMB = {"E": E, "nu": NU, "cohesion": COHESION, "friction_angle": ANGLE, "tension": 1e9}
SINE = np.sin(ANGLE)
# The outer cone: through the corners of triaxial compression.
CONE = {
    "E": E,
    "nu": NU,
    "q_phi": 6 * SINE / (np.sqrt(3) * (3 - SINE)),
    "k_phi": 6 * COHESION * np.cos(ANGLE) / (np.sqrt(3) * (3 - SINE)),
    "tension": 1e9,
}
Row = dict[str, np.ndarray]


def drive(name: str, constants: dict[str, float], moves: np.ndarray, lanes: bool = False) -> Row:
    """Return columns by name, one value for each step."""
    rows, names, _ = drive_point(DENSITY, name, constants, np.ascontiguousarray(moves), lanes)
    return dict(zip(names, rows.T, strict=True))


def diagonal(strains: np.ndarray) -> np.ndarray:
    """Return increments for steps of logarithmic strains, shape (steps, 3)."""
    return np.expm1(strains)[:, :, None] * np.eye(3)


@cache
def triaxial(
    name: str, chosen: tuple[tuple[str, float], ...], axial: float, steps: int, cell: float
) -> tuple[Row, np.ndarray]:
    """Squeeze to a cell pressure, then strain along z at constant lateral stress.

    The lateral strain of each step is found by the secant method, which meets the stress to
    rounding, as the models are linear in pieces but for terms of second order. Returns the columns
    and the strains of each step, shape (steps + 1, 3).
    """
    constants = dict(chosen)
    bulk = E / (3 * (1 - 2 * NU))
    strains = np.array([3 * [-cell / (3 * bulk)]])

    def lateral(last: np.ndarray) -> float:
        return drive(name, constants, diagonal(np.vstack([strains, last])))["stress_xx"][-1]

    guess = 0.0
    for _ in range(steps):
        e = [guess, guess + 1e-3 * abs(axial) / steps]
        f = [lateral(np.array([[x, x, axial / steps]])) + cell for x in e]
        for _ in range(30):
            if abs(f[1]) < 1e-9 * E * 1e-3 or f[1] == f[0]:
                break
            e = [e[1], e[1] - f[1] * (e[1] - e[0]) / (f[1] - f[0])]
            f = [f[1], lateral(np.array([[e[1], e[1], axial / steps]])) + cell]
        guess = e[1]
        strains = np.vstack([strains, [guess, guess, axial / steps]])
    return drive(name, constants, diagonal(strains)), strains


def test_the_cone_of_the_example() -> None:
    assert CONE["q_phi"] == pytest.approx(0.692820, abs=1e-6)
    assert CONE["k_phi"] == pytest.approx(12_000)


@pytest.mark.parametrize("name", ["mohr_coulomb", "drucker_prager"])
def test_triaxial_compression(name: str) -> None:
    """The axial pressure at failure is N p + 2 c sqrt N; Terzaghi 1943, sec. 7."""
    constants = COULOMB if name == "mohr_coulomb" else CONE
    rows, strains = triaxial(name, tuple(constants.items()), -0.06, 40, CELL)
    assert np.allclose(rows["stress_xx"][2:], -CELL, rtol=1e-9, atol=0)
    failure = N * CELL + 2 * COHESION * np.sqrt(N)
    assert failure == pytest.approx(334_641, abs=0.5)
    assert -rows["stress_zz"][-1] == pytest.approx(failure, rel=1e-8)
    # Up to failure it is elastic: the axial pressure rises by E times the strain.
    assert -rows["stress_zz"][2] == pytest.approx(CELL + E * 0.06 / 40, rel=1e-3)
    # Without dilation the volume stays once the stress does.
    assert abs(strains[-1].sum()) < 1e-6 * 0.06


@pytest.mark.parametrize("name", ["mohr_coulomb", "drucker_prager"])
def test_dilation_in_triaxial_compression(name: str) -> None:
    """Once the stress is constant, all strain is plastic and the volume grows as the flow says."""
    psi = np.radians(10.0)
    if name == "mohr_coulomb":
        constants = COULOMB | {"dilation_angle": psi}
        expected = 2 * np.sin(psi) / (1 - np.sin(psi))
    else:
        q = 6 * np.sin(psi) / (np.sqrt(3) * (3 - np.sin(psi)))
        constants = CONE | {"q_psi": q}
        expected = q / (1 / np.sqrt(3) - q / 3)
    rows, strains = triaxial(name, tuple(constants.items()), -0.06, 40, CELL)
    # The gradient's reference to the middle of a step errs by a third of the square of its strain.
    near = 4 * (0.06 / 40) ** 2
    assert strains[-1].sum() / -strains[-1, 2] == pytest.approx(expected, rel=near)
    growth = np.log(rows["volume"][-1] / rows["volume"][-2])
    assert growth == pytest.approx(strains[-1].sum(), rel=1e-9)
    # The plastic strain grows by sqrt(2/3 e:e), the work lost by the stress times the strain.
    equivalent = np.sqrt(2 / 3) * np.linalg.norm(strains[-1])
    assert np.diff(rows["plastic_strain"])[-1] == pytest.approx(equivalent, rel=near)
    lost = -CELL * 2 * strains[-1, 0] + rows["stress_zz"][-1] * strains[-1, 2]
    volume = rows["volume"][-2:].mean()
    assert np.diff(rows["dissipated"])[-1] == pytest.approx(lost * volume, rel=1e-5)


def test_triaxial_extension() -> None:
    """Relieved along z the soil fails where the cell pressure is N s + 2 c sqrt N."""
    rows, _ = triaxial("mohr_coulomb", tuple(COULOMB.items()), 0.06, 40, CELL)
    failure = (CELL - 2 * COHESION * np.sqrt(N)) / N
    assert -rows["stress_zz"][-1] == pytest.approx(failure, rel=1e-8)


@pytest.mark.parametrize("lanes", [False, True])
def test_pure_shear_of_mohr_and_coulomb(lanes: bool) -> None:
    """With no mean stress and no dilation the shear stress at failure is c cos(phi)."""
    moves = diagonal(np.tile([1e-5, -1e-5, 0.0], (200, 1)))
    rows = drive("mohr_coulomb", COULOMB, moves, lanes)
    tau = COHESION * np.cos(ANGLE)
    assert rows["stress_xx"][-1] == pytest.approx(tau, rel=1e-8)
    assert rows["stress_yy"][-1] == pytest.approx(-tau, rel=1e-8)
    assert abs(rows["stress_zz"][-1]) < 1e-4 * tau


def test_pure_shear_of_drucker_and_prager() -> None:
    moves = diagonal(np.tile([1e-5, -1e-5, 0.0], (200, 1)))
    rows = drive("drucker_prager", CONE, moves)
    assert rows["stress_xx"][-1] == pytest.approx(CONE["k_phi"], rel=1e-4)  # mean stress: E d^2


@pytest.mark.parametrize(
    ("tension", "expected"), [(0.0, 0.0), (5e3, 5e3), (1e9, 2 * COHESION / np.sqrt(N))]
)
def test_uniaxial_tension_of_mohr_and_coulomb(tension: float, expected: float) -> None:
    """The limit of a bar: the tension given, or where the shear failure comes first."""
    constants = COULOMB | {"tension": tension}
    rows, _ = triaxial("mohr_coulomb", tuple(constants.items()), 2e-3, 20, 0.0)
    assert rows["stress_zz"][-1] == pytest.approx(expected, rel=1e-8, abs=1e-6 * COHESION)


@pytest.mark.parametrize("tension", [0.0, 5e3, 1e9])
@pytest.mark.parametrize("name", ["mohr_coulomb", "drucker_prager"])
def test_the_same_tension_on_all_sides(name: str, tension: float) -> None:
    """No more than the apex of the cone, and back in compression the soil bears again."""
    if name == "mohr_coulomb":
        constants, apex = COULOMB, COHESION / np.tan(ANGLE)
    else:
        constants, apex = CONE, CONE["k_phi"] / CONE["q_phi"]
    strains = np.concatenate([np.full((20, 3), 1e-4), np.full((25, 3), -1e-4)])
    rows = drive(name, constants | {"tension": tension}, diagonal(strains))
    expected = min(tension, apex)
    for axis in ("xx", "yy", "zz"):
        at = rows[f"stress_{axis}"]
        assert at[20] == pytest.approx(expected, abs=1e-8 * COHESION)
        bulk = E / (3 * (1 - 2 * NU))
        assert at[-1] == pytest.approx(expected - bulk * 75e-4, rel=1e-6)


def test_the_corner_of_cone_and_tension() -> None:
    """Stretched and sheared beyond both limits, Drucker and Prager's soil stays at their corner."""
    tension = 5e3
    strains = np.tile([2e-4, 0.5e-4, -0.5e-4], (100, 1))
    rows = drive("drucker_prager", CONE | {"tension": tension, "q_psi": 0.2}, diagonal(strains))
    stress = np.array([rows[f"stress_{a}"][-1] for a in ("xx", "yy", "zz")])
    mean = stress.mean()
    tau = np.sqrt(0.5 * ((stress - mean) ** 2).sum())
    assert mean == pytest.approx(tension, rel=1e-9)
    assert tau == pytest.approx(CONE["k_phi"] - CONE["q_phi"] * tension, rel=1e-9)


def test_plane_of_failure_of_a_turned_block() -> None:
    """The model knows no axes: pure shear as simple shear gives the same limit."""
    moves = np.zeros((400, 3, 3))
    moves[:, 0, 1] = 1e-5
    rows = drive("mohr_coulomb", COULOMB, moves)
    stress = np.array(
        [
            [rows["stress_xx"][-1], rows["stress_xy"][-1]],
            [rows["stress_xy"][-1], rows["stress_yy"][-1]],
        ]
    )
    s = np.linalg.eigvalsh(stress)
    assert s[1] * (1 + SINE) - s[0] * (1 - SINE) == pytest.approx(
        2 * COHESION * np.cos(ANGLE), rel=1e-9
    )
    assert rows["stress_xy"][-1] == pytest.approx(COHESION * np.cos(ANGLE), rel=1e-2)
