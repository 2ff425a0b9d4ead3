# SPDX-License-Identifier: BSD-3-Clause
"""Volumes averaged over cells: what it changes, what it leaves, and where its energy goes.

That nearly incompressible matter does not lock is judged in tests/verification/test_locking.py.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, SCHEMES, block, everything, materials, three_blocks
from mpm3dpp import Case, CaseError, Grid, Material, Run, Simulation
from mpm3dpp.io import result_hash

KINDS = [(d, scheme, basis) for d in (2, 3) for scheme in SCHEMES for basis in BASES]


def averaged(case: Case, which: bool = True) -> Case:
    """Return the case with volumes averaged in all materials that deform."""
    for material in case.material.values():
        material.damping = None  # which does not go with it
        material.volume_averaging = which and material.strength.model != "rigid"
    return case


def waving(
    dimension: int,
    scheme: str = "musl",
    basis: str = "gimp",
    averages: bool = True,
    per_axis: int = 2,
    cfl: float = 0.25,
    transfer: Any = "flip",
    velocity: str = "2 * sin(200 * x) * cos(150 * y)",
    material: dict[str, Any] | None = None,
) -> Simulation:
    """Return a free block, 5 cells along each edge, nearly incompressible, that waves strongly."""
    soft = {"density": 1000.0, "strength": {"elastic": {"E": "1 MPa", "nu": 0.49}}}
    soft |= material or {}
    field: list[Any] = [{"expression": velocity}, {"expression": velocity.replace("x", "y + x")}]
    case = Case(
        grid=Grid(dimension=dimension, cell_size=CELL, basis=basis),
        run=Run(end_time=1.0, scheme=scheme, cfl=cfl, transfer=transfer, energy_growth_limit=1e9),
        material={"solid": Material(**soft, volume_averaging=averages)},
        body={
            "body": block(
                (1,) * dimension,
                (5,) * dimension,
                material="solid",
                particles_per_cell=per_axis,
                velocity=[*field, 0.0][:dimension],
            )
        },
    )
    return Simulation(case, threads=1)


def history(sim: Simulation) -> dict[str, np.ndarray]:
    return dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))


@pytest.mark.parametrize(("dimension", "scheme", "basis"), KINDS)
def test_all_particles_of_a_cell_change_volume_alike(
    dimension: int, scheme: str, basis: str
) -> None:
    """In a step; without averaging they do not."""
    # Cells with a node amid them but for the linear basis. All stay in their cells for a step.
    shift = 0.0 if basis == "linear" else 0.5
    spread = {}
    for averages in (True, False):
        sim = waving(dimension, scheme, basis, averages)
        sim.advance(1)  # USF strains in the second step for the first time
        cells = np.floor(sim.column("body", "position") / CELL + shift)
        before = sim.column("body", "volume")[:, 0].copy()
        sim.advance(1)
        change = sim.column("body", "volume")[:, 0] / before - 1
        _, number = np.unique(cells, axis=0, return_inverse=True)
        of_cell = [np.ptp(change[number.ravel() == k]) for k in range(number.max() + 1)]
        assert np.ptp(change) > 1e-4
        spread[averages] = max(of_cell) / np.ptp(change)
    assert spread[True] < 1e-10 and spread[False] > 0.1


@pytest.mark.parametrize(("dimension", "scheme", "basis"), KINDS)
def test_the_forces_are_the_adjoint(dimension: int, scheme: str, basis: str) -> None:
    """What FLIP's mapping loses is what F-bar has beyond the forces' own work, to rounding.

    With USF and MUSL forces and stress work on the same velocities, so that without averaging
    mapping loses nothing (theory, the ledger). USL's lumped mass does lose energy.
    """
    sim = waving(dimension, scheme, basis)
    sim.advance(50)
    rows = history(sim)
    energy = rows["kinetic"][0]
    size = np.abs(rows["numerical_averaging"]).max()
    assert np.abs(rows["residual"]).max() < 1e-12 * energy
    assert 1e-9 * energy < size < 1e-3 * energy
    if scheme != "usl":
        apart = rows["numerical_mapping"] - rows["numerical_averaging"]
        assert np.abs(apart).max() < 1e-12 * energy


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("transfer", ["flip", "apic", {"xpic": 3}])
def test_its_energy_goes_with_the_step(scheme: str, transfer: Any) -> None:
    """It is of the second order in a step, so over a time of the first.

    With USF what mapping loses is judged, in which the forces themselves are.
    """
    column = "numerical_mapping" if scheme == "usf" else "numerical_averaging"
    made = []
    for cfl in (0.4, 0.2, 0.1):
        sim = waving(2, scheme, "quadratic_bspline", cfl=cfl, transfer=transfer)
        while sim.advance(1000, 1e-3):
            pass
        rows = history(sim)
        made.append(np.abs(rows[column]).max() / rows["kinetic"][0])
    assert made[0] < 5e-3
    # A half each, or less: it has both signs. Of the first order in a step it would stay.
    assert made[0] > 1.5 * made[1] and made[1] > 1.5 * made[2]


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_one_particle_a_cell_is_its_own_mean(dimension: int, scheme: str) -> None:
    found = []
    for averages in (True, False):
        sim = waving(dimension, scheme, "linear", averages, per_axis=1)
        sim.advance(5)  # while all stay in their cells
        found.append([sim.column("body", name) for name in ("position", "stress")])
    for one, other in zip(*found, strict=True):
        assert np.abs(one - other).max() < 1e-9 * np.abs(other).max()


@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_uniform_strain_is_left_as_it_is(dimension: int, scheme: str) -> None:
    """Inside of a body whose velocity is linear in the place, before its surface is felt there."""
    found = []
    for averages in (True, False):
        sim = waving(dimension, scheme, "linear", averages, velocity="-3 * x + y")
        sim.advance(2 if scheme == "usf" else 1)  # the first that strains
        inner = np.all(np.abs(sim.column("body", "position") / CELL - 3.5) < 1, axis=1)
        found.append(sim.column("body", "stress")[inner])
    assert np.abs(found[1]).max() > 10.0  # [Pa]
    assert np.abs(found[0] - found[1]).max() < 1e-9 * np.abs(found[1]).max()


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_run_goes_on_with_the_same_bits(
    tmp_path: Path, dimension: int, scheme: str, basis: str
) -> None:
    """From a checkpoint, with another number of threads, with unfused stages; walls, contact."""
    case = averaged(everything(tmp_path, dimension, scheme, basis, "absorbing"))
    steps = 3 if scheme == "usl" else 15
    straight = Simulation(case, threads=1)
    straight.advance(steps)
    straight.save(tmp_path / "state.zip")
    straight.advance(steps)
    again = Simulation(case, threads=2)
    again.restore(tmp_path / "state.zip")
    again.advance(steps)
    assert result_hash(straight.core) == result_hash(again.core)
    assert straight.core.history().tobytes()[-200:] == again.core.history().tobytes()[-200:]
    off = Simulation(averaged(case, False), threads=1)
    off.advance(2 * steps)
    assert result_hash(straight.core) != result_hash(off.core)


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_fused_stages_give_the_same_bits(dimension: int, scheme: str) -> None:
    found = []
    for fused in (True, False):
        sim = Simulation(averaged(three_blocks(dimension, scheme)), threads=2, fused=fused)
        sim.advance(30)
        found.append(result_hash(sim.core) + sim.core.history().tobytes().hex())
    assert found[0] == found[1]


@pytest.mark.parametrize("scheme", SCHEMES)
def test_failed_particles_take_no_part(scheme: str) -> None:
    """In cells with some that have failed the others change alike, and these as they like."""
    torn = {"failure": {"plastic_strain": {"limit": 0.02}}}
    brittle = {"strength": {"j2": {"E": "1 MPa", "nu": 0.49, "Y0": "2 kPa"}}} | torn
    sim = waving(2, scheme, material=brittle)
    while (sim.column("body", "failed") > 0).mean() < 0.3:
        assert sim.advance(1) and sim.step < 500
    place, failed = sim.column("body", "position"), sim.column("body", "failed")[:, 0] > 0
    before = sim.column("body", "volume")[:, 0].copy()
    sim.advance(1)
    stayed = np.all(np.floor(place / CELL + 0.5) == np.floor(now(sim) / CELL + 0.5), axis=1)
    assert stayed.all() and (failed == (sim.column("body", "failed")[:, 0] > 0)).mean() > 0.95
    change = sim.column("body", "volume")[:, 0] / before - 1
    pressure = sim.column("body", "force_pressure")[:, 0]
    _, number = np.unique(np.floor(place / CELL + 0.5), axis=0, return_inverse=True)
    mixed = 0
    for k in range(number.max() + 1):
        mine = number.ravel() == k
        intact, gone = change[mine & ~failed], change[mine & failed]
        if min(len(intact), len(gone)) < 1:
            continue
        mixed += 1
        assert np.ptp(intact) < 1e-10 * np.abs(change).max()
        assert np.abs(gone - intact[0]).min() > 1e-6 * np.abs(change).max()
        if len(intact) == 1:  # its own mean
            assert abs(pressure[mine & ~failed][0]) < 1e-9 * np.abs(pressure).max()
    assert mixed > 3 and np.all(pressure[failed] == 0.0)


def now(sim: Simulation) -> np.ndarray:
    return np.asarray(sim.column("body", "position"))


@pytest.mark.parametrize(
    ("material", "rule"),
    [
        ({"strength": {"rigid": {}}}, "rigid does not deform and takes no volume_averaging"),
        ({"library": "tnt"}, "takes no volume_averaging: its front is sharper than a cell"),
    ],
)
def test_what_it_is_not_for(material: dict[str, Any], rule: str) -> None:
    given = {"density": 1000.0} if "strength" in material else {}
    with pytest.raises(CaseError) as error:
        Simulation(
            Case(
                grid=Grid(dimension=2, cell_size=CELL),
                run=Run(end_time=1.0),
                material={"solid": Material(**given, **material, volume_averaging=True)},
                body={"body": block((1, 1), (4, 4), material="solid")},
            )
        )
    assert rule in str(error.value)


def test_off_is_the_default() -> None:
    assert not Material(density=1.0, strength={"elastic": {"E": 1, "nu": 0}}).volume_averaging
    assert all(not m.volume_averaging for m in materials().values())
