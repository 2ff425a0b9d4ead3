# SPDX-License-Identifier: BSD-3-Clause
"""The example of a hopper with few grains: nothing is lost on the way, and the walls hold."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mpm3dpp import Simulation, load_case

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "05_hopper" / "case_small.toml"
EPS = np.finfo(float).eps


@pytest.fixture(scope="module")
def half_empty() -> Simulation:
    """60 grains that fall into the funnel at 2 m/s; those that get 60 mm below it end."""
    case = load_case(EXAMPLE)
    packing = case.grains["sand"].packing
    assert packing is not None and case.grid.outflow_box is not None
    packing.count, packing.upper = 60, (packing.upper[0], packing.lower[1] + 0.13)
    case.grains["sand"].velocity = (0.0, -2.0)
    case.grid.outflow_box.lower = (-5.0, -0.06)
    simulation = Simulation(case, threads=1)
    simulation.advance(10**9, end_time=0.12)
    return simulation


def test_what_left_and_what_is_inside_is_the_start(half_empty: Simulation) -> None:
    mass, state = (half_empty.column("sand", name)[:, 0] for name in ("mass", "failed"))
    left = half_empty.left()
    inside = state == 0
    assert 100 < left["count"] < len(mass) - 100  # some grains of 20 particles on either side
    assert left["count"] == np.count_nonzero(state == 4) == len(mass) - inside.sum()
    assert left["mass"] + mass[inside].sum() == pytest.approx(mass.sum(), rel=len(mass) * EPS)


def test_the_energy_closes(half_empty: Simulation) -> None:
    core = half_empty.core
    rows = dict(zip(core.history_columns, core.history().T, strict=True))
    assert rows["friction"][-1] > 0.0 and rows["left"][-1] > 0.0
    assert np.abs(rows["residual"]).max() < 1e-11 * rows["kinetic"].max()
    # Nothing stops it but the walls, contact and friction: the step makes little of it, and AFLIP
    # takes what rings in grains of 2.5 cells, a tenth of what falls on the funnel.
    assert abs(rows["numerical_time"][-1]) < 0.02 * rows["kinetic"].max()
    assert 0.0 < rows["numerical_transfer"][-1] < 0.2 * rows["kinetic"].max()


def test_grains_leave_by_the_outlet_only(half_empty: Simulation) -> None:
    """Below the funnel they are where its edges let them fall; half a cell is for the corners."""
    x = half_empty.column("sand", "position")
    reach, slack = np.interp(x[:, 1], [0.0, 0.096], [0.135, 0.3]), 0.006
    assert np.all(np.abs(x[:, 0]) < reach + slack)
