# SPDX-License-Identifier: BSD-3-Clause
"""A run that is saved and restored goes on with the same bits."""

from __future__ import annotations

from pathlib import Path

import pytest

from cases import CELL, block, each_numerics, everything, materials, three_blocks
from mpm3dpp import Case, Contact, Grid, Run, Simulation
from mpm3dpp.io.result_hash import result_hash


def outcome(simulation: Simulation) -> tuple[object, ...]:
    """Return all that a run tells in the end, time and memory left out."""
    core = simulation.core
    pairs = [(p.bodies, p.impulse, p.friction_work, p.first_step) for p in core.contact_pairs()]
    summary = {k: v for k, v in core.contact_summary().items() if k != "bytes"}
    loads = [(load.name, load.force, load.impulse, load.area) for load in core.loads()]
    states = [
        core.column(body, column.name).tobytes()
        for body in range(core.body_count)
        for column in core.columns(body)
    ]
    limiter = core.limiter()
    return (
        *(core.step, core.time, core.dt, core.eroded(), core.left(), states, pairs, summary, loads),
        *(limiter.body, limiter.particle, core.history().tobytes(), core.part_sums()[0]),
        result_hash(core),
    )


def check(case: Case, folder: Path, steps: int, threads: tuple[int, int] = (1, 2)) -> Simulation:
    """Save after some steps, go on for as many with another number of threads, and compare."""
    straight = Simulation(case, threads=threads[0])
    assert straight.advance(steps) == steps
    straight.save(folder / "state.zip")
    assert straight.advance(steps) == steps
    again = Simulation(case, threads=threads[1])
    again.restore(folder / "state.zip")
    assert again.step == steps
    assert again.advance(steps) == steps
    for k, (one, other) in enumerate(zip(outcome(straight), outcome(again), strict=True)):
        assert one == other, k
    return again


@each_numerics
@pytest.mark.parametrize("dimension", [2, 3])
def test_everything(tmp_path: Path, dimension: int, scheme: str, basis: str) -> None:
    for left, travel in (("absorbing", 0.0), ("slip", 0.05)):
        case = everything(tmp_path, dimension, scheme, basis, left)
        case.contact.normal_refresh_distance = travel
        check(case, tmp_path, 6 if scheme == "usl" else 30)


@pytest.mark.parametrize("dimension", [2, 3])
def test_bonded(tmp_path: Path, dimension: int) -> None:
    case = three_blocks(dimension)
    case.contact.friction, case.contact.bonded = 0.0, True
    check(case, tmp_path, 30)


@pytest.mark.parametrize("dimension", [2, 3])
def test_cells_that_have_doubled(tmp_path: Path, dimension: int) -> None:
    case = three_blocks(dimension, apart=2, grid={"coarsening": {"tiles": 1, "times": 2}})
    again = check(case, tmp_path, 40)
    rows = again.core.history_columns
    assert again.advance(1) and again.core.history()[-1, rows.index("cell_size")] == 4 * CELL


def test_particles_that_erode_and_leave(tmp_path: Path) -> None:
    """Some have gone before the state is saved, others go after it."""
    torn = materials()["solid"].table() | {
        "failure": {"plastic_strain": {"limit": 0.02, "action": "erode"}},
        "strength": {"j2": {"E": "1 MPa", "nu": 0.3, "Y0": "1 kPa"}},
    }
    case = Case(
        grid=Grid(dimension=2, cell_size=CELL, outflow_box={"upper": (20 * CELL, 20 * CELL)}),
        run=Run(end_time=1.0, cfl=0.3),
        contact=Contact(friction=0.2),
        material={"torn": torn, **materials()},
        body={
            "soft": block((0, 0), (8, 8), material="torn", velocity=(4.0, 0.0)),
            "hard": block((9, 2), (8, 4), material="solid", velocity=(-2.0, 0.0)),
            "gone": block((14, 14), (5, 4), material="rubber", velocity=(6.0, 0.0)),
        },
    )
    steps = 60
    early = Simulation(case, threads=1)
    early.advance(steps)
    late = check(case, tmp_path, steps)
    for gone in ("eroded", "left"):
        assert 0 < getattr(early, gone)()["count"] < getattr(late, gone)()["count"], gone


def test_rows_of_the_history_that_nobody_took_are_in_the_state(tmp_path: Path) -> None:
    case = three_blocks(2)
    first = Simulation(case, threads=1)
    first.advance(5)
    first.save(tmp_path / "state.zip")
    again = Simulation(case, threads=1)
    again.core.history()
    again.restore(tmp_path / "state.zip")
    assert again.core.history()[:, 0].tolist() == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("dimension", [2, 3])
def test_rigid_bodies_that_turn_and_leave(tmp_path: Path, dimension: int) -> None:
    """One flies out of the region that is kept before, one after; one is led; gravity changes."""
    spin = {"sine": {"amplitude": 20.0, "frequency": 100.0}}
    motion = {
        "velocity": (0.5, {"ramp": {"to": 1.0, "end": 0.01}}, 0.0)[:dimension],
        "angular_velocity": spin if dimension == 2 else (0.0, 0.0, spin),
    }
    stone = {"density": 2000.0, "strength": {"rigid": {}}}

    def at(*cells: int) -> tuple[int, ...]:
        return cells[:dimension]

    case = Case(
        grid=Grid(
            dimension=dimension, cell_size=CELL, outflow_box={"upper": (24 * CELL,) * dimension}
        ),
        run=Run(
            end_time=1.0,
            gravity=(0.0, {"sine": {"amplitude": 9.0, "frequency": 50.0}}, 0.0)[:dimension],
            cfl=0.25,
        ),
        contact=Contact(friction=0.2),
        material={"stone": stone, **materials()},
        body={
            "bed": block(at(0, 0, 0), at(12, 4, 4), material="solid"),
            "blade": block(at(2, 4, 0), at(6, 2, 4), material="stone", motion=motion),
            "early": block(at(18, 14, 0), at(5, 4, 4), material="stone", velocity=at(9, 0, 0)),
            "late": block(at(12, 9, 0), at(5, 4, 4), material="stone", velocity=at(8, 1, 0)),
        },
    )
    steps = 100
    early = Simulation(case, threads=1)
    early.advance(steps)
    late = check(case, tmp_path, steps)
    assert 0 < early.left()["count"] < late.left()["count"]
