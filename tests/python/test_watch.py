# SPDX-License-Identifier: BSD-3-Clause
"""What a run tells or stops for: nonsense must not end as "completed"."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from mpm3dpp import Case, CaseError, Run, RunError, Simulation
from mpm3dpp.cli.app import app
from mpm3dpp.io import read_history, read_manifest
from mpm3dpp.run.run import run_case

SOFT = {"density": 1000.0, "strength": {"elastic": {"E": 1e6, "nu": 0.3}}}
BOX = {"lower": [0.0, 0.0], "upper": [80e-3, 80e-3]}


def disc(walls: Any = "fixed", speed: float = 300.0, end: float = 1e-3, **run: Any) -> Case:
    """Return an elastic disc, waves of 37 m/s, that flies against a wall of a box."""
    return Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": 2e-3,
                "box": BOX | {"walls": walls},
                "basis": "gimp",
            },
            "run": {"end_time": end} | run,
            "material": {"soft": SOFT},
            "body": {
                "disc": {
                    "material": "soft",
                    "shape": {"disc": {"centre": [30e-3, 40e-3], "radius": 20e-3}},
                    "velocity": [-speed, 0.0],
                }
            },
        }
    )


def block(traction: Any, end: float, **run: Any) -> Case:
    """Return a block on a fixed floor that is pulled on a side; its first step is 28 us long."""
    return Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": 10e-3,
                "basis": "gimp",
                "box": {"lower": [-1, 0], "upper": [9, 9], "walls": {"y_min": "fixed"}},
            },
            "run": {"end_time": end} | run,
            "material": {"soft": {"density": 1e3, "strength": {"elastic": {"E": 6e6, "nu": 0.3}}}},
            "body": {
                "block": {
                    "material": "soft",
                    "shape": {"box": {"lower": [0, 0], "upper": [0.2, 0.2]}},
                }
            },
            "load": {"pull": {"body": "block", "side": "x_max", "traction": traction}},
        }
    )


def ended(case: Case, threads: int = 1) -> tuple[Simulation, str]:
    """Run to the end or to the failure, which is returned."""
    simulation = Simulation(case, threads)
    try:
        simulation.advance(10**6)
    except RunError as error:
        return simulation, str(error)
    return simulation, ""


def told(simulation: Simulation) -> dict[str, Any]:
    """The warnings by kind; there is one body."""
    found = {w.kind: w for w in simulation.core.warnings()}
    assert len(found) == len(simulation.core.warnings())
    return found


def history(simulation: Simulation) -> dict[str, Any]:
    """The columns of the last steps, as many as the core keeps."""
    return dict(zip(simulation.core.history_columns, simulation.core.history().T, strict=True))


@pytest.mark.parametrize("basis", ["gimp", "linear"])
@pytest.mark.parametrize("walls", ["fixed", "slip"])
def test_a_disc_crushed_into_a_wall_stops_the_run(walls: str, basis: str) -> None:
    """It went on to 3e-6 of its volume and lower, beyond the closed wall, and "completed"."""
    case = disc(walls)
    case = case.model_copy(update={"grid": case.grid.model_copy(update={"basis": basis})})
    simulation, sentence = ended(case)
    failure = simulation.core.failure
    kind = "outside walls" if (walls, basis) == ("fixed", "gimp") else "volume"
    assert failure.kind == kind and 0 < simulation.time < 1e-3
    key = "outside_limit" if kind == "outside walls" else "volume_limit"
    for part in (kind, f"run.{key}", 'body "disc"', f"particle {failure.particle}", "give"):
        assert part in sentence
    where = simulation.column("disc", "position")[failure.particle]
    assert failure.position[:2] == pytest.approx(where.tolist())
    assert told(simulation)[kind].share > (0.05 if kind == "outside walls" else 0.2)


def test_the_limits_are_the_users() -> None:
    """With 1 nothing stops the run, but it is told, once for each kind."""
    simulation, sentence = ended(disc(outside_limit=1.0, volume_limit=1.0))
    assert sentence == "" and simulation.time == 1e-3
    found = told(simulation)
    assert set(found) >= {"outside walls", "volume"}
    assert found["volume"].share == 1.0 and found["volume"].count > 1
    for limit in ("outside_limit", "volume_limit"):
        with pytest.raises(CaseError, match=rf"{limit} .*0 < f <= 1"):
            Run(end_time=1.0, **{limit: 0.0})


def test_nothing_is_told_of_an_ordinary_impact() -> None:
    simulation, sentence = ended(disc("slip", speed=5.0, end=10e-3))
    assert sentence == "" and simulation.core.warnings() == []


def test_what_leaves_through_an_open_face_is_reported(tmp_path: Path) -> None:
    manifest = run_case(disc("free"), tmp_path, pictures=False)
    assert manifest.status == "completed"
    [note] = read_manifest(tmp_path)["warnings"]
    assert (note["kind"], note["body"], note["is_error"]) == ("left box", "disc", False)
    assert note["share"] == 1.0 and note["count"] > 1
    assert "x_min" in note["message"] and note["position"][0] < 0.0


def test_the_command_fails_and_keeps_what_was_computed(tmp_path: Path) -> None:
    case = """\
[grid]
dimension = 2
cell_size = "2 mm"
basis = "gimp"
box = { lower = [0, 0], upper = ["80 mm", "80 mm"], walls = "fixed" }
[run]
end_time = "1 ms"
[material.soft]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.disc]
material = "soft"
shape = { disc = { centre = ["30 mm", "40 mm"], radius = "20 mm" } }
velocity = ["-300 m/s", 0]
"""
    (tmp_path / "case.toml").write_text(case)
    line = ["run", str(tmp_path / "case.toml"), "--out", str(tmp_path / "out"), "--threads", "1"]
    done = CliRunner().invoke(app, [*line, "--no-pictures"])
    assert done.exit_code != 0 and isinstance(done.exception, (RunError, SystemExit))
    manifest = read_manifest(tmp_path / "out")
    assert manifest["status"] == "failed" and "run.outside_limit" in manifest["reason"]
    assert read_history(tmp_path / "out")["step"][-1] == manifest["steps"] > 0
    assert "warning: " in done.output and manifest["reason"] in str(done.exception)


def test_volumes_of_what_has_failed_do_not_count() -> None:
    def crushed(material: dict[str, Any]) -> Simulation:
        table = disc("slip", end=5e-4).table()
        simulation = Simulation(Case.model_validate(table | {"material": {"soft": material}}), 1)
        simulation.advance(10**6)
        volume, mass = (simulation.column("disc", name) for name in ("volume", "mass"))
        assert (volume * material["density"] / mass < 0.01).mean() > 0.2
        return simulation

    cold = {"ideal_gas": {"gamma": 1.4, "E0": 1.0}}
    gas = {"density": 1000.0, "strength": {"fluid": {"viscosity": 0.0}}, "eos": cold}
    gas |= {"artificial_viscosity": {"quadratic": 0.0, "linear": 0.0}}
    # Gases fill any volume, but not less than a thousandth of their own.
    with pytest.raises(RunError, match="volume_limit"):
        crushed(gas)
    assert crushed(SOFT | {"failure": {"maximum_shear": {"limit": 1.0}}}).core.warnings() == []
    with pytest.raises(RunError, match="volume_limit"):
        crushed(SOFT)


def test_a_load_that_tears_a_corner_off_is_told_of() -> None:
    """The step fell from 28 us to 0.3 us, as the corner flew away under its load, without a word:
    next to all of that energy is work of the load, and little is made by numerics."""
    simulation, sentence = ended(block([1e6, 0.0], 0.023))
    assert sentence == ""
    warning = told(simulation)["time step"]
    assert warning.count > 100
    for part in ('body "block"', "particle", "a load may have torn", "median"):
        assert part in warning.message
    columns = history(simulation)
    assert abs(columns["numerical"][-1]) < 0.01 * columns["load_work"][-1]


def test_a_step_that_makes_energy_is_told_of() -> None:
    """USL with the linear basis: a node that a particle barely reaches gets any velocity."""
    run = {"scheme": "usl", "cfl": 0.5, "energy_growth_limit": 1e9}
    case = disc("slip", speed=20.0, end=20e-3, **run)
    case = case.model_copy(update={"grid": case.grid.model_copy(update={"basis": "linear"})})
    case.body["disc"].fill = "lattice"
    simulation, _ = ended(case)
    note = told(simulation)["energy of a step"]
    columns = history(simulation)
    (row,) = np.flatnonzero(columns["step"] == note.step)
    made = columns["numerical"][row - 1] - columns["numerical"][row]
    assert note.is_error and f"{made:.4g} J" in note.message
    assert made > 0.05 * columns["kinetic"][0]
    for part in ("5 %", 'body "disc"', f"particle {note.particle}", "cfl"):
        assert part in note.message


def test_a_load_that_does_its_work_in_one_step_is_told_of() -> None:
    sudden = {"times": [0.0, 3e-3, 3.001e-3], "values": [10.0, 10.0, 1e8]}
    simulation, _ = ended(block([sudden, 0.0], 3.1e-3))
    assert "loads have done the work" in told(simulation)["load"].message


def test_a_constant_load_and_a_ramp_are_not() -> None:
    for pull in (1e4, {"ramp": {"to": 1e4, "end": 10e-3}}):
        simulation, _ = ended(block([pull, 0.0], 10e-3))
        assert simulation.core.warnings() == []


def test_the_same_is_told_by_any_number_of_threads_and_after_a_restart(tmp_path: Path) -> None:
    case = disc(outside_limit=1.0, volume_limit=1.0)

    def words(simulation: Simulation) -> list[tuple[str, int, float]]:
        return [(w.message, w.count, w.share) for w in simulation.core.warnings()]

    whole, two = ended(case)[0], ended(case, threads=2)[0]
    part = Simulation(case, threads=1)
    part.advance(150)
    part.save(tmp_path / "state")
    again = Simulation(case, threads=1)
    again.restore(tmp_path / "state")
    assert words(again) == words(part) != []
    again.advance(10**6)
    assert words(whole) == words(two) == words(again)


def test_many_bodies_at_a_node_are_told_and_do_not_hold_up_a_step() -> None:
    """They made 9 steps a minute, without a word."""
    count = 18  # along each axis: 324 grains of a particle each, that fill three cells by three
    lattice = {"lower": [0.0, 0.0], "count": [count, count], "radius": 1e-3 / count}
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": 12e-3, "basis": "gimp"},
            "run": {"end_time": 1.0},
            "contact": {"friction": 0.3},
            "material": {"soft": SOFT},
            "grains": {
                "dust": {
                    "material": "soft",
                    "lattice": lattice,
                    "spacing": 2e-3 / count,
                    "align": "particle",
                    "velocity": [-1.0, 0.0],
                }
            },
            "body": {
                "wall": {
                    "material": "soft",
                    "shape": {"box": {"lower": [-24e-3, -24e-3], "upper": [0.0, 24e-3]}},
                }
            },
        }
    )
    simulation = Simulation(case, threads=1)
    simulation.advance(3)
    warning = told(simulation)["crowded node"]
    assert warning.is_error and warning.count == 3
    assert f"{count * count + 1} bodies meet at one node" in warning.message
    assert np.array(warning.position) == pytest.approx(0.0, abs=1e-12) and warning.particle == -1
    assert "smaller cells" in warning.message
