# SPDX-License-Identifier: BSD-3-Clause
"""Gases, explosives and liquids by default: they keep their room and their energy, and meet solids.

Decision 62. Energies are kinetic, internal, plastic and viscous together.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mpm3dpp import Case, RunError, Simulation
from mpm3dpp.fill.gas_notes import gas_notes
from mpm3dpp.fill.response_notes import response_notes
from turning import balance

GAMMA = 1.4


def gas(energy: float, density: float = 1.0) -> dict[str, Any]:
    """Return an ideal gas with that energy per initial volume."""
    return {
        "density": density,
        "strength": {"fluid": {}},
        "eos": {"ideal_gas": {"gamma": GAMMA, "E0": energy}},
    }


def end(case: Case) -> tuple[Simulation, dict[str, np.ndarray]]:
    """Run to the end time; also the columns of the history."""
    simulation = Simulation(case, threads=1)
    rows = [simulation.core.history()]
    while simulation.time < case.run.end_time:
        simulation.advance(200)
        rows.append(simulation.core.history())
        assert simulation.core.failure is None
    columns = zip(simulation.core.history_columns, np.concatenate(rows).T, strict=True)
    return simulation, dict(columns)


def kept(row: dict[str, np.ndarray]) -> float:
    """Return the energy at the end over that of the start."""
    total = sum(row[name] for name in ("kinetic", "internal", "plastic", "viscous"))
    return float(total[-1] / total[0])


@pytest.mark.parametrize("spacing", [0.5, 1.0, 1.5, 2.0])
@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("scheme", ["usf", pytest.param("musl", marks=pytest.mark.slow)])
def test_a_gas_at_rest_in_disorder_stays_at_rest(
    spacing: float, seed: int, scheme: str, tmp_path: Path
) -> None:
    # Lone particles inflated themselves: the sum of volumes was 1.9 to 1e12 times the room.
    n = 18
    side = (np.arange(round(n / spacing)) + 0.5) * spacing
    places = np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
    places += np.random.default_rng(seed).uniform(-0.1, 0.1, places.shape) * spacing
    table = tmp_path / "gas.csv"
    rows = "\n".join(f"{x},{y},{spacing**2}" for x, y in places)
    table.write_text(f"x,y,volume\n{rows}\n")
    walls = {"lower": [0, 0], "upper": [n, n], "walls": "slip"}
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": 1, "box": walls},
            "run": {"end_time": 30.0, "scheme": scheme},
            "material": {"gas": gas(1.0 / GAMMA / (GAMMA - 1.0))},
            "body": {"gas": {"material": "gas", "particles": str(table)}},
        }
    )
    simulation, row = end(case)
    volumes = simulation.column("gas", "volume").sum() / n**2
    # A volume grows to 1.12 of the room, by which that of all does (1.13), and none is cut: two
    # cells apart .937 are filled in the mean of four seeds.
    assert (0.95 if spacing < 2.0 else 0.92) <= volumes <= 1.14
    assert abs(kept(row) - 1.0) < 1e-3
    if spacing != 1.5:
        told = {warning.kind for warning in simulation.core.warnings()}
        assert ("sparse gas" in told) == (spacing > 1.5)


@pytest.mark.parametrize(
    ("per_cell", "dimension"), [(2, 2), (3, 2), (2, 3), pytest.param(3, 3, marks=pytest.mark.slow)]
)
def test_a_gas_that_fills_an_empty_box_presses_on_it_or_says_so(
    per_cell: int, dimension: int
) -> None:
    # With two a cell particles end 1.9 cells apart (1.55 in 3D): .78 and .93 of the pressure.
    half, radius = (0.1, 0.03) if dimension == 2 else (0.04, 0.016)
    box = {"lower": [-half] * dimension, "upper": [half] * dimension, "walls": "slip"}
    shape = {"centre": [0.0] * dimension, "radius": radius}
    case = Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": 5e-3, "box": box},
            "run": {"end_time": 1e-3},
            "material": {"hot": gas(25e6, 10.0)},
            "body": {
                "charge": {
                    "material": "hot",
                    "shape": {"disc" if dimension == 2 else "sphere": shape},
                    "particles_per_cell": per_cell,
                }
            },
        }
    )
    simulation = Simulation(case, threads=1)
    pushes = []
    for half_time in (0.5e-3, 1e-3):
        while simulation.time < half_time:
            simulation.advance(100)
        faces = [np.abs(wall.impulse).max() for wall in simulation.core.walls()]
        pushes.append((simulation.time, np.mean(faces)))
    (start, before), (stop, after) = pushes
    pressure = (after - before) / ((stop - start) * (2 * half) ** (dimension - 1))
    rows = dict(zip(simulation.core.history_columns, simulation.core.history().T, strict=True))
    heat = sum(rows[name][-1] for name in ("internal", "viscous", "plastic"))
    exact = (GAMMA - 1.0) * heat / (2 * half) ** dimension
    told = {warning.kind: warning.message for warning in simulation.core.warnings()}
    if "sparse gas" in told:
        assert "give it a smaller spacing" in told["sparse gas"]
        assert pressure < 0.97 * exact
    else:
        assert pressure == pytest.approx(exact, rel=0.03)
    assert ("sparse gas" in told) == (per_cell == 2)


@pytest.mark.parametrize("beside", ["walls", "a solid"])
def test_a_gas_that_sounds_makes_no_noise_of_its_heat(beside: str) -> None:
    # A standing wave of 3 m/s, 6e-6 of the heat of the gas, became .0035 of it in noise.
    width, height, pressure = 0.1, 0.2, 1e5
    gap = 0.05 if beside == "a solid" else 0.0
    box = {"lower": [0, 0], "upper": [width, height + gap], "walls": "slip"}
    room = {"box": {"lower": [0, 0], "upper": [width, height]}}
    wave = {"expression": f"3.0 * sin(pi * x / {width}) * cos(pi * y / {height} * 5)"}
    tables: dict[str, Any] = {
        "grid": {"dimension": 2, "cell_size": 5e-3, "box": box},
        "run": {"end_time": 8e-3},
        "material": {"air": gas(pressure / (GAMMA - 1.0), 1.2)},
        "body": {"air": {"material": "air", "shape": room, "velocity": [wave, 0.0]}},
    }
    if gap:
        tables["material"]["solid"] = {
            "density": 2000.0,
            "strength": {"elastic": {"E": 1e8, "nu": 0.3}},
        }
        block = {"box": {"lower": [0, height], "upper": [width, height + gap]}}
        tables["body"]["block"] = {"material": "solid", "shape": block, "motion": "fixed"}
    _, row = end(Case.model_validate(tables))
    heat = row["internal"][0]
    assert row["kinetic"][0] < 1e-5 * heat
    assert row["kinetic"].max() < 1e-3 * heat
    assert abs(kept(row) - 1.0) < 1e-3
    assert abs(row["contact"][-1]) < 1e-3 * heat


def charge(dimension: int, transfer: str, material: dict[str, Any], **run: Any) -> Case:
    """Return a bare charge of 10 cells a radius (2D) or 5 (3D), lit in the middle."""
    radius = 0.05
    shape = {
        "disc" if dimension == 2 else "sphere": {"centre": [0.0] * dimension, "radius": radius}
    }
    return Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": radius / (10 if dimension == 2 else 5)},
            "run": {"viscosity": {}, "transfer": transfer, **run},
            "material": {"charge": material},
            "body": {"charge": {"material": "charge", "shape": shape}},
            **({"detonation": [{"point": [0.0] * dimension}]} if "library" in material else {}),
        }
    )


@pytest.mark.parametrize(
    ("dimension", "material", "time"),
    [
        (2, {"library": "tnt"}, 160e-6),
        (3, {"library": "tnt"}, 60e-6),
        (2, gas(1e9, 1000.0), 400e-6),
    ],
)
def test_a_bare_charge_keeps_its_energy_and_its_way(
    dimension: int, material: dict[str, Any], time: float
) -> None:
    def reach(transfer: str) -> float:
        simulation, row = end(charge(dimension, transfer, material, end_time=time))
        places = simulation.column("charge", "position")[:, :dimension]
        if transfer == "aflip":
            assert abs(kept(row) - 1.0) < 1e-3
            # A lone particle stands for 1.12 over the sum of its squared weights at most.
            cell = simulation.case.grid.cell_size
            most = 1.12 * (1.0 / 0.5) ** dimension * cell**dimension
            assert simulation.column("charge", "volume").max() < 1.01 * most
        return float(np.linalg.norm(places, axis=1).max())

    # FLIP keeps the energy of a charge to 4e-5 and so knows how far its front comes; it is that of
    # single particles in the corners, hence the 6 %.
    assert reach("aflip") == pytest.approx(reach("flip"), rel=0.06)


@pytest.mark.parametrize(
    ("dimension", "n", "radius", "constant"),
    [(2, 52, 45.0, 1.0040), pytest.param(3, 24, 20.0, 1.0328, marks=pytest.mark.slow)],
)
def test_a_blast_keeps_its_energy_and_comes_as_far_as_sedov_says(
    dimension: int, n: int, radius: float, constant: float
) -> None:
    # Sedov 1959 for gamma 1.4: R = constant (E t^2 / rho)^(1 / (2 + D)), E of the whole space.
    source, energy = 2.0, 0.5**dimension
    time = (radius / constant) ** ((2 + dimension) / 2)
    room = {"lower": [0.0] * dimension, "upper": [n] * dimension}
    hot = {"box": {"lower": [0.0] * dimension, "upper": [source] * dimension}}
    case = Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": 1.0, "box": {**room, "walls": "slip"}},
            "run": {"end_time": time, "viscosity": {}},
            "contact": {"bonded": True},
            "material": {"hot": gas(energy / source**dimension), "cold": gas(1e-6)},
            "body": {
                "hot": {"material": "hot", "shape": hot},
                "cold": {"material": "cold", "shape": {"difference": [{"box": room}, hot]}},
            },
        }
    )
    simulation, row = end(case)
    assert abs(kept(row) - 1.0) < 1e-3
    # One per cent and half a cell, to which a front three cells wide is found. In 3D it is .7 cells
    # ahead (.9 at a radius of 30 cells): 4 %, told as a miss in decision 0065.
    most = 0.5 + 0.01 * radius if dimension == 2 else 0.8
    assert front(simulation, dimension, n) == pytest.approx(radius, abs=most)


def front(simulation: Simulation, dimension: int, n: int) -> float:
    """Return where the density, by shells of half a cell, has fallen to half of the peak's rise."""
    places = np.concatenate(
        [simulation.column(name, "position")[:, :dimension] for name in ("hot", "cold")]
    )
    mass = np.concatenate([simulation.column(name, "mass") for name in ("hot", "cold")]).ravel()
    edges = np.linspace(0.0, n, 2 * n + 1)
    inside, _ = np.histogram(np.linalg.norm(places, axis=1), edges, weights=mass)
    shells = np.diff(edges**dimension) * (np.pi / 4.0 if dimension == 2 else np.pi / 6.0)
    density = np.convolve(inside / shells, np.ones(3) / 3.0, "same")
    k = int(density[: 2 * n - 8].argmax())
    half = 0.5 * (density[k] + 1.0)
    while density[k] > half:
        k += 1
    share = (half - density[k]) / (density[k - 1] - density[k])
    return float(0.5 * (edges[k] + edges[k + 1]) - 0.5 * share)


CHARGES = {"tnt": ({"library": "tnt"}, 0.3e-3), "gas": (gas(250e6, 100.0), 0.3e-3)}


def charge_in(filling: str, around: str, **contact: str) -> Case:
    """Return a square charge, or a gas under pressure, in a block of something else."""
    material, time = CHARGES[filling]
    inner = {"box": {"lower": [-0.05, -0.05], "upper": [0.05, 0.05]}}
    outer = {"box": {"lower": [-0.2, -0.2], "upper": [0.2, 0.2]}}
    return Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": 0.01},
            "run": {"end_time": time, "viscosity": {}},
            "material": {"inner": material, "outer": {"library": around}},
            "body": {
                "inner": {"material": "inner", "shape": inner},
                "outer": {"material": "outer", "shape": {"difference": [outer, inner]}},
            },
            "contact": contact,
            **({"detonation": [{"point": [0.0, 0.0]}]} if filling == "tnt" else {}),
        }
    )


@pytest.mark.parametrize("filling", CHARGES)
@pytest.mark.parametrize("around", ["water", "aluminium_6061_t6"])
def test_what_flows_pushes_others_without_making_energy(filling: str, around: str) -> None:
    # Springs made 429 % (TNT in water) and 189 % (gas in water) and stopped.
    case = charge_in(filling, around)
    assert case.contact.response == "by_matter"
    _, row = end(case)
    whole = row["internal"][0]
    assert abs(row["contact"][-1]) < 0.01 * whole
    assert row["numerical"].min() > -0.01 * whole  # nothing is made
    assert 0.95 < kept(row) < 1.001


@pytest.mark.parametrize("filling", CHARGES)
def test_check_tells_of_springs_where_matter_flows(filling: str) -> None:
    case = charge_in(filling, "water", response="springs")
    told = " ".join(response_notes(case))
    assert "makes energy where body.inner, a gas, meets other bodies" in told
    assert not response_notes(charge_in(filling, "water"))


LIQUID = {
    "density": 1000.0,
    "strength": {"fluid": {"viscosity": 1e-3}},
    "eos": {"tait": {"c0": 50.0}},
}
SOFT = {"density": 1200.0, "strength": {"neo_hookean": {"K": 1.67e6, "G": 0.357e6}}}
RIGID = {"density": 7800.0, "strength": {"rigid": {}}}


@pytest.mark.parametrize(
    ("dimension", "cell", "target", "time"),
    [(2, 1e-3, RIGID, 8e-3), (2, 1e-3, SOFT, 8e-3), (3, 2.5e-3, RIGID, 5e-3)],
)
def test_a_liquid_splashes_on_a_solid(
    dimension: int, cell: float, target: dict[str, Any], time: float
) -> None:
    # Impulses took 33, 19 and 63 % of a drop of a radius of 10 mm that comes with 5 m/s. What is
    # left to be lost is the motion of single particles. In 3D springs give back 2.4 % more than
    # they took, as the surface that they push is another one by then.
    low, high = [-0.03] * dimension, [0.03] * dimension
    low[-1], high[-1] = -0.008, 0.0
    up = [0.0] * (dimension - 1)
    shape = {"disc" if dimension == 2 else "sphere": {"centre": [*up, 0.011], "radius": 0.01}}
    plate: dict[str, Any] = {"material": "target", "shape": {"box": {"lower": low, "upper": high}}}
    if target is RIGID:
        plate["motion"] = "fixed"
    case = Case.model_validate(
        {
            "grid": {"dimension": dimension, "cell_size": cell},
            "run": {"end_time": time},
            "material": {"liquid": LIQUID, "target": target},
            "body": {
                "drop": {"material": "liquid", "shape": shape, "velocity": [*up, -5.0]},
                "plate": plate,
            },
        }
    )
    assert case.contact.response == "by_matter" and not response_notes(case)
    _, row = end(case)
    assert 0.87 < kept(row) < 1.04
    assert row["contact"].min() > -0.035 * row["kinetic"][0]


def test_check_tells_of_liquids_that_meet_by_springs() -> None:
    drops = {
        name: {"material": "liquid", "shape": {"disc": {"centre": [x, 0.0], "radius": 0.01}}}
        for name, x in (("left", -0.011), ("right", 0.011))
    }
    tables = {
        "grid": {"dimension": 2, "cell_size": 1e-3},
        "run": {"end_time": 1e-3},
        "material": {"liquid": LIQUID},
        "body": drops,
    }
    assert not response_notes(Case.model_validate(tables))
    springs = Case.model_validate({**tables, "contact": {"response": "springs"}})
    assert "the liquids body.left and body.right meet" in " ".join(response_notes(springs))


def test_check_tells_of_a_gas_without_viscosity_and_at_walls_that_are_contact() -> None:
    walls = {"lower": [-0.1, -0.1], "upper": [0.1, 0.1], "walls": "contact"}
    disc = {"disc": {"centre": [0.0, 0.0], "radius": 0.03}}
    tables: dict[str, Any] = {
        "grid": {"dimension": 2, "cell_size": 5e-3, "box": walls},
        "run": {"end_time": 1e-3, "viscosity": {"quadratic": 0.0, "linear": 0.0}},
        "material": {"hot": gas(25e6, 10.0)},
        "body": {"charge": {"material": "hot", "shape": disc}},
    }
    case = Case.model_validate(tables)
    told = [*gas_notes(case), *response_notes(case)]
    assert any("material.hot is a gas without artificial viscosity" in one for one in told)
    assert any('give grid.box.walls = "slip"' in one for one in told)
    del tables["run"]["viscosity"]
    walls["walls"] = "slip"
    case = Case.model_validate(tables)
    assert not gas_notes(case) and not response_notes(case)


def test_energy_that_the_transfer_makes_stops_a_run() -> None:
    # A gas without viscosity in an empty box: 1e75 of the energy at the start had been made.
    walls = {"lower": [-0.1, -0.1], "upper": [0.1, 0.1], "walls": "slip"}
    disc = {"disc": {"centre": [0.0, 0.0], "radius": 0.03}}
    case = Case.model_validate(
        {
            "grid": {"dimension": 2, "cell_size": 5e-3, "box": walls},
            "run": {"end_time": 1e-3, "viscosity": {"quadratic": 0.0, "linear": 0.0}},
            "material": {"hot": gas(25e6, 10.0)},
            "body": {"charge": {"material": "hot", "shape": disc}},
        }
    )
    simulation = Simulation(case, threads=1)
    with pytest.raises(RunError, match="numerics have made"):
        simulation.advance(1000)
    rows = dict(zip(simulation.core.history_columns, simulation.core.history().T, strict=True))
    assert -rows["numerical"][-1] < 100.0 * rows["internal"][0]


def test_energy_made_is_told_by_its_column_with_what_helps() -> None:
    case = charge_in("tnt", "water", response="springs")
    case.run.energy_growth_limit, case.run.cfl = 0.02, 0.2
    with pytest.raises(
        RunError, match=r"in the column contact of history.csv: give contact\.response"
    ):
        end(case)


def test_solids_beside_what_flows_keep_their_springs() -> None:
    # Two discs of rubber that meet beside a block of gas that touches none of them.
    discs = {
        name: {
            "material": "rubber",
            "frame": "updated",
            "shape": {"disc": {"centre": [x, 0.0], "radius": 0.01}},
            "velocity": [speed, 0.0],
        }
        for name, x, speed in (("left", -0.0101, 1.0), ("right", 0.0101, -1.0))
    }
    rubber = {"density": 1000.0, "strength": {"neo_hookean": {"K": 1e6, "G": 4e5}}}
    far = {"material": "gas", "shape": {"box": {"lower": [0.1, 0.1], "upper": [0.11, 0.11]}}}
    tables = {
        "grid": {"dimension": 2, "cell_size": 1e-3},
        "run": {"end_time": 0.5e-3},
        "material": {"rubber": rubber},
        "body": discs,
    }

    def force(case: Case) -> np.ndarray:
        simulation, row = end(case)
        assert row["springs"].max() > 0.0
        return simulation.column("left", "velocity")

    alone = Case.model_validate(tables)
    beside = Case.model_validate(
        {
            **tables,
            "run": {"end_time": 0.5e-3, "time_step": 5e-6},
            "material": {"rubber": rubber, "gas": gas(1.0)},
            "body": {**discs, "gas": far},
        }
    )
    alone.run.time_step = 5e-6
    assert (alone.contact.response, beside.contact.response) == ("springs", "by_matter")
    np.testing.assert_allclose(force(beside), force(alone), rtol=0.0, atol=1e-12)


def test_a_spinning_grain_keeps_its_spin_and_its_energy() -> None:
    # The affine part is carried along: 0.990 of the spin and 0.978 of the energy were left.
    for cells in (4, 6):
        spin, radius = 50.0, 0.01
        case = Case.model_validate(
            {
                "grid": {"dimension": 2, "cell_size": radius / cells},
                "run": {"end_time": 3.2 * 2.0 * np.pi / spin},
                "material": {
                    "soft": {"density": 1000.0, "strength": {"elastic": {"E": 1e5, "nu": 0.3}}}
                },
                "body": {
                    "grain": {
                        "material": "soft",
                        "shape": {"disc": {"centre": [0.0, 0.0], "radius": radius}},
                        "angular_velocity": spin,
                    }
                },
            }
        )
        first = balance(Simulation(case, threads=1))["momentum"][2]
        simulation, row = end(case)
        assert balance(simulation)["momentum"][2] / first == pytest.approx(1.0, abs=1e-3)
        assert kept(row) == pytest.approx(1.0, abs=5e-3)


LOST = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "20 us"
cfl = {cfl}
viscosity = {{}}
[material.steel]
density = 7850
strength = {{ elastic = {{ E = "210 GPa", nu = 0.3 }} }}
[material.brittle]
density = 3900
strength = {{ {strength} }}
failure = {{ principal_stress = {{ limit = "260 MPa" }} }}
[body.ball]
material = "steel"
shape = {{ disc = {{ centre = [0, "4 mm"], radius = "4 mm" }} }}
velocity = [0, "-600 m/s"]
[body.strip]
material = "brittle"
shape = {{ box = {{ lower = ["-15 mm", "-6 mm"], upper = ["15 mm", 0] }} }}
"""
YIELDING = {
    "j2": 'j2 = { E = "370 GPa", nu = 0.22, Y0 = "3 GPa" }',
    "johnson_cook": 'simplified_johnson_cook = { E = "370 GPa", nu = 0.22, A = "3 GPa", '
    'B = "1 GPa", n = 0.5, C = 0.01, rate0 = 1 }',
    "voce": 'voce = { E = "370 GPa", nu = 0.22, Y0 = "3 GPa", Q = "1 GPa", b = 10 }',
}


@pytest.mark.parametrize("strength", YIELDING)
def test_what_has_failed_dissipates_nothing_by_plastic_flow(strength: str) -> None:
    # It yielded in every step from no stress at all: plastic work grew with the number of steps,
    # 16.8 kJ/m at 0.5 for 7.4 at 0.1, and the internal energy fell below zero.
    found = {}
    for cfl in (0.5, 0.1):
        text = LOST.format(cfl=cfl, strength=YIELDING[strength])
        _, row = end(Case.from_text(text))
        assert row["internal"].min() > -1e-3 * row["kinetic"][0]
        found[cfl] = row["plastic"][-1]
    # What yields before it fails does so by steps: first order, 18, 6 and 0 % at 0.5, 0.25 and 0.1.
    assert found[0.5] == pytest.approx(found[0.1], rel=0.25)


TORN = """
[grid]
dimension = {dimension}
cell_size = "1 mm"
[run]
end_time = "{time}"
[material.rubber]
density = 1000
strength = {{ neo_hookean = {{ K = "10 MPa", G = "1 MPa" }} }}
[body.band]
material = "rubber"
frame = "updated"
shape = {{ box = {{ lower = {lower}, upper = {upper} }} }}
velocity = [{velocity}]
"""


@pytest.mark.parametrize(("speed", "notes"), [(100.0, True), (5.0, False)])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_body_that_comes_apart_between_sparse_particles_is_told(
    speed: float, notes: bool, dimension: int
) -> None:
    across = ', "-2 mm"' * (dimension - 1), ', "2 mm"' * (dimension - 1)
    text = TORN.format(
        dimension=dimension,
        time="2 ms" if notes else "1 ms",
        lower=f'["-20 mm"{across[0]}]',
        upper=f'["20 mm"{across[1]}]',
        velocity=", ".join([f'{{ expression = "{speed / 0.02} * x" }}', *["0"] * (dimension - 1)]),
    )
    simulation, _ = end(Case.from_text(text))
    told = [w.message for w in simulation.core.warnings() if w.kind == "sparse particles"]
    assert bool(told) == notes
    assert all("more than a cell apart" in t and 'body "band"' in t for t in told)
