# SPDX-License-Identifier: BSD-3-Clause
"""`check` tells how long a run will take."""

from __future__ import annotations

import os
import re

import pytest

from mpm3dpp import Case, Simulation
from mpm3dpp.fill.build import build
from mpm3dpp.run import estimate
from mpm3dpp.run.summary import time_step

CASE = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 s"
[material.steel]
density = "7850 kg/m^3"
strength = { elastic = { E = "210 GPa", nu = 0.3 } }
[material.tool]
density = "7850 kg/m^3"
strength = { rigid = {} }
[body.sheet]
material = "steel"
shape = { box = { lower = [0, 0], upper = ["10 mm", "5 mm"] } }
[body.punch]
material = "tool"
shape = { box = { lower = ["0 mm", "10 mm"], upper = ["30 mm", "20 mm"] } }
"""


def test_the_time_is_steps_times_particles(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(estimate, "_seconds", lambda *_: 1e-6)
    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    case = Case.from_text(CASE)
    bodies = build(case)
    steps = 1.0 / time_step(case, bodies)
    minutes = steps * bodies.particle_count * 1e-6 / 60.0
    for cores, ranks, workers, at_once in (
        (8, 1, "2 threads", 1),
        (8, 4, "4 ranks of 2 threads", 4),
        (4, 4, "4 ranks of 2 threads", 2),
    ):
        monkeypatch.setattr(os, "sched_getaffinity", lambda _, n=cores: set(range(n)))
        line = estimate.estimate_line(case, bodies, ranks)
        found = re.match(rf"estimate: about (\S+) (min|h) with {workers} on this machine", line)
        assert found
        told = float(found[1]) * (60.0 if found[2] == "h" else 1.0)
        assert told == pytest.approx(minutes / at_once, rel=0.05)
        assert "(1e+03 ns for a particle and step; contact and frames come on top)" in line


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_block_and_a_heap_of_grains_are_stepped(dimension: int) -> None:
    """Of what deforms; the grains touch, as they will."""
    text = CASE.replace("dimension = 2", f"dimension = {dimension}")
    if dimension == 3:
        corners = r'\], upper = \[("\S+ mm"), ("\S+ mm")\]'
        text = re.sub(corners, r', 0], upper = [\1, \2, "3 mm"]', text)
    lattice = f"lower = {[0.1] * dimension}, count = {[3] * dimension}, radius = 0.002"
    text += f'[grains.balls]\nmaterial = "steel"\nframe = "updated"\nlattice = {{ {lattice} }}\n'
    case = Case.from_text(text)
    bodies = build(case)
    line = estimate.estimate_line(case, bodies, threads=1)
    assert re.search(r"with 1 thread on this machine \(\S+ ns for a particle and step", line)
    heap = Simulation(estimate._heap(case, case.grains["balls"], bodies.parts["balls"]), threads=1)
    heap.advance(3)
    assert heap.core.body_count == 3**dimension
    assert heap.core.contact_summary()["overlapped_nodes"] > 0
    block = estimate._block(case, "steel", bodies.parts["sheet"].count)
    assert build(block).particle_count == pytest.approx(bodies.parts["sheet"].count, rel=0.3)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0.2, "less than a second"),
        (1.2, "about 2 s"),
        (119.0, "about 119 s"),
        (1800.0, "about 30 min"),
        (5.4e4, "about 15 h"),
        (8.64e5, "about 10 days"),
    ],
)
def test_words(seconds: float, words: str) -> None:
    assert estimate._in_words(seconds) == words
