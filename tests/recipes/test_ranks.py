# SPDX-License-Identifier: BSD-3-Clause
"""The same bits for any number of ranks, which are threads here."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import three_blocks
from mpm3dpp import Case, Simulation, _core
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
box = {{ lower = [{zeros}], upper = [{upper}], walls = {{ {walls} }} }}
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


def grains(dimension: int, walls: str = 'y_min = "fixed", x_min = "slip"') -> Case:
    """Return grains that fall on each other and on a floor, filled and stepped by default."""
    two = dimension == 2
    return Case.from_text(
        GRAINS.format(
            dimension=dimension,
            walls=walls,
            zeros=", ".join(["0"] * dimension),
            upper=", ".join(['"40 mm"'] * dimension),
            gravity=", ".join(["0", "-50", "0"][:dimension]),
            velocity=", ".join(["-1", "-2", "1"][:dimension]),
            count="4, 3" if two else "3, 2, 2",
        )
    )


@pytest.mark.parametrize(
    "walls", ['y_min = "fixed", x_min = "slip"', 'y_min = "contact", x_min = "contact"']
)
@pytest.mark.parametrize("dimension", [2, 3])
def test_grains(dimension: int, walls: str) -> None:
    case, found = grains(dimension, walls), []
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


def free_block(cells: int) -> Case:
    return Case.from_text(f"""
[grid]
dimension = 3
cell_size = 1.0
basis = "linear"
[run]
end_time = 1000
scheme = "musl"
cfl = 0.25
[material.m]
density = 1000
strength = {{ elastic = {{ E = 1e7, nu = 0.3 }} }}
[body.block]
material = "m"
shape = {{ box = {{ lower = [0, 0, 0], upper = [{cells}, {cells}, {cells}] }} }}
velocity = [1, 2, 3]
""")


def test_what_passes_between_two_ranks() -> None:
    """Counted, so that a change that sends more is seen: nodes of one face, twice a step."""
    cells = 24
    simulation = Simulation(free_block(cells), threads=1, ranks=2)
    simulation.core.reset_timers()
    simulation.advance(10)
    told = simulation.core.ranks()
    assert told["ranks"] == 2
    # Momentum and forces, remapped momentum, which cells are occupied: one letter each.
    assert told["letters"] == pytest.approx(3.0)
    assert told["exchanges"] <= 2.0 and told["reductions"] <= 9.0
    # The nodes of a face: 8 numbers of each, then 4. Patches give them on either side of the face.
    face = 8 * (8 + 4) * (cells + 1) ** 2
    assert face < told["bytes"] < 2.5 * face
    assert 0.0 < told["share"] < 1.0 <= told["imbalance"]


def test_who_has_what() -> None:
    simulation = Simulation(free_block(8), threads=1, ranks=4)
    ranks = simulation.ranks_of("block")
    assert ranks.shape == (8 * 8**3,) and sorted(set(ranks.tolist())) == [0, 1, 2, 3]
    counts = np.bincount(ranks)
    assert counts.max() <= 1.2 * counts.mean()


def test_ranks_follow_a_body_that_flies() -> None:
    """From tiles of one rank into those of the other: the tiles are shared out anew on the way."""
    simulation = Simulation(
        Case.from_text("""
[grid]
dimension = 2
cell_size = 1.0
[run]
end_time = 100
[material.m]
density = 1000
strength = { elastic = { E = 1e4, nu = 0.3 } }
[body.block]
material = "m"
shape = { box = { lower = [0, 0], upper = [64, 16] } }
velocity = [2, 0]
"""),
        threads=1,
        ranks=2,
    )
    for end in (10.0, 20.0, 30.0):
        simulation.advance(1000, end)
        counts = np.bincount(simulation.ranks_of("block"), minlength=2)
        assert counts.max() <= 1.2 * counts.mean()  # 1.05, and 20 steps more
    assert simulation.column("block", "position")[:, 0].min() > 55.0


ALIKE = (["a", "b"], np.array([1, 1]), np.array([1.0, 1.0]), np.zeros((2, 2)), np.zeros((1, 2)))


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({0: []}, "need a name, a count and a volume"),
        ({1: np.array([1])}, "need a name, a count and a volume"),
        ({1: np.array([1, -1])}, "b: it has no particles"),
        ({2: np.array([1.0, 0.0])}, "b: volumes must be finite numbers > 0"),
        ({2: np.array([1.0, np.nan])}, "b: volumes must be finite numbers > 0"),
        ({3: np.zeros((1, 2))}, "b: its particles are not given"),
        ({3: np.array([[0.0, 0.0], [0.0, np.inf]])}, "b: positions must be finite numbers"),
        ({4: np.zeros((3, 2))}, "a: velocities must be"),
    ],
)
def test_bodies_that_do_not_fit(changes: dict[int, Any], sentence: str) -> None:
    settings = _core.Settings()
    settings.grid.dimension, settings.grid.cell_size = 2, 1.0
    core = _core.Simulation(settings)
    material = core.add_material(
        1000.0, "elastic", {"E": 1e6, "nu": 0.3}, None, [], (0, 0), 0.0, False
    )
    names, counts, volumes, positions, velocities = (
        changes.get(k, ALIKE[k]) for k in range(len(ALIKE))
    )
    with pytest.raises(ValueError, match=re.escape(sentence)):
        core.add_bodies(names, material, counts, volumes, 0, positions, velocities)
    assert core.body_count == 0
    assert core.add_bodies(ALIKE[0], material, *ALIKE[1:3], 0, *ALIKE[3:]) == 0
    assert core.body_count == 2
