# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that have a velocity are held while a case settles, and get it at the time 0."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from commands import mpm3dpp
from mpm3dpp import Case, Simulation, open_results, run_case
from mpm3dpp.io import read_history
from mpm3dpp.io.results import Results
from settling import HAMMER, HIT, ONLY_LOAD, hammer


def at_start(results: Results, body: str) -> np.ndarray:
    """Return the velocities of a body's particles in the frame of the time 0."""
    frame = results.arrays(0, ["velocity", "body"])
    return frame["velocity"][frame["body"] == results.bodies.index(body)]


@pytest.mark.parametrize("material", ["rubber", "iron"])
def test_the_hammer_begins_at_the_time_0(tmp_path: Path, material: str) -> None:
    """It hangs, then falls from where it is drawn: y = y0 - v t - g t^2 / 2 to rounding, which
    steps under a constant force give at their ends but for g t dt / 2, here 3e-5 m."""
    run_case(Case.from_text(hammer(material=material)), tmp_path, threads=1, pictures=False)
    history = read_history(tmp_path)
    told = np.isfinite(history["body_hammer_velocity_y"])
    t = history["time"][told]
    v, y = (history[f"body_hammer_{name}_y"][told] for name in ("velocity", "centre"))
    before, after = t < 0.0, t >= 0.0
    assert before.sum() > 3 and np.all(v[before] == 0.0) and np.ptp(y[before]) == 0.0
    assert v[after] == pytest.approx(-5.0 - 9.81 * t[after], rel=1e-12)
    start = y[before][0]
    assert y[after] == pytest.approx(start - 5.0 * t[after] - 4.905 * t[after] ** 2, abs=3e-5)
    residual, energy = history["residual"], np.abs(history["external"]).max()
    assert np.abs(residual).max() <= 1e-12 * energy
    first = np.flatnonzero(history["time"] == 0.0)[0]
    mass = history["body_hammer_mass"][told][0]
    assert history["kinetic"][first] == pytest.approx(12.5 * mass, rel=1e-12)
    assert history["motion_work"][first] == pytest.approx(12.5 * mass, rel=1e-12)
    assert history["motion_impulse_y"][first] == pytest.approx(-5.0 * mass, rel=1e-12)
    # Rounding: of nodes in the block below, whose spin is kept, 1e-11 was seen.
    assert np.abs(history["angular_momentum_numerical_z"][told]).max() <= 1e-10 * mass
    # The block has settled, and stays: it moves by less than a thousandth of that speed.
    assert np.abs(history["body_block_velocity_y"][told][after]).max() < 5e-3
    results = open_results(tmp_path)
    assert results.times[0] == 0.0
    assert np.all(at_start(results, "hammer")[:, 1] == -5.0)


def test_it_hits_after_the_time_0() -> None:
    """The gap of 340 mm and what the block has sunk is closed after .065 s at 5 m/s and more."""
    case = hammer().replace('end_time = "10 ms"', 'end_time = "80 ms"')
    sim = Simulation(Case.from_text(case), threads=1)
    sim.advance(10**7, end_time=0.08)
    [pair] = sim.core.contact_groups()
    gap, g = 0.34, 9.81
    meets = (np.sqrt(25.0 + 2.0 * g * gap) - 5.0) / g
    assert meets == pytest.approx(pair.first_time, rel=0.02)


MOVING = {
    "spin": 'angular_velocity = "100 rad/s"\nvelocity = [1, -5]',
    "formula": 'velocity = [{ expression = "40 * x" }, { expression = "-5 - 30 * (y - 0.425)" }]',
}


@pytest.mark.parametrize("scheme", ["usf", "musl"])
@pytest.mark.parametrize("name", MOVING)
def test_it_moves_as_without_settling(name: str, scheme: str) -> None:
    """A hammer that meets nothing: spin, stretch and their energy are those of the run without.

    Steps are those of the block's waves, which its stress hardly changes: 1e-6."""
    found = []
    text = hammer(MOVING[name]).replace("[run]", f'[run]\nscheme = "{scheme}"')
    for case in (text, text.replace('settle = { longest = "0.2 s" }', "")):
        sim = Simulation(Case.from_text(case), threads=1)
        while sim.time < 0.0:
            sim.advance(10**6, end_time=0.0)
        sim.advance(10**6, end_time=5e-3)
        columns = ["position", "velocity", "affine_velocity", "stress"]
        found.append([sim.column("hammer", column) for column in columns])
    for one, other in zip(*found, strict=True):
        assert np.abs(one - other).max() <= 1e-6 * np.abs(other).max()


def test_all_kinds_of_bodies_that_move(tmp_path: Path) -> None:
    """Velocities one by one, grains, a rigid and a driven body: held, then as given."""
    places = np.array([[0.105 + 0.01 * i, 0.305 + 0.01 * j] for i in range(3) for j in range(3)])
    rows = [f"{x},{y},{1 + k},{-k}" for k, (x, y) in enumerate(places.tolist())]
    (tmp_path / "points.csv").write_text("x,y,vx,vy\n" + "\n".join(rows) + "\n")
    more = """
[body.single]
material = "rubber"
particles = "points.csv"
spacing = "10 mm"
[grains.g]
material = "rubber"
lattice = { lower = ["-100 mm", "200 mm"], count = [2, 1], radius = "15 mm" }
velocity = [{ expression = "2 * x" }, 0]
angular_velocity = 30
[body.wheel]
material = "iron"
shape = { disc = { centre = ["120 mm", "150 mm"], radius = "20 mm" } }
angular_velocity = 50
[body.driven]
material = "iron"
shape = { disc = { centre = ["-140 mm", "350 mm"], radius = "20 mm" } }
motion = { velocity = [3, 0], angular_velocity = 10 }
"""
    (tmp_path / "case.toml").write_text(hammer(more=more))
    out = mpm3dpp("run", "case.toml", "--out", "out", "--no-pictures", cwd=tmp_path)
    assert out.returncode == 0, out.stderr
    names = "body.hammer, body.single, body.wheel, grains.g"
    held = re.search(r"note: (.*) have a velocity at the start: they are held", out.stderr)
    assert held is not None and sorted(held[1].split(", ")) == names.split(", ")
    results = open_results(tmp_path / "out")
    single = at_start(results, "single")
    assert single[:, :2] == pytest.approx(np.array([[1 + k, -k] for k in range(9)]), abs=0.0)
    history = read_history(tmp_path / "out")
    told = np.flatnonzero(np.isfinite(history["body_hammer_velocity_y"]))
    settling = told[history["time"][told] < 0.0]
    for name in (
        "body_single_kinetic",
        "body_g_kinetic",
        "body_wheel_kinetic",
        "body_driven_kinetic",
    ):
        assert np.all(history[name][settling] == 0.0), name
    first = told[history["time"][told] == 0.0][0]
    assert history["body_wheel_spin_z"][first] == pytest.approx(50.0, rel=1e-12)
    assert history["body_driven_spin_z"][first] == pytest.approx(10.0, rel=1e-12)
    assert history["body_driven_velocity_x"][first] == pytest.approx(3.0, rel=1e-12)
    spins = np.asarray(results.grains(0)["spin_z"])
    assert spins[-2:] == pytest.approx([30.0, 30.0], rel=1e-4)
    assert np.abs(history["residual"]).max() <= 1e-12 * np.abs(history["external"]).max()


def test_what_rests_on_a_held_body_is_carried() -> None:
    """A block on a table that will be pulled away: the table carries its weight until then."""
    more = (
        HAMMER.format(material="rubber", motion='velocity = ["5 m/s", 0]')
        + """
[body.load]
material = "rubber"
shape = { box = { lower = ["-50 mm", "450 mm"], upper = ["50 mm", "480 mm"] } }
"""
    )
    text = (HIT + more).replace('longest = "0.2 s"', 'longest = "0.2 s", ratio = 0.005')
    sim = Simulation(Case.from_text(text), threads=1)
    places = sim.column("hammer", "position").copy()
    while sim.time < 0.0:
        sim.advance(10**6, end_time=0.0)
    assert np.array_equal(sim.column("hammer", "position"), places)
    [pair] = [p for p in sim.core.contact_groups() if {p.bodies[0], p.bodies[1]} == {1, 2}]
    weight = 1000.0 * 9.81 * 0.1 * 0.03
    assert abs(pair.force[1]) == pytest.approx(weight, rel=0.01)
    assert not sim.core.warnings()
    # Pulled away, it still bears the load for a while: no force of the springs jumps.
    kinetic = sim.core.history()[-1][sim.core.history_columns.index("kinetic")]
    sim.advance(20)
    rows = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
    assert np.abs(rows["kinetic"] / kinetic - 1.0).max() < 0.01


def test_goes_on_from_the_middle_and_from_after_it(tmp_path: Path) -> None:
    """The same bits as in one go."""
    case = Case.from_text(hammer('angular_velocity = 20\nvelocity = [0, "-5 m/s"]'))
    whole = Simulation(case, threads=1)
    for stop, name in ((100, "settling"), (10**6, "moving")):
        whole.advance(stop, end_time=0.0)
        if name == "moving":
            whole.advance(10, end_time=0.01)
        whole.save(tmp_path / name)
    assert whole.time > 0.0
    whole.advance(10**6, end_time=0.01)
    for name in ("settling", "moving"):
        again = Simulation(case, threads=1)
        again.restore(tmp_path / name)
        assert (again.time < 0.0) == (name == "settling")
        again.advance(10**6, end_time=0.0) if again.time < 0.0 else None
        again.advance(10, end_time=0.01) if name == "settling" else None
        again.advance(10**6, end_time=0.01)
        for column in ("position", "velocity", "stress"):
            one, other = (sim.column("hammer", column) for sim in (whole, again))
            assert np.array_equal(one, other)


def test_the_same_bits_on_ranks() -> None:
    case = Case.from_text(hammer('angular_velocity = 20\nvelocity = [0, "-5 m/s"]'))
    found = []
    for ranks in (1, 2, 3):
        sim = Simulation(case, threads=1, ranks=ranks)
        sim.advance(10**6, end_time=0.0)
        sim.advance(20, end_time=0.01)
        rows = [sim.core.column(b, name) for b in range(2) for name in ("position", "velocity")]
        found.append(np.concatenate([np.ravel(row) for row in [*rows, sim.core.history()]]))
    assert np.array_equal(found[0], found[1]) and np.array_equal(found[0], found[2])


def test_a_press_fit_is_hit_at_the_speed_that_is_given() -> None:
    text = """
[grid]
dimension = 2
cell_size = "2 mm"
[run]
end_time = "100 us"
settle = { longest = "30 us" }
gravity = [0, "-0.001 m/s^2"]
[material.steel]
density = "7850 kg/m^3"
strength = { j2 = { E = "210 GPa", nu = 0.3, Y0 = "600 MPa" } }
[body.shaft]
material = "steel"
shape = { disc = { centre = [0, 0], radius = "10.05 mm" } }
[body.hub]
material = "steel"
shape = { ring = { centre = [0, 0], inner_radius = "10 mm", outer_radius = "20 mm" } }
[body.hammer]
material = "steel"
shape = { disc = { centre = [0, "26 mm"], radius = "5 mm" } }
velocity = [0, "-50 m/s"]
"""
    sim = Simulation(Case.from_text(text), threads=1)
    while sim.time < 0.0:
        sim.advance(10**6, end_time=0.0)
    assert np.all(sim.column("hammer", "velocity") == [0.0, -50.0])
    assert np.all(sim.column("hub", "velocity") == 0.0)


def test_a_load_on_a_held_body_waits_with_it() -> None:
    sim = Simulation(Case.from_text(hammer(more=ONLY_LOAD)), threads=1)
    while sim.time < 0.0:
        sim.advance(10**6, end_time=0.0)
    rows = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
    assert np.all(rows["load_work"] == 0.0)
    assert sim.core.loads()[0].impulse[1] == 0.0
    sim.advance(10**6, end_time=0.001)
    # 1 kPa on 0.1 m for a millisecond; the side grows as the body is squeezed, by some p / E.
    assert sim.core.loads()[0].impulse[1] == pytest.approx(-0.1, rel=1e-3)


def test_its_velocity_cannot_be_set_until_then() -> None:
    sim = Simulation(Case.from_text(hammer()), threads=1)
    given = np.zeros_like(sim.column("hammer", "velocity"))
    with pytest.raises(ValueError, match="hammer is held until the run has settled"):
        sim.set_velocity("hammer", given)
    while sim.time < 0.0:
        sim.advance(10**6, end_time=0.0)
    sim.set_velocity("hammer", given)
    assert np.all(sim.column("hammer", "velocity") == 0.0)
