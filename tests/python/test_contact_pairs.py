# SPDX-License-Identifier: BSD-3-Clause
"""Friction of a pair, and frames at their times, through the whole path from a case to results."""

from __future__ import annotations

from pathlib import Path

import pytest

from cases import CELL, block, materials
from mpm3dpp import (
    Case,
    Contact,
    ContactPair,
    Grid,
    Output,
    Run,
    Simulation,
    open_results,
    run_case,
)


def sliding(pair: dict[str, object] | None, friction: float = 0.0) -> Case:
    """Return two blocks that are pressed together and slide on each other."""
    pairs = [ContactPair(**pair)] if pair else []
    return Case(
        grid=Grid(dimension=2, cell_size=CELL),
        run=Run(end_time=0.004),
        material=materials(),
        contact=Contact(friction=friction, pair=pairs),
        body={
            "upper": block((0, 4), (6, 4), material="rubber", velocity=(1.0, -0.5)),
            "lower": block((-4, 0), (14, 4), material="solid"),
        },
    )


def tangential_over_normal(case: Case) -> float:
    simulation = Simulation(case, threads=1)
    simulation.advance(100000)
    (pair,) = simulation.core.contact_pairs()
    return abs(pair.impulse[0]) / abs(pair.impulse[1])


@pytest.mark.parametrize(
    "pair",
    [
        {"bodies": ["upper", "lower"], "friction": 0.3},
        {"materials": ["solid", "rubber"], "friction": 0.3},
    ],
)
def test_the_friction_of_a_pair_beats_the_default(pair: dict[str, object]) -> None:
    none = tangential_over_normal(sliding(None))
    by_default = tangential_over_normal(sliding(None, friction=0.3))
    of_pair = tangential_over_normal(sliding(pair))
    assert of_pair == by_default  # the same number by another way: the same bits
    assert of_pair > none + 0.2  # most of mu = 0.3: the normals are inclined at the edges


def test_frames_come_at_their_times_without_contact(tmp_path: Path) -> None:
    case = sliding(None)
    case = Case(
        grid=case.grid,
        run=Run(end_time=0.02),
        output=Output(frames=20),
        material=case.material,
        body={"lower": block((0, 0), (4, 4), material="solid", velocity=(1.0, 0.0))},
    )
    run_case(case, tmp_path, threads=1, pictures=False)
    with open_results(tmp_path) as results:
        times = list(results.times)
    wanted = case.frame_times()
    assert len(times) == len(wanted)
    step = 0.02 / 100
    assert all(0.0 <= t - w <= step for t, w in zip(times, wanted, strict=True))
