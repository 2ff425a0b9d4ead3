# SPDX-License-Identifier: BSD-3-Clause
"""What each body has, mass to angular momentum, against sums over its particles."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from cases import CELL, block, materials, three_blocks
from mpm3dpp import Case, Grid, Run, Simulation, run_case
from mpm3dpp.io.history import read_history
from mpm3dpp.io.part_cells import PART_COLUMNS


def expected(sim: Simulation, name: str) -> dict[str, np.ndarray]:
    """Return the same from the columns of the particles, with zeros behind the dimension."""

    def in_space(values: np.ndarray) -> np.ndarray:
        return np.pad(values, ((0, 0), (0, 3 - values.shape[1])))

    m = sim.column(name, "mass")[:, 0]
    x, v = (in_space(sim.column(name, column)) for column in ("position", "velocity"))
    centre, momentum = m @ x / m.sum(), m @ v
    angular = m @ np.cross(x - centre, v)
    kinetic = 0.5 * m @ np.sum(v**2, axis=1)
    if sim.case.run.transfer.word == "apic":
        d = sim.case.grid.dimension
        C = sim.column(name, "affine_velocity").reshape(-1, d, d)
        moment = 0.25 * CELL**2
        kinetic += 0.5 * moment * m @ np.sum(C**2, axis=(1, 2))
        C = np.pad(C, ((0, 0), (0, 3 - d), (0, 3 - d)))
        axial = C.transpose(0, 2, 1) - C  # [a, b]: C_ba - C_ab
        angular += moment * m @ np.column_stack([axial[:, 1, 2], axial[:, 2, 0], axial[:, 0, 1]])
    return {
        "mass": m.sum(),
        "centre": centre,
        "velocity": momentum / m.sum(),
        "momentum": momentum,
        "kinetic": kinetic,
        "angular_momentum": angular,
    }


@pytest.mark.parametrize("transfer", ["flip", "apic"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_sums_of_bodies(dimension: int, transfer: str) -> None:
    blocks = {
        name: block((at,) * dimension, (at + 3,) * dimension, material="solid")
        for name, at in (("a", 0), ("b", 7))
    }
    grid = Grid(dimension=dimension, cell_size=CELL, basis="quadratic_bspline")
    case = Case(
        grid=grid, run=Run(end_time=1.0, transfer=transfer), material=materials(), body=blocks
    )
    found = []
    for threads in (1, 2):
        sim = Simulation(case, threads=threads)
        for seed, name in enumerate(blocks):
            v = np.random.default_rng(seed).uniform(-1, 1, sim.column(name, "velocity").shape)
            sim.set_velocity(name, v)
        sim.advance(5)
        found.append(sim.core.part_sums()[1])
    assert np.array_equal(found[0], found[1])
    for row, name in zip(found[0], blocks, strict=True):
        sums = dict(zip(PART_COLUMNS, row, strict=True))
        for key, value in expected(sim, name).items():
            names = [key] if np.ndim(value) == 0 else [f"{key}_{axis}" for axis in "xyz"]
            given = np.array([sums[each] for each in names])
            # Sums of some hundred particles.
            scale = max(1e-12, float(np.abs(value).max()))
            assert np.abs(given - value).max() <= 1e-11 * scale, key


def test_history_has_them(tmp_path: Path) -> None:
    """Angular momentum of all about the origin is that of the bodies and of their centres."""
    case = three_blocks(3, run={"end_time": 2e-4})
    run_case(case, tmp_path, threads=1, pictures=False)
    history = read_history(tmp_path)
    for k in (0, -1):
        total = np.zeros(3)
        momentum = np.zeros(3)
        for name in case.body:
            vectors = {
                key: np.array([history[f"body_{name}_{key}_{axis}"][k] for axis in "xyz"])
                for key in ("centre", "momentum", "angular_momentum")
            }
            momentum += vectors["momentum"]
            total += vectors["angular_momentum"]
            total += np.cross(vectors["centre"], vectors["momentum"])
        told = np.array([history[f"angular_momentum_{axis}"][k] for axis in "xyz"])
        assert np.isfinite(told).all() and np.abs(told - total).max() <= 1e-12 * np.abs(total).max()
        everything = np.array([history[f"momentum_{axis}"][k] for axis in "xyz"])
        scale = np.abs(everything).max() + np.abs(momentum).max()
        assert np.abs(momentum - everything).max() <= 1e-10 * max(scale, 1e-12)


def test_the_balance_of_angular_momentum_is_in_the_history(tmp_path: Path) -> None:
    """In each row that has it the terms add up to what there was at the start."""
    run = {"end_time": 1e-3, "gravity": [0.0, -9.81, 0.0], "transfer": "apic"}
    case = three_blocks(3, run=run, grid={"basis": "quadratic_bspline"})
    run_case(case, tmp_path, threads=1, pictures=False)
    history = read_history(tmp_path)
    told = np.isfinite(history["angular_momentum_x"])
    assert told.sum() > 2
    for axis in "xyz":
        total = sum(
            sign * history[f"angular_{name}_{axis}"][told]
            for name, sign in (
                ("momentum", 1.0),
                ("momentum_removed", 1.0),
                ("momentum_numerical", 1.0),
                ("impulse_gravity", -1.0),
                ("impulse_loads", -1.0),
                ("impulse_walls", -1.0),
                ("impulse_motion", -1.0),
            )
        )
        scale = np.abs(history[f"angular_momentum_{axis}"][told]).max()
        assert np.abs(total - total[0]).max() < 1e-14 * scale
    assert history["angular_impulse_gravity_z"][told][-1] < 0.0
