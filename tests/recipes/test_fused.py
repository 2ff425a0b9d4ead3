# SPDX-License-Identifier: BSD-3-Clause
"""Stages that are fused give the same bits as the list of the scheme, one by one."""

from __future__ import annotations

from pathlib import Path

import pytest

from cases import BASES, SCHEMES, three_blocks
from mpm3dpp import Case, Simulation, load_case
from mpm3dpp.io.result_hash import result_hash

# Nearly all that a step can hold: walls that mirror and that absorb, gravity, contact with
# friction, a load, viscosity, PIC damping, a rigid body that is free and one that is led.
EVERYTHING = """
[grid]
dimension = {dimension}
cell_size = "10 mm"
basis = "{basis}"
box = {{ lower = {zero}, upper = {box}, walls = {{ y_min = "slip", x_min = "{left}" }} }}
[run]
scheme = "{scheme}"
end_time = "1 s"
time_step_factor = 0.3
energy_growth_limit = 1e9
gravity = {gravity}
viscosity = {{}}
pic_damping = "5 1/s"
[contact]
friction = 0.3
[material.soft]
density = 1000.0
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[material.metal]
density = 2000.0
strength = {{ j2 = {{ E = "4 MPa", nu = 0.3, Y0 = "2 kPa" }} }}
[material.stone]
density = 3000.0
strength = {{ rigid = {{}} }}
[body.bed]
material = "soft"
particles_per_cell = {per_axis}
shape = {{ box = {{ lower = {zero}, upper = {bed} }} }}
[body.block]
material = "metal"
velocity = {falling}
shape = {{ box = {{ lower = {low_block}, upper = {high_block} }} }}
[body.ball]
material = "stone"
velocity = {falling}
shape = {{ {ball} = {{ centre = {centre}, radius = "25 mm" }} }}
[body.press]
material = "stone"
motion = {{ velocity = {pressing} }}
shape = {{ box = {{ lower = {low_press}, upper = {high_press} }} }}
[load.side]
body = "bed"
side = "x_max"
pressure = "1 kPa"
"""


def everything(tmp_path: Path, dimension: int, scheme: str, basis: str, left: str) -> Case:
    def vector(*values: float) -> str:
        return str(list(values[:dimension]))

    text = EVERYTHING.format(
        dimension=dimension,
        scheme=scheme,
        basis=basis,
        left=left,
        per_axis=7 - dimension if left == "slip" else 2,  # More than are laid out at once.
        zero=vector(0.0, 0.0, 0.0),
        box=vector(0.4, 0.3, 0.08),
        gravity=vector(1.0, -10.0, 2.0),
        bed=vector(0.2, 0.06, 0.08),
        falling=vector(0.5, -2.0, 0.2),
        low_block=vector(0.02, 0.061, 0.01),
        high_block=vector(0.07, 0.11, 0.07),
        ball="disc" if dimension == 2 else "sphere",
        centre=vector(0.1, 0.087, 0.04),
        pressing=vector(0.0, -1.0, 0.0),
        low_press=vector(0.14, 0.061, 0.01),
        high_press=vector(0.18, 0.1, 0.07),
    )
    file = tmp_path / "case.toml"
    file.write_text(text)
    return load_case(file)


def hashes(case: Case, steps: int, threads: int = 1) -> list[str]:
    """Return the hash of the state after some steps, fused and one by one, and of the history."""
    found = []
    for fused in (True, False):
        simulation = Simulation(case, threads=threads, fused=fused)
        assert simulation.advance(steps) == steps
        found.append(result_hash(simulation.core) + simulation.core.history().tobytes().hex())
    return found


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_everything(tmp_path: Path, dimension: int, scheme: str, basis: str) -> None:
    for left in ("absorbing", "slip"):
        case = everything(tmp_path, dimension, scheme, basis, left)
        one, other = hashes(case, 12 if scheme == "usl" else 40)
        assert one == other, left


@pytest.mark.parametrize("basis", BASES)
@pytest.mark.parametrize("scheme", ["usf", "musl"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_three_blocks(dimension: int, scheme: str, basis: str) -> None:
    one, other = hashes(three_blocks(dimension, scheme, grid={"basis": basis}), 60, threads=2)
    assert one == other


@pytest.mark.parametrize("scheme", SCHEMES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_bonded(dimension: int, scheme: str) -> None:
    case = three_blocks(dimension, scheme)
    case.contact.friction, case.contact.bonded = 0.0, True
    one, other = hashes(case, 40)
    assert one == other


def test_the_stages_differ() -> None:
    """Lest the tests above compare a list with itself."""
    case = three_blocks(2)
    fused, listed = (set(Simulation(case, fused=f).core.timers()) for f in (True, False))
    assert {"map momentum", "map forces", "move particles"} <= listed - fused
