# SPDX-License-Identifier: BSD-3-Clause
"""`grid.coarsening`: cells double where debris spreads; particles, walls and contacts carry on."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, block, materials
from mpm3dpp import Case, CaseError, Contact, Grid, GridBox, GridCoarsening, Run, Simulation

SPEED = 4.0


def colliding(
    dimension: int, coarsening: dict[str, Any] | None, box: Any = None, **more: Any
) -> Case:
    """Return two blocks of 6 cells that fly at each other, 5 cells apart."""
    run = {"end_time": 0.02, "cfl": 0.3, "scheme": more.pop("scheme", "musl")}
    grid: dict[str, Any] = {"basis": more.pop("basis", "gimp"), "box": box}
    where = ((8, 4, 4)[:dimension], (19, 4, 4)[:dimension])
    velocity = np.zeros((2, dimension))
    velocity[:, 0] = SPEED, -SPEED
    bodies = {
        name: block(at, (6,) * dimension, material="solid", velocity=tuple(v.tolist()), **more)
        for name, at, v in zip(("one", "other"), where, velocity, strict=True)
    }
    return Case(
        grid=Grid(dimension=dimension, cell_size=CELL, coarsening=coarsening, **grid),
        run=Run(**run),
        contact=Contact(friction=0.2),
        material=materials(),
        body=bodies,
    )


def history(simulation: Simulation) -> dict[str, np.ndarray]:
    rows = simulation.core.history()
    return dict(zip(simulation.core.history_columns, rows.T, strict=True))


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_nothing_changes_but_the_cells(dimension: int, scheme: str, basis: str) -> None:
    """The state after the step that doubles is bitwise that of a run that does not double."""
    whole = Simulation(colliding(dimension, None, scheme=scheme, basis=basis), 1)
    whole.advance(1000)
    limit = int(history(whole)["tiles"].max()) - 1
    plain = Simulation(colliding(dimension, None, scheme=scheme, basis=basis), 1)
    coarsening = {"tiles": limit, "times": 1}
    double = Simulation(colliding(dimension, coarsening, scheme=scheme, basis=basis), 1)
    history(double)
    tiles = limit
    while tiles <= limit:
        assert double.advance(1) and plain.advance(1)
        row = history(double)
        tiles = row["tiles"][-1]
        for name in ("one", "other"):
            for column in ("position", "velocity", "stress", "volume", "mass"):
                assert np.array_equal(double.column(name, column), plain.column(name, column))
        assert history(plain)["kinetic"][-1] == row["kinetic"][-1]
        assert row["cell_size"][-1] == CELL
    double.advance(1)
    row = history(double)
    assert row["cell_size"][-1] == 2.0 * CELL
    assert row["tiles"][-1] < tiles
    energy = row["kinetic"][-1]
    double.advance(1000)
    row = history(double)
    assert np.abs(row["residual"]).max() < 1e-12 * energy
    assert (row["cell_size"] == 2.0 * CELL).all()
    scale = SPEED * double.core.total_mass
    assert np.abs(row["momentum_x"]).max() < 1e-12 * scale


def bounced(threads: int) -> Simulation:
    """Return blocks that have met, bounced off each other and lost cells on the way."""
    box = GridBox(lower=(0, 0), upper=(32 * CELL, 16 * CELL), walls="slip")
    simulation = Simulation(colliding(2, {"tiles": 2, "times": 1}, box), threads)
    simulation.advance(100_000, 0.02)
    return simulation


def test_bodies_meet_after_their_cells_have_doubled() -> None:
    """Two equal blocks exchange their velocities; the coarsening comes before they meet."""
    simulation = bounced(1)
    row = history(simulation)
    assert row["cell_size"][1] == CELL
    assert row["cell_size"][2] == 2 * CELL
    speeds = [simulation.column(b, "velocity")[:, 0].mean() for b in ("one", "other")]
    assert speeds[0] == pytest.approx(-speeds[1], rel=1e-9)
    assert -SPEED <= speeds[0] < -0.5 * SPEED  # the rest is vibration; without coarsening 0.67
    (pair,) = simulation.core.contact_pairs()
    assert pair.impulse[0] == pytest.approx(-(SPEED - speeds[0]) * simulation.core.total_mass / 2)


def test_same_bits_on_one_and_two_threads() -> None:
    one, two = bounced(1), bounced(2)
    for body in ("one", "other"):
        for column in ("position", "velocity", "stress"):
            assert np.array_equal(one.column(body, column), two.column(body, column))


def test_as_often_as_asked() -> None:
    simulation = Simulation(colliding(2, {"tiles": 1, "times": 2}), 1)
    simulation.advance(10)
    assert history(simulation)["cell_size"].tolist() == [CELL, CELL, 2 * CELL, *[4 * CELL] * 8]


def test_bytes() -> None:
    """What the nodes need is compared: a little less than what is reserved for them."""
    reserved = Simulation(colliding(2, None), 1).core.bytes()["grid"]
    for limit, cells in ((reserved // 2, 2 * CELL), (reserved, CELL)):
        simulation = Simulation(colliding(2, {"bytes": limit, "times": 1}), 1)
        simulation.advance(2)
        assert history(simulation)["cell_size"][-1] == cells


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(CaseError, match="needs tiles or bytes"):
        GridCoarsening()
    odd = GridBox(lower=(0, 0), upper=(32 * CELL, 15 * CELL))
    with pytest.raises(CaseError, match="an odd number"):
        colliding(2, {"tiles": 4}, odd)
