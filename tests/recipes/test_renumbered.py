# SPDX-License-Identifier: BSD-3-Clause
"""Bodies in another order in the case file: the same motion, to the last bit."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp import Case, Simulation

RADIUS, CELL = 4e-3, 1e-3


def heap(dimension: int, along: int) -> np.ndarray:
    """Centres of round bodies in a corner, `along` an axis, each a little out of its place."""
    places = np.stack(np.meshgrid(*[np.arange(along)] * dimension), axis=-1).reshape(-1, dimension)
    out_of_place = np.random.default_rng(3).uniform(0.0, 0.05, places.shape)
    return RADIUS * (1.02 + 2.0 * places + out_of_place)


def run(case: dict[str, Any], order: np.ndarray, steps: int) -> dict[str, bytes]:
    bodies = list(case["body"].items())
    renumbered = case | {"body": dict(bodies[k] for k in order)}
    simulation = Simulation(Case.model_validate(renumbered), threads=2)
    simulation.advance(steps)
    if case["contact"].get("response") == "impulses":  # Else no order of pairs is asked for.
        assert simulation.core.contact_summary()["bodies_per_node_max"] > 2
    return {
        name: b"".join(simulation.column(name, c).tobytes() for c in ("velocity", "stress"))
        for name in sorted(case["body"])
    }


def corner(dimension: int, along: int, contact: dict[str, Any]) -> dict[str, Any]:
    """Soft and stiff balls that fall into a corner, as into a V, and roll over each other."""
    shape = "disc" if dimension == 2 else "sphere"
    strengths = ({"neo_hookean": {"K": 1e6, "G": 4e5}}, {"elastic": {"E": 3e6, "nu": 0.3}})
    edge = 2.0 * RADIUS * (along + 1)
    walls = {f"{a}_min": "contact" for a in "xyz"[:dimension]}
    return {
        "grid": {
            "dimension": dimension,
            "cell_size": CELL,
            "box": {"lower": [0.0] * dimension, "upper": [edge] * dimension, "walls": walls},
        },
        "run": {"end_time": 1.0, "gravity": [-10.0] * dimension},
        "contact": contact,
        "material": {
            f"m{k}": {"density": 1000.0 * (1 + k), "strength": strength}
            for k, strength in enumerate(strengths)
        },
        "body": {
            f"ball_{k:02d}": {
                "material": f"m{k % 2}",
                "frame": "updated",
                "shape": {shape: {"centre": centre.tolist(), "radius": RADIUS}},
                "velocity": [-0.5 - 0.01 * k] + [-0.5] * (dimension - 1),
            }
            for k, centre in enumerate(heap(dimension, along))
        },
    }


CONTACTS: dict[str, dict[str, Any]] = {
    "springs": {},
    "impulses with friction": {"response": "impulses", "friction": 0.3},
    "springs with friction": {"friction": 0.3},
    "impulses": {"response": "impulses"},
}
HEAPS = [(2, 4, 150), (3, 2, 40)]


@pytest.mark.parametrize(
    ("dimension", "along", "steps", "contact"),
    [
        pytest.param(*heap, contact, id=f"{heap[0]}D {name}", marks=marks)
        for k, (name, contact) in enumerate(CONTACTS.items())
        for heap in HEAPS
        for marks in [() if k < 2 and (heap[0] == 2 or k == 0) else pytest.mark.slow]
    ],
)
def test_bodies_in_another_order(
    dimension: int, along: int, steps: int, contact: dict[str, Any]
) -> None:
    """With springs discs differed from the fifth step on: sums went by the numbers of bodies."""
    case = corner(dimension, along, contact)
    count = along**dimension
    first = run(case, np.arange(count), steps)
    other = run(case, np.random.default_rng(1).permutation(count), steps)
    assert [name for name in first if first[name] != other[name]] == []
