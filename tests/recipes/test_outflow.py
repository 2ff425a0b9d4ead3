# SPDX-License-Identifier: BSD-3-Clause
"""Particles that leave `grid.outflow_box` take no part: what they have is counted."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, DENSITY, SCHEMES, block, materials
from mpm3dpp import Case, CaseError, Contact, Eos, Grid, Material, Run, Simulation, Strength

SPEED = 5.0


def flying(dimension: int, region: dict[str, Any], material: Any = None, **more: Any) -> Case:
    """Return a block that flies to the right, 8 cells long, its front at cell 8."""
    grid = {"basis": more.pop("basis", "gimp")}
    run = {"end_time": 0.05, "cfl": 0.3} | more
    return Case(
        grid=Grid(dimension=dimension, cell_size=CELL, outflow_box=region, **grid),
        run=Run(**run),
        material={"solid": material or materials()["solid"]},
        body={
            "block": block(
                (0,) * dimension,
                (8, 3, 3)[:dimension],
                material="solid",
                velocity=(SPEED, 1.0, 0.0)[:dimension],
            )
        },
    )


def history(simulation: Simulation) -> dict[str, np.ndarray]:
    rows = simulation.core.history()
    return dict(zip(simulation.core.history_columns, rows.T, strict=True))


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_flies_out(dimension: int, scheme: str, basis: str) -> None:
    """Layer after layer passes the limit at the time x / v; a body at uniform speed has no force.

    A particle leaves at the start of the step after that in which it has passed.
    """
    limit = 10.0 * CELL
    upper = (limit, 1.0, 1.0)[:dimension]
    simulation = Simulation(flying(dimension, {"upper": upper}, scheme=scheme, basis=basis), 1)
    x, mass = simulation.column("block", "position"), simulation.core.total_mass
    energy = 0.5 * mass * (SPEED**2 + 1.0)
    seen = set()
    while simulation.advance(1):
        row = history(simulation)
        left = simulation.left()
        passed = (x[:, 0] + SPEED * (simulation.time - row["dt"][-1]) > limit).mean()
        assert left["count"] == round(passed * len(x))
        seen.add(left["count"])
        assert left["mass"] == pytest.approx(passed * mass, rel=1e-13)
        assert row["left"][-1] == pytest.approx(passed * energy, rel=1e-12)
        assert row["kinetic"][-1] == pytest.approx((1 - passed) * energy, abs=1e-12 * energy)
        assert row["momentum_x"][-1] == pytest.approx(
            (1 - passed) * mass * SPEED, abs=1e-12 * mass * SPEED
        )
        assert abs(row["residual"][-1]) < 1e-13 * energy
    assert len(seen) == 17  # all 16 layers, one after another
    assert simulation.eroded()["count"] == 0
    assert (simulation.column("block", "failed") == 4).all()
    # They stay as they were: within a step of the limit.
    assert simulation.column("block", "position")[:, 0].max() < limit + 0.2 * CELL


@pytest.mark.parametrize("eos", [False, True])
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_ledger_closes_where_stressed_particles_leave(
    dimension: int, scheme: str, eos: bool
) -> None:
    """A block that stretches and swings loses particles on both sides."""
    plastic = Material(
        density=DENSITY,
        strength=Strength(model="j2", parameters={"E": 1e6, "nu": 0.3, "Y0": 2e4}),
        eos=Eos(model="linear", parameters={"K": 1e6}) if eos else None,
    )
    region = {
        "lower": (-0.2 * CELL, -CELL, -CELL)[:dimension],
        "upper": (8.2 * CELL, 4 * CELL, 4 * CELL)[:dimension],
    }
    case = flying(dimension, region, plastic, scheme=scheme, energy_growth_limit=1e9)
    simulation = Simulation(case, threads=1)
    x = simulation.column("block", "position")
    v = np.zeros_like(x)
    v[:, 0] = 150.0 * (x[:, 0] - 4 * CELL)
    simulation.set_velocity("block", v)
    simulation.advance(200)

    def staying() -> np.ndarray:
        return simulation.column("block", "failed")[:, 0] == 0

    # What passed the limit in the last step leaves in the next.
    while simulation.left()["count"] != (~staying()).sum():
        simulation.advance(1)
    row, stays = history(simulation), staying()
    assert 0 < simulation.left()["count"] < len(x)
    begin = row["kinetic"][0] + row["external"][-1]  # what set_velocity has given
    assert np.abs(row["residual"]).max() < 1e-12 * begin  # some thousand roundings
    energy = simulation.column("block", "recoverable_energy")[stays].sum()
    m, v = (simulation.column("block", name)[stays] for name in ("mass", "velocity"))
    assert simulation.left()["count"] == (~stays).sum()
    volume = m[0, 0] / DENSITY
    assert row["internal"][-1] == pytest.approx(energy * volume, abs=1e-10 * begin)
    assert row["kinetic"][-1] == pytest.approx(0.5 * (m * v**2).sum(), rel=1e-11)
    assert row["left"][-1] > 0.0 and row["plastic"][-1] > 0.0


def test_a_rigid_body_leaves_as_a_whole() -> None:
    """It goes with its mass centre; what is left flies on."""
    case = Case(
        grid=Grid(dimension=2, cell_size=CELL, outflow_box={"upper": (10 * CELL, 1.0)}),
        run=Run(end_time=0.05),
        contact=Contact(),
        material=materials() | {"stone": Material(density=3000.0, strength={"rigid": {}})},
        body={
            "stone": block((0, 0), (4, 4), material="stone", velocity=(SPEED, 0.0)),
            "solid": block((0, 20), (4, 4), material="solid"),
        },
    )
    simulation = Simulation(case, threads=1)
    energy = simulation.core.total_mass
    while simulation.advance(1):
        row = history(simulation)
        centre = 2 * CELL + SPEED * (simulation.time - row["dt"][-1])
        assert simulation.left()["count"] == (64 if centre > 10 * CELL else 0)
    assert simulation.left() == {"mass": pytest.approx(3000.0 * 16 * CELL**2), "count": 64}
    energy = 0.5 * simulation.left()["mass"] * SPEED**2
    assert row["left"][-1] == pytest.approx(energy, rel=1e-12)
    assert abs(row["residual"][-1]) < 1e-12 * energy


def test_leaving_does_not_depend_on_threads() -> None:
    region = {"upper": (9.0 * CELL, 1.0, 1.0)}

    def run(threads: int) -> list[np.ndarray]:
        simulation = Simulation(flying(3, region), threads)
        simulation.advance(100)
        assert simulation.left()["count"] > 0
        return [simulation.core.history(), simulation.column("block", "position")]

    one, two = run(1), run(2)
    assert all(a.tobytes() == b.tobytes() for a, b in zip(one, two, strict=True))


@pytest.mark.parametrize(
    ("region", "sentence"),
    [
        ({}, "outflow_box has no limit; give lower, upper or both"),
        ({"lower": (0.0,)}, "grid.outflow_box.lower = [0.0] must have two numbers"),
        ({"lower": (1.0, 0.0), "upper": (0.5, 1.0)}, "must be > lower = 1 m; swap the two corners"),
        ({"upper": (0.01, 1.0)}, "body.block.shape reaches out of grid.outflow_box"),
    ],
)
def test_bad_regions(region: dict[str, Any], sentence: str) -> None:
    with pytest.raises(CaseError) as error:
        Simulation(flying(2, region), threads=1)
    assert sentence in str(error.value)
