# SPDX-License-Identifier: BSD-3-Clause
"""Faces drawn touching, levelled beside their edges: the same bits in any way they are run.

One block slides off, so that what is levelled falls; another tips, so that gaps open in which it
goes; a third stays.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from in_body import CELL
from mpm3dpp import Case, Simulation
from same_bits import check_same_bits

LOAD = 1e4  # Gravity that presses blocks in by some thousandths of a cell [m/s^2].


def stacks(dimension: int) -> Case:
    """Return three blocks of 4 cells on a slab of which they lie on both ends and the middle."""

    def box(left: float, bottom: float, right: float, top: float) -> dict[str, Any]:
        ends = [[left, bottom, 0.0], [right, top, 4.0]]
        lower, upper = ([CELL * x for x in end[:dimension]] for end in ends)
        return {"box": {"lower": lower, "upper": upper}}

    def body(*corners: float, **more: Any) -> dict[str, Any]:
        return {"material": "m", "frame": "material", "shape": box(*corners), **more}

    turn = 60.0 if dimension == 2 else [0.0, 0.0, 60.0]
    return Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": CELL},
            "run": {"end_time": 1.0, "gravity": [0.0, -LOAD, 0.0][:dimension]},
            "contact": {"friction": 0.3},
            "material": {"m": {"density": 1000.0, "strength": {"elastic": {"E": 1e7, "nu": 0.3}}}},
            "body": {
                "slab": body(0.0, -3.0, 18.0, 0.0),
                "slides": body(0.0, 0.0, 4.0, 4.0, velocity=[0.3, 0.0, 0.0][:dimension]),
                "stays": body(7.0, 0.0, 11.0, 4.0),
                "tips": body(14.0, 0.0, 18.0, 4.0, angular_velocity=turn),
            },
        }
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_what_is_levelled_falls_as_it_slides_and_ends_in_gaps(dimension: int) -> None:
    simulation = Simulation(stacks(dimension))
    begun = simulation.core.contact_summary()["levelled_points"]
    assert begun > (10 if dimension == 2 else 100)
    simulation.advance(60)
    left = simulation.core.contact_summary()["levelled_points"]
    assert 0.1 * begun < left < 0.9 * begun


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_same_bits(dimension: int, tmp_path: Path) -> None:
    check_same_bits(stacks(dimension), tmp_path)
