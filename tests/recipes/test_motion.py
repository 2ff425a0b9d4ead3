# SPDX-License-Identifier: BSD-3-Clause
"""Prescribed motions and loads that depend on time: closed forms, work, impulse, same bits."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, DENSITY, SCHEMES, YOUNG, block, box, materials
from mpm3dpp import Body, Case, Contact, Grid, Material, Motion, Run, Simulation, shapes

SOFT = Material(density=DENSITY, strength={"elastic": {"E": YOUNG, "nu": 0.0}})
STONE = Material(density=3000.0, strength={"rigid": {}})


def simulation(
    dimension: int,
    bodies: dict[str, Body],
    threads: int = 1,
    friction: float = 0.0,
    grid: dict[str, Any] | None = None,
    **run: Any,
) -> Simulation:
    settings = {"cfl": 0.2, "end_time": 10.0, "energy_growth_limit": 1e9} | run
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, **(grid or {})),
        run=Run(**settings),
        contact=Contact(friction=friction),
        material=materials() | {"soft": SOFT, "stone": STONE},
        body=bodies,
    )
    return Simulation(case, threads=threads)


def history(sim: Simulation) -> dict[str, np.ndarray]:
    return dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))


def check_balance(rows: dict[str, np.ndarray], gravity: bool = False) -> None:
    """The energy closes at rounding; momentum less the impulse of the motions stays."""
    size = max(np.abs(rows[name]).max() for name in ("kinetic", "internal", "external"))
    assert np.abs(rows["residual"]).max() < 1e-11 * size
    if not gravity:
        for x in "xyz":
            kept = rows[f"momentum_{x}"] - rows[f"motion_impulse_{x}"]
            size = np.abs([rows[f"motion_impulse_{y}"] for y in "xyz"]).max()
            assert np.abs(kept - kept[0]).max() < 1e-12 * size


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_a_moving_plate_drags_a_block(scheme: str, basis: str) -> None:
    """While it slips m v_x is mu times the impulse of the plate, m (g t + v_y); then it sticks.

    That holds however the block swings under the weight that is suddenly on, as long as it is
    pressed on. Sticking is sought from 2.5 times mu g t = V on; by then swings of a tenth of V are
    left in the block, whose mean velocity is compared.
    """
    V, g, mu = 0.03, 10.0, 0.3
    bodies = {
        "plate": block((0, 0), (30, 3), material="soft", motion={"velocity": (V, 0.0)}),
        "block": block((4, 3), (8, 3), material="solid"),
    }
    sim = simulation(
        2, bodies, friction=mu, gravity=(0.0, -g), scheme=scheme, grid={"basis": basis}
    )
    slips = V / (mu * g)
    for t in np.linspace(0.2, 0.8, 4) * slips:
        sim.advance(10**9, end_time=float(t))
        v = sim.column("block", "velocity").mean(axis=0)
        assert v[0] == pytest.approx(mu * (g * t + v[1]), rel=0.02)
    found = []
    for t in np.linspace(2.5, 3.5, 21) * slips:
        sim.advance(10**9, end_time=float(t))
        found.append(sim.column("block", "velocity").mean(axis=0)[0])
    assert np.mean(found) == pytest.approx(V, rel=0.02)
    assert np.abs(np.array(found) - V).max() < 0.1 * V
    plate = sim.column("plate", "velocity")
    assert np.array_equal(plate, np.broadcast_to((V, 0.0), plate.shape))
    assert sim.column("plate", "position")[0, 0] == pytest.approx(
        CELL / 4 + V * sim.time, rel=1e-12
    )
    assert np.all(sim.column("plate", "stress") == 0.0)
    check_balance(history(sim), gravity=True)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_turning_plate_drags_a_block(dimension: int) -> None:
    """About a centre 100 m away: to 1e-3 the plate slides, and drags as one that does.

    The particles' distances from the centre stay to rounding of the 100 m. At the block's edges the
    normals are inclined, so that it gets some 2 % more.
    """
    V, g, mu, R, d = 0.03, 10.0, 0.3, 100.0, dimension
    spin = -V / R if d == 2 else (0.0, 0.0, -V / R)
    centre = (8 * CELL, -R, 0.0)[:d]
    motion = {"angular_velocity": spin, "centre": centre}
    bodies = {
        "plate": block((0, 0, 0)[:d], (16, 3, 6)[:d], material="stone", motion=motion),
        "block": block((4, 3, 1)[:d], (8, 3, 4)[:d], material="solid"),
    }
    sim = simulation(d, bodies, friction=mu, gravity=(0.0, -g, 0.0)[:d])
    arm = np.linalg.norm(sim.column("plate", "position") - centre, axis=1)
    for t in np.array((0.3, 0.6)) * V / (mu * g):
        sim.advance(10**9, end_time=float(t))
        v = sim.column("block", "velocity").mean(axis=0)
        assert v[0] == pytest.approx(mu * (g * t + v[1]), rel=0.03)
    now = np.linalg.norm(sim.column("plate", "position") - centre, axis=1)
    assert np.abs(now - arm).max() < 1e-15 * R * sim.step
    check_balance(history(sim), gravity=True)


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_a_piston_pushes_a_column(scheme: str, basis: str) -> None:
    """Behind the front of the wave the stress is rho c v, and so is the piston's force per area.

    The piston takes up its speed while the wave runs twenty cells: a sudden one rings on the grid.
    """
    length, v = 120, 0.05
    c = np.sqrt(YOUNG / DENSITY)
    rise = 20 * CELL / c
    walls = {"y_min": "slip", "y_max": "slip"}
    grid = {
        "basis": basis,
        "box": {"lower": (-20 * CELL, 0.0), "upper": (180 * CELL, CELL), "walls": walls},
    }
    push = {"ramp": {"to": v, "end": rise}}
    bodies = {
        "piston": block((-3, 0), (3, 1), material="soft", motion={"velocity": (push, 0.0)}),
        "column": block((0, 0), (length, 1), material="soft"),
    }
    sim = simulation(2, bodies, grid=grid, scheme=scheme)
    start = sim.column("column", "position")[:, 0]
    sim.advance(10**9, end_time=0.8 * length * CELL / c)
    behind = (start > 0.1 * length * CELL) & (start < 0.5 * length * CELL)
    stress = sim.column("column", "stress")[behind, 0]
    assert stress.mean() == pytest.approx(-DENSITY * c * v, rel=0.005)
    means = stress.reshape(12, 16).mean(axis=1)  # over four cells each; particles scatter more
    assert np.abs(means + DENSITY * c * v).max() < 0.015 * DENSITY * c * v
    rows = history(sim)
    check_balance(rows)
    # The piston has done the work of rho c v(t)^2 per time and area, half of it kinetic; and it
    # has its own kinetic energy and momentum.
    own = DENSITY * 3 * CELL**2
    work = DENSITY * c * CELL * v**2 * (sim.time - rise + rise / 3)
    impulse = DENSITY * c * CELL * v * (sim.time - rise / 2)
    kinetic = 0.5 * own * v**2
    assert rows["motion_work"][-1] == pytest.approx(work + kinetic, rel=0.02)
    assert rows["kinetic"][-1] == pytest.approx(work / 2 + kinetic, rel=0.02)
    assert rows["motion_impulse_x"][-1] == pytest.approx(impulse + own * v, rel=0.02)


@pytest.mark.parametrize("scheme", SCHEMES)
def test_shaken_gravity_gives_its_integral(scheme: str) -> None:
    """A free body's velocity is the integral of gravity, to rounding, whatever the time step."""
    gravity = (
        {"sine": {"amplitude": 30.0, "period": 0.011, "phase": 0.3, "mean": 2.0}},
        {"times": [0.002, 0.005, 0.013], "values": [0.0, -9.0, 4.0]},
        {"ramp": {"to": 6.0, "start": 0.001, "end": 0.004}},
    )
    bodies = {"block": block((0, 0, 0), (3, 2, 2), material="solid", velocity=(1.0, 0.0, 0.0))}
    sim = simulation(3, bodies, gravity=gravity, scheme=scheme)
    sim.advance(10**9, end_time=0.02)
    w, t = 2 * np.pi / 0.011, 0.02
    expected = (
        1.0 + 2.0 * t + 30.0 / w * (np.cos(0.3) - np.cos(w * t + 0.3)),
        -0.5 * 9.0 * 0.003 - 0.5 * (9.0 - 4.0) * 0.008 + 4.0 * 0.007,
        0.5 * 6.0 * 0.003 + 6.0 * 0.016,
    )
    v = sim.column("block", "velocity")
    # A rounding of 1 m/s in each of the steps, some 500.
    assert np.abs(v - expected).max() < 1e-13
    rows = history(sim)
    assert np.abs(rows["residual"]).max() < 1e-13 * rows["kinetic"].max()
    gained = rows["kinetic"][-1] - rows["kinetic"][0]
    assert rows["external"][-1] == pytest.approx(gained, rel=1e-10)


def test_a_constant_in_a_table_is_the_constant() -> None:
    bodies = {"block": block((0, 0), (3, 2), material="solid")}
    ends = []
    for down in (-10.0, {"times": [0.0], "values": [-10.0]}):
        sim = simulation(2, bodies, gravity=(0.0, down))
        sim.advance(50)
        ends.append(sim.column("block", "position"))
    assert np.abs(ends[0] - ends[1]).max() < 1e-15


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_prescribed_turn_is_the_integral(dimension: int) -> None:
    """A body that turns about an axis off its centre, while that moves: exact but for rounding."""
    spin = {"ramp": {"from": 0.0, "to": 100.0, "end": 0.02}}
    moves = {"sine": {"amplitude": 2.0, "frequency": 40.0}}
    centre = (0.03, 0.01, 0.0)[:dimension]
    motion = {
        "velocity": (moves, 0.0, 0.0)[:dimension],
        "angular_velocity": spin if dimension == 2 else (0.0, 0.0, spin),
        "centre": centre,
    }
    d = dimension
    bodies = {
        "drum": block((0,) * d, (3,) * d, material="stone", motion=motion),
        "far": block((40,) * d, (2,) * d, material="solid"),
    }
    sim = simulation(d, bodies)
    arm = sim.column("drum", "position") - centre
    while sim.time < 0.03:
        sim.advance(500, end_time=0.03)
    t = sim.time
    angle = 0.5 * 100.0 * 0.02 + 100.0 * (t - 0.02)
    w = 2 * np.pi * 40.0
    turned = arm.copy()
    turned[:, 0] = np.cos(angle) * arm[:, 0] - np.sin(angle) * arm[:, 1]
    turned[:, 1] = np.sin(angle) * arm[:, 0] + np.cos(angle) * arm[:, 1]
    turned[:, 0] += 2.0 / w * (1 - np.cos(w * t))
    assert np.abs(sim.column("drum", "position") - centre - turned).max() < 1e-14
    rows = history(sim)
    gained = rows["kinetic"][-1] - rows["kinetic"][0]
    assert rows["motion_work"][-1] == pytest.approx(gained, rel=1e-12)
    check_balance(rows)


def test_a_ball_in_a_fixed_box() -> None:
    """It bounces, stays in, and no energy is made; the box stands still."""
    side = 12 * CELL
    inner = shapes.Box(lower=(0.0,) * 3, upper=(side,) * 3)
    outer = shapes.Box(lower=(-2 * CELL,) * 3, upper=(side + 2 * CELL,) * 3)
    ball = shapes.Sphere(centre=(5 * CELL, 6 * CELL, 4 * CELL), radius=3 * CELL)
    bodies = {
        "box": Body(shape=outer - inner, material="stone", motion="fixed"),
        "ball": Body(shape=ball, material="solid", velocity=(2.0, 1.0, -3.0)),
    }
    sim = simulation(3, bodies, friction=0.2, gravity=(0.0, 0.0, -9.81), cfl=0.25)
    walls = sim.column("box", "position")
    sim.advance(10**9, end_time=0.012)
    x, v = sim.column("ball", "position"), sim.column("ball", "velocity")
    assert x.min() > -0.5 * CELL
    assert x.max() < side + 0.5 * CELL
    assert v[:, 2].mean() > 0.5  # It has bounced ...
    assert len(sim.core.contact_pairs()) == 1
    assert np.array_equal(sim.column("box", "position"), walls)
    rows = history(sim)
    check_balance(rows, gravity=True)
    assert np.all(rows["motion_work"] == 0.0)  # What stands still does no work.
    assert rows["motion_impulse_z"][-1] > 0.0
    made = -(rows["numerical"] + rows["contact"])
    assert (
        made.max() < 0.02 * rows["kinetic"][0]
    )  # ... and a fiftieth is the error of the time step.


def test_a_fixed_funnel_holds_a_disc() -> None:
    """Its impulse is m (g t + v) always; its force the weight once that is fully on.

    A fifth of a cell closes the gap that the lattice leaves between the two.
    """
    funnel = shapes.Funnel(
        centre=(0.0, 0.0), outlet_radius=2 * CELL, inlet_radius=8 * CELL, height=6 * CELL,
        thickness=2.5 * CELL,
    )  # fmt: skip
    middle = float(4 * np.sqrt(2.0) - 2 - 0.2) * CELL  # The walls, |x| = outlet + y, touch it.
    bodies = {
        "funnel": Body(shape=funnel, material="stone", motion="fixed"),
        "disc": Body(
            shape=shapes.Disc(centre=(0.0, middle), radius=4 * CELL),
            material="solid",
            frame="updated",
        ),
    }
    on, end, g = 0.03, 0.055, 9.81
    gravity = (0.0, {"ramp": {"to": -g, "end": on}})
    viscosity = {"quadratic": 1.5, "linear": 1.0}
    sim = simulation(2, bodies, gravity=gravity, viscosity=viscosity, cfl=0.5)
    weight = g * sim.core.column(1, "mass").sum()
    forces = []
    while sim.time < end:
        sim.advance(20, end_time=end)
        if sim.time > on:
            [pair] = sim.core.contact_pairs()
            fall = sim.time - on / 2 + sim.column("disc", "velocity")[:, 1].mean() / g
            assert -pair.impulse[1] == pytest.approx(weight * fall, rel=1e-10)
            forces.append(-pair.force[1])
    assert np.mean(forces) == pytest.approx(weight, rel=0.005)
    assert np.abs(np.array(forces) - weight).max() < 0.1 * weight
    rows = history(sim)
    check_balance(rows, gravity=True)
    made = -(rows["numerical"] + rows["contact"])
    # The funnel's sides are stairs of particles, with a surface in waves: 0.7 % of the work.
    assert made.max() < 1e-2 * rows["external"][-1]


def test_bodies_that_do_not_deform_do_not_act_on_each_other() -> None:
    """Walls may overlap each other and a rigid body may pass through them."""
    bodies = {
        "floor": block((0, 0), (10, 3), material="stone", motion="fixed"),
        "wall": block((0, 1), (3, 8), material="soft", motion=Motion(velocity=(0.0, 1.0))),
        "stone": block((4, 1), (3, 3), material="stone", velocity=(-3.0, -2.0)),
        "far": block((40, 0), (2, 2), material="solid"),
    }
    sim = simulation(2, bodies, friction=0.5)
    assert "stone is rigid and passes through" in sim.notes[0]
    before = sim.column("stone", "velocity")
    sim.advance(300)
    assert len(sim.core.contact_pairs()) == 0
    assert np.abs(sim.column("stone", "velocity") - before).max() < 1e-13
    rows = history(sim)
    assert np.abs(rows["motion_work"]).max() == 0.0


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_work_and_impulse_of_shaking_plates(scheme: str, basis: str) -> None:
    """A block between plates that shake, slide and turn: energy and momentum close."""
    shake = {"sine": {"amplitude": 1.0, "frequency": 60.0}}
    slide = {"times": [0.0, 0.01, 0.02], "values": [0.0, 2.0, -1.0]}
    turn = {"ramp": {"from": 5.0, "to": -20.0, "end": 0.02}}
    bodies = {
        "below": block((0, 0), (14, 3), material="stone", motion={"velocity": (slide, shake)}),
        "block": block((2, 3), (9, 6), material="solid"),
        "above": block((0, 9), (14, 3), material="soft", motion={"angular_velocity": turn}),
    }
    sim = simulation(2, bodies, friction=0.4, scheme=scheme, grid={"basis": basis})
    sim.advance(400, end_time=0.03)
    assert len(sim.core.contact_pairs()) == 2
    rows = history(sim)
    check_balance(rows)
    pairs = {pair.bodies: np.array(pair.impulse) for pair in sim.core.contact_pairs()}
    # What the plates have got from the block is what it has lost; it was at rest.
    block_momentum = (sim.column("block", "mass") * sim.column("block", "velocity")).sum(axis=0)
    given = -pairs[0, 1] + pairs[1, 2]
    assert np.abs(given[:2] - block_momentum).max() < 1e-11 * np.abs(given).max()


@pytest.mark.parametrize(("dimension", "scheme"), [(2, "usf"), (3, "usl"), (3, "musl")])
def test_the_same_bits_on_two_threads(dimension: int, scheme: str) -> None:
    d = dimension
    shake = {"sine": {"amplitude": 1.0, "frequency": 300.0}}
    bodies = {
        "floor": block((0, 0, 0)[:d], (14, 3, 6)[:d], material="stone", motion="fixed"),
        "block": block((2, 3, 0)[:d], (9, 5, 6)[:d], material="solid"),
        "tool": block(
            (4, 8, 0)[:d], (9, 4, 6)[:d], material="soft",
            motion={
                "velocity": ({"ramp": {"to": -3.0, "end": 1e-3}}, shake, 0.0)[:d],
                "angular_velocity": (0.0, 0.0, 20.0)[3 - (1 if d == 2 else 3) :],
            },
        ),
    }  # fmt: skip
    gravity = (0.0, {"ramp": {"to": -50.0, "end": 0.01}}, 0.0)[:d]
    runs = []
    for threads in (1, 2):
        sim = simulation(d, bodies, threads, friction=0.3, scheme=scheme, gravity=gravity)
        sim.advance(60)
        found = {f"{b} {c}": sim.column(b, c) for b in bodies for c in ("position", "velocity")}
        runs.append(found | {"history": sim.core.history()})
        assert len(sim.core.contact_pairs()) == 2
    assert [name for name in runs[0] if runs[0][name].tobytes() != runs[1][name].tobytes()] == []


def test_a_prescribed_body_leaves_the_box_of_the_grid_alone() -> None:
    """Walls of the grid do not hold it."""
    bodies = {
        "tool": block((2, 2), (3, 3), material="stone", motion={"velocity": (0.0, -1.0)}),
        "far": block((30, 20), (2, 2), material="solid"),
    }
    sim = simulation(2, bodies, grid=box(2, 40, "fixed"))
    start = sim.column("tool", "position")
    while sim.time < 0.05:
        sim.advance(200, end_time=0.05)
    moved = sim.column("tool", "position") - start
    assert moved[:, 1] == pytest.approx(-sim.time, rel=1e-12)
