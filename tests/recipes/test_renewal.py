# SPDX-License-Identifier: BSD-3-Clause
"""Nodes are laid anew into bodies that flow: energy, momenta, contact and loads go on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from in_body import blocks, noise_of_pressure, run_and_look
from mpm3dpp import Case, Simulation, _core
from same_bits import check_same_bits
from worlds import check_worlds

AVERAGES = "volume_averaging = true"

METALS = """
[grid]
dimension = DIMENSION
cell_size = "2 mm"
box = { lower = LOWER, upper = UPPER, walls = { y_min = "contact" } }
[run]
end_time = "1 s"
gravity = GRAVITY
renewal_strain = 0.004
[contact]
friction = 0.3
restitution = 0.9
[material.soft]
density = "1000 kg/m^3"
strength = { j2 = { E = "1 MPa", nu = 0.3, Y0 = "10 kPa", H = "50 kPa" } }
[material.rubber]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[material.hard]
density = "2000 kg/m^3"
strength = { rigid = {} }
[body.one]
material = "soft"
frame = "material"
shape = { SHAPE = { centre = FIRST, radius = "9 mm" } }
velocity = FALLS
[load.tip]
body = "one"
point = TIP
force = PULL
[body.two]
material = "rubber"
frame = "material"
shape = { SHAPE = { centre = SECOND, radius = "7 mm" } }
[body.three]
material = "soft"
frame = "material"
shape = { box = { lower = LOW, upper = HIGH } }
[body.four]
material = "hard"
shape = { SHAPE = { centre = THIRD, radius = "6 mm" } }
velocity = FALLS
angular_velocity = SPIN
[[contact.pair]]
bodies = ["two", "three"]
bonded = true
"""


def metals(dimension: int, of_soft: str) -> Case:
    """Return bodies of soft metal and rubber that hit each other, a rigid one and the floor."""
    text = METALS.replace("DIMENSION", str(dimension))
    text = text.replace("[material.soft]", f"[material.soft]\n{of_soft}")
    text = text.replace("SHAPE", ("disc", "sphere")[dimension - 2])
    text = text.replace("SPIN", "300" if dimension == 2 else "[100, -50, 300]")
    for word, value in {
        "LOWER": [-0.06, 0.0, -0.04],
        "UPPER": [0.06, 0.1, 0.04],
        "GRAVITY": [0.0, -9.81, 1.0],
        "FIRST": [0.003, 0.033, 0.0005],
        "FALLS": [0.5, -3.0, 0.2],
        "TIP": [0.009, 0.033, 0.0005],
        "PULL": [20.0, 30.0] if dimension == 2 else [0.04, 0.06, -0.02],
        "SECOND": [0.0, 0.017, 0.0],
        "LOW": [-0.012, 0.0, -0.01],
        "HIGH": [0.012, 0.01, 0.01],
        "THIRD": [-0.012, 0.0235, 0.0],
    }.items():
        text = text.replace(word, str(value[:dimension]))
    return Case.from_text(text)


CELL = 0.76e-3
FAR = 60 * CELL


def flat_bar(
    sides: tuple[float, float] = (0.37 * CELL, 10.37 * CELL),
    box: tuple[float, float] = (-FAR, FAR),
    walls: dict[str, str] | None = None,
    **run: Any,
) -> Case:
    """Return a bar of copper, 7.6 x 25.4 mm, that hits a smooth wall with 190 m/s."""
    copper = {"E": 117e9, "nu": 0.35, "A": 90e6, "B": 292e6, "n": 0.31, "C": 0.0}
    return Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": CELL,
                "box": {
                    "lower": [0.0, box[0]],
                    "upper": [FAR, box[1]],
                    "walls": {"x_min": "contact", **(walls or {})},
                },
            },
            "run": {"end_time": 90e-6, **run},
            "material": {
                "copper": {"density": 8930, "strength": {"simplified_johnson_cook": copper}}
            },
            "body": {
                "bar": {
                    "material": "copper",
                    "frame": "material",
                    "velocity": [-190.0, 0.0],
                    "shape": {"box": {"lower": [0.0, sides[0]], "upper": [25.4e-3, sides[1]]}},
                }
            },
        }
    )


def pressed_block(strength: dict[str, Any], to: float, **body: Any) -> Case:
    """Return a block, 10 cells high, that a smooth plate presses on a wall to a share of itself."""
    h, speed = 1e-3, 5.0
    high = 10 * h
    return Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": h,
                "box": {
                    "lower": [-0.04, 0.0],
                    "upper": [0.04, 0.02],
                    "walls": {"y_min": "contact"},
                },
            },
            "run": {"end_time": high * (1.0 - to) / speed},
            "contact": {"friction": 0.0},
            "material": {
                "metal": {"density": 1000, "strength": strength},
                "steel": {"density": 8000, "strength": {"rigid": {}}},
            },
            "body": {
                "block": {
                    "material": "metal",
                    "frame": "material",
                    "shape": {"box": {"lower": [-5 * h, 0.0], "upper": [5 * h, high]}},
                    **body,
                },
                "plate": {
                    "material": "steel",
                    "shape": {"box": {"lower": [-0.03, high], "upper": [0.03, high + 2 * h]}},
                    "motion": {"velocity": [0.0, -speed]},
                },
            },
        }
    )


def test_a_block_that_is_pressed_to_a_third_resists_by_its_hardening() -> None:
    """To a logarithmic strain of 1: 2 / 3^(1/2) (Y0 + H e) W h0 / h with e = 2 / 3^(1/2) ln(h0 / h)
    in plane strain without friction (Hill 1950), to 3 % once it flows everywhere."""
    E, Y0, H = 1e9, 5e6, 10e6
    case = pressed_block({"j2": {"E": E, "nu": 0.3, "Y0": Y0, "H": H}}, np.exp(-1.0))
    simulation = Simulation(case)
    end, high = case.run.end_time, 10e-3
    columns, seen = run_and_look(
        simulation, 50, lambda s: [abs(pair.impulse[1]) for pair in s.core.contact_pairs()]
    )
    times = np.array([t for t, _ in seen])
    impulse = np.array([sum(found) for _, found in seen])
    edges = np.linspace(0.2, 1.0, 9) * end
    mean = np.diff(np.interp(edges, times, impulse)) / np.diff(edges)
    thick = high - 5.0 * np.linspace(edges[:-1], edges[1:], 101)
    plane = 2.0 / np.sqrt(3.0)
    law = plane * (Y0 + H * plane * np.log(high / thick)) * 10e-3 * high / thick
    assert mean / law.mean(axis=0) == pytest.approx(1.0, abs=0.03)
    assert columns["renewals"][-1] >= 1
    left = columns["numerical"] + columns["contact"]
    assert np.abs(left).max() < 0.002 * columns["external"][-1]


def test_a_bar_keeps_its_energy_and_its_shape() -> None:
    """Copper on a wall: energy to .5 %, length and foot to 2 % of those on nodes as they were."""
    found = {}
    for strain in (0.69, 0.0):
        simulation = Simulation(flat_bar(renewal_strain=strain))
        columns, _ = run_and_look(simulation, 500)
        energy = sum(columns[name] for name in ("kinetic", "internal", "plastic", "springs"))
        assert energy[-1] / energy[0] == pytest.approx(1.0, abs=0.005)
        assert energy.max() / energy[0] < 1.001
        assert np.abs(columns["residual"]).max() < 1e-12 * energy[0]
        assert (columns["renewals"][-1] > 0) == (strain > 0)
        places = simulation.column("bar", "position")
        foot = abs(places[:, 0] - places[:, 0].min() - 1.5e-3) < 0.4e-3
        found[strain] = np.ptp(places[:, 0]), np.ptp(places[foot, 1]), columns["step"][-1]
    assert found[0.69][:2] == pytest.approx(found[0.0][:2], rel=0.02)
    assert found[0.69][2] < 0.8 * found[0.0][2]


def test_pressures_have_less_noise_than_in_the_updated_frame() -> None:
    """While a bar is pressed, by a tenth; and by a third than points have by themselves."""
    noise = []
    for material, body in (({}, {}), ({"volume_averaging": False}, {}), ({}, {"frame": "updated"})):
        tables = flat_bar().table()
        tables["material"]["copper"] |= material
        tables["body"]["bar"] |= body
        simulation = Simulation(Case.model_validate(tables))
        found = []
        for time in np.arange(2.5, 63.0, 5.0) * 1e-6:
            simulation.advance(10**5, time)
            found.append(noise_of_pressure(simulation, "bar", CELL)[0])
        noise.append(np.mean(found))
    assert noise[0] < 0.95 * noise[2]
    assert noise[0] < 0.75 * noise[1]


def test_rubber_keeps_its_nodes() -> None:
    """It comes back to what it was, however far it is pressed."""
    case = pressed_block({"neo_hookean": {"K": 10e6, "G": 1e6}}, 0.4)
    simulation = Simulation(case)
    columns, _ = run_and_look(simulation, 500)
    assert columns["renewals"][-1] == 0


def test_half_a_bar_moves_as_the_half_of_a_whole_one() -> None:
    """Its nodes are laid anew on the plane of symmetry, a slip wall, on which it begins.

    To a thousandth of a cell: passes that meet the velocities begin with another rigid motion.
    """
    whole = flat_bar((-5 * CELL, 5 * CELL))
    half = flat_bar((0.0, 5 * CELL), box=(0.0, FAR), walls={"y_min": "slip"})
    both = [Simulation(case) for case in (whole, half)]
    above = both[0].column("bar", "position")[:, 1] > 0.0
    for simulation in both:
        simulation.advance(800)
        assert renewals(simulation) > 0
    places = [simulation.column("bar", "position") for simulation in both]
    upper = places[0][above]
    assert upper == pytest.approx(places[1], abs=1e-3 * CELL)


def renewals(simulation: Simulation) -> float:
    core = simulation.core
    return float(core.history()[-1][core.history_columns.index("renewals")])


def told(simulation: Simulation) -> str:
    """Return why nodes were not laid anew."""
    return " ".join(w.message for w in simulation.core.warnings() if w.kind == "nodes kept")


def test_a_wall_on_which_it_did_not_begin_does_not_catch_it() -> None:
    """It is pushed back there, also by nodes that are laid anew beyond the wall."""
    rows = []
    for wall in ("slip", "contact"):
        simulation = Simulation(flat_bar(box=(-FAR, 14 * CELL), walls={"y_max": wall}))
        columns, _ = run_and_look(simulation, 1000)
        assert columns["renewals"][-1] >= 1
        assert simulation.column("bar", "position")[:, 1].max() < 14 * CELL
        rows.append(np.array(list(columns.values())))
    assert np.array_equal(*rows)


def test_a_tube_that_is_folded_keeps_its_nodes() -> None:
    """Its inner faces come as near to each other as nodes reach, which would weld them."""
    h = 1e-3
    ring = {"ring": {"centre": [0.0, 5 * h], "inner_radius": 2.2 * h, "outer_radius": 5 * h}}
    strength = {"j2": {"E": 1e9, "nu": 0.3, "Y0": 5e6, "H": 10e6}}
    simulation = Simulation(pressed_block(strength, 0.55, shape=ring))
    simulation.advance(10**5)
    assert "it is folded" in told(simulation)


def test_what_has_parted_is_told_of() -> None:
    simulation = Simulation(flat_bar())
    simulation.advance(10**5)
    assert "more than 1.5 cells apart" in told(simulation)


@pytest.mark.parametrize("dimension", [2, 3])
def test_momentum_is_kept(dimension: int) -> None:
    """Of soft metal that hits rubber, metal, a rigid ball and a floor: to rounding, both kinds."""
    simulation = Simulation(metals(dimension, ""))
    simulation.advance(200)
    core = simulation.core
    history = dict(zip(core.history_columns, core.history().T, strict=True))
    assert history["renewals"][-1] > 2
    assert np.abs(history["residual"]).max() < 1e-12 * history["kinetic"][0]
    totals = dict(zip(_core.total_columns, core.part_sums()[0], strict=True))
    size = max(abs(value) for name, value in totals.items() if name.startswith("angular_momentum"))
    for axis in "xyz":
        assert abs(totals[f"angular_momentum_numerical_{axis}"]) < 1e-11 * size


@pytest.mark.parametrize("of_soft", ["", AVERAGES])
@pytest.mark.parametrize("dimension", [2, 3])
def test_another_world_is_the_same(dimension: int, of_soft: str) -> None:
    """Blocks that hit each other and walls: as they are told of by particles, boxes have the faces
    that they have by their shape."""
    text = blocks(dimension).replace("[run]", "[run]\nrenewal_strain = 0.001")
    text = text.replace("[material.soft]", f"[material.soft]\n{of_soft}")
    case = Case.from_text(text)
    check_worlds(case, 150 if dimension == 2 else 60, "", meet=False)
    simulation = Simulation(case)
    simulation.advance(60)
    assert renewals(simulation) > 1


@pytest.mark.parametrize(
    ("dimension", "of_soft"),
    [
        (2, ""),
        pytest.param(2, AVERAGES, marks=pytest.mark.slow),
        pytest.param(3, "", marks=pytest.mark.slow),
        pytest.param(3, AVERAGES, marks=pytest.mark.slow),
    ],
)
def test_the_same_bits(dimension: int, of_soft: str, tmp_path: Path) -> None:
    """With any number of threads and ranks, and after a restart amid it."""
    check_same_bits(metals(dimension, of_soft), tmp_path)
