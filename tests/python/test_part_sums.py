# SPDX-License-Identifier: BSD-3-Clause
"""What each body has, mass to angular momentum, against sums over its particles."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import CELL, block, materials, three_blocks
from mpm3dpp import Case, Grid, Run, Simulation, load_case, open_results, run_case
from mpm3dpp.io import read_history
from mpm3dpp.io.part_cells import PART_COLUMNS

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"


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


@pytest.mark.parametrize("transfer", ["flip", "apic"])
@pytest.mark.parametrize(("dimension", "spin"), [(2, 40.0), (3, (30.0, -20.0, 10.0))])
def test_spin_is_that_of_a_body_that_turns(dimension: int, spin: Any, transfer: str) -> None:
    """A block of unequal sides turns as it is told to, whatever the axes of its inertia."""
    sides = (3, 5, 7)[:dimension]
    blocks = {"a": block((0,) * dimension, sides, material="solid", angular_velocity=spin)}
    grid = Grid(dimension=dimension, cell_size=CELL, basis="quadratic_bspline")
    run = Run(end_time=1.0, transfer=transfer)
    sim = Simulation(Case(grid=grid, run=run, material=materials(), body=blocks), threads=1)
    sums = dict(zip(PART_COLUMNS, sim.core.part_sums()[1][0], strict=True))
    found = [sums[f"spin_{axis}"] for axis in "xyz"]
    assert found == pytest.approx(spin if dimension == 3 else (0.0, 0.0, spin), rel=1e-12)


IMPACT = """
[grid]
dimension = 3
cell_size = "1 mm"
outflow_box = { lower = ["-20 mm", "-20 mm", "-10 mm"], upper = ["20 mm", "20 mm", "10 mm"] }
[run]
end_time = "8 us"
scheme = "usf"
[material.copper]
library = "copper_ofhc"
failure = { plastic_strain = { limit = 0.6, action = "erode" } }
[body.ball]
material = "copper"
shape = { sphere = { centre = ["1 mm", "0.5 mm", "4.5 mm"], radius = "4 mm" } }
velocity = ["200 m/s", "100 m/s", "-800 m/s"]
[body.plate]
material = "copper"
shape = { box = { lower = ["-10 mm", "-10 mm", "-2 mm"], upper = ["10 mm", "10 mm", "0 mm"] } }
[load.push]
body = "plate"
side = "z_min"
pressure = "1 MPa"
"""


def test_what_bodies_have_is_what_all_have(tmp_path: Path) -> None:
    """Energies of the bodies are the ledger's, the eroded mass is all of it, and forces oppose."""
    manifest = run_case(Case.from_text(IMPACT), tmp_path, threads=2, pictures=False, quiet=True)
    history, final = read_history(tmp_path), {}
    for name in ("internal", "plastic", "viscous", "kinetic"):
        final[name] = sum(history[f"body_{body}_{name}"] for body in ("ball", "plate"))
        told = ~np.isnan(final[name])
        assert told.sum() > 5
        differences = np.abs(final[name] - history[name])[told]
        assert differences.max() < 1e-12 * history["kinetic"][0], name
    assert final["plastic"][-1] > 0.05 * history["kinetic"][0]
    eroded = {name: found["final"]["eroded_mass"] for name, found in manifest.bodies.items()}
    assert min(eroded.values()) > 0.0
    assert sum(eroded.values()) == pytest.approx(manifest.eroded["mass"], rel=1e-14)
    forces = np.array(
        [[history[f"body_{b}_contact_force_{x}"] for x in "xyz"] for b in ("ball", "plate")]
    )
    pairs = np.array([history[f"contact_force_ball_plate_{x}"] for x in "xyz"])
    told = ~np.isnan(forces[0, 0]) & ~np.isnan(pairs[0])
    assert np.array_equal(forces[0][:, told], pairs[:, told]) and np.abs(pairs[:, told]).max() > 0
    assert np.array_equal(forces[0][:, told], -forces[1][:, told])
    load = [manifest.bodies["plate"]["final"][f"load_force_{x}"] for x in "xyz"]
    assert load == manifest.loads["push"].force and load[2] > 0.0


def test_a_gas_has_its_energy_from_the_start(tmp_path: Path) -> None:
    """Of two bodies of which one alone has an equation of state with an energy."""
    sim = Simulation(load_case(EXAMPLES / "13_sod_tube" / "case.toml"), threads=1)
    rows = [dict(zip(PART_COLUMNS, row, strict=True)) for row in sim.core.part_sums()[1]]
    whole = sim.core.history()[0][sim.core.history_columns.index("internal")]
    assert sum(row["internal"] for row in rows) == pytest.approx(whole, rel=1e-14) and whole > 0.0


SPINS = """
[grid]
dimension = {dimension}
cell_size = "5 mm"
[run]
end_time = "0.4 ms"
[output]
frames = 2
[material.s]
density = 1000
strength = {{ rigid = {{}} }}
[material.e]
density = 1000
strength = {{ elastic = {{ E = "100 MPa", nu = 0.3 }} }}
[body.rigid]
material = "s"
shape = {shape[0]}
angular_velocity = {spin}
[body.soft]
material = "e"
shape = {shape[1]}
angular_velocity = {spin}
[body.driven]
material = "s"
shape = {shape[2]}
motion = {{ angular_velocity = {spin} }}
[body.driven_soft]
material = "e"
shape = {shape[3]}
motion = {{ angular_velocity = {spin} }}
[grains.hard]
material = "s"
lattice = {{ lower = {lower[4]}, count = {one}, radius = "20 mm" }}
angular_velocity = {spin}
[grains.g]
material = "e"
lattice = {{ lower = {lower[5]}, count = {one}, radius = "20 mm" }}
angular_velocity = {spin}
"""


@pytest.mark.parametrize("dimension", [2, 3])
def test_spins_are_told_as_given(dimension: int, tmp_path: Path) -> None:
    """Of what deforms, is rigid or driven, one by one and in the history, also of a run that went
    on. Only bodies that deform have an affine part; in their material others have room for it."""
    kind = "disc" if dimension == 2 else "sphere"
    corners = [[0.1 * k] + [0.0] * (dimension - 1) for k in range(6)]
    shapes = [f'{{ {kind} = {{ centre = {c}, radius = "20 mm" }} }}' for c in corners]
    spin = 100.0 if dimension == 2 else [60.0, 0.0, 80.0]
    lower = [[x - 0.02 for x in c] for c in corners]
    one = [1] * dimension
    text = SPINS.format(dimension=dimension, shape=shapes, spin=spin, lower=lower, one=one)
    case = Case.from_text(text)
    given = np.array([0.0, 0.0, 100.0] if dimension == 2 else spin)

    def check(sim: Simulation) -> None:
        rows = [dict(zip(PART_COLUMNS, row, strict=True)) for row in sim.core.part_sums()[1]]
        found = [[row[f"spin_{a}"] for a in "xyz"] for row in rows]
        assert len(found) == 6 and np.abs(np.array(found) - given).max() <= 1e-4 * 100.0
        rigid = [k for k, name in enumerate(case.parts()) if name not in ("soft", "g")]
        assert np.abs(np.array(found)[rigid] - given).max() <= 1e-10 * 100.0

    sim = Simulation(case, threads=1)
    check(sim)
    sim.advance(3)
    sim.save(tmp_path / "state")
    again = Simulation(case, threads=1)
    again.restore(tmp_path / "state")
    check(again)
    if dimension == 3:
        return
    run_case(case, tmp_path / "out", threads=1, pictures=False)
    history = read_history(tmp_path / "out")
    told = np.isfinite(history["body_rigid_spin_z"])
    for name in ("rigid", "driven", "driven_soft", "hard"):
        assert np.abs(history[f"body_{name}_spin_z"][told] - 100.0).max() <= 1e-9
    with open_results(tmp_path / "out") as results:
        for frame in range(len(results.times)):
            spins = np.asarray(results.grains(frame)["spin_z"])
            assert len(spins) == 6 and np.abs(spins - 100.0).max() <= 0.01
