# SPDX-License-Identifier: BSD-3-Clause
"""Bounds of equations of state: tension at the spall strength, energy at absolute zero."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp import Material
from mpm3dpp.materials.point import drive_point

ALUMINIUM = Material(library="aluminium_6061_t6")
NUMBERS = ALUMINIUM.eos.parameters if ALUMINIUM.eos else {}
STIFFNESS = ALUMINIUM.density * NUMBERS["c0"] ** 2
HEAT = ALUMINIUM.density * 885.0 * 298.0  # cp T0: all that a constant specific heat lets it hold
SPALL = NUMBERS["spall_strength"]


def swell(
    volumes: np.ndarray, spall: float = SPALL, solid: bool = True, lanes: bool = True, **more: Any
) -> dict[str, np.ndarray]:
    """Take aluminium through relative volumes, equal along all axes: columns and pressure."""
    axis = np.cbrt(volumes)
    moves = np.diff(axis)[:, None, None] / axis[:-1, None, None] * np.eye(3)
    given = ALUMINIUM.for_core() | {"eos": ("mie_gruneisen", NUMBERS | {"spall_strength": spall})}
    if not solid:
        given |= {"strength": "fluid", "parameters": {"viscosity": 0.0}}
    given = {k: v for k, v in given.items() if k != "failures"} | more
    rows, names, _ = drive_point(increments=moves, lanes=lanes, **given)
    found = dict(zip(names, rows.T, strict=True))
    return found | {"pressure": -rows[:, :3].mean(axis=1)}


def closing(widest: float = 40.0, start: float = 1.0) -> np.ndarray:
    """Volumes of debris: open in steps of up to a fifth, and shut again."""
    opens = np.geomspace(start, widest, 60)
    return np.concatenate([opens, opens[::-1][1:]])


@pytest.mark.parametrize("solid", [True, False])
@pytest.mark.parametrize("spall", [SPALL, 0.0])
def test_debris_is_not_pulled_shut_without_bound(spall: float, solid: bool) -> None:
    """An energy a little below zero at 40 times the volume had become -1e17 Pa on closing."""
    found = swell(closing()[59:], spall, solid, state={"volume": 40.0, "internal_energy": -1e6})
    floor = -HEAT if solid else -STIFFNESS / NUMBERS["gamma0"]
    least = -spall if spall else -STIFFNESS + NUMBERS["gamma0"] * floor
    assert found["pressure"].min() >= least * (1 + 1e-12)
    assert found["internal_energy"].min() >= floor


def test_energy_stops_at_absolute_zero() -> None:
    """Nothing is below E0 - rho0 cp T0; where the specific heat is unknown the bond energy is."""
    path = np.linspace(40.0, 1.2, 1600)  # so fine that a step passes the last 5 % above the floor
    for solid, floor in ((True, -HEAT), (False, -STIFFNESS / NUMBERS["gamma0"])):
        found = swell(path, 0.0, solid, state={"volume": 40.0, "internal_energy": -1e6})
        # The step that would lead below bears no tension, and so ends a little above.
        assert floor <= found["internal_energy"].min() < 0.95 * floor


def test_tension_at_its_limit_opens_voids_and_heats_nothing() -> None:
    """The energy stays where the limit is reached, and what opening took comes back."""
    path = np.concatenate([np.linspace(1, 5, 4001), np.linspace(5, 1, 4001)[1:]])
    found = swell(path, solid=False)
    held = found["pressure"] <= -SPALL * (1 - 1e-9)
    assert held[200:7000].all()
    assert np.ptp(found["internal_energy"][200:7000]) < 1e-14 * found["internal_energy"][4000]
    reached = SPALL**2 / (2 * STIFFNESS)  # but for some times SPALL / STIFFNESS, 4 %
    assert found["internal_energy"][4000] == pytest.approx(reached, rel=0.15)
    assert abs(found["internal_energy"][-1]) < 0.02 * reached
    assert abs(found["pressure"][-1]) < 0.01 * SPALL


def test_a_bound_that_does_not_act_changes_no_bit() -> None:
    path = np.concatenate([np.linspace(1, 0.8, 50), np.linspace(0.8, 1.02, 50)])
    free, bounded = (swell(path, spall) for spall in (0.0, SPALL))
    assert free["pressure"].min() > -SPALL
    for name in free:
        assert free[name].tobytes() == bounded[name].tobytes(), name


def test_lanes_and_scalar_agree() -> None:
    state = {"volume": 40.0, "internal_energy": -1e6}
    one, many = (swell(closing()[59:], lanes=x, state=state) for x in (False, True))
    for name in ("pressure", "internal_energy"):
        size = np.abs(one[name]).max()
        assert np.abs(one[name] - many[name]).max() < 1e-11 * size


@pytest.mark.parametrize(
    "eos",
    [
        ("ideal_gas", {"gamma": 1.4, "E0": 2.5e5}),
        ("jwl", {"A": 371.2e9, "B": 3.21e9, "R1": 4.15, "R2": 0.95, "omega": 0.3, "E0": 7e9}),
        ("polynomial", {"c4": 0.4, "c5": 0.4, "E0": 2.5e5}),
    ],
)
def test_a_gas_has_no_energy_below_zero(eos: tuple[str, dict[str, float]]) -> None:
    """Expanding to ten times the volume in one step would take more than it has."""
    found = swell(np.array([1.0, 10.0, 100.0, 1000.0]), solid=False, eos=eos)
    assert found["internal_energy"].min() >= 0.0
    assert found["pressure"].min() >= 0.0


@pytest.mark.parametrize("lanes", [False, True])
def test_debris_that_closes_in_one_step_is_pressed(lanes: bool) -> None:
    """From ten times its volume to 0.95 of it the pressure was -14 GPa: a factor below zero."""
    state = {"volume": 10.0, "internal_energy": 1e9}
    found = swell(np.array([10.0, 0.95]), 0.0, False, lanes, state=state)
    assert found["pressure"][1] > 0.0


EQUATIONS: tuple[tuple[str, dict[str, float]], ...] = (
    ("mie_gruneisen", NUMBERS | {"spall_strength": 0.0}),
    ("polynomial", {"c1": STIFFNESS, "c2": STIFFNESS, "c3": STIFFNESS, "c4": NUMBERS["gamma0"]}),
)


@pytest.mark.parametrize("share", [0.01, 0.3, 0.98, 1.02])
@pytest.mark.parametrize(("eos", "most"), [*zip(EQUATIONS, (1.2, 2.4), strict=True)])
def test_debris_is_no_stiffer_than_its_matter(
    eos: tuple[str, dict[str, float]], most: float, share: float
) -> None:
    """What pulls at the nodes is pressure times volume: at 300 volumes that was 300 moduli."""
    volumes = np.array([300.0, 315.0, 330.0, 305.0, 280.0, 270.0, 290.0])
    evaporated = STIFFNESS / NUMBERS["gamma0"]
    state = {"volume": 300.0, "internal_energy": share * evaporated}
    found = swell(volumes, 0.0, False, state=state, eos=eos)
    # At most 1.2 K (and 1.2 (c1 + c3) of the polynomial), doubled for steps of 5 % in the volume.
    assert np.abs(found["pressure"] * volumes)[1:].max() < 2 * most * STIFFNESS
    assert found["sound_speed"].max() < 3 * NUMBERS["c0"]


@pytest.mark.parametrize("eos", EQUATIONS, ids=lambda eos: eos[0])
def test_tension_is_linear_up_to_a_fifth_and_falls_with_the_density_beyond(
    eos: tuple[str, dict[str, float]],
) -> None:
    given = (eos[0], eos[1] | {"gamma0" if eos[0] == "mie_gruneisen" else "c4": 0.0})
    volumes = np.linspace(1.0, 3.0, 201)
    found = swell(volumes, 0.0, False, eos=given)
    mu = 1.0 / volumes - 1.0
    tension = STIFFNESS * (mu if eos[0] == "mie_gruneisen" else mu + mu**3)
    right = tension * np.minimum(1.2 / volumes, 1.0)
    assert np.abs(found["pressure"] - right).max() < 1e-12 * STIFFNESS
