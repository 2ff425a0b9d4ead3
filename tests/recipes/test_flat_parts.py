# SPDX-License-Identifier: BSD-3-Clause
"""Flat bodies that slide on flat bodies: their faces have no bumps beside their edges to catch on.
By default settings, from case files."""

from __future__ import annotations

import math
from typing import Any

import pytest

from in_body import part
from mpm3dpp import Case, Simulation

CELL = 5e-3
GRAVITY = 9.81
RUBBER = {
    "density": 1000.0,
    "damping": {"stiffness": "100 us"},
    "strength": {"elastic": {"E": 1e6, "nu": 0.3}},
}


def sliding(
    size: list[float], degrees: float, friction: float, plate: dict[str, Any], speed: float = 0.0
) -> Simulation:
    """A block of rubber, of that size [m], on a slab on a slope."""
    dimension = len(size)
    along, width = size[0] / 2, size[-1] / 2

    def turned(lower: list[float], upper: list[float]) -> dict[str, Any]:
        box = {"box": {"lower": lower, "upper": upper}}
        axis = {"axis": [0, 0, 1]} if dimension == 3 else {}
        return {
            "rotate": {
                "shape": box,
                "angle": -math.radians(degrees),
                "about": [0.0] * dimension,
                **axis,
            }
        }

    slab, block = ([-0.06, -0.02], [0.1, 0.0]), ([-along, 0.0], [along, size[1]])
    if dimension == 3:
        slab, block = (
            ([-0.06, -0.02, -0.05], [0.1, 0.0, 0.05]),
            ([-along, 0.0, -width], [along, size[1], width]),
        )
    case = Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": CELL},
            "run": {"end_time": 0.15, "gravity": [0.0, -GRAVITY, 0.0][:dimension]},
            "contact": {"friction": friction},
            "material": {"m": RUBBER},
            "body": {
                "slab": {"material": "m", "shape": turned(*slab), **plate},
                "block": {
                    "material": "m",
                    "frame": "material",
                    "shape": turned(*block),
                    "velocity": [speed, 0.0, 0.0][:dimension],
                },
            },
        }
    )
    return Simulation(case)


def way(simulation: Simulation, degrees: float, end: float) -> float:
    """How far the block goes down the slope until then [m]."""

    def centre() -> float:
        x, y = part(simulation, "centre_x", 1), part(simulation, "centre_y", 1)
        return x * math.cos(math.radians(degrees)) - y * math.sin(math.radians(degrees))

    start = centre()
    simulation.advance(10**7, end)
    return centre() - start


FIXED = {"motion": "fixed"}
DEFORMS = {"frame": "material"}


@pytest.mark.parametrize(
    ("size", "degrees", "plate"),
    [
        ([0.04, 0.02], 3.0, FIXED),
        ([0.0437, 0.0213], 5.0, FIXED),
        ([0.0437, 0.0213], 3.0, DEFORMS),
        ([0.02, 0.01, 0.02], 5.0, FIXED),
        ([0.0217, 0.0116, 0.0188], 5.0, FIXED),
    ],
    ids=str,
)
def test_a_block_slides_down_without_friction(size, degrees, plate):
    """As a point does; that of 3 degrees swung within half a millimetre where its own surface and
    the slab's bulged beside their edges. Weight presses it in by less than a thousandth of the
    points' distance, and in 3D rows that do not fit a side leave waves of nearly that."""
    end = 0.15 if len(size) == 2 else 0.06
    expected = 0.5 * GRAVITY * math.sin(math.radians(degrees)) * end**2
    went = way(sliding(size, degrees, 0.0, plate), degrees, end)
    assert went == pytest.approx(expected, rel=2e-3 if len(size) == 2 else 1e-2)


def test_a_block_goes_on_over_a_level_slab():
    simulation = sliding([0.04, 0.02], 0.0, 0.0, FIXED, speed=0.02)
    assert way(simulation, 0.0, 0.15) == pytest.approx(0.003, rel=5e-3)


@pytest.mark.parametrize(
    "size",
    [
        [0.04, 0.02],
        [0.0437, 0.0213],
        pytest.param([0.02, 0.01, 0.02], marks=pytest.mark.slow),
    ],
    ids=str,
)
def test_a_block_slides_down_with_friction(size):
    """With the law's acceleration, g (sin 20 - .3 cos 20), as it is after the start: while weight
    comes on the block hardly rubs."""
    end = 0.15 if len(size) == 2 else 0.08
    simulation = sliding(size, 20.0, 0.3, FIXED)
    ways = [way(simulation, 20.0, end * (k + 1) / 3) for k in range(3)]
    expected = GRAVITY * (math.sin(math.radians(20)) - 0.3 * math.cos(math.radians(20)))
    assert (ways[2] - ways[1]) / (end / 3) ** 2 == pytest.approx(expected, rel=0.03)


def test_a_disc_that_is_drawn_touching_rolls_at_once():
    """Only what sinks beside edges is levelled: a disc of 6 cells has no flat to stand on."""
    angle, radius, end = math.radians(1.0), 6 * CELL, 0.05
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": CELL},
            "run": {
                "end_time": end,
                "gravity": [GRAVITY * math.sin(angle), -GRAVITY * math.cos(angle)],
            },
            "contact": {"friction": 0.5},
            "material": {"m": RUBBER},
            "body": {
                "slab": {
                    "material": "m",
                    "shape": {"box": {"lower": [-0.05, -0.02], "upper": [0.06, 0.0]}},
                    "motion": "fixed",
                },
                "disc": {
                    "material": "m",
                    "frame": "material",
                    "shape": {"disc": {"centre": [0.0, radius], "radius": radius}},
                },
            },
        }
    )
    expected = GRAVITY * math.sin(angle) * end**2 / 3
    assert way(Simulation(case), 0.0, end) == pytest.approx(expected, rel=4e-3)
