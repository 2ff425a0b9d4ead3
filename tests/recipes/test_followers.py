# SPDX-License-Identifier: BSD-3-Clause
"""Nodes that hardly any matter reaches follow those within: corners of turned bodies, tips, planes
of symmetry. All by default settings."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp import Case, Simulation

CELL = 5e-3
RUBBER = {"density": 1100.0, "strength": {"neo_hookean": {"K": 20e6, "G": 1e6}}}
BLOCK = {"box": {"centre": [0.0, 0.08], "size": [0.08, 0.04]}}
SHAPES = {
    "block, 30 degrees": {"rotate": {"shape": BLOCK, "angle": np.pi / 6, "about": [0.0, 0.08]}},
    "block, 41 degrees": {"rotate": {"shape": BLOCK, "angle": 0.72, "about": [0.0, 0.08]}},
    "kite": {"polygon": {"points": [[0.0013, 0.03], [0.03, 0.06], [0.0, 0.11], [-0.03, 0.06]]}},
    "triangle": {"polygon": {"points": [[0.001, 0.03], [0.05, 0.06], [-0.01, 0.1]]}},
}


def falling(shape: dict[str, Any], friction: float) -> Case:
    box = {"lower": [-0.2, 0.0], "upper": [0.2, 0.3], "walls": {"y_min": "contact"}}
    return Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": CELL, "box": {**box, "friction": friction}},
            "run": {"end_time": 0.3, "gravity": [0.0, -9.81]},
            "material": {"m": RUBBER},
            "body": {"a": {"material": "m", "frame": "material", "shape": shape}},
        }
    )


def turns_against_body(simulation: Simulation) -> float:
    """The largest angle between the turning of a particle and that of the body [rad]."""
    start, now = (simulation.column("a", name) for name in ("reference_position", "position"))
    left, _, right = np.linalg.svd((start - start.mean(axis=0)).T @ (now - now.mean(axis=0)))
    turned = (left @ right).T
    F = simulation.column("a", "deformation_gradient").reshape(-1, 2, 2)
    angles = np.arctan2(F[:, 1, 0] - F[:, 0, 1], F[:, 0, 0] + F[:, 1, 1])
    body = np.arctan2(turned[1, 0], turned[0, 0])
    return float(np.abs(np.angle(np.exp(1j * (angles - body)))).max())


@pytest.mark.parametrize("friction", [0.0, 0.5])
@pytest.mark.parametrize("shape", SHAPES)
def test_no_particle_turns_by_itself(shape: str, friction: float) -> None:
    """Rubber that falls on an edge or a tip: without a node to follow particles there turned by 126
    to 179 degrees, and blocks lost 9 to 16 % of their energy in .3 s."""
    case = falling(SHAPES[shape], friction)
    simulation, most = Simulation(case), 0.0
    for time in np.linspace(0.02, 0.3, 15):
        simulation.advance(10**7, time)
        most = max(most, turns_against_body(simulation))
    row = dict(zip(simulation.core.history_columns, simulation.core.history()[-1], strict=True))
    assert np.degrees(most) < 45.0  # of rubber that is sheared at an edge
    for column in ("contact", "numerical"):
        assert abs(row[column]) < 0.004 * abs(row["external"])


def toothed(half: bool, steps: int) -> Simulation:
    """A block with two teeth of one particle each on its top, a cell beside the middle, that hits a
    floor; or the half of it at a plane of symmetry."""
    h, sides = CELL, (1.0,) if half else (1.0, -1.0)
    lower = [0.0 if half else -3 * h, 1.2 * h]
    parts: list[dict[str, Any]] = [{"box": {"lower": lower, "upper": [3 * h, 6 * h]}}]
    for side in sides:
        x = sorted([side * 0.5 * h, side * h])
        parts.append({"box": {"lower": [x[0], 6 * h], "upper": [x[1], 7 * h]}})
    walls = {"y_min": "contact"} | ({"x_min": "slip"} if half else {})
    box = {"lower": [0.0 if half else -0.1, 0.0], "upper": [0.1, 0.1], "walls": walls}
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": h, "box": box},
            "run": {"end_time": 1.0},
            "material": {"m": RUBBER},
            "body": {
                "a": {
                    "material": "m",
                    "frame": "material",
                    "shape": {"union": parts},
                    "fill": "lattice",
                    "velocity": [0.0, -3.0],
                }
            },
        }
    )
    simulation = Simulation(case)
    simulation.advance(steps)
    return simulation


def test_half_a_body_has_the_followers_of_the_whole() -> None:
    """Those who lead may lie beyond the plane of symmetry: the same to rounding, and the momentum
    of the half is what the faces of the box have given it."""
    half, whole = toothed(True, 300), toothed(False, 300)
    found = []
    for simulation in (half, whole):
        start = simulation.column("a", "reference_position")
        own = start[:, 0] > 0.0
        order = np.lexsort(start[own].round(9).T)
        found.append([simulation.column("a", of)[own][order] for of in ("velocity", "position")])
    for ours, theirs, size in zip(*found, (3.0, CELL), strict=True):
        assert np.abs(ours - theirs).max() < 1e-9 * size
    walls = {face.name: face for face in half.core.walls()}
    columns = list(half.core.history_columns)
    momentum = half.core.history()[-1][columns.index("momentum_x")]
    assert walls["x_min"].impulse[0] != 0.0
    given = -sum(face.impulse[0] for face in walls.values())
    assert given == pytest.approx(momentum, abs=1e-9 * abs(walls["x_min"].impulse[0]))
