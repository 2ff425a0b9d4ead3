# SPDX-License-Identifier: BSD-3-Clause
"""Contact between surfaces on several ranks, which are threads here: the same bits.

Friction, bonds and rigid bodies: `check_same_bits` of test_surfaces.py, test_bonds_of_surfaces.py.
"""

from __future__ import annotations

import numpy as np
import pytest

from mpm3dpp import Case, Simulation

GRAINS = """
[grid]
dimension = DIMENSION
cell_size = "1 mm"
box = { lower = LOWER, upper = UPPER, walls = { y_min = "contact", x_min = "contact" } }
[run]
end_time = "20 ms"
gravity = GRAVITY
[contact]
friction = 0.3
restitution = RESTITUTION
[material.soft]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[grains.all]
material = "soft"
frame = "material"
lattice = { lower = LOWER, count = COUNT, radius = "3 mm", spacing = "6.2 mm" }
velocity = VELOCITY
"""
RING = """
[grid]
dimension = 2
cell_size = "1.6 mm"
box = { lower = ["-80 mm", "-80 mm"], upper = ["80 mm", "80 mm"], walls = { x_max = "contact" } }
[run]
end_time = "20 ms"
[material.rubber]
density = 1010
strength = { neo_hookean = { K = "121.7 MPa", G = "26.1 MPa" } }
[body.ring]
material = "rubber"
frame = "material"
shape = { ring = { centre = ["39 mm", 0], inner_radius = "30 mm", outer_radius = "40 mm" } }
velocity = [50, 0]
"""


def grains(dimension: int, restitution: float) -> Case:
    """Return balls that fall on each other, on a floor and on a wall, some in several tiles."""
    text = GRAINS.replace("DIMENSION", str(dimension)).replace("RESTITUTION", str(restitution))
    for word, value in {
        "LOWER": [0, 0, 0],
        "UPPER": [0.04, 0.04, 0.04],
        "GRAVITY": [0, -50, 0],
        "VELOCITY": [-1, -2, 1],
    }.items():
        text = text.replace(f"= {word}", f"= {value[:dimension]}")
    return Case.from_text(text.replace("COUNT", str([4, 3] if dimension == 2 else [3, 2, 2])))


def after(case: Case, steps: int, ranks: int) -> tuple[Simulation, list[bytes]]:
    simulation = Simulation(case, threads=1, ranks=ranks)
    simulation.advance(steps)
    return simulation, state(simulation)


def state(simulation: Simulation) -> list[bytes]:
    """Return what all columns, the history, sums of bodies and pairs are by now."""
    core = simulation.core
    found = [core.history(), core.part_sums()[0], core.part_sums()[1]]
    found += [core.column(b, one.name) for b in range(core.body_count) for one in core.columns(b)]
    found += [[*one.force, *one.impulse, one.friction_work] for one in core.contact_pairs()]
    return [np.array(one).tobytes() for one in found]


@pytest.mark.parametrize(
    ("dimension", "restitution"),
    [(2, 1.0), (2, 0.5), pytest.param(3, 1.0, marks=pytest.mark.slow), (3, 0.5)],
)
def test_grains(dimension: int, restitution: float) -> None:
    case, steps = grains(dimension, restitution), 300 if dimension == 2 else 80
    one, found = after(case, steps, 1)
    assert len(one.core.contact_pairs()) > 5
    for ranks in (2, 5):
        assert after(case, steps, ranks)[1] == found


def test_a_ring_that_touches_itself() -> None:
    """Squeezed by a wall that it hits at 50 m/s until its inner faces meet."""
    case, steps = Case.from_text(RING), 1350
    one, found = after(case, steps, 1)
    places, start = (one.column("ring", name) for name in ("position", "reference_position"))
    inner = np.hypot(start[:, 0] - 0.039, start[:, 1]) < 0.031
    near = inner & (np.abs(places[:, 1]) < 1e-3)
    left = places[near & (start[:, 0] < 0.039), 0].max()
    right = places[near & (start[:, 0] > 0.039), 0].min()
    assert 0.0 < right - left < 1e-3
    for ranks in (2, 3):
        assert after(case, steps, ranks)[1] == found


def test_velocities_that_are_set() -> None:
    """Between two steps, of a body that two ranks share; as one rank has it."""
    case, found = grains(2, 0.5), []
    for ranks in (1, 3):
        simulation, _ = after(case, 100, ranks)
        for name in simulation.bodies[:3]:
            simulation.set_velocity(name, -simulation.column(name, "velocity"))
        simulation.advance(100)
        found.append(state(simulation))
    assert found[0] == found[1]


def test_grains_that_settle() -> None:
    """Before the time 0, and a while after it."""
    text = GRAINS.replace("DIMENSION", "2").replace("RESTITUTION", "0.5")
    for word, value in {
        "LOWER": [0, 0],
        "UPPER": [0.04, 0.04],
        "GRAVITY": [0, -50],
        "VELOCITY": [0, 0],
        "COUNT": [4, 3],
    }.items():
        text = text.replace(f"= {word}", f"= {value}")
    case = Case.from_text(text.replace("[contact]", 'settle = { longest = "2 ms" }\n[contact]'))
    one, found = after(case, 300, 1)
    assert one.time > 0.0
    assert after(case, 300, 3)[1] == found
