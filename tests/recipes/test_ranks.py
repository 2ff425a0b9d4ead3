# SPDX-License-Identifier: BSD-3-Clause
"""The same bits for any number of ranks, which are threads here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import three_blocks
from mpm3dpp import Case, Simulation
from mpm3dpp.base.errors import CaseError
from outcomes import different, outcome, steps_of

DEFAULT = {"basis": "quadratic_bspline"}


@pytest.mark.parametrize("ranks", [2, 3, 8])
@pytest.mark.parametrize(("dimension", "basis"), [(2, "gimp"), (3, "linear"), (3, "gimp")])
def test_three_blocks(dimension: int, basis: str, ranks: int) -> None:
    case = three_blocks(dimension, "musl", grid={"basis": basis})
    steps = steps_of(dimension, "musl", basis)
    parts = Simulation(case, threads=1, ranks=ranks)
    assert different(outcome(case, steps=steps), outcome(case, steps=steps, simulation=parts)) == []


GRAINS = """
[grid]
dimension = {dimension}
cell_size = "1 mm"
box = {{ lower = [{zeros}], upper = [{upper}], walls = {{ y_min = "fixed", x_min = "slip" }} }}
[run]
end_time = "20 ms"
gravity = [{gravity}]
[contact]
friction = 0.3
[material.soft]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[grains.all]
material = "soft"
lattice = {{ lower = [{zeros}], count = [{count}], radius = "3 mm", spacing = "6.2 mm" }}
velocity = [{velocity}]
"""


def grains(dimension: int) -> Case:
    """Return grains that fall on each other and on a floor, filled and stepped by default."""
    two = dimension == 2
    return Case.from_text(
        GRAINS.format(
            dimension=dimension,
            zeros=", ".join(["0"] * dimension),
            upper=", ".join(['"40 mm"'] * dimension),
            gravity=", ".join(["0", "-50", "0"][:dimension]),
            velocity=", ".join(["-1", "-2", "1"][:dimension]),
            count="4, 3" if two else "3, 2, 2",
        )
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_grains(dimension: int) -> None:
    case, found = grains(dimension), []
    for ranks in (1, 2, 4):
        simulation = Simulation(case, threads=1, ranks=ranks)
        simulation.advance(400 if dimension == 2 else 60)
        rows = [simulation.core.history()]
        for name in ("position", "velocity", "stress"):
            rows += [simulation.core.column(b, name) for b in range(len(simulation.bodies))]
        rows += [np.array(pair.impulse) for pair in simulation.core.contact_pairs()]
        found.append(np.concatenate([np.ravel(row) for row in rows]))
    assert len(simulation.core.contact_pairs()) > 5
    assert all(row.tobytes() == found[0].tobytes() for row in found)


def mistake(simulation: Simulation) -> Any:
    return simulation.core.column(0, "no such column")


def test_a_mistake_of_all_ranks_is_one() -> None:
    simulation = Simulation(grains(2), threads=1, ranks=3)
    with pytest.raises(ValueError, match="no column is named"):
        mistake(simulation)
    assert simulation.advance(1) == 1


@pytest.mark.parametrize("ranks", [0, -1, 2.5, 2000])
def test_a_number_of_ranks_that_cannot_be(ranks: Any) -> None:
    with pytest.raises(CaseError, match="ranks"):
        Simulation(grains(2), threads=1, ranks=ranks)


def test_a_checkpoint_goes_on_with_any_number_of_ranks(tmp_path: Path) -> None:
    """That of three with one, two and four, and all end as one that was never stopped."""
    case, states = grains(2), []
    straight = Simulation(case, threads=1)
    straight.advance(150)
    three = Simulation(case, threads=1, ranks=3)
    three.advance(100)
    three.save(tmp_path / "state.zip")
    for simulation in (straight, *(Simulation(case, threads=1, ranks=n) for n in (1, 2, 4))):
        if simulation is not straight:
            simulation.restore(tmp_path / "state.zip")
            simulation.advance(50)
        core = simulation.core
        rows = [core.history()[-1:], *(core.column(b, "position") for b in range(core.body_count))]
        states.append(b"".join(row.tobytes() for row in rows))
    assert len(states[0]) > 1000 and all(state == states[0] for state in states)


def test_a_full_disk_is_one_mistake() -> None:
    def full(_: memoryview) -> int:
        raise OSError(28, "no space left on device")

    simulation = Simulation(grains(2), threads=1, ranks=3)
    with pytest.raises(OSError, match="no space left"):
        simulation.core.save(full)
    assert simulation.advance(1) == 1
    again = Simulation(grains(2), threads=1, ranks=3)
    with pytest.raises(ValueError, match="too early"):
        again.core.restore(lambda _: 0, 10_000)
