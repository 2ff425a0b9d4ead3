# SPDX-License-Identifier: BSD-3-Clause
"""Laws by rates in the body: vibrations about a stress that is there already keep their energy."""

from __future__ import annotations

import numpy as np
import pytest

from mpm3dpp import Case, Simulation

DISC = """
[grid]
dimension = 2
cell_size = "2.7 mm"
[run]
end_time = 1
[contact]
enabled = false
[material.soft]
density = 1000
strength = { STRENGTH }
[body.disc]
material = "soft"
particles_per_cell = 3
shape = { disc = { centre = ["4.4 mm", "4.4 mm"], radius = "4.05 mm" } }
velocity = [{ expression = "0.06*sin(700*x+300*y)" }, { expression = "0.06*cos(500*x-600*y)" }]
angular_velocity = 10
[body.disc.initial]
stress = [
    { expression = "5e4*sin(900*y+1)" },
    { expression = "5e4*cos(700*x)" },
    0,
    { expression = "5e4*sin(600*x-500*y)" },
]
"""
ELASTIC = 'elastic = { E = "1 MPa", nu = 0.3 }'
METAL = 'j2 = { E = "1 MPa", nu = 0.3, Y0 = "10 MPa", H = 0 }'


@pytest.mark.parametrize("strength", [ELASTIC, METAL], ids=["elastic", "j2"])
def test_vibrations_about_a_stress_keep_their_energy(strength: str) -> None:
    """A twentieth of E: by a rate of Cauchy's stress, which has no potential, the kinetic energy
    was 16 times all of it after .7 s, and the internal energy far below nothing."""
    simulation = Simulation(Case.from_text(DISC.replace("STRENGTH", strength)), threads=1)
    columns = simulation.core.history_columns
    kinetic, total = [], []
    for _ in range(30):
        simulation.advance(1000)
        row = dict(zip(columns, simulation.core.history()[-1], strict=True))
        kinetic.append(row["kinetic"])
        total.append(row["kinetic"] + row["internal"])
    assert simulation.time > 0.5
    assert np.ptp(total) < 0.02 * total[0]
    assert max(kinetic) < 0.8 * total[0]
