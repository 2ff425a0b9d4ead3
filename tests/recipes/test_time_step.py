# SPDX-License-Identifier: BSD-3-Clause
"""Time steps by hand: a fixed one, which must stay stable, and a bound of the automatic ones."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import CELL, DENSITY, YOUNG, one_block, three_blocks
from mpm3dpp import CaseError, Run, RunError, Simulation, run_case
from mpm3dpp.fill.advisories import refuse_time_step
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import time_step

# Of the block in tests/cases.py: elastic with nu = 0.3, at rest.
WAVE = (YOUNG * 0.7 / (1.3 * 0.4) / DENSITY) ** 0.5
STABLE = CELL / WAVE


def steps_of(simulation: Simulation) -> np.ndarray:
    core = simulation.core
    return core.history()[1:, core.history_columns.index("dt")]


def block(**run: Any) -> Simulation:
    return Simulation(one_block(2, {}, run, velocity=(0.0, 0.0), frame="updated"), threads=1)


def test_steps_are_as_given_but_for_the_last_two() -> None:
    given = 0.3 * STABLE
    simulation = block(end_time=10.6 * given, time_step=given)
    assert simulation.core.dt == given
    assert simulation.advance(1000) == 11
    steps = steps_of(simulation)
    assert (steps[:9] == given).all()
    assert steps[9:] == pytest.approx([0.8 * given, 0.8 * given], rel=1e-12)
    assert simulation.time == 10.6 * given


def test_a_bound_cuts_automatic_steps() -> None:
    """Below the automatic step it is the step, to the same bits; above, it does nothing."""
    automatic = three_blocks(2)
    own = Simulation(automatic, threads=1).core.dt
    columns = []
    for run in ({"largest_time_step": 0.5 * own}, {"time_step": 0.5 * own},
                {"largest_time_step": 2.0 * own}, {}):  # fmt: skip
        simulation = Simulation(three_blocks(2, run=run), threads=1)
        simulation.advance(40)
        columns.append([simulation.column(name, "stress") for name in simulation.bodies])
    for first, second in ((0, 1), (2, 3)):
        pairs = zip(columns[first], columns[second], strict=True)
        assert all(np.array_equal(one, other) for one, other in pairs)


def test_a_step_that_is_too_large_is_refused_at_the_start() -> None:
    assert block(time_step=0.999 * STABLE).core.dt == 0.999 * STABLE
    case = one_block(2, {}, {"time_step": 1.001 * STABLE}, velocity=(0.0, 0.0))
    with pytest.raises(CaseError, match="is larger than the largest stable step") as caught:
        Simulation(case)
    assert caught.value.key == "run.time_step" and caught.value.value == 1.001 * STABLE
    assert "give a smaller one" in caught.value.remedy
    with pytest.raises(CaseError, match="is larger than the largest stable step"):  # As `check`.
        refuse_time_step(case, build(case))


def test_a_run_whose_waves_or_particles_become_too_fast_stops(tmp_path: Path) -> None:
    """A block that falls: c + v passes h / dt when it is 0.25 c fast."""
    gravity = 1000.0
    # MUSL, which sees the velocities of the step that it has made; USF those of the one before.
    run = {"time_step": 0.8 * STABLE, "gravity": (0.0, -gravity), "end_time": 0.1}
    case = one_block(2, {}, run | {"scheme": "musl"}, velocity=(0.0, 0.0))
    with pytest.raises(
        RunError, match=r"^time step at step .* run.time_step = .* s is larger than"
    ):
        run_case(case, tmp_path / "falls", threads=1, pictures=False)
    simulation = Simulation(case, threads=1)
    with pytest.raises(RunError):
        simulation.advance(1000)
    speed = gravity * simulation.time
    assert abs(speed - 0.25 * WAVE) <= gravity * 0.8 * STABLE
    with pytest.raises(RunError):  # It stays so.
        simulation.advance(1)


def test_velocities_that_are_too_fast_stop_it_too() -> None:
    simulation = block(time_step=0.5 * STABLE)
    simulation.advance(3)
    shape = simulation.column("block", "velocity").shape
    simulation.set_velocity("block", np.full(shape, 2.0 * WAVE))
    with pytest.raises(RunError, match="is larger than the largest stable step"):
        simulation.advance(1)


@pytest.mark.parametrize("key", ["time_step", "largest_time_step"])
def test_a_run_goes_on_with_the_same_bits(tmp_path: Path, key: str) -> None:
    case = three_blocks(2, run={key: 2e-5})
    straight = Simulation(case, threads=1)
    straight.advance(20)
    straight.save(tmp_path / "state.zip")
    straight.advance(20)
    again = Simulation(case, threads=2)
    again.restore(tmp_path / "state.zip")
    again.advance(20)
    assert again.time == straight.time and again.core.dt == straight.core.dt == 2e-5
    for name in again.bodies:
        assert np.array_equal(again.column(name, "stress"), straight.column(name, "stress"))


def test_the_estimate_of_check_is_the_step_given() -> None:
    for run, wanted in (
        ({"time_step": 1e-6}, 1e-6),
        ({"largest_time_step": 2e-6}, 2e-6),
        ({"cfl": 0.3}, 0.3 * STABLE),
    ):
        case = one_block(2, {}, run, velocity=(0.0, 0.0))
        assert time_step(case, build(case)) == pytest.approx(wanted, rel=1e-12)


def test_what_is_no_step_is_a_sentence() -> None:
    with pytest.raises(CaseError, match=r"run\.time_step = 0.* must be > 0"):
        Run(end_time=1.0, time_step=0)
    with pytest.raises(CaseError, match=r"run\.time_step = \"1 m\" .*must be a time"):
        Run(end_time=1.0, time_step="1 m")
    with pytest.raises(CaseError, match="largest_time_step must not be given together with"):
        Run(end_time=1.0, time_step="1 us", largest_time_step="2 us")
