# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on nodes of their own whose particles fail: pieces, energy, and surfaces uncovered."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from in_body import CELL, DENSITY, SPEED, E, blocks, part, run_and_look
from mpm3dpp import Case, Simulation
from same_bits import check_same_bits
from worlds import check_worlds


def torn_bar(
    dimension: int = 2, frame: str = "material", along: str = "", run: Any = None, **material: Any
) -> Case:
    """Return a bar of 24 by 6 cells, nu 0, whose halves fly apart with .02 of the waves' speed.

    Its limit is .004 E: where they part it would have .01 E.
    """
    long, v = 24 * CELL, 0.01 * SPEED
    lower, upper = [-long / 2, 0.0, 0.0], [long / 2, 6 * CELL, 4 * CELL]
    strength = {"elastic": {"E": E, "nu": 0.0}}
    failure = {"principal_stress": {"limit": 0.004 * E}}
    return Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": CELL},
            "run": run or {"end_time": 20 * long / SPEED},
            "contact": {"friction": 0.0},
            "material": {
                "m": {"density": DENSITY, "strength": strength, "failure": failure, **material}
            },
            "body": {
                "a": {
                    "material": "m",
                    "frame": frame,
                    "shape": {"box": {"lower": lower[:dimension], "upper": upper[:dimension]}},
                    "velocity": [{"expression": along or f"{v} * x / abs(x)"}]
                    + [0.0] * (dimension - 1),
                }
            },
        }
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_halves_that_tear_fly_apart(dimension: int) -> None:
    """With the speed that they had, to 5 %: what has failed between them, a sixth, was slower.
    Momentum to rounding; energy to 1e-6, as only time stepping takes any."""
    simulation = Simulation(torn_bar(dimension))
    columns, _ = run_and_look(simulation, 10**5)
    x, v = (simulation.column("a", name)[:, 0] for name in ("position", "velocity"))
    failed = simulation.column("a", "failed").ravel() > 0.0
    right = x > 0.0
    speeds = [v[~failed & side].mean() for side in (right, ~right)]
    assert speeds[0] - speeds[1] == pytest.approx(2 * 0.01 * SPEED, rel=0.05)
    gap = x[right & ~failed].min() - x[~right & ~failed].max()
    assert gap > 10 * CELL
    assert 0.05 < failed.mean() < 0.4
    mass = DENSITY * 24 * 6 * (4 * CELL if dimension == 3 else 1.0) * CELL**2
    assert abs(columns["momentum_x"]).max() < 1e-12 * mass * SPEED
    total = sum(columns[name] for name in ("kinetic", "internal", "fracture"))
    assert total[-1] / total[0] == pytest.approx(1.0, abs=1e-6)
    assert np.abs(columns["residual"]).max() < 1e-12 * total[0]


@pytest.mark.parametrize("frame", ["material", "updated"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_what_fails_gives_up_what_it_stored(dimension: int, frame: str) -> None:
    """Of a bar that is stretched evenly limit^2 / 2 E; `internal` keeps what its ends hold."""
    run = {"end_time": 0.0048 / 500, "time_step": 5e-8}
    simulation = Simulation(torn_bar(dimension, frame, "500 * x", run))
    columns, _ = run_and_look(simulation, 10**5)
    failed = simulation.column("a", "failed").ravel() > 0.0
    volume = simulation.column("a", "mass").ravel()[failed].sum() / DENSITY
    assert failed.mean() > 0.7
    stored = volume * (0.004 * E) ** 2 / (2 * E)
    assert columns["fracture"][-1] / stored == pytest.approx(1.0, abs=0.05)
    assert columns["internal"][-1] < 0.2 * stored
    assert np.abs(columns["residual"]).max() < 1e-12 * columns["kinetic"][0]


def punched_block(dimension: int = 2) -> Case:
    """Return a brittle block on a wall, into which a rigid punch goes."""
    size = 20 * CELL
    return Case.model_validate(
        {
            "grid": {
                "dimension": dimension,
                "cell_size": CELL,
                "box": {
                    "lower": [-size] * dimension,
                    "upper": [size, 2 * size, size][:dimension],
                    "walls": {"y_min": "contact"},
                },
            },
            "run": {"end_time": 1.0},
            "material": {
                "m": {
                    "density": DENSITY,
                    "strength": {"elastic": {"E": E, "nu": 0.2}},
                    "failure": {"principal_stress": {"limit": 0.002 * E}},
                },
                "punch": {"density": DENSITY, "strength": {"rigid": {}}},
            },
            "body": {
                "block": {
                    "material": "m",
                    "frame": "material",
                    "shape": {
                        "box": {
                            "lower": [-8 * CELL, -size, -4 * CELL][:dimension],
                            "upper": [8 * CELL, -size + 8 * CELL, 4 * CELL][:dimension],
                        }
                    },
                },
                "punch": {
                    "material": "punch",
                    "shape": {
                        ("disc", "sphere")[dimension - 2]: {
                            "centre": [0.3 * CELL, -size + 12.05 * CELL, 0.0][:dimension],
                            "radius": 4 * CELL,
                        }
                    },
                    "velocity": [0.0, -0.1 * SPEED, 0.0][:dimension],
                },
            },
        }
    )


@pytest.mark.parametrize("dimension", [2, 3])
def test_what_failure_uncovers_is_surface(dimension: int) -> None:
    """The upper two of eight cells of a block have failed: what lies below stops a punch, a disc of
    4 cells, which sinks in by less than .7 of one and parts with most of its speed."""
    size = 20 * CELL
    tables = punched_block(dimension).table()
    material, speed = tables["material"]["m"], 0.02 * SPEED
    material["strength"] = {"j2": {"E": E, "nu": 0.2, "Y0": E}}
    material["failure"] = {"plastic_strain": {"limit": 0.5}}
    bad = f"0.5 + 0.5 * tanh(1e6 * (y + {size - 6 * CELL}))"
    tables["body"]["block"]["initial"] = {"state": {"plastic_strain": {"expression": bad}}}
    tables["body"]["punch"]["velocity"][1] = -speed
    simulation = Simulation(Case.model_validate(tables))
    lowest = np.inf
    while simulation.time < 8 * CELL / speed:
        simulation.advance(20)
        lowest = min(lowest, (part(simulation, "centre_y", 1) + size) / CELL)
    assert (simulation.column("block", "failed") > 0.0).mean() == pytest.approx(0.25)
    assert 9.3 < lowest < 10.0
    assert part(simulation, "velocity_y", 1) > 0.5 * speed


@pytest.mark.parametrize("limit", [0.002, 0.005, 0.02])
def test_a_block_that_is_crushed_makes_no_energy(limit: float) -> None:
    """What is uncovered may lie in a punch or a wall, and begins unpressed: 1 % at most is made,
    where pressed springs made as much as there was."""
    tables = punched_block().table()
    tables["material"]["m"]["failure"]["principal_stress"]["limit"] = limit * E
    tables["body"]["punch"]["velocity"][1] = -0.05 * SPEED
    simulation = Simulation(Case.model_validate(tables))
    simulation.advance(1500)
    columns = dict(zip(simulation.core.history_columns, simulation.core.history().T, strict=True))
    total = sum(columns[name] for name in ("kinetic", "internal", "fracture", "springs"))
    assert (simulation.column("block", "failed") > 0.0).mean() > 0.2
    assert total.max() < 1.01 * total[0]
    assert columns["contact"].min() > -0.01 * total[0]
    assert np.abs(columns["residual"]).max() < 1e-12 * total[0]
    told = " ".join(w.message for w in simulation.core.warnings())
    assert 'particles of body "block" have failed' in told


@pytest.mark.parametrize("cfl", [0.4, pytest.param(0.1, marks=pytest.mark.slow)])
def test_debris_on_a_wall_makes_no_energy(cfl: float) -> None:
    """Particles that have failed are stretched between pieces that fly apart, which is not their
    surface: with it one step made 4 % or 26 % as a point leapt into the wall."""
    box = {"lower": [-0.08, 0.0], "upper": [0.08, 0.08], "walls": {"y_min": "contact"}}
    glass = {"density": 2500.0, "strength": {"elastic": {"E": 10e9, "nu": 0.25}}}
    disc = {"disc": {"centre": [0.0, 10.5e-3], "radius": 10e-3}}
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": 1e-3, "box": box},
            "run": {"end_time": 0.25e-3, "cfl": cfl},
            "material": {"m": {**glass, "failure": {"principal_stress": {"limit": 20e6}}}},
            "body": {
                "a": {
                    "material": "m",
                    "frame": "material",
                    "shape": disc,
                    "velocity": [0.0, -30.0],
                }
            },
        }
    )
    simulation = Simulation(case)
    columns, _ = run_and_look(simulation, 1000)
    total = sum(columns[name] for name in ("kinetic", "internal", "fracture", "springs"))
    assert (simulation.column("a", "failed") > 0.0).mean() > 0.5
    # What is pressed on the wall as it fails loses what its springs have stored.
    assert 0.99 * total[0] < total.min()
    assert total.max() < 1.001 * total[0]


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
def test_the_same_bits(dimension: int, tmp_path: Path) -> None:
    """With any number of threads and ranks, and after a restart amid it."""
    case = punched_block(dimension)
    check_same_bits(case, tmp_path)
    simulation = Simulation(case)
    simulation.advance(30)
    assert (simulation.column("block", "failed") > 0.0).any()


@pytest.mark.parametrize("dimension", [2, 3])
def test_another_world_is_the_same(dimension: int) -> None:
    text = blocks(dimension).replace(
        "[material.soft]", "[material.soft]\nfailure = { plastic_strain = { limit = 0.01 } }"
    )
    case = Case.from_text(text)
    check_worlds(case, 150 if dimension == 2 else 60, "", meet=False)
    simulation = Simulation(case)
    simulation.advance(60)
    assert (simulation.column("one", "failed") > 0.0).any()


def test_nodes_are_not_laid_anew_into_what_has_failed() -> None:
    text = blocks(2).replace(
        "[material.soft]", "[material.soft]\nfailure = { plastic_strain = { limit = 0.01 } }"
    )
    simulation = Simulation(Case.from_text(text.replace("[run]", "[run]\nrenewal_strain = 0.02")))
    simulation.advance(200)
    messages = " ".join(w.message for w in simulation.core.warnings())
    assert "particles of it have failed" in messages


@pytest.mark.parametrize("action", ["erode", "no_shear"])
def test_what_leaves_no_solid_is_refused(action: str) -> None:
    failure = {"principal_stress": {"limit": 1e4, "action": action}}
    with pytest.raises(ValueError, match=f'failure whose action is "{action}"'):
        torn_bar(failure=failure)


def bonded_bars(**more: Any) -> Case:
    """Return two bars of 12 by 6 cells that are bonded and fly apart faster than they bear."""
    tables = torn_bar(**more).table()
    del tables["body"]["a"]
    for name, side in (("a", -1), ("b", 1)):
        ends = sorted((0.0, side * 12 * CELL))
        tables["body"][name] = {
            "material": "m",
            "frame": "material",
            "shape": {"box": {"lower": [ends[0], 0.0], "upper": [ends[1], 6 * CELL]}},
            "velocity": [side * 0.02 * SPEED, 0.0],
        }
    tables["contact"]["pair"] = [{"bodies": ["a", "b"], "bonded": True}]
    return Case.model_validate(tables)


def test_bonds_of_what_has_failed_stay_broken(tmp_path: Path) -> None:
    """After a restart too: they are found anew there from the case."""
    case = bonded_bars()
    check_same_bits(case, tmp_path)
    simulation = Simulation(case)
    simulation.advance(30)
    assert all((simulation.column(name, "failed") > 0.0).any() for name in "ab")


def test_pressures_are_averaged_no_more_once_some_has_failed(tmp_path: Path) -> None:
    """Nothing is left of what was taken off stresses, nor at nodes; another body goes on."""
    metal = {"j2": {"E": E, "nu": 0.3, "Y0": 0.001 * E, "H": 0.05 * E}}
    tables = torn_bar(strength=metal, failure={"plastic_strain": {"limit": 0.03}}).table()
    rate = 0.02 * SPEED / (12 * CELL)
    tables["body"]["a"]["velocity"] = [{"expression": f"{rate} * x"}, 0.0]
    tables["body"]["b"] = {
        **tables["body"]["a"],
        "shape": {"box": {"lower": [-6 * CELL, 0.01], "upper": [6 * CELL, 0.014]}},
        "velocity": [{"expression": f"{-0.5 * rate} * x"}, 0.0],
    }
    simulation = Simulation(Case.model_validate(tables))
    seen = []
    for _ in range(120):
        simulation.advance(10)
        failed = (simulation.column("a", "failed") > 0.0).any()
        taken = [np.abs(simulation.column(name, "force_pressure")).max() for name in "ab"]
        seen.append((failed, *taken))
    before = [taken for failed, taken, _ in seen if not failed]
    after = [(taken, other) for failed, taken, other in seen if failed]
    assert max(before) > 0.0
    assert len(after) > 80
    assert max(taken for taken, _ in after) == 0.0
    assert min(other for _, other in after) > 0.0
    simulation.save(tmp_path / "state.zip")
    again = Simulation(simulation.case)
    again.restore(tmp_path / "state.zip")
    assert again.step == simulation.step
