# SPDX-License-Identifier: BSD-3-Clause
"""Body forces by place and time: gravity, a manufactured solution, work, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import BASES, CELL, SCHEMES, block, box, each_numerics, materials, three_blocks
from mpm3dpp import Body, Case, CaseError, Grid, Motion, Run, RunError, Simulation
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import echo


def formula(text: str, **units: str) -> dict[str, str]:
    return {"expression": text, **units}


def history(simulation: Simulation) -> dict[str, np.ndarray]:
    core = simulation.core
    return dict(zip(core.history_columns, core.history().T, strict=True))


def forced(case: Case, force: Any) -> Case:
    """Give all bodies that deform a body force."""
    for name, body in case.body.items():
        if not case.is_rigid(name):
            body.body_force = force
    return case


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", SCHEMES)
def test_a_uniform_one_is_gravity(scheme: str, basis: str) -> None:
    """Three bodies with friction at walls that mirror: the same motion, work as `external`."""
    g = (30.0, -90.0)
    steps = 10 if scheme == "usl" else 60
    grid = box(2, 160, {"y_min": "slip", "x_min": "fixed"}) | {"basis": basis}
    shift = (-140, -140, 0)  # into the corner of the box
    runs = []
    for run, force in (
        ({"gravity": g}, None),
        ({}, g),
        ({}, (formula("30"), formula("-90 + 0*X"))),
    ):
        case = forced(three_blocks(2, scheme, shift, grid=grid, run=run), force)
        runs.append(Simulation(case, threads=1))
        runs[-1].advance(steps)
    first, first_rows = runs[0], history(runs[0])
    for other in runs[1:]:
        rows = history(other)
        for name in ("kinetic", "external", "internal", "numerical", "friction"):
            size = np.abs(first_rows["kinetic"]).max()
            assert rows[name] == pytest.approx(first_rows[name], abs=1e-11 * size), name
        assert rows["load_work"] == pytest.approx(first_rows["external"], abs=1e-11 * size)
        assert np.abs(rows["residual"]).max() <= 1e-12 * size
        for body in first.bodies:
            for column, size in (("position", 1.0), ("velocity", 10.0), ("stress", 1e5)):
                one, two = first.column(body, column), other.column(body, column)
                assert np.abs(one - two).max() <= 1e-11 * size, (body, column)


TOTAL = """
[grid]
dimension = 2
cell_size = "10 mm"
[run]
end_time = "20 ms"
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.block]
material = "soft"
frame = "updated"
shape = { box = { lower = [0, 0], upper = ["60 mm", "30 mm"] } }
force = ["2 N", { expression = "1000 * t" }]
body_force = ["3 m/s^2", 0]
[grains.balls]
material = "soft"
frame = "updated"
lattice = { radius = "20 mm", count = [2, 1], lower = ["200 mm", 0] }
force = [0, "-4 N"]
"""


def test_a_force_on_all_of_a_body() -> None:
    """Newton: its momentum is the force times the time, and F(t) = a t gives a t^2 / 2, exactly as
    the force is that of the middle of each step. Grains share theirs by mass.
    """
    case = Case.from_text(TOTAL)
    simulation = Simulation(case, threads=1)
    while simulation.time < 0.02:
        simulation.advance(10)
    t = simulation.time
    mass, (along_x, along_y) = momentum(simulation, "block")
    assert along_x == pytest.approx((2.0 + 3.0 * mass) * t, rel=1e-9)
    assert along_y == pytest.approx(500.0 * t**2, rel=1e-9)
    _, (along_x, along_y) = momentum(simulation, "balls")
    assert along_y == pytest.approx(-4.0 * t, rel=1e-9) and abs(along_x) < 1e-12


def momentum(simulation: Simulation, name: str) -> tuple[float, np.ndarray]:
    """Return mass and momentum of a body, or of all the grains of an entry."""
    core, mass, found = simulation.core, 0.0, np.zeros(2)
    for body in simulation._numbers(name):
        masses = core.column(body, "mass").ravel()
        mass += masses.sum()
        found += masses @ core.column(body, "velocity").reshape(len(masses), -1)[:, :2]
    return float(mass), found


MANUFACTURED = """
[grid]
dimension = 2
cell_size = {cell}
basis = "{basis}"
box = {{ lower = [0, 0], upper = [1, 1], walls = "slip" }}
[run]
scheme = "{scheme}"
end_time = {end}
time_step = {step}
[material.rubber]
density = 1000.0
strength = {{ neo_hookean = {{ K = {K}, G = {G} }} }}
[body.square]
material = "rubber"
shape = {{ box = {{ lower = [0, 0], upper = [1, 1] }} }}
velocity = [{{ expression = "{vx}" }}, {{ expression = "{vy}" }}]
body_force = [{{ expression = "{bx}" }}, {{ expression = "{by}" }}]
"""
K, G, DENSITY, A = 2e6, 1e6, 1000.0, 1e-4
C = ((K + 4 / 3 * G) / DENSITY) ** 0.5


def manufactured(cells: int, basis: str, scheme: str) -> Case:
    """Waves along both axes, u_i = A sin(pi X_i) sin(c pi t + phi_i), of no stress at the start.

    P = lambda ln J F^-T + G (F - F^-T) (Bonet & Wood 2008, 6.27), of which F is diagonal. So
    rho_0 b_i = rho_0 u_i'' - dP_ii/dX_i, and dP_xx/dX = (lambda (1 - ln J) / F_xx^2
    + G (1 + 1 / F_xx^2)) d^2 u_x/dX^2. The step goes with the square of the cell: that of time is
    an error of the first order.
    """
    lame = K - 2 / 3 * G
    turn = {"X": f"sin({C!r}*pi*t)", "Y": f"(-sin({C!r}*pi*t))"}
    stretch = {a: f"(1 + {A}*pi*cos(pi*{a})*{turn[a]})" for a in "XY"}
    volume = f"log({stretch['X']} * {stretch['Y']})"
    forces = {}
    for a, f in stretch.items():
        u = f"{A} * pi^2 * sin(pi*{a})*{turn[a]}"
        stiffness = f"({lame!r} * (1 - {volume})/{f}^2 + {G} * (1 + 1/{f}^2)) / {DENSITY}"
        forces[a] = f"({stiffness} - {C!r}^2) * {u}"
    rate = f"{A * C!r} * pi"
    text = MANUFACTURED.format(
        cell=1 / cells, basis=basis, scheme=scheme, end=0.4 / C, step=0.4 / C / cells**2,
        K=K, G=G, vx=f"{rate} * sin(pi*x)", vy=f"-{rate} * sin(pi*y)",
        bx=forces["X"], by=forces["Y"],
    )  # fmt: skip
    return Case.from_text(text)


def error(cells: int, basis: str, scheme: str) -> float:
    """The largest error of a place over the amplitude."""
    simulation = Simulation(manufactured(cells, basis, scheme), threads=1)
    start = simulation.column("square", "start_position")
    assert np.array_equal(start, simulation.column("square", "position"))
    simulation.advance(10**6)
    assert simulation.time == 0.4 / C
    wanted = A * np.sin(np.pi * start) * np.sin(0.4 * np.pi) * np.array([1.0, -1.0])
    moved = simulation.column("square", "position") - start
    return float(np.abs(moved - wanted).max() / A)


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
def test_a_manufactured_solution_is_met_to_second_order(basis: str, scheme: str) -> None:
    errors = [error(cells, basis, scheme) for cells in (6, 12, 24)]
    ratios = np.array(errors[:-1]) / errors[1:]
    assert (np.abs(np.log2(ratios) - 2.0) < 0.15).all(), errors  # 2 in the limit of small cells
    assert errors[-1] < 0.004


def everywhere(dimension: int, scheme: str, basis: str = "gimp") -> Case:
    """Three blocks with friction and forces of all variables."""
    force = [
        formula("40 * sin(300 * x + 500 * Y + 2e4 * t)"),
        formula("-9e4 * X * y + 1e6 * t"),
        formula("3e3 * z * Z"),
    ][:dimension]
    return forced(three_blocks(dimension, scheme, grid={"basis": basis}), force)


def outcome(simulation: Simulation) -> list[bytes]:
    core = simulation.core
    columns = [
        core.column(body, column.name).tobytes()
        for body in range(core.body_count)
        for column in core.columns(body)
    ]
    return [*columns, core.history().tobytes()]


@each_numerics
@pytest.mark.parametrize("dimension", [2, 3])
def test_the_same_bits(tmp_path: Path, dimension: int, scheme: str, basis: str) -> None:
    """With other threads, stages one by one, sorted at every step, and after a restart."""
    steps = 6 if scheme == "usl" else 30
    case = everywhere(dimension, scheme, basis)
    one = Simulation(case, threads=1)
    one.advance(steps)
    one.save(tmp_path / "state.zip")
    others = [Simulation(case, threads=2), Simulation(case, threads=1, fused=False, disorder=0.0)]
    for other in others:
        other.advance(steps)
    others.append(Simulation(case, threads=2))
    others[-1].restore(tmp_path / "state.zip")
    for simulation in (one, *others):
        simulation.advance(steps)
    wanted = outcome(one)
    assert all(outcome(other) == wanted for other in others)


def test_it_is_that_of_the_place_and_of_the_middle_of_the_step() -> None:
    force = (formula("7 * (x - 2 * X + Y) + t"), formula("y", length="mm", unit="mm/s^2"))
    simulation = Simulation(forced(three_blocks(2), force), threads=1)
    simulation.advance(7)
    before = {name: simulation.column(name, "position") for name in simulation.bodies}
    time, dt = simulation.time, simulation.core.dt
    simulation.advance(1)
    for name, (x, y) in ((name, places.T) for name, places in before.items()):
        start = simulation.column(name, "start_position")
        found = simulation.column(name, "body_force")
        wanted = 7 * (x - 2 * start[:, 0] + start[:, 1]) + time + dt / 2
        assert found[:, 0] == pytest.approx(wanted, rel=1e-13)
        assert found[:, 1] == pytest.approx(y, rel=1e-13)


def alone(force: Any, **run: Any) -> Case:
    """A block that nothing else acts on."""
    return Case(
        grid=Grid(dimension=2, cell_size=CELL),
        run=Run(**{"end_time": 0.01} | run),
        material=materials(),
        body={"block": block((3, 3), (4, 4), material="solid", frame="updated", body_force=force)},
    )


def test_a_force_in_time_gives_its_impulse_and_its_work() -> None:
    """A force that is linear in time: the rule of the middle is exact."""
    simulation = Simulation(alone((formula("1000 * t"), 3.0)), threads=1)
    simulation.advance(10**6)
    end = simulation.time
    velocity = simulation.column("block", "velocity")
    assert velocity[:, 0] == pytest.approx(500 * end**2, rel=1e-12)
    assert velocity[:, 1] == pytest.approx(3 * end, rel=1e-12)
    rows = history(simulation)
    assert rows["load_work"][-1] == rows["external"][-1]
    assert rows["load_work"][-1] == pytest.approx(rows["kinetic"][-1], rel=1e-12)
    assert np.abs(rows["residual"]).max() <= 1e-13 * rows["kinetic"][-1]


def test_columns_are_there_where_they_are_asked_for() -> None:
    def names(case: Case) -> set[str]:
        simulation = Simulation(case, threads=1)
        return {column.name for column in simulation.core.columns(0)}

    both = {"body_force", "start_position"}
    assert names(alone(None)) & both == set()
    assert names(alone((formula("x"), 0))) & both == {"body_force"}
    assert names(alone((0, formula("X")))) & both == both
    fields = alone((0, formula("X"))).table() | {"output": {"fields": sorted(both)}}
    assert Case(**fields).output.fields == sorted(both)
    fields = alone((0, 1)).table() | {"output": {"fields": ["start_position"]}}
    with pytest.raises(CaseError, match="is not a column that this case stores"):
        Case(**fields)


def test_grains_have_it_too() -> None:
    case = Case(
        grid=Grid(dimension=2, cell_size=CELL),
        run=Run(end_time=1e-3),
        material=materials(),
        grains={
            "sand": {
                "material": "solid",
                "lattice": {"lower": (0, 0), "count": (2, 1), "radius": 3 * CELL},
                "body_force": (formula("100 * X"), 0),
            }
        },
    )
    simulation = Simulation(case, threads=1)
    simulation.advance(3)
    start = simulation.column("sand", "start_position")
    assert simulation.column("sand", "body_force")[:, 0] == pytest.approx(100 * start[:, 0])
    assert "body force on sand: (100*X m/s^2, 0 m/s^2)" in echo(case, build(case))


@pytest.mark.parametrize("text", ["sqrt(-x)", "1 / (x - x)", "1e30"])
def test_one_without_a_value_stops_the_run(text: str) -> None:
    simulation = Simulation(alone((0, formula(text))), threads=1)
    before = simulation.column("block", "position")
    with pytest.raises(RunError) as caught:
        simulation.advance(10)
    sentence = str(caught.value)
    assert sentence.startswith("body force at step 1") and "m/s^2 along y" in sentence
    assert np.array_equal(simulation.column("block", "position"), before)


STONE = {"density": 2000.0, "strength": {"rigid": {}}}


@pytest.mark.parametrize(
    ("change", "key", "part"),
    [
        ({"body_force": (1, 0), "motion": Motion()}, "", "of a body that does not deform"),
        ({"body_force": (1, 0), "material": "stone"}, "", "of a body that does not deform"),
        ({"body_force": (1, 0, 0)}, "", "must have 2 numbers"),
        ({"body_force": (0, formula("Z"))}, "[1].expression", "is a formula of z"),
    ],
)
def test_what_takes_none_is_a_sentence(change: dict[str, Any], key: str, part: str) -> None:
    body = alone(None).body["block"].table() | change
    case = alone(None)
    with pytest.raises(CaseError, match=part) as caught:
        Case(
            grid=case.grid, run=case.run, material=materials() | {"stone": STONE},
            body={"block": body, "other": block((9, 9), (2, 2), material="solid")},
        )  # fmt: skip
    assert caught.value.key == f"case.body.block.body_force{key}" and caught.value.remedy


def test_wrong_words_and_units() -> None:
    with pytest.raises(CaseError, match='has the name "r", which is not known') as caught:
        Body(material="solid", body_force=(formula("r"), 0))
    assert "valid here: x, y, z, X, Y, Z, t, pi, e" in caught.value.remedy
    with pytest.raises(CaseError, match="is no unit that fits m/s"):
        Body(material="solid", body_force=(formula("x", unit="N"), 0))


def test_the_core_refuses_it_too() -> None:
    core = Simulation(alone(None), threads=1).core
    with pytest.raises(ValueError, match="must be added before prepare"):
        core.add_body_force([0], [[("number", 1.0)]] * 2)
