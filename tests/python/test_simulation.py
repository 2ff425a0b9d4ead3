# SPDX-License-Identifier: BSD-3-Clause
"""The compiled simulation behind a case: conservation, closed forms, walls, failures, history."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, DENSITY, SCHEMES, YOUNG, box, one_block, three_blocks
from mpm3dpp import (
    Body,
    Case,
    Contact,
    Grid,
    Material,
    Run,
    RunError,
    Simulation,
    Viscosity,
    shapes,
)
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io.history import TERMS

EPS = np.finfo(float).eps
ALL = [(d, scheme, basis) for d in (2, 3) for scheme in SCHEMES for basis in BASES]
ROUNDING = 1e-12  # of the whole energy or momentum: some thousand sums of rounded numbers


def history(simulation: Simulation) -> dict[str, np.ndarray]:
    rows = simulation.core.history()
    return dict(zip(simulation.core.history_columns, rows.T, strict=True))


def total_momentum(simulation: Simulation) -> np.ndarray:
    return sum(
        (simulation.column(name, "mass") * simulation.column(name, "velocity")).sum(axis=0)
        for name in simulation.bodies
    )


@pytest.mark.parametrize(("dimension", "scheme", "basis"), ALL)
def test_the_ledger_closes_and_momentum_stays(dimension: int, scheme: str, basis: str) -> None:
    run = {"viscosity": Viscosity(), "energy_growth_limit": 1e9}
    case = three_blocks(dimension, scheme, grid={"basis": basis}, run=run)
    simulation = Simulation(case, threads=1)
    momentum = total_momentum(simulation)
    simulation.advance(12 if (scheme, basis) == ("usl", "linear") else 60)  # USL soon fails
    row = history(simulation)
    assert row["friction"][-1] > 0 and row["viscous"][-1] > 0 and row["internal"][-1] > 0
    assert np.abs(row["residual"]).max() <= ROUNDING * row["kinetic"][0]
    names = [f"momentum_{axis}" for axis in "xyz"][:dimension]
    drift = np.array([row[name] - row[name][0] for name in names])
    size = sum(
        np.abs(simulation.column(name, "mass") * simulation.column(name, "velocity")).sum()
        for name in simulation.bodies
    )
    assert np.abs(drift).max() <= ROUNDING * size
    assert [row[name][0] for name in names] == pytest.approx(momentum, abs=ROUNDING * size)


def test_artificial_viscosity_of_a_material() -> None:
    """Its own factors replace those of the run, to the last bit; 0, 0 is none at all."""
    grid = box(2, 12, {"y_min": "slip"})
    flying = {"velocity": (0.0, -5.0)}

    def positions(of_the_run: Viscosity | None, own: Viscosity | None) -> np.ndarray:
        case = one_block(2, grid, {"viscosity": of_the_run}, **flying)
        case.material["solid"].artificial_viscosity = own
        simulation = Simulation(case, threads=1)
        simulation.advance(60)
        assert (history(simulation)["viscous"][-1] > 0) == (sum(case.viscosity_of("solid")) > 0)
        return simulation.column("block", "position")

    strong, none = Viscosity(quadratic=3.0, linear=0.5), Viscosity(quadratic=0.0, linear=0.0)
    assert (positions(None, strong) == positions(strong, None)).all()
    assert (positions(Viscosity(), strong) == positions(strong, None)).all()
    assert (positions(strong, none) == positions(None, None)).all()
    assert (positions(strong, None) != positions(None, None)).any()


@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_the_ledger_closes_with_plastic_work(scheme: str) -> None:
    """A block flies against a wall: its plastic work is the yield stress times plastic strain."""
    case = one_block(2, box(2, 12, {"y_min": "slip"}), {"scheme": scheme}, velocity=(0.0, -5.0))
    limit = 0.01 * YOUNG
    case.material["solid"] = Material(
        density=DENSITY, strength={"j2": {"E": YOUNG, "nu": 0.3, "Y0": limit}}
    )
    simulation = Simulation(case, threads=1)
    work, strain, volume = (
        0.0,
        *(simulation.column("block", c) for c in ("plastic_strain", "volume")),
    )
    for _ in range(250):
        simulation.advance(1)
        before, size = strain, volume
        strain, volume = (simulation.column("block", c) for c in ("plastic_strain", "volume"))
        assert (strain >= before).all()
        work += limit * (0.5 * (size + volume) * (strain - before)).sum()
    row = history(simulation)
    assert np.abs(row["residual"]).max() <= ROUNDING * row["kinetic"][0]
    assert row["plastic"][-1] == pytest.approx(work, rel=1e-10)
    assert row["plastic"][-1] > 0.1 * row["kinetic"][0]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_ledger_closes_with_gravity_and_walls(scheme: str) -> None:
    grid = box(2, 12, {"y_min": "fixed", "x_min": "slip"})
    run = {"gravity": (0.0, -50.0), "scheme": scheme, "cfl": 0.2}
    simulation = Simulation(one_block(2, grid, run, velocity=(-3.0, -4.0)), threads=1)
    simulation.advance(250)
    row = history(simulation)
    energy = row["kinetic"][0] + np.abs(row["external"]).max()
    assert row["external"][-1] != 0.0
    assert np.abs(row["residual"]).max() <= ROUNDING * energy


@pytest.mark.parametrize("count", [3, 5, 50])
def test_many_bodies_keep_their_momentum(count: int) -> None:
    random = np.random.default_rng(count)
    side = int(np.ceil(np.sqrt(count)))
    bodies = {}
    for k in range(count):
        centre = (CELL * (4 * (k % side) + 2), CELL * (4 * (k // side) + 2))
        away = np.array(centre) - 2 * side * CELL  # the discs fly together
        speed = tuple((random.uniform(-1.0, 1.0, 2) - 5.0 * away / (side * CELL)).tolist())
        disc = shapes.Disc(centre=centre, radius=1.9 * CELL)
        bodies[f"disc{k}"] = Body(material="solid", shape=disc, velocity=speed)
    case = Case(
        grid=Grid(dimension=2, cell_size=CELL),
        run=Run(end_time=1.0),
        contact=Contact(friction=0.4),
        material={"solid": three_blocks(2).material["solid"]},
        body=bodies,
    )
    simulation = Simulation(case, threads=1)
    size = sum(np.abs(simulation.column(b, "velocity")).sum() for b in bodies)
    mass = simulation.column("disc0", "mass")[0, 0]
    before = total_momentum(simulation)
    simulation.advance(100)
    assert len(simulation.core.contact_pairs()) >= count // 3
    assert np.abs(total_momentum(simulation) - before).max() <= ROUNDING * mass * size
    assert (
        np.abs(history(simulation)["residual"]).max() <= ROUNDING * 0.5 * mass * size * size / count
    )


@pytest.mark.parametrize(("dimension", "scheme", "basis"), ALL)
def test_free_fall(dimension: int, scheme: str, basis: str) -> None:
    """v = v_0 + g t and x = x_0 + sum of v dt, with v at the end of each step, exactly."""
    g = np.array((3.0, -9.81, 1.0)[:dimension])
    v0 = np.array((2.0, 1.0, -1.0)[:dimension])
    run = {"gravity": tuple(g), "scheme": scheme}
    case = one_block(dimension, {"basis": basis}, run, velocity=tuple(v0))
    simulation = Simulation(case, threads=1)
    start = simulation.column("block", "position")
    steps = 200
    simulation.advance(steps)
    row = history(simulation)
    times, dt = row["time"], row["dt"][1:]
    path = ((v0 + np.outer(times[1:], g)) * dt[:, None]).sum(axis=0)
    # Ten roundings a step; USL divides them by the small masses of nodes that a body just reaches.
    grown = 100 if scheme == "usl" else 1
    rounding = 10 * steps * EPS * grown
    velocity, position = (
        simulation.column("block", "velocity"),
        simulation.column("block", "position"),
    )
    assert np.abs(velocity - (v0 + g * simulation.time)).max() <= rounding * np.abs(v0).max()
    assert np.abs(position - start - path).max() <= rounding * np.abs(position).max()
    # g is interpolated with weights that sum to one but for rounding, so strain is rounding too:
    # some ten roundings of the motion, in cells, in each step.
    assert np.abs(simulation.column("block", "stress")).max() <= 1e-12 * grown * YOUNG
    fallen = simulation.core.total_mass * g @ path
    assert row["external"][-1] == pytest.approx(fallen, rel=1e-2)


@pytest.mark.parametrize(("dimension", "scheme", "basis"), ALL)
def test_rigid_translation_strains_nothing(dimension: int, scheme: str, basis: str) -> None:
    v = (7.0, -3.0, 5.0)[:dimension]
    case = one_block(dimension, {"basis": basis}, {"scheme": scheme}, velocity=v)
    simulation = Simulation(case, threads=1)
    start = simulation.column("block", "position")
    simulation.advance(300)
    moved = simulation.column("block", "position") - start
    assert np.abs(moved).max() > 8 * CELL  # through more than a tile
    assert moved == pytest.approx(
        np.tile(np.array(v) * simulation.time, (len(moved), 1)), rel=1e-12
    )
    assert np.abs(simulation.column("block", "stress")).max() <= 1e-12 * YOUNG
    row = history(simulation)
    assert np.ptp(row["kinetic"]) <= ROUNDING * row["kinetic"][0]


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("face", ["x_min", "x_max", "y_min", "y_max", "z_min", "z_max"])
def test_a_fixed_wall_stops_a_body(face: str, basis: str) -> None:
    axis, sign = "xyz".index(face[0]), 1 if face.endswith("max") else -1
    cells = 10  # the block, in cells 3 to 7, is three cells from each wall
    v = np.zeros(3)
    v[axis], v[(axis + 1) % 3] = 5.0 * sign, 1.0
    grid = {"basis": basis, **box(3, cells, {face: "fixed"})}
    simulation = Simulation(one_block(3, grid, {}, velocity=tuple(v)), threads=1)
    momentum = total_momentum(simulation)
    after = momentum
    for _ in range(30):
        simulation.advance(10)
        x = simulation.column("block", "position")[:, axis]
        assert x.min() > 0 if sign < 0 else x.max() < cells * CELL
        after = total_momentum(simulation)
        if after[axis] * momentum[axis] < 0:
            break
    assert after[axis] * momentum[axis] < 0, "the block has not bounced"
    assert abs(after[(axis + 1) % 3]) < 0.9 * abs(momentum[(axis + 1) % 3])  # it holds fast


@pytest.mark.parametrize("basis", BASES)
def test_a_slip_wall_is_a_mirror(basis: str) -> None:
    """It changes only the momentum normal to it, and no energy but the numerical."""
    grid = {"basis": basis, **box(2, 24, "slip")}
    simulation = Simulation(one_block(2, grid, {}, velocity=(0.0, -5.0)), threads=1)
    simulation.advance(300)
    x = simulation.column("block", "position")
    row = history(simulation)
    assert x[:, 1].min() > 0 and row["momentum_y"].max() > 0.5 * abs(row["momentum_y"][0])
    assert np.abs(row["momentum_x"]).max() <= ROUNDING * abs(row["momentum_y"][0])
    assert row["external"][-1] == 0.0


def test_a_free_face_lets_a_body_pass() -> None:
    simulation = Simulation(one_block(2, box(2, 10, "free"), {}, velocity=(0.0, -5.0)), threads=1)
    simulation.advance(300)
    assert simulation.column("block", "position")[:, 1].max() < 0.0
    assert np.abs(simulation.column("block", "stress")).max() <= 1e-12 * YOUNG


def test_an_unknown_column_or_body_is_one_sentence() -> None:
    simulation = Simulation(one_block(2, box(2, 10, "free"), {}, velocity=(0.0, 0.0)), threads=1)
    with pytest.raises(CaseError) as error:
        simulation.column("block", "presure")
    assert '"presure" is not a column of block; valid here: ' in str(error.value)
    known = ["position", "velocity", "mass", "volume", "stress"]
    assert all(name in str(error.value) for name in known)
    for call in (
        lambda: simulation.column("blok", "mass"),
        lambda: simulation.set_velocity("blok", np.zeros((1, 2))),
    ):
        with pytest.raises(CaseError, match='"blok" is not a body of the case; did you mean "blo'):
            call()
    with pytest.raises(ValueError, match="no column is named presure; there are position, "):
        simulation.core.column(0, "presure")


def test_set_velocity() -> None:
    flip = {"transfer": "flip"}  # whose particles have no energy beside that of their velocity
    simulation = Simulation(one_block(2, {}, flip, velocity=(7.0, 0.0)), threads=1)
    simulation.advance(150)  # far enough that the columns have been sorted anew
    x = simulation.column("block", "position")
    given = np.column_stack([1e2 * x[:, 1], -1e2 * x[:, 0]])
    simulation.set_velocity("block", given)
    assert simulation.column("block", "velocity").tolist() == given.tolist()
    simulation.advance(1)
    row = history(simulation)
    mass = simulation.column("block", "mass")
    gained = 0.5 * (mass * given**2).sum() - row["kinetic"][0]
    assert row["external"][-1] == pytest.approx(gained, rel=1e-12)
    assert abs(row["residual"][-1]) <= ROUNDING * (row["kinetic"][0] + abs(gained))
    with pytest.raises(CaseError, match=r"velocities must be .* shape \(n, D\)"):
        simulation.set_velocity("block", given[:-1])
    with pytest.raises(CaseError, match="finite"):
        simulation.set_velocity("block", np.full_like(given, np.nan))


def test_history_has_a_row_for_each_step() -> None:
    simulation = Simulation(one_block(2, {}, {"end_time": 1e-3}, velocity=(1.0, 0.0)), threads=1)
    names = simulation.core.history_columns
    assert list(names) == list(TERMS)
    first = history(simulation)
    assert first["step"].tolist() == [0.0] and first["dt"].tolist() == [0.0]
    assert first["kinetic"][0] == pytest.approx(0.5 * simulation.core.total_mass)
    made = simulation.advance(10**6)
    row = history(simulation)
    assert row["step"].tolist() == list(range(1, made + 1))
    assert np.allclose(np.cumsum(row["dt"]), row["time"], rtol=1e-12)
    assert row["time"][-1] == simulation.time == 1e-3  # exactly
    assert simulation.advance(5) == 0
    assert history(simulation)["step"].size == 0  # rows are handed out once
    parts = sum(row[f"numerical_{part}"] for part in ("mapping", "time", "transfer"))
    assert np.allclose(row["numerical"], parts, rtol=1e-12, atol=0.0)


def test_the_time_step_is_the_critical_one_and_its_limiter_is_named() -> None:
    run = {"cfl": 0.25}
    block = one_block(2, {}, run, velocity=(3.0, 4.0), frame="updated")
    simulation = Simulation(block, threads=1)
    c = np.sqrt(YOUNG * 0.7 / (1.3 * 0.4) / DENSITY)  # of pressure waves, nu = 0.3
    assert simulation.core.dt == pytest.approx(0.25 * CELL / (c + 5.0), rel=1e-12)
    limiter = simulation.core.limiter()
    assert (limiter.body, limiter.speed) == (0, pytest.approx(5.0))
    assert limiter.sound_speed == pytest.approx(c)


def failing(**run: Any) -> Simulation:
    case = three_blocks(2, "usl", grid={"basis": "linear"}, run={"cfl": 0.5, **run})
    return Simulation(case, threads=1)


def test_an_unstable_run_says_who_where_when_and_why() -> None:
    simulation = failing(energy_growth_limit=1e12)
    with pytest.raises(RunError) as error:
        simulation.advance(1000)
    failure, text = simulation.core.failure, str(error.value)
    assert failure.kind in ("negative volume", "non-finite")
    assert failure.step == simulation.step and failure.time == simulation.time
    body = simulation.bodies[failure.body]
    assert 0 <= failure.particle < simulation.core.body_particle_count(failure.body)
    volume = simulation.column(body, "volume")[failure.particle, 0]
    assert not volume > 0.0
    where = simulation.column(body, "position")[failure.particle]
    assert failure.position[:2] == pytest.approx(where.tolist())
    for part in (failure.kind, f"step {failure.step}", f'body "{body}"', f"{failure.particle}"):
        assert part in text
    with pytest.raises(RunError):  # it makes no further step
        simulation.advance(1)
    assert simulation.step == failure.step


def test_energy_growth_stops_a_run() -> None:
    limit = 0.01
    simulation = failing(energy_growth_limit=limit)
    with pytest.raises(RunError, match="energy growth at step"):
        simulation.advance(1000)
    row = history(simulation)
    growth = -(row["numerical"] + row["contact"]) / row["kinetic"][0]
    assert growth[-1] > limit
    assert (growth[:-1] <= limit).all()
