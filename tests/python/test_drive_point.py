# SPDX-License-Identifier: BSD-3-Clause
"""The single material point: what it is given, and what it refuses."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp.materials import catalogue
from mpm3dpp.materials.point import COUNTED, drive_point

METAL = ("j2", {"E": 1e8, "nu": 0.3, "Y0": 1e5, "H": 1e6})
RUBBER = ("neo_hookean", {"K": 1e8, "G": 1e7})
GAS = ("ideal_gas", {"gamma": 1.4, "E0": 2.5e5})
FAILURE = [("principal_stress", {"limit": 3e5}, "no_tension")]
POINTS: dict[str, dict[str, Any]] = {
    "metal": {"strength": METAL[0], "parameters": METAL[1], "failures": FAILURE},
    "rubber": {"strength": RUBBER[0], "parameters": RUBBER[1], "viscosity": (1.5, 0.06)},
    "gas": {"strength": "fluid", "parameters": {"viscosity": 0.1}, "eos": GAS},
}


def moves(steps: int) -> np.ndarray:
    """Return increments without symmetry, the same in every call."""
    return np.random.default_rng(3).uniform(-3e-3, 3e-3, (steps, 3, 3))


@pytest.mark.parametrize("lanes", [False, True])
@pytest.mark.parametrize("point", POINTS.values(), ids=POINTS)
def test_a_row_given_back_as_the_state_goes_on_from_there(
    point: dict[str, Any], lanes: bool
) -> None:
    """Bit for bit: the state is all that a point remembers."""
    path = moves(40)
    whole, names, units = drive_point(1000.0, increments=path, lanes=lanes, **point)
    state = {n: v for n, v in zip(names, whole[25], strict=True) if n not in COUNTED}
    rest, again, _ = drive_point(1000.0, increments=path[25:], lanes=lanes, state=state, **point)
    assert again == names
    assert len(units) == len(names)
    for k, name in enumerate(names):
        if name not in COUNTED or name == "sound_speed":
            assert np.array_equal(rest[:, k], whole[25:, k]), name
        else:
            size = np.abs(whole[:, k]).max() + 1.0
            assert np.diff(rest[:, k]) == pytest.approx(np.diff(whole[25:, k]), abs=1e-12 * size)
    assert np.ptp(whole[:, 0]) > 0.0


def test_columns_have_the_units_of_the_catalogue() -> None:
    _, names, units = drive_point(1000.0, *RUBBER, moves(1), viscosity=(1.5, 0.0))
    found = dict(zip(names, units, strict=True))
    [column] = catalogue("strength")["neo_hookean"].state
    assert found[f"{column.name}_5"] == column.unit
    wanted = {"stress_xy": "Pa", "volume": "1", "viscosity_pressure": "Pa", "viscous": "J/m^3"}
    wanted |= {"work": "J/m^3", "sound_speed": "m/s"}
    assert {name: found[name] for name in wanted} == wanted


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"increments": np.zeros(9)}, r"increments must have the shape \(n, 3, 3\)"),
        ({"increments": np.zeros((2, 9))}, r"increments must have the shape \(n, 3, 3\)"),
        ({"increments": np.zeros((9, 1, 1))}, r"increments must have the shape \(n, 3, 3\)"),
        ({"increments": np.zeros((3, 3, 3, 1))}, r"increments must have the shape \(n, 3, 3\)"),
        ({"time_step": 0.0}, "time_step = 0.* must be > 0"),
        ({"time_step": -1.0}, "time_step = -1.* must be > 0"),
        ({"time_step": np.nan}, "time_step = nan must be > 0"),
        ({"cell_size": 0.0}, "cell_size = 0.* must be > 0"),
        ({"viscosity": (-1.0, 0.0)}, "viscosity = -1 must be >= 0"),
        ({"state": {"jelly": 1.0}}, "state.jelly is not a column here; there are stress_xx"),
        ({"state": {"work": 1.0}}, "state.work is not a column here"),
        ({"state": {"plastic_strain": np.inf}}, "state.plastic_strain must be a finite number"),
        ({"state": {"volume": 0.0}}, "state.volume must be > 0"),
    ],
)
def test_mistakes_name_the_argument(wrong: dict[str, Any], sentence: str) -> None:
    given: dict[str, Any] = {"increments": np.zeros((1, 3, 3))}
    with pytest.raises(ValueError, match=sentence):
        drive_point(1000.0, *METAL, **(given | wrong))
