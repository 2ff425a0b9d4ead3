# SPDX-License-Identifier: BSD-3-Clause
"""XPIC: what the grid does not see of velocities goes, and what it sees stays, as orders rise.

Laws of all transfers (momentum, ledger, contact, bits) are in test_transfers.py.
"""

from __future__ import annotations

import itertools
from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, SCHEMES, block, box, materials
from mpm3dpp import Body, Case, CaseError, Contact, Grid, Run, Simulation
from mpm3dpp.io import result_hash


def simulation(
    transfer: Any,
    basis: str = "linear",
    dimension: int = 2,
    scheme: str = "musl",
    bodies: dict[str, Body] | None = None,
    **grid: Any,
) -> Simulation:
    """Return a block, 4 cells along each edge and a cell above the origin, at rest if alone."""
    d = dimension
    case = Case(
        grid=Grid(dimension=d, cell_size=CELL, basis=basis, **grid),
        run=Run(end_time=1.0, scheme=scheme, transfer=transfer, energy_growth_limit=1e9),
        contact=Contact(bonded=bodies is not None),
        material=materials(),
        body=bodies or {"body": block((1,) * d, (4,) * d, material="solid")},
    )
    return Simulation(case, threads=1)


def places(sim: Simulation) -> np.ndarray:
    """Return the numbers of the particles in their lattice, from 0 to 7 along each axis."""
    return np.rint(sim.column("body", "position") / (CELL / 2) - 2.5).astype(int)


def after_a_step(transfer: Any, basis: str, dimension: int, field: Any) -> tuple[Any, Any]:
    """Return velocities of a body without stress before and after a step."""
    sim = simulation(transfer, basis, dimension)
    v = field(places(sim))
    sim.set_velocity("body", v)
    sim.advance(1)
    return v, sim.column("body", "velocity")


def noise(place: np.ndarray) -> np.ndarray:
    """Return what alternates from particle to particle along every axis."""
    v = np.zeros(place.shape)
    v[:, 0] = np.prod(1 - 2 * (place % 2), axis=1)
    return v


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_noise_that_the_grid_does_not_see_goes(dimension: int, basis: str) -> None:
    """Off the surface the noise maps to nothing: all orders take it whole, and FLIP keeps it."""
    for transfer, low, high in (("flip", 1.0, 1.0), ({"xpic": 2}, 0, 0.1), ({"xpic": 5}, 0, 0.1)):
        v, after = after_a_step(transfer, basis, dimension, noise)
        sim = simulation(transfer, basis, dimension)
        inner = np.all((places(sim) > 2) & (places(sim) < 5), axis=1)
        left = np.abs(after[inner, 0]) / np.abs(v[inner, 0])
        assert low - 1e-12 <= left.min() and left.max() <= high + 1e-12, transfer


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_linear_field_is_kept_the_better_the_higher_the_order(dimension: int, basis: str) -> None:
    """S S+ has eigenvalues from 0 to 1, so that (I - S S+)^k falls; what it takes is its energy."""

    def spin(place: np.ndarray) -> np.ndarray:
        arm = place - 3.5
        return np.column_stack([-arm[:, 1], arm[:, 0], *arm.T[2:]])

    lost = []
    for order in (1, 2, 4, 8, 16):
        v, after = after_a_step({"xpic": order}, basis, dimension, spin)
        lost.append(np.linalg.norm(v - after) / np.linalg.norm(v))
    # Of the spin of a block of 4 cells PIC takes an eighth, and each doubling half of that or less.
    assert all(b < 0.5 * a for a, b in itertools.pairwise(lost)), lost
    assert lost[0] > 0.1 and lost[-1] < 0.003, lost


def test_what_is_taken_is_the_kinetic_energy_that_is_gone() -> None:
    sim = simulation({"xpic": 3}, "gimp", 3)
    v = np.random.default_rng(1).uniform(-1.0, 1.0, sim.column("body", "velocity").shape)
    sim.set_velocity("body", v)
    sim.advance(1)
    rows = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
    after, unseen = sim.column("body", "velocity"), sim.column("body", "unseen_velocity")
    mass = sim.column("body", "mass")[:, 0]
    before, left = (0.5 * mass @ np.sum(u**2, axis=1) for u in (v, after))
    # No stress yet: some hundred roundings.
    assert rows["numerical_transfer"][-1] == pytest.approx(before - left, rel=1e-13)
    assert rows["numerical_transfer"][-1] > 0.1 * before
    assert np.abs(v - unseen - after).max() <= 1e-14


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_first_order_is_pic(dimension: int, scheme: str, basis: str) -> None:
    """Thrown into a corner of two kinds of walls, on which nodes are held."""
    found = []
    for transfer in ("pic", {"xpic": 1}):
        walls = {"x_min": "slip", "y_min": "fixed"}
        sim = simulation(transfer, basis, dimension, scheme, **box(dimension, 8, walls))
        sim.set_velocity("body", np.full(sim.column("body", "velocity").shape, -8.0))
        sim.advance(30)
        assert sim.column("body", "position").min(axis=0).max() < 0.9 * CELL
        found.append({name: sim.column("body", name) for name in ("position", "velocity")})
    # Some ten roundings of 8 m/s in a step, which waves carry on.
    assert np.abs(found[0]["velocity"] - found[1]["velocity"]).max() <= 1e-11
    assert np.abs(found[0]["position"] - found[1]["position"]).max() <= 1e-13


def test_what_is_taken_may_be_in_the_frames() -> None:
    body = {"body": block((1, 1), (4, 4), material="solid", velocity=(1.0, 0.0))}
    for transfer in ("xpic", "flip"):
        fields = {
            "grid": {"dimension": 2, "cell_size": CELL},
            "run": {"end_time": 1.0, "transfer": transfer},
            "output": {"fields": ["unseen_velocity"]},
        }
        if transfer == "xpic":
            Case(**fields, material=materials(), body=body)
            continue
        with pytest.raises(CaseError, match="is not a column that this case stores"):
            Case(**fields, material=materials(), body=body)


def test_every_third_step_is_filtered() -> None:
    hashes = []
    for transfer in ("flip", {"xpic": 4, "every": 3}):
        sim = simulation(transfer, "gimp")
        sim.set_velocity("body", noise(places(sim)))
        said = []
        for _ in range(3):
            sim.advance(1)
            said.append(sim.column("body", "velocity").tobytes())
        hashes.append(said)
    flip, periodic = hashes
    assert flip[:2] == periodic[:2] and flip[2] != periodic[2]


def test_bonded_bodies_are_filtered_as_one() -> None:
    """They share the velocities of the grid, so that two halves lose what a whole one does."""
    halves = {
        "body": block((1, 1), (2, 4), material="solid"),
        "other": block((3, 1), (2, 4), material="solid"),
    }
    whole, parts = simulation({"xpic": 3}), simulation({"xpic": 3}, bodies=halves)
    v = np.random.default_rng(2).uniform(-1.0, 1.0, whole.column("body", "velocity").shape)
    whole.set_velocity("body", v)
    left = whole.column("body", "position")[:, 0] < 3 * CELL
    for name, rows in (("body", left), ("other", ~left)):
        assert np.array_equal(
            parts.column(name, "position"), whole.column("body", "position")[rows]
        )
        parts.set_velocity(name, v[rows])
    for sim in (whole, parts):
        sim.advance(5)
    for name, rows in (("body", left), ("other", ~left)):
        apart = parts.column(name, "velocity") - whole.column("body", "velocity")[rows]
        assert np.abs(apart).max() <= 1e-13  # a hundred roundings of 1 m/s
    rows = dict(zip(parts.core.history_columns, parts.core.history().T, strict=True))
    mass = whole.column("body", "mass")[:, 0]
    assert np.abs(rows["momentum_x"][1:] - mass @ v[:, 0]).max() <= 1e-13


@pytest.mark.parametrize("scheme", SCHEMES)
def test_rows_in_another_order_are_filtered_alike(scheme: str) -> None:
    hashes = set()
    for disorder in (0.0, None):
        body = {"body": block((1, 1), (4, 4), material="solid")}
        grid = Grid(dimension=2, cell_size=CELL, basis="gimp")
        run = Run(end_time=1.0, scheme=scheme, transfer={"xpic": 2, "every": 2})
        case = Case(grid=grid, run=run, material=materials(), body=body)
        sim = Simulation(case, threads=1, disorder=disorder)
        sim.set_velocity("body", np.array([9.0, 4.0]) + 0.1 * noise(places(sim)))
        sim.advance(60)
        hashes.add(result_hash(sim.core))
    assert len(hashes) == 1
