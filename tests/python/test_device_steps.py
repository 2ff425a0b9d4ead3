# SPDX-License-Identifier: BSD-3-Clause
"""Steps on a device have the processor's bits; the card is emulated (tests/device/emulated).

What is compared is a run of some steps from a case file, with what a device makes alone and what it
shares with the host. All strength models, bases and transfers are compared by
`mpm_device_check compare`, on a card.
"""

from __future__ import annotations

import importlib
import platform
import re
from pathlib import Path

import numpy as np
import pytest

from commands import write
from mpm3dpp import Simulation, load_case, run_case
from mpm3dpp.io import read_history, read_manifest

pytestmark = pytest.mark.skipif(
    platform.machine() not in ("x86_64", "AMD64"), reason="the emulation is for x86-64 alone"
)

STEEL = """
[material.steel]
density = "7850 kg/m^3"
strength = { elastic = { E = "200 GPa", nu = 0.3 } }
"""
COPPER = """
[material.copper]
density = "8960 kg/m^3"
eos = { mie_gruneisen = { c0 = "3940 m/s", s = 1.49, gamma0 = 1.96 } }
failure = { plastic_strain = { limit = 0.004, action = "erode" } }
[material.copper.strength.johnson_cook]
E = "124 GPa"
nu = 0.34
A = "90 MPa"
B = "292 MPa"
n = 0.31
C = 0.025
m = 1.09
T_melt = "1356 K"
cp = "383 J/kg/K"
"""
PLATE = """
[body.plate]
material = "PLATE"
shape = { box = { lower = [0, 0, 0], upper = ["8 mm", "2 mm", "4 mm"] } }
"""
BALL = """
[body.ball]
material = "steel"
shape = { sphere = { centre = ["5 mm", "4 mm", "2 mm"], radius = "2 mm" } }
velocity = ["30 m/s", "-400 m/s", 0]
"""
IMPACT = STEEL + COPPER + PLATE.replace("PLATE", "copper") + BALL
"""Contact, failure, particles that erode, walls."""
PRESSED = (
    STEEL
    + PLATE.replace("PLATE", "steel")
    + """
[material.stone]
density = "2700 kg/m^3"
strength = { rigid = {} }
[body.floor]
material = "steel"
motion = { velocity = [0, "20 m/s", 0] }
shape = { box = { lower = ["1 mm", "-2 mm", 0], upper = ["4 mm", 0, "4 mm"] } }
[body.stone]
material = "stone"
shape = { box = { lower = ["5 mm", "-2 mm", 0], upper = ["7 mm", 0, "4 mm"] } }
velocity = [0, "50 m/s", 0]
[load.press]
body = "plate"
side = "y_max"
pressure = "10 MPa"
[[contact.pair]]
bodies = ["plate", "stone"]
bonded = true
"""
)
"""A rigid body that sticks to another, one that is led, of a material that others have, a load."""
PUSHED = (
    STEEL
    + PLATE.replace("PLATE", "steel")
    + """
body_force = [{ expression = "1e7 + 1e10 * x" }, 0, 0]
damping = { mass = "1e4 /s", local = 0.2 }
"""
)
"""A body force, damping, a wall that absorbs."""
LEAVING = STEEL + BALL.replace('"-400 m/s"', '"2000 m/s"')
"""A body that leaves the region that is kept."""


def text(bodies: str, dimension: int, **run: str) -> str:
    """Return a case in a box with a fixed wall, a plane of symmetry and gravity."""
    walls = 'x_min = "fixed", x_max = "absorbing"' + (
        ', z_min = "symmetry"' if dimension == 3 else ""
    )
    settings = "\n".join(f'{key} = "{value}"' for key, value in run.items() if key != "basis")
    whole = f"""
title = "Steps on a device"
[grid]
dimension = {dimension}
cell_size = "1 mm"
basis = "{run.get("basis", "quadratic_bspline")}"
box = {{ lower = [0, "-4 mm", 0], upper = ["8 mm", "12 mm", "6 mm"], walls = {{ {walls} }} }}
outflow_box = {{ upper = ["20 mm", "7 mm", "20 mm"] }}
[run]
end_time = "{1.5 if dimension == 2 else 0.7} us"
gravity = [0, "-1e6 m/s^2", 0]
viscosity = {{}}
{settings}
[contact]
friction = 0.2
[output]
frames = 2
{bodies}"""
    if dimension == 2:  # the first two of three
        whole = whole.replace("sphere", "disc")
        whole = re.sub(r"\[([^][,]+), ([^][,]+), [^][,]+\]", r"[\1, \2]", whole)
    return whole


@pytest.fixture(autouse=True)
def emulated(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("MPM3DPP_DEVICE_LIBRARY", "libmpm_device_emulated.so")


ENERGIES = [
    "kinetic",
    "internal",
    "plastic",
    "viscous",
    "friction",
    "contact",
    "springs",
    "external",
    "absorbed",
    "damped",
    "eroded",
    "left",
]


def same_on_both(folder: Path, case: str) -> None:
    """Compare all numbers of a run's frames, and the energies of its history to rounding.

    The sums of the ledger are made in another order: 1e-12 of the largest energy.
    """
    path = write(folder, case)
    runs = [folder / device for device in ("cpu", "cuda")]
    for out in runs:
        run_case(path, out, threads=2, pictures=False, device=out.name)
    manifests = [read_manifest(out) for out in runs]
    assert [m["device"] for m in manifests] == ["cpu", "an emulated card"]
    assert manifests[0]["steps"] == manifests[1]["steps"] >= 8
    assert manifests[0]["result_hash"] == manifests[1]["result_hash"]
    cpu, cuda = (read_history(out) for out in runs)
    rows = np.searchsorted(cpu["time"], cuda["time"])
    scale = max(np.abs(cpu[name]).max() for name in ENERGIES)
    for name in ENERGIES:
        assert np.abs(cpu[name][rows] - cuda[name]).max() <= 1e-12 * scale, name


@pytest.mark.parametrize("dimension", [2, 3])
def test_an_impact(tmp_path: Path, dimension: int) -> None:
    case = text(IMPACT, dimension)
    same_on_both(tmp_path, case)
    history = read_history(tmp_path / "cpu")
    assert history["eroded"][-1] > 0.0 and history["friction"][-1] > 0.0


@pytest.mark.parametrize(
    ("scheme", "basis", "transfer"),
    [("usf", "quadratic_bspline", "aflip"), ("musl", "gimp", "flip")],
)
def test_rigid_and_loaded_bodies(tmp_path: Path, scheme: str, basis: str, transfer: str) -> None:
    case = text(PRESSED, 2, scheme=scheme, basis=basis, transfer=transfer)
    same_on_both(tmp_path, case)
    manifest = read_manifest(tmp_path / "cpu")
    assert manifest["status"] == "completed"


def test_pushed_damped_and_absorbed(tmp_path: Path) -> None:
    same_on_both(tmp_path, text(PUSHED, 2))
    history = read_history(tmp_path / "cpu")
    assert history["damped"][-1] > 0.0 and history["absorbed"][-1] > 0.0


def test_a_body_that_leaves(tmp_path: Path) -> None:
    same_on_both(tmp_path, text(LEAVING, 2))
    assert read_history(tmp_path / "cpu")["left"][-1] > 0.0


def test_a_run_goes_on_with_or_without_a_device(tmp_path: Path) -> None:
    case = load_case(write(tmp_path, text(IMPACT, 2)))
    whole = Simulation(case, threads=1)
    whole.advance(16)
    parts = Simulation(case, threads=1, device="cuda")
    parts.advance(8)
    parts.save(tmp_path / "state.zip")
    rest = Simulation(case, threads=1)
    rest.restore(tmp_path / "state.zip")
    rest.advance(8)
    back = Simulation(case, threads=1, device="cuda")
    back.restore(tmp_path / "state.zip")
    back.advance(8)
    for body in ("plate", "ball"):
        for quantity in ("position", "velocity", "stress"):
            expected = whole.column(body, quantity)
            assert np.array_equal(rest.column(body, quantity), expected)
            assert np.array_equal(back.column(body, quantity), expected)


def test_auto_falls_back_to_the_processor(tmp_path: Path) -> None:
    path = write(tmp_path, text(PUSHED, 2, scheme="usl"))
    manifest = run_case(path, tmp_path / "out", threads=1, pictures=False, device="auto")
    assert manifest.device == "cpu"


def test_a_rigid_body_is_given_a_velocity(tmp_path: Path) -> None:
    case = load_case(write(tmp_path, text(PRESSED, 2, basis="gimp", transfer="flip")))
    both = [Simulation(case, threads=1, device=device) for device in ("cpu", "cuda")]
    for simulation in both:
        simulation.advance(4)
        for body in ("stone", "plate"):
            simulation.set_velocity(body, 2.0 * simulation.column(body, "velocity"))
        simulation.advance(4)
    for body in ("stone", "plate", "floor"):
        cpu, cuda = (simulation.column(body, "velocity") for simulation in both)
        assert np.array_equal(cpu, cuda)


def test_the_first_step_that_differs_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """tools/lockstep.py: nothing to tell, then with a device whose sixth step is another one."""
    monkeypatch.syspath_prepend(Path(__file__).parents[2] / "tools")
    tool = importlib.import_module("lockstep")
    words = ["lockstep.py", str(write(tmp_path, text(LEAVING, 2))), "--every", "4", "--steps", "8"]
    monkeypatch.setattr("sys.argv", words)
    assert tool.main() == 0
    assert "step 8" in capsys.readouterr().out

    def advance(simulation: Simulation, steps: int, end_time: float | None = None) -> int:
        made = Simulation.advance(simulation, steps, end_time)
        if simulation.device.name != "cpu" and simulation.step >= 6:
            simulation.set_velocity("ball", 1.5 * simulation.column("ball", "velocity"))
        return made

    other = type("Other", (Simulation,), {"advance": advance})
    monkeypatch.setattr(tool, "Simulation", other)
    assert tool.main() == 1
    told = capsys.readouterr().out
    assert "step 4, t " in told and "step 6 is the first that differs:" in told
    assert "ball, velocity: " in told and "position" not in told.split("first that differs")[1]
