# SPDX-License-Identifier: BSD-3-Clause
"""When the failure models fail, and what is left of the stress afterwards."""

from __future__ import annotations

import numpy as np
import pytest

from motions import DENSITY, rotation
from mpm3dpp.materials.point import drive_point

E, NU = 2e11, 0.3
LAMBDA, G = E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU))
BULK = LAMBDA + 2 / 3 * G
ELASTIC = {"E": E, "nu": NU}
STEEL = {"A": 792e6, "B": 510e6, "n": 0.26, "C": 0.014, "m": 1.03, "T_melt": 1793.0, "cp": 477.0}
STEEL |= ELASTIC
DAMAGE = {"D1": 0.05, "D2": 3.44, "D3": -2.12, "D4": 0.002, "D5": 0.61}
Row = dict[str, np.ndarray]

STEP = 1e-5  # strain of a step


def drive(
    failures: list[tuple[str, dict[str, float], str]],
    moves: np.ndarray,
    strength: str = "elastic",
    constants: dict[str, float] = ELASTIC,
    lanes: bool = False,
    **more: object,
) -> Row:
    """Return columns by name, one value for each step."""
    moves = np.ascontiguousarray(moves)
    rows, names, _ = drive_point(
        DENSITY, strength, constants, moves, lanes, failures=failures, **more
    )
    return dict(zip(names, rows.T, strict=True))


def stretch(xx: float, yy: float, zz: float, steps: int) -> np.ndarray:
    """Return increments of logarithmic strain along fixed axes, the same in each step."""
    return np.tile(np.diag(np.expm1([xx, yy, zz])), (steps, 1, 1))


def normal(rows: Row) -> np.ndarray:
    """Return the stresses xx, yy, zz, shape (steps + 1, 3)."""
    return np.column_stack([rows["stress_xx"], rows["stress_yy"], rows["stress_zz"]])


def fails_at(rows: Row, step: int, action: float) -> bool:
    """Tell whether a point is intact before a step and failed from then on."""
    failed = rows["failed"]
    return bool((failed[:step] == 0).all() and (failed[step:] == action).all())


@pytest.mark.parametrize("lanes", [False, True])
@pytest.mark.parametrize(
    ("action", "number"), [("no_shear", 1.0), ("no_tension", 2.0), ("erode", 3.0)]
)
def test_principal_stress_and_what_is_left_of_it(action: str, number: float, lanes: bool) -> None:
    """Uniaxial strain in tension to (lambda + 2 G) e = limit, then back into compression."""
    limit = (LAMBDA + 2 * G) * 50.5 * STEP
    moves = np.concatenate([stretch(STEP, 0, 0, 60), stretch(-STEP, 0, 0, 120)])
    rows = drive([("principal_stress", {"limit": limit}, action)], moves, lanes=lanes)
    assert fails_at(rows, 51, number)
    stress = normal(rows)
    strain = STEP * np.concatenate([np.arange(61), np.arange(59, -61, -1)])
    assert stress[50, 0] == pytest.approx((LAMBDA + 2 * G) * 50 * STEP, rel=1e-8)
    # Afterwards there is no deviator, and the mean stress is whole or, in compression only, starts
    # anew from zero.
    after = stress[51:]
    assert np.ptp(after, axis=1).max() < 1e-9 * limit
    if action == "no_shear":
        assert np.allclose(after[:, 0], BULK * strain[51:], rtol=0, atol=1e-8 * limit)
    elif action == "erode":
        assert not after.any()
    else:
        closing = strain[51:] - np.maximum.accumulate(strain[51:])
        assert np.allclose(after[:, 0], BULK * closing, rtol=0, atol=1e-8 * limit)
        assert after.max() <= 0.0


def test_the_principal_stress_knows_no_axes() -> None:
    """Simple shear fails where G gamma is the limit, as its tension at 45 degrees."""
    moves = np.zeros((100, 3, 3))
    moves[:, 0, 1] = STEP
    rows = drive([("principal_stress", {"limit": G * 70.5 * STEP}, "no_shear")], moves)
    assert fails_at(rows, 71, 1.0)
    rows = drive([("principal_stress", {"limit": 1e6}, "no_tension")], -stretch(0.1, 0.1, 0.1, 5))
    assert not rows["failed"].any()  # compression is no tension


def test_principal_strain() -> None:
    """Extension along one axis; compression as large does not count; rotation neither."""
    limit = {"limit": 50.5 * STEP}
    pull = stretch(STEP, 0, 0, 60)
    assert fails_at(drive([("principal_strain", limit, "no_shear")], pull), 51, 1.0)
    rows = drive([("principal_strain", limit, "no_shear")], stretch(-STEP, 0, 0, 200))
    assert not rows["failed"].any()

    angle = 2 * np.pi / 2000
    turn = np.tile(rotation((1, 2, 3), angle) - np.eye(3), (2000, 1, 1))
    turned = rotation((1, 2, 3), 2000 * angle)
    pull = turned @ stretch(STEP, 0, 0, 40) @ turned.T
    moves = np.concatenate([stretch(STEP, 0, 0, 20), turn, pull])
    rows = drive([("principal_strain", limit, "no_shear")], moves)
    assert fails_at(rows, 20 + 2000 + 31, 1.0)
    strain = np.array([rows[f"strain_{c}"][-1] for c in range(6)])
    # The mid-step reference strains a turn by a fraction of the cube of its angle, every step.
    assert np.abs(strain - 60 * STEP * np.array([1, 0, 0, 0, 0, 0])).max() < 2000 * angle**3


def test_large_principal_strains_are_logarithmic() -> None:
    """To second order: with steps of 1 % the error is a third of their cubes."""
    rows = drive([("principal_strain", {"limit": 1.0}, "no_shear")], stretch(0.01, 0, 0, 80))
    assert rows["strain_0"][-1] == pytest.approx(0.8, rel=0.01**2)


def test_maximum_shear() -> None:
    """Half of s1 - s3: G (e1 - e3), whatever the pressure."""
    limit = G * 50.5 * STEP
    for mean in (0.0, 3.0, -3.0):
        moves = stretch(STEP * (mean + 0.5), STEP * mean, STEP * (mean - 0.5), 60)
        rows = drive([("maximum_shear", {"limit": limit}, "no_shear")], moves)
        assert fails_at(rows, 51, 1.0)
        assert rows["stress_xx"][-1] == pytest.approx(3 * BULK * STEP * mean * 60, abs=1e-6 * limit)


@pytest.mark.parametrize("eos", [None, ("linear", {"K": BULK})])
def test_hydrostatic_tension(eos: tuple[str, dict[str, float]] | None) -> None:
    """Spall: 3 K e = limit, with the strength's own pressure or an equation of state's."""
    limit = 3 * BULK * 50.5 * STEP
    moves = np.concatenate([stretch(STEP, STEP, STEP, 60), stretch(-STEP, -STEP, -STEP, 120)])
    rows = drive([("hydrostatic_tension", {"limit": limit}, "no_tension")], moves, eos=eos)
    assert fails_at(rows, 51, 2.0)
    stress = normal(rows)
    assert np.allclose(stress[51:61], 0.0, atol=1e-6)
    # 60 steps out and 120 back: with an equation of state the gap closes first.
    pressed = 120 if eos is None else 60
    assert stress[-1, 0] == pytest.approx(-3 * BULK * pressed * STEP, rel=1e-2)
    still = drive([("hydrostatic_tension", {"limit": limit}, "no_tension")], -moves, eos=eos)
    assert not still["failed"][:61].any()


def test_energy_limit() -> None:
    """Elastic energy 9/2 K e^2 of a volume change with a linear equation of state."""
    limit = 4.5 * BULK * (50.5 * STEP) ** 2
    moves = stretch(-STEP, -STEP, -STEP, 60)
    eos = ("linear", {"K": BULK})
    rows = drive([("energy_limit", {"limit": limit}, "no_shear")], moves, eos=eos)
    energy = rows["internal_energy"]
    assert fails_at(rows, 52, 1.0)  # the step after the limit is passed
    assert energy[50] < limit < energy[51]
    assert energy[50] == pytest.approx(4.5 * BULK * (50 * STEP) ** 2, rel=2e-3)
    with pytest.raises(ValueError, match="needs an internal energy"):
        drive([("energy_limit", {"limit": limit}, "no_shear")], moves)


@pytest.mark.parametrize("lanes", [False, True])
@pytest.mark.parametrize("mean", [-0.4, 0.0, 0.4])
def test_johnson_cook_damage(mean: float, lanes: bool) -> None:
    """Perfectly plastic at a constant triaxiality and rate the strain at fracture is the formula's.

    The plastic flow is a shear along fixed axes at constant volume; the mean stress comes before
    it, elastically, as `mean` times the yield stress.
    """
    Y, rate0, dt = 1e9, 1.0, 1e-6
    metal = ELASTIC | {"Y0": Y}
    swell = mean * Y / BULK / 3
    step = 1e-3
    moves = np.concatenate([stretch(swell, swell, swell, 1), stretch(step, -step, 0, 8000)])
    failure = ("johnson_cook_damage", DAMAGE | {"rate0": rate0}, "no_tension")
    rows = drive([failure], moves, "j2", metal, lanes, time_step=dt)
    rate = 2 * step / np.sqrt(3) / dt
    exact = DAMAGE["D1"] + DAMAGE["D2"] * np.exp(DAMAGE["D3"] * mean)
    exact *= 1 + DAMAGE["D4"] * np.log(rate / rate0)
    first = int(np.argmax(rows["failed"] > 0))
    assert fails_at(rows, first, 2.0)
    # The strain is found within a step, and the first step, part elastic, has another rate.
    assert rows["plastic_strain"][first] == pytest.approx(exact, abs=2 * step * 2 / np.sqrt(3))
    slope = np.diff(rows["plastic_strain"]) / np.maximum(np.diff(rows["damage"]), 1e-300)
    assert slope[first // 2] == pytest.approx(exact, rel=1e-4)
    assert rows["damage"][first] >= 1.0 > rows["damage"][first - 1]


def test_johnson_cook_damage_of_a_heated_metal() -> None:
    """The temperature delays fracture by 1 + D5 T*, T* of the strength model."""
    moves = stretch(1e-3, -1e-3, 0, 200)
    failure = ("johnson_cook_damage", DAMAGE | {"D4": 0.0}, "no_shear")
    rows = drive([failure], moves, "johnson_cook", STEEL, time_step=1e-6)
    dep, dd = np.diff(rows["plastic_strain"]), np.diff(rows["damage"])
    star = (rows["temperature"][1:] - 298.0) / (1793.0 - 298.0)
    flow = dep > 1e-4
    exact = (DAMAGE["D1"] + DAMAGE["D2"]) * (1 + DAMAGE["D5"] * star)
    assert flow.sum() > 150
    assert star[-1] > 0.05
    assert np.allclose((dep / np.maximum(dd, 1e-300))[flow], exact[flow], rtol=1e-4)


def test_a_strain_at_fracture_below_zero_does_no_damage() -> None:
    """Where the constants give a strain at fracture below zero they do not hold."""
    failure = ("johnson_cook_damage", {"D1": -1.0, "D2": 0.0, "D3": 0.0}, "no_shear")
    rows = drive([failure], stretch(1e-3, -1e-3, 0, 20), "j2", ELASTIC | {"Y0": 1e9})
    assert rows["plastic_strain"][-1] > 0.01
    assert (rows["damage"] == 0).all()


def test_triaxialities_above_one_and_a_half_count_as_that() -> None:
    """Johnson & Cook 1985 give their formula for s* <= 1.5 only."""
    Y = 1e8
    swell = 4.0 * Y / BULK / 3
    moves = np.concatenate([stretch(swell, swell, swell, 1), stretch(1e-3, -1e-3, 0, 50)])
    failure = ("johnson_cook_damage", DAMAGE | {"D4": 0.0}, "no_shear")
    rows = drive([failure], moves, "j2", ELASTIC | {"Y0": Y})
    exact = DAMAGE["D1"] + DAMAGE["D2"] * np.exp(1.5 * DAMAGE["D3"])
    slope = np.diff(rows["plastic_strain"])[5:20] / np.diff(rows["damage"])[5:20]
    assert slope == pytest.approx(np.full(15, exact), rel=1e-6)


def test_of_two_models_the_stronger_action_is_done() -> None:
    first = ("maximum_shear", {"limit": 20.5 * G * STEP / 2}, "no_shear")
    second = ("principal_strain", {"limit": 40.5 * STEP}, "no_tension")
    for failures in ([first, second], [second, first]):
        rows = drive(failures, stretch(STEP, 0, 0, 60))
        failed = rows["failed"]
        assert (failed[:11] == 0).all()
        assert (failed[11:41] == 1).all() or (failed[21:41] == 1).all()
        assert (failed[41:] == 2).all()


@pytest.mark.parametrize("lanes", [False, True])
def test_debris_that_closes_by_more_than_its_first_volume(lanes: bool) -> None:
    """A torn particle of 90 times its volume has no stress, whatever it closes by in a step.

    p = (A + B E) / (1 + B dV / 2) has a pole at dV = -2 / B, B = 1.97 here, in initial volumes.
    """
    eos = ("mie_gruneisen", {"c0": 5350.0, "s": 1.34, "gamma0": 1.97})
    wide = stretch(0.0225, 0.0225, 0.0225, 67)
    failure = ("hydrostatic_tension", {"limit": 1e9}, "no_tension")
    for closing in np.linspace(0.002, 0.006, 41):
        moves = np.concatenate([wide, stretch(-closing, -closing, -closing, 1)])
        rows = drive([failure], moves, "elastic", ELASTIC, lanes, eos=eos)
        assert rows["failed"][-1] == 2.0
        assert rows["volume"][-2] > 80.0
        # The stress of the strength model, some GPa, is dropped to rounding.
        assert abs(rows["stress_xx"][-1]) < 1e-6
