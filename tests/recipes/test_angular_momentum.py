# SPDX-License-Identifier: BSD-3-Clause
"""The balance of angular momentum: each impulse against a closed form, and what is left of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, SCHEMES, block, box, everything, materials
from mpm3dpp import Body, Case, Contact, Grid, Material, Run, Simulation, shapes
from mpm3dpp.case.loads import Load
from turning import GRAVITY, SPLINE, Array, balance, one, size, stirred
from worlds import World


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_apic_keeps_it_in_free_flight(dimension: int, scheme: str) -> None:
    sim = stirred(Simulation(one(dimension, transfer="apic", scheme=scheme), 1))
    sim.advance(20)
    terms = balance(sim)
    assert np.abs(terms["numerical"]).max() < 1e-13 * size(sim)
    for name in ("gravity", "loads", "walls", "motion", "removed"):
        assert not terms[name].any()


@pytest.mark.parametrize("dimension", [2, 3])
def test_flip_loses_it_and_says_how_much(dimension: int) -> None:
    """What is lost is the difference of the particles' sums, found here."""

    def summed(sim: Simulation) -> Array:
        x, v, m = (sim.column("body", name) for name in ("position", "velocity", "mass"))
        x, v = (np.pad(each, ((0, 0), (0, 3 - dimension))) for each in (x, v))
        return np.asarray(m[:, 0] @ np.cross(x, v))

    sim = stirred(Simulation(one(dimension, transfer="flip"), 1))
    before = summed(sim)
    sim.advance(20)
    lost = balance(sim)["numerical"]
    assert np.abs(lost - (before - summed(sim))).max() < 1e-13 * size(sim)
    assert np.abs(lost).max() > 1e-4 * size(sim)


@pytest.mark.parametrize("transfer", ["flip", "apic"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_gravity_turns_what_is_off_the_origin(dimension: int, transfer: str) -> None:
    """The impulse is the sum over the steps of M X x g dt, X the centre of a parabola in steps."""
    start, x, g = np.zeros((3, 3))
    start[:dimension] = (2.0, -1.0, 0.5)[:dimension]
    x[:dimension], g[:dimension] = 5 * CELL, GRAVITY[:dimension]
    run = {"transfer": transfer, "gravity": GRAVITY[:dimension], "time_step": 1e-5}
    body = {"velocity": tuple(start[:dimension].tolist())}
    sim = Simulation(one(dimension, body=body, **run), 1)
    mass = float(sim.column("body", "mass").sum())
    n, dt = 50, 1e-5
    sim.advance(n)
    terms = balance(sim)
    expected = mass * (n * dt * np.cross(x, g) + 0.5 * n * (n - 1) * dt**2 * np.cross(start, g))
    assert np.abs(terms["gravity"] - expected).max() < 1e-12 * np.abs(expected).max()
    # A body that falls freely keeps its spin, whatever the transfer.
    assert np.abs(terms["numerical"]).max() < 1e-13 * size(sim)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("wall", ["slip", "fixed", "absorbing"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_walls_and_loads_account_for_all(dimension: int, wall: str, scheme: str) -> None:
    """With apic nothing is left, whatever a body does in a corner, under gravity and loads."""
    grid = box(dimension, 12, {"x_min": wall, "y_min": wall})
    forces = ({"expression": "3 + x"}, {"expression": "20 * y - x"}, 0.0)[:dimension]
    case = one(
        dimension,
        grid,
        at=(0, 0, 0),
        body={"body_force": forces},
        load={"push": Load(body="body", side="x_max", pressure=500.0)},
        transfer="apic",
        scheme=scheme,
        gravity=GRAVITY[:dimension],
    )
    sim = stirred(Simulation(case, 1))
    sim.advance(20)
    terms = balance(sim)
    for name in ("gravity", "loads", "walls"):
        assert np.abs(terms[name]).max() > 1e-4 * size(sim)
    assert np.abs(terms["numerical"]).max() < 1e-12 * size(sim)


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("transfer", ["flip", "apic"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_body_on_a_frictionless_wall(dimension: int, transfer: str, basis: str) -> None:
    """The wall pushes upwards below the centre: its impulse there is what gravity's lacks.

    The block bounces, both its halves alike.
    """
    if transfer == "apic" and basis != SPLINE:
        return
    grid = box(dimension, 20, {"y_min": "slip"}) | {"basis": basis}
    gravity = (0.0, -9.81, 0.0)[:dimension]
    sim = Simulation(one(dimension, grid, (8, 0, 6), transfer=transfer, gravity=gravity), 1)
    pushed, fell = np.zeros(3), np.zeros(3)
    mass = float(sim.column("body", "mass").sum())
    for _ in range(200):
        (centre, momentum), time = middle(sim), sim.time
        sim.advance(1)
        weight = np.array([0.0, -9.81, 0.0]) * mass * (sim.time - time)
        push = middle(sim)[1] - momentum - weight
        assert abs(push[0]) + abs(push[2]) < 1e-12 * size(sim)
        pushed += np.cross(centre, push)
        fell += np.cross(centre, weight)
    terms = balance(sim)
    assert np.abs(pushed).max() > 0.1 * np.abs(fell).max()
    assert np.abs(terms["gravity"] - fell).max() < 1e-11 * np.abs(fell).max()
    assert np.abs(terms["walls"] - pushed).max() < 1e-11 * np.abs(fell).max()


def middle(sim: Simulation, body: str = "body") -> tuple[Array, Array]:
    """Return mass centre and momentum of a body."""
    x, v, m = (sim.column(body, name) for name in ("position", "velocity", "mass"))
    x, v = (np.pad(each, ((0, 0), (0, 3 - each.shape[1]))) for each in (x, v))
    return m[:, 0] @ x / m.sum(), m[:, 0] @ v


@pytest.mark.parametrize("transfer", ["flip", "apic"])
def test_a_beam_pulled_at_its_end_spins_up(transfer: str) -> None:
    """A pair of tractions at both ends: the torque is force times length, the spin its integral.

    While the beam has turned little; so the arm has shortened by (angle^2) / 2 at most.
    """
    length, height = 24 * CELL, 6 * CELL
    stress, end = 200.0, 4e-3
    beam = Body(
        material="solid",
        shape=shapes.Box(lower=(CELL, CELL), upper=(CELL + length, CELL + height)),
    )
    pull = {
        side: Load(body="body", side=side, traction=(0.0, sign * stress))
        for side, sign in (("x_max", 1.0), ("x_min", -1.0))
    }
    case = Case(
        grid=Grid(dimension=2, cell_size=CELL, basis=SPLINE),
        run=Run(end_time=end, transfer=transfer),
        material={"solid": materials()["solid"]},
        body={"body": beam},
        load=pull,
    )
    sim = Simulation(case, 1)
    sim.advance(1)
    first = balance(sim)["loads"]
    assert first[2] == pytest.approx(stress * height * length * sim.time, rel=1e-12)
    sim.advance(10**6)
    terms = balance(sim)
    # The ends lag behind the pull by what the beam bends.
    assert terms["loads"][2] == pytest.approx(stress * height * length * end, rel=1e-2)
    left = 1e-13 if transfer == "apic" else 0.02
    assert abs(terms["momentum"][2] / terms["loads"][2] - 1.0) < left


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_prescribed_rotor_in_a_ring(dimension: int) -> None:
    """Work of a steady rotation is spin times angular impulse, exactly; friction turns the disc.

    The disc in the rotor gets what the rotor gives, but for what the method loses.
    """
    cells = 10 if dimension == 2 else 6
    inner, outer, radius = cells * CELL, (cells + 3) * CELL, (cells - 0.02) * CELL
    middle_at = (0.0,) * dimension
    if dimension == 2:
        rotor: Any = shapes.Ring(centre=middle_at, inner_radius=inner, outer_radius=outer)
        disc: Any = shapes.Disc(centre=middle_at, radius=radius)
    else:
        height = 3 * CELL
        rotor = shapes.Tube(centre=middle_at, inner_radius=inner, outer_radius=outer, height=height)
        disc = shapes.Cylinder(centre=middle_at, radius=radius, height=height)
    spin: Any = 20.0 if dimension == 2 else (0.0, 0.0, 20.0)
    # It stretches along x, and so into the rotor.
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis=SPLINE),
        run=Run(end_time=1.0, cfl=0.4, transfer="apic"),
        contact=Contact(friction=0.5),
        material=materials(),
        body={
            "rotor": Body(material="solid", shape=rotor, motion={"angular_velocity": spin}),
            "body": Body(
                material="solid",
                shape=disc,
                velocity=({"expression": "2 * x"}, 0.3, 0.0)[:dimension],
            ),
        },
    )
    sim = Simulation(case, 1)
    start = balance(sim)["momentum"]
    sim.advance(400)
    rows = dict(zip(sim.core.history_columns, sim.core.history()[-1], strict=True))
    terms = balance(sim)
    given = terms["motion"][2]
    assert rows["motion_work"] == pytest.approx(20.0 * given, rel=1e-12)
    assert given > 0.01 * size(sim)
    gained = terms["momentum"] - start
    assert abs(gained[2] - given + terms["numerical"][2]) < 1e-12 * size(sim, "rotor")
    # Positions move by velocities without approach, which particles do not have.
    assert abs(terms["numerical"][2]) < 0.02 * given


@pytest.mark.parametrize("transfer", ["flip", "apic"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_particles_that_leave_take_theirs(dimension: int, transfer: str) -> None:
    """A block that flies straight out takes all its m x v, which the flight does not change."""
    lower, upper = (0.0,) * dimension, (12 * CELL,) * dimension
    velocity = (9.0, 2.0, -1.0)[:dimension]
    grid = {"outflow_box": {"lower": lower, "upper": upper}}
    sim = Simulation(one(dimension, grid, body={"velocity": velocity}, transfer=transfer), 1)
    start, scale = balance(sim)["momentum"], size(sim)
    sim.advance(10**6, end_time=6 * CELL / 9.0)
    terms = balance(sim)
    assert 0.1 * scale < np.abs(terms["momentum"]).max() < 0.9 * np.abs(start).max()
    sim.advance(10**6, end_time=12 * CELL / 9.0)
    terms = balance(sim)
    assert not terms["momentum"].any()
    assert np.abs(terms["removed"] - start).max() < 1e-12 * scale
    assert np.abs(terms["numerical"]).max() < 1e-12 * scale


@pytest.mark.parametrize("transfer", ["flip", "apic"])
def test_eroded_particles_take_theirs(transfer: str) -> None:
    """A spinning bar bursts; what is gone is the sum over the particles that failed."""
    law = {"principal_stress": {"limit": 2e4, "action": "erode"}}
    weak = Material(density=1000.0, strength={"elastic": {"E": 1e6, "nu": 0.3}}, failure=law)
    bar = block((100, 80), (16, 4), material="weak", angular_velocity=80.0, velocity=(3.0, 1.0))
    case = Case(
        grid=Grid(dimension=2, cell_size=CELL, basis=SPLINE),
        run=Run(end_time=1.0, transfer=transfer, energy_growth_limit=1e9),
        material={"weak": weak},
        body={"body": bar},
    )
    sim = Simulation(case, 1)
    start, scale = balance(sim)["momentum"][2], size(sim)
    sim.advance(40)
    gone = sim.column("body", "failed")[:, 0] == 3
    for _ in range(1000):
        if 0 < gone.sum() == sim.eroded()["count"]:
            break
        sim.advance(1)
        gone = sim.column("body", "failed")[:, 0] == 3
    assert 0 < gone.sum() < len(gone)
    x, v, m = (sim.column("body", name)[gone] for name in ("position", "velocity", "mass"))
    taken = m[:, 0] @ (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])
    if transfer == "apic":
        C = sim.column("body", "affine_velocity")[gone]
        taken += 0.25 * CELL**2 * m[:, 0] @ (C[:, 2] - C[:, 1])
    terms = balance(sim)
    assert abs(terms["removed"][2] - taken) < 1e-12 * scale
    assert abs(taken) > 1e-3 * abs(start)
    if transfer == "apic":
        assert abs(terms["numerical"][2]) < 1e-12 * scale


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_rigid_body_on_a_wall(dimension: int) -> None:
    """It does not fall: the wall's impulse at its centre is that of its weight."""
    grid = box(dimension, 20, {"y_min": "slip"})
    case = one(dimension, grid, (2, 12, 2), transfer="apic", gravity=(0.0, -9.81, 0.0)[:dimension])
    stone = block((8, 0, 5)[:dimension], (4,) * dimension, material="stone")
    case = case.model_copy(
        update={
            "material": case.material | {"stone": Material(density=3000.0, strength={"rigid": {}})},
            "body": case.body | {"stone": stone},
        }
    )
    sim = Simulation(case, 1)
    sim.advance(100)
    centre, momentum = middle(sim, "stone")
    mass = float(sim.column("stone", "mass").sum())
    assert np.abs(momentum).max() == 0.0
    terms = balance(sim)
    expected = np.cross(centre, [0.0, 9.81 * mass * sim.time, 0.0])
    assert np.abs(terms["walls"] - expected).max() < 1e-12 * np.abs(expected).max()
    assert np.abs(terms["numerical"]).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("transfer", ["flip", "apic"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_another_origin(dimension: int, transfer: str) -> None:
    """What a shift X adds is X x the momentum, the weight and the load; what is lost stays."""
    cells = np.array([40, -24, 16]) * (np.arange(3) < dimension)
    found = []
    for at in (np.array([3, 3, 3]), np.array([3, 3, 3]) + cells):
        case = one(
            dimension,
            at=tuple(at.tolist()),
            load={"push": Load(body="body", side="x_max", pressure=500.0)},
            transfer=transfer,
            gravity=GRAVITY[:dimension],
            time_step=1e-5,
        )
        sim = stirred(Simulation(case, 1))
        sim.advance(20)
        found.append((sim, balance(sim)))
    (here, one_here), (_, there) = found
    X = CELL * cells
    weight, push = np.zeros((2, 3))
    mass, [load] = here.column("body", "mass").sum(), here.core.loads()
    weight[:dimension] = mass * 20e-5 * np.array(GRAVITY[:dimension])
    push[:dimension] = load.impulse[:dimension]
    scale = size(here) + np.linalg.norm(X) * mass
    for name, linear in (
        ("momentum", middle(here)[1]),
        ("gravity", weight),
        ("loads", push),
        ("numerical", np.zeros(3)),
    ):
        assert np.abs(there[name] - one_here[name] - np.cross(X, linear)).max() < 1e-12 * scale


@pytest.mark.parametrize("axes", [((0, -1), (1, 1)), ((1, -1), (0, 1))], ids=["mirror", "turn"])
@pytest.mark.parametrize("transfer", ["flip", "apic", "pic"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_another_world(dimension: int, transfer: str, axes: tuple[tuple[int, int], ...]) -> None:
    """All terms turn as axial vectors do: with the world, and by its handedness."""
    world = World(axes if dimension == 2 else (*axes, (2, 1)))
    q = np.eye(3)
    q[:dimension, :dimension] = world.matrix()
    grid = box(dimension, 12, {"x_min": "slip", "y_min": "fixed"})
    first = one(dimension, grid, (0, 0, 3), transfer=transfer, gravity=GRAVITY[:dimension])
    upper = block((2, 4, 2)[:dimension], (4,) * dimension, material="rubber")
    here = first.model_copy(update={"body": first.body | {"upper": upper}})
    found = []
    start = Simulation(here, 1)
    for case in (here, world.case(here, start)):
        sim = Simulation(case, 1)
        for k, body in enumerate(("body", "upper")):
            v = np.random.default_rng(k).uniform(-1.0, 1.0, start.column(body, "velocity").shape)
            v[:, 1] -= 2.0 * k
            sim.set_velocity(body, v if case is here else v @ world.matrix().T)
        sim.advance(20)
        found.append((sim, balance(sim)))
    (sim, one_here), (_, there) = found
    for name, term in one_here.items():
        turned = np.linalg.det(q) * q @ term
        assert np.abs(there[name] - turned).max() < 1e-10 * size(sim), name
    assert np.abs(one_here["walls"]).max() > 0.01 * size(sim)


@pytest.mark.parametrize("dimension", [2, 3])
def test_the_same_bits_for_any_number_of_threads(tmp_path: Path, dimension: int) -> None:
    """Also with stages fused, as far as these do the same."""
    case = everything(tmp_path, dimension, "musl", "gimp", "absorbing")
    found = []
    for threads, fused in ((1, True), (2, True), (1, False)):
        sim = Simulation(case, threads, fused=fused)
        sim.advance(100)
        found.append(sim.core.part_sums()[0])
        assert all(
            np.abs(term).max() > 0.0 for name, term in balance(sim).items() if name != "removed"
        )
    assert found[0] == found[1] == found[2]
