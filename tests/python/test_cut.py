# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that are cut at the faces of the box."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mpm3dpp import Case, CaseError, Simulation
from mpm3dpp.fill.build import build

QUARTER = """
[grid]
dimension = 2
cell_size = "2 mm"
box = { lower = [0, 0], upper = ["40 mm", "40 mm"], walls = WALLS }
[run]
end_time = "1 ms"
[material.rubber]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.disc]
material = "rubber"
shape = { disc = { centre = [0, 0], radius = "20 mm" } }
cut_at_box = true
velocity = [{ expression = "-50 * x" }, { expression = "-50 * y" }]
"""
WALLS = '{ x_min = "symmetry", y_min = "symmetry" }'
QUARTER = QUARTER.replace("WALLS", WALLS)
BALL = (
    QUARTER.replace("dimension = 2", "dimension = 3")
    .replace('[0, 0], upper = ["40 mm", "40 mm"]', '[0, 0, 0], upper = ["40 mm", "40 mm", "40 mm"]')
    .replace("disc = { centre = [0, 0]", "sphere = { centre = [0, 0, 0]")
    .replace(' * y" }]', ' * y" }, 0]')
)


@pytest.mark.parametrize(
    ("text", "whole"), [(QUARTER, math.pi * 0.02**2), (BALL, 4 / 3 * math.pi * 0.02**3)]
)
def test_what_is_left_of_a_body(text: str, whole: float) -> None:
    case = Case.from_text(text)
    parts = 2**case.grid.dimension
    [body] = build(case)
    # A lattice of 20 particles along the radius has 0.6 % (2D) and 0.1 % (3D) too much.
    assert body.mass == pytest.approx(1000 * whole / parts, rel=0.02)
    assert body.positions.min() > 0.0
    assert np.linalg.norm(body.positions, axis=1).max() < 0.021


def test_a_quarter_is_the_whole_disc() -> None:
    """Both filled by the same lattice, whose points are mirrored by the axes."""
    free = QUARTER.replace("lower = [0, 0]", 'lower = ["-40 mm", "-40 mm"]')
    free = free.replace('x_min = "symmetry", y_min = "symmetry"', "")
    free = free.replace("cut_at_box = true", 'fill = "lattice"')
    runs = []
    for text in (QUARTER, free):
        simulation = Simulation(Case.from_text(text), threads=1)
        simulation.advance(100)
        core = simulation.core
        columns = [
            core.column(0, name).reshape(core.particle_count, -1)
            for name in ("position", "velocity")
        ]
        kept = (columns[0][:, 0] > 0) & (columns[0][:, 1] > 0)
        order = np.lexsort(np.round(columns[0][kept][:, :2], 9).T)
        runs.append([column[kept][order] for column in columns])
    for one, other in zip(*runs, strict=True):
        np.testing.assert_allclose(one[:, :2], other[:, :2], atol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("\nbox =", "\n# box =", "body.disc.cut_at_box needs a box to cut at"),
        ("cut_at_box = true", 'cut_at_box = true\nfill = "shells"', "does not go with shells"),
        ("centre = [0, 0]", 'centre = ["-50 mm", 0]', "body.disc.shape"),
        ("cut_at_box = true", "cut_at_box = 1", "must be true or false"),
    ],
)
def test_mistakes(old: str, new: str, sentence: str) -> None:
    with pytest.raises(CaseError) as error:
        build(Case.from_text(QUARTER.replace(old, new)))
    assert sentence in str(error.value)
