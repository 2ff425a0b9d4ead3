# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that are cut at the faces of the box."""

from __future__ import annotations

import itertools
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial import cKDTree

from mpm3dpp import Body, Case, CaseError, Grid, Material, Run, Simulation, run_case
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build
from mpm3dpp.io import read_history
from mpm3dpp.shapes import (
    Box,
    Cylinder,
    Disc,
    Ring,
    Rotate,
    Shape,
    Sphere,
    fill,
    reference_volume,
)

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
frame = "updated"
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
    assert body.fill == "shells"
    assert body.mass == pytest.approx(1000 * whole / parts, rel=1e-12)
    assert body.positions.min() > 0.0
    assert np.linalg.norm(body.positions, axis=1).max() < 0.021


def test_a_quarter_is_the_whole_disc() -> None:
    """Both filled by the same lattice, whose points are mirrored by the axes."""
    quarter = QUARTER + 'fill = "lattice"\n'
    free = QUARTER.replace("lower = [0, 0]", 'lower = ["-40 mm", "-40 mm"]')
    free = free.replace('x_min = "symmetry", y_min = "symmetry"', "")
    free = free.replace("cut_at_box = true", 'fill = "lattice"')
    runs = []
    for text in (quarter, free):
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
        (
            'centre = [0, 0], radius = "20 mm" } }',
            'centre = ["1 mm", 0], radius = "20 mm" } }\nfill = "shells"',
            'body.disc.fill = "shells" is for a disc, ring, sphere, cylinder or tube (whole, bored',
        ),
        ("centre = [0, 0]", 'centre = ["-50 mm", 0]', "body.disc.shape"),
        ("cut_at_box = true", "cut_at_box = 1", "must be true or false"),
    ],
)
def test_mistakes(old: str, new: str, sentence: str) -> None:
    with pytest.raises(CaseError) as error:
        build(Case.from_text(QUARTER.replace(old, new)))
    assert sentence in str(error.value)


BALL_ON_FLOOR = """
[grid]
dimension = 2
cell_size = "1 mm"
box = { lower = [X, 0], upper = ["15 mm", "30 mm"], walls = { WALL y_min = "contact" } }
[run]
end_time = "1.6 ms"
[output]
frames = 2
[material.r]
density = 1000
strength = { elastic = { E = "10 MPa", nu = 0.3 } }
[body.ball]
material = "r"
shape = { disc = { centre = [0, "10 mm"], radius = "10 mm" } }
velocity = [0, "-1 m/s"]
"""
HALF = BALL_ON_FLOOR.replace("X", "0").replace("WALL", 'x_min = "slip",') + "cut_at_box = true\n"
WHOLE = BALL_ON_FLOOR.replace("X", '"-15 mm"').replace("WALL", "")


@pytest.mark.parametrize("frame", ["material", "updated"])
def test_half_a_disc_on_a_floor_is_the_whole_one(tmp_path: Path, frame: str) -> None:
    """Their shells differ by where points stand on every second circle: by a per cent of its peak
    in the force, which moves by that much with the number of circles too.

    Forces between surfaces swing by a tenth with the time in which a wave passes two cells, so that
    of nodes in the body it is the impulse that is compared: to .2 % of all of it at any time.
    """
    found = []
    for text, parts in ((HALF, 2), (WHOLE, 1)):
        text += f'frame = "{frame}"\n'
        run_case(Case.from_text(text), tmp_path / str(parts), pictures=False)
        history = read_history(tmp_path / str(parts) / "history.csv")
        written = np.isfinite(history["wall_y_min_impulse_y"])
        columns = ("time", "wall_y_min_force_y", "wall_y_min_impulse_y")
        time, force, impulse = (history[name][written] for name in columns)
        found.append((time, parts * force, parts * impulse))
    (t, half, out), (u, whole, other) = found
    peak = np.abs(whole).max()
    if frame == "updated":
        assert np.abs(half).max() == pytest.approx(peak, rel=0.01)
        assert np.abs(np.interp(u, t, half) - whole).max() < 0.01 * peak
    assert np.abs(np.interp(u, t, out) - other).max() < 0.002 * np.abs(other[-1])


CYLINDER = Cylinder(centre=(0, 0, 0), radius=8, height=16)
SPHERE = Sphere(centre=(0, 0, 0), radius=8)
DISC = Disc(centre=(0, 0), radius=8)
RING = Ring(centre=(0, 0), inner_radius=3, outer_radius=8)
FLAT = Box(lower=(0, -40), upper=(40, 40))
DEEP = Box(lower=(0, 0, -40), upper=(40, 40, 40))
PARTS: list[tuple[Shape, float]] = [
    (DISC & FLAT, DISC.volume() / 2),
    (DISC - Box(lower=(-40, -40), upper=(40, 0)), DISC.volume() / 2),
    (FLAT & Box(lower=(-40, 0), upper=(40, 40)) & DISC, DISC.volume() / 4),
    (RING & FLAT, RING.volume() / 2),
    (DISC - Disc(centre=(0, 0), radius=3), RING.volume()),
    ((DISC - Disc(centre=(0, 0), radius=3)) & FLAT, RING.volume() / 2),
    (Rotate(shape=DISC & FLAT, angle=0.3), DISC.volume() / 2),
    (CYLINDER & DEEP, CYLINDER.volume() / 4),
    (CYLINDER & Box(lower=(-40, -40, -5), upper=(40, 40, 40)), CYLINDER.volume() * 13 / 16),
    (CYLINDER - Cylinder(centre=(0, 0, 0), radius=4, height=20), CYLINDER.volume() * 3 / 4),
    (SPHERE & DEEP, SPHERE.volume() / 4),
    (SPHERE & Box(lower=(0, 0, 0), upper=(9, 9, 9)), SPHERE.volume() / 8),
    (SPHERE - Box(lower=(-9, -9, 0), upper=(9, 9, 9)), SPHERE.volume() / 2),
]


@pytest.mark.parametrize(("shape", "volume"), PARTS)
def test_parts_of_round_bodies_keep_their_shells(shape: Shape, volume: float) -> None:
    body = Body(material="m", shape=shape, spacing=1.0)
    grid = Grid(dimension=len(shape.bounds()[0]), cell_size=2.0)
    assert body.filled_by() == "shells"
    positions, volumes = fill(body, grid)
    assert volumes.sum() == pytest.approx(volume, rel=1e-12)
    assert np.ptp(volumes) == 0.0
    assert reference_volume(shape) == (pytest.approx(volume, rel=1e-12), True)
    assert shape.contains(positions).all()
    parts = [fill(body, grid, part=k, parts=3)[0] for k in range(3)]
    assert np.array_equal(np.concatenate(parts), positions)


@pytest.mark.parametrize("shape", [DISC, RING, CYLINDER, SPHERE])
@pytest.mark.parametrize("radius", [1.0, 1.6, 2.5, 4.0, 5.3, 8.0, 12.0])
def test_the_parts_make_up_a_whole_without_points_on_the_cuts(shape: Any, radius: float) -> None:
    """Mirrored by the cuts, an eighth of a sphere is a whole one with its inertia."""
    names = ("radius", "outer_radius", "inner_radius", "height")
    scaled = {name: getattr(shape, name) * radius / 8 for name in names if hasattr(shape, name)}
    whole = shape.model_copy(update=scaled)
    dimension = len(shape.centre)
    grid = Grid(dimension=dimension, cell_size=1.0)
    cuts = dimension if isinstance(shape, Sphere) else 2
    box = Box(lower=((0.0,) * cuts + (-40.0,))[:dimension], upper=(40.0,) * dimension)
    part, volumes = fill(Body(material="m", shape=whole & box, spacing=0.5), grid)
    assert part[:, :cuts].min() > 0.05  # A tenth of a spacing from the cuts.
    signs = itertools.product((1, -1), repeat=cuts)
    points = np.concatenate([part * (s + (1,) * (dimension - cuts)) for s in signs])
    gaps, _ = cKDTree(points).query(points, k=2)
    assert gaps[:, 1].min() > 0.5 * 0.5  # None is near another or twice there.
    second = points.T @ points * volumes[0]
    usual, each = fill(Body(material="m", shape=whole, spacing=0.5), grid)
    np.testing.assert_allclose(second, usual.T @ usual * each[0], atol=1e-12 * second.max())


@pytest.mark.parametrize(
    "shape",
    [
        DISC & Box(lower=(-40, -40), upper=(3, 40)),
        DISC - Disc(centre=(2, 0), radius=3),
        SPHERE - Cylinder(centre=(0, 0, 0), radius=3, height=20),
    ],
)
def test_what_keeps_no_shells_is_said_and_has_its_mass(shape: Shape) -> None:
    material = Material(density=1.0, strength={"elastic": {"E": 1.0, "nu": 0.3}})
    case = Case(
        grid=Grid(dimension=len(shape.bounds()[0]), cell_size=2.0),
        run=Run(end_time=1.0),
        material={"m": material},
        body={"b": Body(material="m", shape=shape)},
    )
    filled = build(case)
    assert filled[0].fill != "shells"
    assert abs(filled[0].mass_error) < 1e-9
    [note] = [note for note in notes(case, filled) if "shells" in note]
    assert note.startswith("body.b was round before it was cut")
