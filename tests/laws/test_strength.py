# SPDX-License-Identifier: BSD-3-Clause
"""What every strength model of the catalogue obeys, to the order of its scheme."""

from __future__ import annotations

import numpy as np
import pytest

from motions import (
    CASES,
    EPS,
    MODELS,
    MODULUS,
    PLASTIC,
    SOFT,
    columns,
    deviator,
    drive,
    falls_with_order,
    increments,
    parameters,
    rotation,
    tangled,
    worst,
)
from mpm3dpp import _core
from mpm3dpp.materials.point import drive_point

STEPS = (100, 200, 400)
# A model without a scheme is exact but for some ten roundings in each step.
FLOOR = 10 * STEPS[-1] * EPS


def test_the_catalogue_is_not_empty() -> None:
    assert {"elastic", "neo_hookean"} <= set(MODELS)
    assert {"j2", "johnson_cook", "mohr_coulomb"} <= set(PLASTIC)


@pytest.mark.parametrize("name", PLASTIC)
def test_flow_takes_energy_and_happens(name: str) -> None:
    """The soft parameters yield in these motions, the hard ones do not; no flow makes energy."""
    moves = increments(tangled, 200)
    flowing = columns(name, moves, constants=parameters(name, SOFT))
    steps = np.diff(flowing["plastic_strain"])
    assert (steps > 0).sum() > 150
    assert flowing["plastic_strain"][-1] > 0.1
    assert np.diff(flowing["dissipated"]).min() >= 0.0
    assert columns(name, moves)["plastic_strain"][-1] == 0.0


@pytest.mark.parametrize(("name", "strength"), CASES)
def test_a_superposed_rotation_only_turns_the_stress(name: str, strength: float) -> None:
    def turn(t: float) -> np.ndarray:
        return rotation((1.0, 2.0, -0.5), 3.0 * t) @ rotation((0.0, 1.0, 1.0), -2.0 * t**2)

    constants = parameters(name, strength)
    errors = []
    for steps in STEPS:
        still = drive(name, increments(tangled, steps), constants=constants)
        moves = increments(lambda t: turn(t) @ tangled(t), steps)
        turned = drive(name, moves, constants=constants)
        q = np.array([turn(k / steps) for k in range(steps + 1)])
        difference = turned - q @ still @ q.transpose(0, 2, 1)
        # The mean stress of a metal that flows is elastic, and much the larger part of the error.
        errors.append(worst(deviator(difference) if strength == SOFT else difference))
    assert errors[-1] < (3e-3 * SOFT / MODULUS if strength == SOFT else 1e-4)
    assert falls_with_order(errors, 2.0, FLOOR), errors


@pytest.mark.parametrize(("name", "strength"), CASES)
def test_a_rotation_of_a_stressed_point_only_turns_its_stress(name: str, strength: float) -> None:
    """Beside a point that is held still meanwhile, for a stress above the slow yield relaxes."""
    stretch = increments(lambda t: np.diag([1 + 0.1 * t, 1 - 0.05 * t, 1.0]), 10)
    constants = parameters(name, strength)
    errors = []
    for steps in STEPS:
        turns = increments(lambda t: rotation((0.3, -1.0, 0.7), 2 * np.pi * t), steps)
        stress = drive(name, np.concatenate([stretch, turns]), constants=constants)[10:]
        held = drive(name, np.concatenate([stretch, 0.0 * turns]), constants=constants)[10:]
        q = np.array([rotation((0.3, -1.0, 0.7), 2 * np.pi * k / steps) for k in range(steps + 1)])
        errors.append(worst(stress - q @ held @ q.transpose(0, 2, 1)))
    assert falls_with_order(errors, 2.0, FLOOR), errors


@pytest.mark.parametrize(("name", "strength"), CASES)
def test_the_choice_of_axes_does_not_matter(name: str, strength: float) -> None:
    q = rotation((1.0, -0.3, 2.0), 1.1)
    moves = increments(tangled, 50)
    constants = parameters(name, strength)
    turned, still = (drive(name, m, constants=constants) for m in (q @ moves @ q.T, moves))
    same = turned - q @ still @ q.T
    assert worst(same) < 10 * 50 * EPS  # ten roundings a step


@pytest.mark.parametrize("name", MODELS)
def test_a_closed_elastic_cycle_gives_and_takes_no_energy(name: str) -> None:
    """A loop of stretches along fixed axes at constant volume, where hypoelasticity is elastic."""

    def loop(t: float) -> np.ndarray:
        a, b = 1e-3 * np.sin(2 * np.pi * t), 2e-3 * (1 - np.cos(2 * np.pi * t))
        return np.diag(np.exp([a, b, -a - b]))

    largest = MODULUS * 4e-3**2
    errors = []
    for steps in STEPS:
        moves = increments(loop, steps)
        stress = drive(name, moves)
        middle = moves @ np.linalg.inv(np.eye(3) + 0.5 * moves)  # gradient in mid-step
        power = np.einsum("kij,kij->k", 0.5 * (stress[1:] + stress[:-1]), middle)
        stored = np.cumsum(power)
        errors.append(abs(stored[-1]) / largest)
        assert stored.max() > 0.1 * largest
    assert errors[-1] < 1e-5
    assert falls_with_order(errors, 2.0, 1e-12), errors


@pytest.mark.parametrize("name", MODELS)
def test_small_strains_follow_hooke(name: str) -> None:
    given, size = parameters(name), 1e-7
    if "E" in given:
        shear = given["E"] / (2 * (1 + given["nu"]))
        bulk = given["E"] / (3 * (1 - 2 * given["nu"]))
    else:
        shear, bulk = given["G"], given["K"]
    strain = size * np.array([[1.0, 0.3, -0.2], [0.3, -0.4, 0.7], [-0.2, 0.7, 0.9]])
    stress = drive(name, strain[None])[1]
    volumetric = np.trace(strain) * np.eye(3)
    hooke = bulk * volumetric + 2 * shear * (strain - volumetric / 3)
    assert worst(stress - hooke) < 10 * size**2  # terms of second order


@pytest.mark.parametrize(("name", "strength"), CASES)
def test_lanes_and_scalar_agree(name: str, strength: float) -> None:
    moves = increments(tangled, 200)
    scalar, lanes = (drive(name, moves, x, parameters(name, strength)) for x in (False, True))
    assert worst(lanes - scalar) <= 4 * 200 * EPS  # four roundings a step may be contracted
    assert worst(scalar) > 1e-2


@pytest.mark.parametrize("name", MODELS)
def test_a_point_at_rest_stays_unstressed(name: str) -> None:
    assert worst(drive(name, np.zeros((10, 3, 3)))) <= EPS


def test_a_mistake_is_one_sentence() -> None:
    moves = np.zeros((1, 3, 3))
    for name in MODELS:
        good = parameters(name)
        model = next(m for m in _core.catalogue() if m.name == name)
        defaults = {p.name for p in model.parameters if p.default is not None}
        for key in good:
            rest = {k: v for k, v in good.items() if k != key}
            if key in defaults:
                continue
            with pytest.raises(ValueError, match=f"{name}.{key}.*missing"):
                drive_point(1000.0, name, rest, moves, False)
            with pytest.raises(ValueError, match=f"{name}.{key} = nan"):
                drive_point(1000.0, name, good | {key: np.nan}, moves, False)
    with pytest.raises(ValueError, match="jelly"):
        drive_point(1000.0, "jelly", {}, moves, False)
