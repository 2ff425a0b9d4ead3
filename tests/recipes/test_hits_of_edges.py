# SPDX-License-Identifier: BSD-3-Clause
"""Edges of turned blocks that hit, and three bodies at once, on nodes of their own, by default."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from in_body import part, run_and_look
from mpm3dpp import Case, Simulation

FRAME = {"material": "m", "frame": "material"}
E, NU, DENSITY = 1e7, 0.3, 1000.0
WAVES = float(np.sqrt(E * (1 - NU) / ((1 + NU) * (1 - 2 * NU)) / DENSITY))
MATTER = {"density": DENSITY, "strength": {"elastic": {"E": E, "nu": NU}}}


def vectors(simulation: Simulation, name: str, bodies: int) -> np.ndarray:
    return np.array([[part(simulation, f"{name}_{a}", k) for a in "xyz"] for k in range(bodies)])


def turning(simulation: Simulation, bodies: int) -> np.ndarray:
    """The angular momentum of all about the origin."""
    masses = np.array([[part(simulation, "mass", k)] for k in range(bodies)])
    centres, velocities = (vectors(simulation, name, bodies) for name in ("centre", "velocity"))
    own = vectors(simulation, "angular_momentum", bodies)
    return np.asarray((own + np.cross(centres, masses * velocities)).sum(axis=0))


def energy(columns: dict[str, np.ndarray]) -> np.ndarray:
    """Kinetic, internal and springs' energy over that at the start."""
    total = columns["kinetic"] + columns["internal"] + columns["springs"]
    return np.asarray(total / total[0])


def round_ones(
    dimension: int, cells: int, places: np.ndarray, velocities: np.ndarray, end: float, mu: float
) -> dict[str, Any]:
    """The tables of a case of discs or balls of the radius 1."""
    shape = "disc" if dimension == 2 else "sphere"
    bodies = {
        f"ball{k}": {
            "shape": {shape: {"centre": place[:dimension].tolist(), "radius": 1.0}},
            "velocity": velocity[:dimension].tolist(),
            **FRAME,
        }
        for k, (place, velocity) in enumerate(zip(places, velocities, strict=True))
    }
    return {
        "grid": {"dimension": dimension, "cell_size": 1.0 / cells},
        "run": {"end_time": end},
        "contact": {"friction": mu},
        "material": {"m": dict(MATTER)},
        "body": bodies,
    }


@pytest.mark.parametrize(("dimension", "cells"), [(2, 6), (3, 4)])
@pytest.mark.parametrize("mu", [0.0, 0.3])
def test_three_meet_at_once(dimension: int, cells: int, mu: float) -> None:
    """From three sides, 120 degrees apart and askew to the grid: each goes back the way it came.

    Their waves keep 1 to 3 % of the speed, more of discs; what the grid does to the three is not
    quite the same, by 1 %.
    """
    angles = 0.3 + 2 * np.pi * np.arange(3) / 3
    out = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    speed = 0.01 * WAVES
    places = 2 / np.sqrt(3) * 1.001 * out
    tables = round_ones(dimension, cells, places, -speed * out, 24 / WAVES, mu)
    simulation = Simulation(Case.model_validate(tables))
    columns, _ = run_and_look(simulation, 50)
    velocities = vectors(simulation, "velocity", 3) / speed
    back = np.sum(velocities * out, axis=1)
    assert (back > 0.96).all() and (back < 1.0).all() and np.ptp(back) < 0.01
    assert np.abs(velocities - back[:, None] * out).max() < 0.01
    assert np.abs(vectors(simulation, "spin", 3)).max() < 0.02 * speed
    mass = part(simulation, "mass")
    for axis in "xy":
        assert np.abs(columns[f"momentum_{axis}"]).max() < 1e-12 * mass * speed
    assert np.abs(turning(simulation, 3)).max() < 1e-12 * mass * speed
    assert 0.994 < energy(columns)[-1] <= energy(columns).max() < 1.0005


@pytest.mark.parametrize(("dimension", "cells"), [(2, 10), (3, 4)])
def test_a_ball_hits_two(dimension: int, cells: int) -> None:
    """Two that touch, abreast: they go off at 30 degrees with 2 3^(1/2) / 5 of its speed, and it
    comes back with a fifth of it (the closed form of smooth balls that lose nothing). 2 % of the
    speed: what waves keep."""
    speed = 0.002 * WAVES
    far = np.sqrt(3) * 1.0001
    places = np.array([[0, 0, 0], [far, 1.0001, 0], [far, -1.0001, 0]])
    velocities = speed * np.array([[1.0, 0, 0], [0, 0, 0], [0, 0, 0]])
    tables = round_ones(dimension, cells, places, velocities, 30 / WAVES, 0.0)
    simulation = Simulation(Case.model_validate(tables))
    columns, _ = run_and_look(simulation, 50)
    exact = np.array([[-0.2, 0, 0], [0.6, np.sqrt(0.12), 0], [0.6, -np.sqrt(0.12), 0]])
    found = vectors(simulation, "velocity", 3) / speed
    assert np.abs(found - exact).max() < 0.02
    assert columns["momentum_x"][-1] == pytest.approx(columns["momentum_x"][0], rel=1e-12)
    assert energy(columns)[-1] == pytest.approx(1.0, abs=0.003)


def test_three_discs_stand_in_a_box() -> None:
    """One rests on two that lean on walls, without friction: statics to 1 %.

    Each touches three things or two. The floor bears 3 W in all, each wall W tan / 2, each pair
    W / (2 cos) of the angle of its line to the vertical; restitution and a loss of the material
    bring them to rest.
    """
    cells, half = 4, 1.25  # half the distance of the lower two
    h, tall = 1.0 / cells, 5.0
    g = 3e-3 * WAVES**2 / tall
    walls = dict.fromkeys(("x_min", "x_max", "y_min"), "contact")
    width = 2 * half + 2.0
    places = np.array([[1.0, 1.0], [width - 1.0, 1.0], [width / 2, 1.0 + np.sqrt(4 - half**2)]])
    tables = round_ones(2, cells, places, np.zeros((3, 2)), 60 / np.sqrt(g), 0.0)
    tables["grid"]["box"] = {"lower": [0, 0], "upper": [width, tall], "walls": walls}
    tables["run"]["gravity"] = [0.0, -g]
    tables["contact"]["restitution"] = 0.5
    tables["material"]["m"]["damping"] = {"stiffness": 0.1 * h / WAVES}
    simulation = Simulation(Case.model_validate(tables))
    simulation.advance(10**7, simulation.case.run.end_time)
    weight = g * part(simulation, "mass")
    left, right, top = vectors(simulation, "centre", 3)
    angle = np.arctan2((right - left)[0] / 2, top[1] - left[1])
    sides = [np.array(wall.force) / weight for wall in simulation.core.walls()]
    pairs = [np.linalg.norm(pair.force) / weight for pair in simulation.core.contact_pairs()]
    floor = max(abs(force[1]) for force in sides)
    assert floor == pytest.approx(3.0, rel=0.005)
    on_walls = sorted(abs(force[0]) for force in sides)[1:]
    assert on_walls == pytest.approx([0.5 * np.tan(angle)] * 2, rel=0.01)
    assert pairs == pytest.approx([0.5 / np.cos(angle)] * 2, rel=0.01)


def block_on_its_edge(
    against: str,
    dimension: int,
    along: float,
    mu: float,
    degrees: float = 30.0,
    beside: float = 0.0,
) -> tuple[Case, Any]:
    """A turned block of 10 x 6 cells that comes down on its edge with 1 m/s, so many cells beside a
    node; and where the edge is, from its middle."""
    h, angle = 1e-2, np.radians(degrees)
    half = np.array([5 * h, 3 * h])
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    edge = turn @ (half * [-1, -1])
    centre = np.array([beside * h, 0.02 * h]) - edge
    deep = [2 * h] if dimension == 3 else []
    far, zero = 40 * h, [0.0] * (dimension - 2)

    def box(lower: Any, upper: Any) -> dict[str, Any]:
        ends = [[*lower, *(-d for d in deep)], [*upper, *deep]]
        return {"box": {"lower": [float(v) for v in ends[0]], "upper": [float(v) for v in ends[1]]}}

    turned: dict[str, Any] = {"shape": box(centre - half, centre + half), "angle": angle}
    turned |= {"axis": [0, 0, 1]} if dimension == 3 else {}
    shape = {"rotate": turned}
    bodies: dict[str, Any] = {"block": {"shape": shape, "velocity": [along, -1.0, *zero], **FRAME}}
    grid: dict[str, Any] = {"dimension": dimension, "cell_size": h}
    material: dict[str, Any] = {"m": MATTER}
    if against == "wall":
        ends = {"lower": [-far, 0, *(-far for _ in zero)], "upper": [far] * dimension}
        grid["box"] = {**ends, "walls": {"y_min": "contact"}, "friction": {"y_min": mu}}
    elif against == "plate":
        material["rigid"] = {"density": 2000.0, "strength": {"rigid": {}}}
        shape = box([-10 * h, -8 * h], [10 * h, 0.0])
        bodies["plate"] = {"material": "rigid", "shape": shape, "motion": "fixed"}
    else:
        bodies["other"] = {"shape": box([-10 * h, -8 * h], [10 * h, 0.0]), **FRAME}
    tables = {"grid": grid, "material": material, "body": bodies}
    tables |= {"run": {"end_time": 80 * h / WAVES}, "contact": {"friction": mu}}
    return Case.model_validate(tables), edge


EDGES = [
    (against, 2, along, mu)
    for against in ("wall", "plate", "block")
    for along, mu in ((0.0, 0.0), (3.0, 0.3), (-3.0, 0.3))
]
EDGES += [("wall", 3, 3.0, 0.3), ("block", 3, 3.0, 0.3)]


@pytest.mark.parametrize(("against", "dimension", "along", "mu"), EDGES)
def test_a_block_hits_with_an_edge(against: str, dimension: int, along: float, mu: float) -> None:
    """Momentum, moment about the edge, energy with what friction took, and friction that slides.

    The force acts where a stiff edge were to .15 of a cell, by which the edge is pressed in (.003
    to .1 of one), friction is mu of the normal force to 2e-3 on a wall, where the normal is known,
    but springs stick as they begin, and to 2 % on a face of points, which without friction pushes
    along itself by .8 % at most, by where among them the edge comes down.
    """
    case, edge = block_on_its_edge(against, dimension, along, mu)
    simulation = Simulation(case)
    count = 2 if against == "block" else 1
    mass, start = part(simulation, "mass"), turning(simulation, count)
    names = ("velocity_x", "velocity_y", "spin_z")
    columns, seen = run_and_look(simulation, 5, lambda s: [part(s, name) for name in names])
    times, (x, y, spin) = np.array([t for t, _ in seen]), np.array([of for _, of in seen]).T
    gained = mass * np.array([x[-1] - along, y[-1] + 1.0])
    taken = sum(columns[name][-1] for name in ("friction", "restitution", "contact"))
    assert energy(columns)[-1] + taken / columns["kinetic"][0] == pytest.approx(1.0, abs=1e-3)
    assert energy(columns).max() < 1.0005
    if mu:
        rubbed = -gained[0] / (mu * gained[1] * np.sign(along))
        assert rubbed == pytest.approx(1.0, abs=2e-3 if against == "wall" else 0.02)
    else:
        assert abs(gained[0]) < (0.003 if against == "wall" else 0.01) * gained[1]
    if count == 2:
        momentum = [columns[f"momentum_{a}"][[0, -1]] for a in "xyz"]
        assert np.abs(np.diff(momentum, axis=1)).max() < 1e-12 * mass
        assert np.abs(turning(simulation, count) - start).max() < 1e-12 * mass
    # The moment of what it gains in each step, at the edge as it turns with the block.
    turned = np.append(0.0, np.cumsum(0.5 * (spin[1:] + spin[:-1]) * np.diff(times)))
    arm_x = np.cos(turned) * edge[0] - np.sin(turned) * edge[1]
    arm_y = np.sin(turned) * edge[0] + np.cos(turned) * edge[1]
    mean_x, mean_y = (0.5 * (arm[1:] + arm[:-1]) for arm in (arm_x, arm_y))
    moment = mass * np.sum(mean_x * np.diff(y) - mean_y * np.diff(x))
    off = part(simulation, "angular_momentum_z") - moment
    assert abs(off) < 0.15 * 1e-2 * np.hypot(*gained)


PLACES = [(45.0, 0.5), (45.0, 0.425), (36.87, 0.45), (53.13, 0.55), (60.0, 0.647), (61.33, 0.65)]


@pytest.mark.parametrize(("degrees", "beside"), PLACES)
@pytest.mark.parametrize("basis", ["quadratic_bspline", "gimp"])
def test_an_edge_comes_down_beside_a_node(degrees: float, beside: float, basis: str) -> None:
    """The outermost nodes have next to no mass in these places: they must bear next to nothing. Up
    to .07 of the energy went into them, or the run stopped; .02 is what their damping takes."""
    case, _ = block_on_its_edge("wall", 2, 0.0, 0.0, degrees, beside)
    tables = case.model_copy(update={"grid": case.grid.model_copy(update={"basis": basis})})
    columns, _ = run_and_look(Simulation(tables), 50)
    assert 0.98 < energy(columns)[-1] < 1.0005
    assert energy(columns).max() < 1.001
