# SPDX-License-Identifier: BSD-3-Clause
"""Laws of every transfer: momentum stays, the ledger closes, a rigid translation is kept."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest

from cases import CELL, SCHEMES, block, everything, materials
from mpm3dpp import Case, CaseError, Contact, Grid, Run, Simulation, _core
from mpm3dpp.io import result_hash

TRANSFERS = tuple(_core.settings["run"]["transfer"]["words"][0])


def simulation(dimension: int, scheme: str, transfer: str, basis: str) -> Simulation:
    """Return a block at rest, 4 cells along each edge, two particles a cell along each axis."""
    run = Run(end_time=1.0, scheme=scheme, transfer=transfer, energy_growth_limit=1e9)
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis=basis),
        run=run,
        contact=Contact(),
        material=materials(),
        body={"body": block((0,) * dimension, (4,) * dimension, material="solid")},
    )
    return Simulation(case, threads=1)


@pytest.mark.parametrize("transfer", TRANSFERS)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_laws(dimension: int, scheme: str, transfer: str) -> None:
    for basis in _core.bases:
        sim = simulation(dimension, scheme, transfer, basis)
        v = np.random.default_rng(1).uniform(-1.0, 1.0, sim.column("body", "velocity").shape)
        sim.set_velocity("body", v)
        sim.advance(5)
        rows = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
        mass = sim.column("body", "mass")[:, 0]
        scale = float(0.5 * np.sum(mass[:, None] * v**2))
        # Sums over at most 512 particles of terms of these sizes: some thousand roundings a step.
        assert np.abs(rows["residual"][1:]).max() <= 1e-11 * scale
        momentum = np.abs(rows["momentum_x"][1:] - mass @ v[:, 0]).max()
        assert momentum <= 1e-12 * float(mass @ np.abs(v[:, 0]))


@pytest.mark.parametrize("transfer", TRANSFERS)
def test_a_translation_is_kept(transfer: str) -> None:
    sim = simulation(2, "musl", transfer, "gimp")
    v = np.broadcast_to([3.0, -2.0], sim.column("body", "velocity").shape)
    sim.set_velocity("body", v)
    sim.advance(50)
    assert np.abs(sim.column("body", "velocity") - v).max() <= 1e-12  # 50 steps of 20 roundings


@pytest.mark.parametrize("transfer", TRANSFERS)
@pytest.mark.parametrize("dimension", [2, 3])
def test_bits_do_not_depend_on_threads_fusion_and_restarts(
    dimension: int, transfer: str, tmp_path: Path
) -> None:
    case = everything(tmp_path, dimension, "musl", "gimp", "absorbing")
    case.contact.enabled = transfer == "flip"
    case.run.pic_damping *= transfer == "flip"
    case.run.transfer = transfer
    found = set()
    for threads, fused, restarts in ((1, True, False), (2, False, False), (2, True, True)):
        sim = Simulation(case, threads=threads, fused=fused)
        sim.core.advance(15, 1.0)
        if restarts:
            state = io.BytesIO()
            sim.core.save(state.write)
            size = state.tell()
            state.seek(0)
            sim = Simulation(case, threads=threads, fused=fused)
            sim.core.restore(state.readinto, size)
        sim.core.advance(15, 1.0)
        found.add(result_hash(sim.core))
    assert len(found) == 1


def test_pic_takes_the_velocity_of_the_grid() -> None:
    """What alternates from particle to particle is not seen by the grid, and gone after a step."""
    left = {}
    for transfer in ("flip", "pic"):
        sim = simulation(2, "musl", transfer, "linear")
        place = np.rint(sim.column("body", "position") / (CELL / 2) - 0.5).astype(int)
        v = np.zeros_like(sim.column("body", "velocity"))
        v[:, 0] = np.prod(1 - 2 * (place % 2), axis=1)
        sim.set_velocity("body", v)
        sim.advance(1)
        inner = np.all((place > 1) & (place < 6), axis=1)
        left[transfer] = np.abs(sim.column("body", "velocity")[inner, 0]).max()
    assert left["flip"] > 0.9 and left["pic"] < 0.1


def test_pic_does_not_go_with_contact() -> None:
    """Its particles take the momentum of eqs. (6)-(7), which records of contact do not count."""
    blocks = {name: block((x, 0), (x + 4, 4), material="solid") for name, x in (("a", 0), ("b", 4))}
    grid, run = Grid(dimension=2, cell_size=CELL), Run(end_time=1.0, transfer="pic", pic_damping=1)
    with pytest.raises(CaseError) as raised:
        Case(grid=grid, run=run, contact=Contact(), material=materials(), body=blocks)
    keys = {error.key for error in (raised.value, *raised.value.others)}
    assert keys == {"case.run.transfer", "case.run.pic_damping"}
    case = Case(
        grid=grid,
        run=Run(end_time=1.0, transfer="pic"),
        material=materials(),
        contact=Contact(bonded=True),
        body=blocks,
    )
    assert Simulation(case, threads=1).advance(3) == 3
