# SPDX-License-Identifier: BSD-3-Clause
"""Contact between surfaces at walls that are planes of symmetry: halves and quarters of wholes."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mpm3dpp import Case, Simulation

CELL = 1e-3


def stack(dimension: int, cut: tuple[int, ...]) -> Case:
    """Return a block that falls on a wider one, rubber, which stands on a floor with friction.

    Cut along some axes at the middle, where walls are planes of symmetry.
    """
    axes = [0, 2][: dimension - 1]

    def box(half: float, low: float, high: float) -> dict[str, Any]:
        lower = [0.0 if a in cut else -half * CELL for a in range(3)]
        upper = [half * CELL] * 3
        lower[1], upper[1] = low * CELL, high * CELL
        return {"box": {"lower": lower[:dimension], "upper": upper[:dimension]}}

    walls = {"y_min": "contact"} | {f"{'xyz'[a]}_min": "slip" for a in axes if a in cut}
    edges = [0.0 if a in cut else -20 * CELL for a in range(3)]
    edges[1] = 0.0
    body = {"material": "m", "frame": "material"}
    return Case.model_validate(
        {
            "grid": {
                "dimension": dimension,
                "cell_size": CELL,
                "box": {
                    "lower": edges[:dimension],
                    "upper": [20 * CELL, 40 * CELL, 20 * CELL][:dimension],
                    "walls": walls,
                    "friction": {"y_min": 0.3},
                },
            },
            "run": {"end_time": 1.0, "gravity": [0.0, -50.0, 0.0][:dimension]},
            "contact": {"friction": 0.3},
            "material": {
                "m": {"density": 1000.0, "strength": {"neo_hookean": {"K": 1.2e6, "G": 4e5}}}
            },
            "body": {
                "anvil": {**body, "shape": box(6, 0, 4)},
                "hammer": {
                    **body,
                    "shape": box(3, 4.2, 9.2),
                    "velocity": [0.0, -4.0, 0.0][:dimension],
                },
            },
        }
    )


def ends(case: Case, steps: int) -> tuple[Simulation, list[np.ndarray]]:
    """Return velocities and places of what lies in the quarter that all have, by where it began."""
    simulation, found = Simulation(case), []
    simulation.advance(steps)
    for name in simulation.bodies:
        start = simulation.column(name, "reference_position")
        own = (np.delete(start, 1, axis=1) > 0.0).all(axis=1)
        order = np.lexsort(start[own].round(9).T)
        found += [simulation.column(name, of)[own][order] for of in ("velocity", "position")]
    return simulation, found


@pytest.mark.parametrize(("dimension", "cut"), [(2, (0,)), (3, (0,)), (3, (0, 2))])
def test_a_part_moves_as_that_of_the_whole(dimension: int, cut: tuple[int, ...]) -> None:
    """In 2D to rounding; in 3D wholes turn with their own inertia, and points of edges differ."""
    steps = 110 if dimension == 2 else 60
    part, found = ends(stack(dimension, cut), steps)
    _, expected = ends(stack(dimension, ()), steps)
    assert part.core.contact_summary()["touching_points_max"] > 5
    near = 1e-11 if dimension == 2 else 2e-4
    for ours, theirs, size in zip(found, expected, [4.0, CELL] * 2, strict=True):
        assert np.abs(ours - theirs).max() < near * size


def test_what_passes_through_the_plane_is_given_by_the_wall() -> None:
    """The momentum of the half is what the faces of the box have given it."""
    half, _ = ends(stack(2, (0,)), 110)
    walls = {face.name: face for face in half.core.walls()}
    momentum = half.history()["momentum_x"][-1]
    given = sum(face.impulse[0] for face in walls.values())
    assert walls["x_min"].impulse[0] != 0.0
    # Its records are of what bodies do to the faces.
    assert -given == pytest.approx(momentum, abs=1e-9 * abs(walls["x_min"].impulse[0]))


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_layer_between_two_planes_is_the_same_from_either(dimension: int) -> None:
    """A layer of one cell with one particle across it: each point feels images behind both walls,
    which give it forces of the same size."""
    wide = [CELL, 8 * CELL, 4 * CELL][:dimension]

    def box(low: float, high: float) -> dict[str, Any]:
        lower, upper = [0.0, low * CELL, 0.0], [wide[0], high * CELL, wide[-1]]
        return {"box": {"lower": lower[:dimension], "upper": upper[:dimension]}}

    body = {"material": "m", "frame": "material", "particles_per_cell": 1}
    fall = [0.0, -5.0, 0.0][:dimension]
    case = Case.model_validate(
        {
            "grid": {
                "dimension": dimension,
                "cell_size": CELL,
                "box": {
                    "lower": [0.0] * dimension,
                    "upper": [CELL, 20 * CELL, 20 * CELL][:dimension],
                    "walls": {"x_min": "slip", "x_max": "slip", "y_min": "fixed"},
                },
            },
            "run": {"end_time": 1.0},
            "material": {"m": {"density": 1000.0, "strength": {"elastic": {"E": 1e6, "nu": 0.3}}}},
            "body": {
                "anvil": {**body, "shape": box(0.0, 4.0)},
                "hammer": {**body, "shape": box(4.1, 8.1), "velocity": fall},
            },
        }
    )
    simulation = Simulation(case)
    simulation.advance(40)
    assert simulation.core.contact_summary()["touching_points_max"] > 1
    faces = {face.name: np.array(face.impulse) for face in simulation.core.walls()}
    one, other = faces["x_min"], faces["x_max"]
    assert one[0] != 0.0
    assert one[0] == pytest.approx(-other[0], rel=1e-9)
    assert one[1:] == pytest.approx(other[1:], abs=1e-9 * abs(one[0]))
    # All of it moves along y as it would in a strip of any width.
    assert np.abs(simulation.column("hammer", "velocity")[:, 0]).max() < 1e-9
