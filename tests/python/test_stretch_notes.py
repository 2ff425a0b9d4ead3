# SPDX-License-Identifier: BSD-3-Clause
"""`check` says which bodies will be stretched until their particles are too far apart."""

from __future__ import annotations

import pytest

from mpm3dpp import Case
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build

FLYING = """
[grid]
dimension = 2
cell_size = "5 mm"
[run]
end_time = "20 ms"
[material.rubber]
density = 1000
strength = { neo_hookean = { K = "0.8333 MPa", G = "0.3846 MPa" } }
[body.bar]
material = "rubber"
shape = { box = { lower = ["-50 mm", "0 mm"], upper = ["50 mm", "20 mm"] } }
velocity = [{ expression = "20*x/abs(x)", length = "m" }, 0]
"""
PULLED = """
[grid]
dimension = 2
cell_size = "5 mm"
[run]
end_time = "0.2 s"
[material.rubber]
density = 1000
strength = { neo_hookean = { K = "0.8333 MPa", G = "0.3846 MPa" } }
[material.s]
density = 7800
strength = { rigid = {} }
[[contact.pair]]
materials = ["rubber", "s"]
bonded = true
[body.strip]
material = "rubber"
shape = { box = { lower = ["0 mm", "0 mm"], upper = ["50 mm", "20 mm"] } }
[body.left]
material = "s"
motion = "fixed"
shape = { box = { lower = ["-15 mm", "-10 mm"], upper = ["0 mm", "30 mm"] } }
[body.right]
material = "s"
motion = { velocity = [{ ramp = { to = "0.55 m/s", end = "36 ms" } }, 0] }
shape = { box = { lower = ["50 mm", "-10 mm"], upper = ["65 mm", "30 mm"] } }
"""
STEEL = FLYING.replace(
    'neo_hookean = { K = "0.8333 MPa", G = "0.3846 MPa" }',
    'j2 = { E = "200 GPa", nu = 0.3, Y0 = "300 MPa" }',
).replace("density = 1000", "density = 7850")


def told(text: str) -> list[str]:
    case = Case.from_text(text)
    return [note for note in notes(case, build(case)) if "comes apart" in note]


def test_halves_that_fly_apart() -> None:
    [note] = told(FLYING)
    assert note.startswith("body.bar: its velocities at the start stretch it by a factor of 1.6")
    assert "give particles_per_cell = 4" in note
    assert told(FLYING + "particles_per_cell = 4\n") == []


def test_grips_that_pull_and_shear() -> None:
    """The right grip has moved 0.1001 m at the end, so that the strip is three times as long."""
    [note] = told(PULLED)
    assert "motions of the bodies that it is bonded to stretch it by a factor of 3" in note
    assert "give particles_per_cell = 7" in note
    sheared = PULLED.replace('end = "36 ms" } }, 0]', 'end = "36 ms" } }]').replace(
        "velocity = [{ ramp", "velocity = [0, { ramp"
    )
    [note] = told(sheared)  # gamma = 2: 1 + sqrt(2)
    assert "stretch it by a factor of 2.4" in note


def test_metal_that_yields_for_long() -> None:
    """rho v^2 / 2 = Y strain: 300 m/s give 1.2; 20 m/s hardly anything."""
    assert told(STEEL) == []
    [note] = told(STEEL.replace("20*x/abs(x)", "300*x/abs(x)"))
    assert "stretch it by a factor of 2.2" in note


@pytest.mark.parametrize(
    "velocity",
    [
        # Halves that meet, and a bar that turns.
        '[{ expression = "-20*x/abs(x)", length = "m" }, 0]',
        '[{ expression = "-500*y", length = "m" }, { expression = "500*x", length = "m" }]',
        "[20, 5]",
    ],
)
def test_what_is_not_stretched_is_not_told(velocity: str) -> None:
    line = 'velocity = [{ expression = "20*x/abs(x)", length = "m" }, 0]'
    assert told(FLYING.replace(line, f"velocity = {velocity}")) == []
