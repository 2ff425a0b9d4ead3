# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on nodes of their own: what they keep, and what they do not go with."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from in_body import CELL, DENSITY, SPEED, E, energies, frame_case, frame_tables, period, run_to_end
from mpm3dpp import Case, Simulation, _core, open_results, run_case
from same_bits import check_same_bits
from worlds import check_worlds


@pytest.mark.parametrize(
    ("cells", "mode", "near", "swing"),
    [(24, 1, 0.005, 0.002), (24, 3, 0.03, 0.01), (6, 1, 0.05, 0.02)],
)
def test_a_bar_vibrates_for_ever(cells: int, mode: int, near: float, swing: float) -> None:
    """Free at both ends: f = k c / 2 L. Its nodes reach half a cell beyond it: a low mode is slow.

    Energy swings by (w dt)^2 / 8, .0005, .005, .009 of it: two to four times that is allowed.
    """
    length = cells * CELL
    exact = 2.0 * length / (mode * SPEED)
    shape = {"box": {"lower": [0, 0], "upper": [length, 4 * CELL]}}
    wave = {"expression": f"cos({mode * np.pi / length} * x)"}
    simulation = Simulation(
        frame_case(2, {"shape": shape, "velocity": [wave, 0.0]}, 20.0 * exact, nu=0.0), threads=1
    )
    form = np.cos(mode * np.pi / length * simulation.column("a", "position")[:, 0])

    def amplitude(simulation: Simulation) -> float:
        return float(2.0 * (form * simulation.column("a", "velocity")[:, 0]).mean())

    columns, (times, values) = run_to_end(simulation, 3, amplitude)
    assert period(times, values) == pytest.approx(exact, rel=near)
    assert np.abs(energies(columns) - 1.0).max() < swing
    assert np.abs(values[-60:]).max() == pytest.approx(np.abs(values[:60]).max(), rel=0.02)
    assert np.abs(columns["residual"]).max() < 1e-12 * columns["kinetic"][0]


def test_a_rod_twists_to_and_fro() -> None:
    """A round bar of 4 cells a radius R, free at both ends: f = (1 / 2 L) sqrt(G / rho).

    The nodes have more inertia than the particles, m h^2 / 2 beside m R^2 / 2: 3 % in the period.
    """
    length, k = 16 * CELL, np.pi / (16 * CELL)
    exact = 2.0 * length / np.sqrt(E / 2.6 / DENSITY) * np.sqrt(1.0 + 1.0 / 16.0)
    shape = {
        "cylinder": {
            "centre": [length / 2, 0, 0],
            "axis": "x",
            "height": length,
            "radius": 4 * CELL,
        }
    }
    twist = [0.0, *({"expression": f"{v} * cos({k} * x)"} for v in ("-100 * z", "100 * y"))]
    case = frame_case(3, {"shape": shape, "velocity": twist}, 5.0 * exact)
    simulation = Simulation(case)
    x, y, z = simulation.column("a", "position").T

    def amplitude(simulation: Simulation) -> float:
        _, v, w = simulation.column("a", "velocity").T
        return float((np.cos(k * x) * (y * w - z * v)).mean())

    columns, (times, values) = run_to_end(simulation, 3, amplitude)
    assert period(times, values) == pytest.approx(exact, rel=0.01)
    assert np.abs(energies(columns) - 1.0).max() < 0.01


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_a_grain_spins_on(dimension: int) -> None:
    """Of four cells a radius, 3.2 turns: the updated frame makes 1e-3 of its energy."""
    shape = {("disc", "sphere")[dimension - 2]: {"centre": [0.0] * dimension, "radius": 4 * CELL}}
    spin = 500.0 if dimension == 2 else [0.0, 0.0, 500.0]
    case = frame_case(dimension, {"shape": shape, "angular_velocity": spin}, 3.2 * 2 * np.pi / 500)
    simulation = Simulation(case)
    turning = [k for k, name in enumerate(_core.part_columns) if "angular_momentum" in name]
    start = np.array(simulation.core.part_sums()[1][0])[turning]
    columns, _ = run_to_end(simulation, 100)
    end = np.array(simulation.core.part_sums()[1][0])[turning]
    assert np.abs(end - start).max() < 1e-10 * np.abs(start).max() > 0.0
    assert np.abs(energies(columns) - 1.0).max() < 1e-3


@pytest.mark.slow
def test_a_block_without_torque_flips() -> None:
    """About the axis between: Euler's equations, with the inertia of the particles."""
    sides, turns = np.array([3.0, 6.0, 9.0]) * CELL, 6.0
    speed = 0.03 * np.sqrt(E * 0.7 / (1.3 * 0.4) / DENSITY) / (0.5 * sides[2])
    spin = speed * np.array([0.1, 1.0, 0.1])
    end = turns * 2.0 * np.pi / speed
    shape = {"box": {"lower": (-sides / 2).tolist(), "upper": (sides / 2).tolist()}}
    case = frame_case(3, {"shape": shape, "angular_velocity": spin.tolist()}, end)
    simulation = Simulation(case)
    X, m = simulation.column("a", "position"), simulation.column("a", "mass")[:, 0]
    square = (m[:, None] * X**2).sum(axis=0)
    inertia = square.sum() - square

    def along(simulation: Simulation) -> float:
        """How much of the body's middle axis points where it did."""
        u, _, v = np.linalg.svd((simulation.column("a", "position") * m[:, None]).T @ X)
        return float((u @ v)[1, 1])

    columns, (times, values) = run_to_end(simulation, 40, along)
    flips = times[np.flatnonzero(np.diff(np.sign(values)))]
    steps, exact = 40_000, []
    dt, w, axes = end / steps, spin.copy(), np.eye(3)

    def turn(w: np.ndarray) -> np.ndarray:
        after, before = np.roll(inertia, -1), np.roll(inertia, -2)
        return np.roll(w, -1) * np.roll(w, -2) * (after - before) / inertia

    for k in range(steps):
        middle = w + 0.5 * dt * turn(w)
        now = (
            axes
            + dt * np.cross(axes @ middle, (axes + 0.5 * dt * np.cross(axes @ w, axes.T).T).T).T
        )
        if now[1, 1] * axes[1, 1] < 0.0:
            exact.append(k * dt)
        w, axes = w + dt * turn(middle), now
    assert len(flips) == len(exact) >= 2
    assert flips == pytest.approx(exact, rel=0.01)
    assert np.abs(energies(columns) - 1.0).max() < 2e-3


def test_a_body_falls_and_is_slowed_down() -> None:
    """Without a strain: v = v0 - g t; with damping in proportion to the mass v0 exp(-alpha t)."""
    body = {"shape": {"box": {"lower": [0, 0], "upper": [0.006, 0.004]}}, "velocity": [3.0, 1.0]}
    falling = Simulation(frame_case(2, body, 1e-3, run={"gravity": [0.0, -9.81e3]}))
    columns, _ = run_to_end(falling, 50)
    velocity = falling.column("a", "velocity")
    assert np.abs(velocity - [3.0, 1.0 - 9.81]).max() < 1e-10
    assert columns["internal"][-1] < 1e-20
    slowed = Simulation(frame_case(2, {**body, "damping": {"mass": 1000.0}}, 1e-3))
    run_to_end(slowed, 50)
    assert slowed.column("a", "velocity")[:, 0] == pytest.approx(3.0 * np.exp(-1.0), rel=1e-3)


@pytest.mark.parametrize(("cells", "outputs"), [(3, 1), (3, 37), (1.4, 37)])
def test_a_spin_is_slowed_down(cells: float, outputs: int) -> None:
    """As exp(-alpha t), off by 4e-6: a body that turns with mended inertia and one of too few cells
    for that, in one go and to many outputs, before which steps differ by rounding."""
    shape = {"disc": {"centre": [0.0, 0.0], "radius": cells * CELL}}
    body = {"shape": shape, "angular_velocity": 100.0, "damping": {"mass": 200.0}}
    simulation = Simulation(frame_case(2, body, 1.0, nu=0.0))
    for k in range(outputs):
        simulation.advance(10**5, 5e-3 * (k + 1) / outputs)
    (x, y), (u, v) = simulation.column("a", "position").T, simulation.column("a", "velocity").T
    spin = (x * v - y * u).sum() / (x**2 + y**2).sum()
    assert spin == pytest.approx(100.0 * np.exp(-1.0), rel=0.01)


def test_a_body_force_accelerates() -> None:
    body = {
        "shape": {"box": {"lower": [0, 0], "upper": [0.006, 0.004]}},
        "body_force": [{"expression": "1e4"}, 0.0],
    }
    simulation = Simulation(frame_case(2, body, 1e-4))
    columns, _ = run_to_end(simulation, 50)
    assert simulation.column("a", "velocity")[:, 0] == pytest.approx(1.0, rel=1e-9)
    assert columns["kinetic"][-1] == pytest.approx(columns["external"][-1], rel=1e-3)


def test_a_probe_sees_where_it_has_flown(tmp_path: Path) -> None:
    """Its nodes' tiles are those of the start, 40 cells away by then."""
    box = {"box": {"lower": [0, 0], "upper": [0.006, 0.004]}}
    places = {"there": {"region": {"lower": [0.035, -0.01], "upper": [0.05, 0.01]}}}
    places["point"] = {"point": [0.043, 0.002]}
    probe = {name: {**place, "fields": ["velocity"]} for name, place in places.items()}
    case = frame_case(2, {"shape": box, "velocity": [40.0, 0.0]}, 1e-3, probe=probe)
    run_case(case, tmp_path / "out", pictures=False)
    for name in probe:
        seen = open_results(tmp_path / "out").probe(name)
        velocity, count = (np.asarray(seen[key]) for key in ("velocity_x", "particles"))
        assert velocity[-1] == pytest.approx(40.0)
        assert count[0] == 0 < count[-1]


IN_BODY = """
[grid]
dimension = DIMENSION
cell_size = "2 mm"
[run]
end_time = "1 s"
gravity = GRAVITY
viscosity = {}
[contact]
enabled = false
[material.soft]
density = "1000 kg/m^3"
strength = { j2 = { E = "1 MPa", nu = 0.3, Y0 = "20 kPa", H = "50 kPa" } }
damping = { stiffness = "10 us" }
[body.one]
material = "soft"
frame = "material"
shape = { SHAPE = { centre = CENTRE, radius = "9 mm" } }
velocity = VELOCITY
damping = { mass = 5, local = 0.1 }
[load.tip]
body = "one"
point = TIP
force = PULL
[body.two]
material = "soft"
shape = { SHAPE = { centre = OTHER, radius = "7 mm" } }
velocity = VELOCITY
[body.three]
material = "soft"
frame = "material"
shape = { SHAPE = { centre = THIRD, radius = "7 mm" } }
velocity = VELOCITY
"""


def several(dimension: int, averages: bool) -> Case:
    """Return a case with bodies of both frames, which deform plastically."""
    text = IN_BODY.replace("DIMENSION", str(dimension))
    if averages:
        text = text.replace('damping = { stiffness = "10 us" }', "volume_averaging = true")
    v = ["4", "-3", "2"][:dimension]
    f = [
        f'{{ expression = "{a}" }}'
        for a in ("3e4 * sin(300 * y)", "-2e6 * X", "1e4 * cos(9e3 * t)")
    ][:dimension]
    for word, value in {
        "GRAVITY": [0.0, -9.81, 1.0][:dimension],
        "CENTRE": [0.001, 0.002, 0.0005][:dimension],
        "OTHER": [0.03, 0.012, 0.0005][:dimension],
        "THIRD": [0.03, -0.012, 0.0005][:dimension],
        "TIP": [0.008, 0.002, 0.0005][:dimension],
        "PULL": [20.0, 30.0, -10.0][:dimension],
    }.items():
        text = text.replace(word, str(value))
    text = text.replace("SHAPE", ("disc", "sphere")[dimension - 2])
    text = text.replace("VELOCITY", f"[{', '.join(v)}]\nangular_velocity = SPIN")
    text = text.replace("SPIN", "300" if dimension == 2 else "[100, -50, 300]")
    text = text.replace("damping = { mass", f"body_force = [{', '.join(f)}]\ndamping = {{ mass")
    return Case.from_text(text)


@pytest.mark.parametrize("averages", [False, True])
@pytest.mark.parametrize("dimension", [2, 3])
def test_another_world_is_the_same(dimension: int, averages: bool) -> None:
    check_worlds(several(dimension, averages), 300 if dimension == 2 else 60, "", meet=False)


@pytest.mark.parametrize(
    ("dimension", "averages"),
    [
        (2, False),
        (2, True),
        pytest.param(3, False, marks=pytest.mark.slow),
        pytest.param(3, True, marks=pytest.mark.slow),
    ],
)
def test_the_same_bits(dimension: int, averages: bool, tmp_path: Any) -> None:
    """With any number of threads, stages fused or not, and after a restart."""
    check_same_bits(several(dimension, averages), tmp_path)


def test_many_nodes_in_a_body_beside_one_that_moves_through_the_grid() -> None:
    """Lists of shared nodes, kept where they were, find no room with the few nodes in space."""
    block = {"shape": {"box": {"lower": [0, 0], "upper": [200 * CELL, 100 * CELL]}}}
    tables = frame_tables(2, block, 2e-3, contact={"enabled": False})
    plate = {"box": {"lower": [-3 * CELL, 0], "upper": [0, 34 * CELL]}}
    tables["body"]["plate"] = {
        "material": "m",
        "shape": plate,
        "motion": {"velocity": [10.0, 0.0]},
    }
    simulation = Simulation(Case.model_validate(tables))
    simulation.advance(120)
    assert simulation.step == 120
    assert np.abs(simulation.column("a", "velocity")).max() == 0.0
