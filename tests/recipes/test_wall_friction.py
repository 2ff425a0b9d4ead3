# SPDX-License-Identifier: BSD-3-Clause
"""Friction on faces of the box, against Coulomb's law in closed forms."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import mpm3dpp, write
from mpm3dpp import Case, Simulation
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import read_history

G = 9.81
BLOCK = """
[grid]
dimension = {dimension}
cell_size = "10 mm"
basis = "{basis}"
[grid.box]
lower = [{zeros}]
upper = ["1 m", "200 mm"{more}]
walls = {{ y_min = "contact" }}
friction = {friction}
[run]
end_time = "{end}"
gravity = [{gravity}]
{run}
[output]
frames = 10
[material.rubber]
density = "1000 kg/m^3"
strength = {{ neo_hookean = {{ K = "1 MPa", G = "0.4 MPa" }} }}
[body.block]
material = "rubber"
shape = {{ box = {{ lower = [{low}], upper = [{high}] }} }}
velocity = [{velocity}]
"""


def block(
    dimension: int = 2,
    basis: str = "quadratic_bspline",
    friction: Any = 0.3,
    slope: float = 0.0,
    speed: float = 1.0,
    end: str = "0.2 s",
    run: str = "",
) -> str:
    """Return the text of a case of a block on the floor, under gravity that is turned by a slope.

    In 3D gravity and the velocity have the same angle of 0.6 with the x axis about the y axis.
    """

    def vector(along: float, up: float) -> str:
        if dimension == 2:
            return f"{along}, {up}"
        return f"{along * math.cos(0.6)}, {up}, {along * math.sin(0.6)}"

    def corner(*values: float) -> str:
        return ", ".join(str(v) for v in values[:dimension])

    return BLOCK.format(
        dimension=dimension,
        basis=basis,
        zeros=corner(0, 0, 0),
        more=', "1 m"' if dimension == 3 else "",
        friction=friction,
        end=end,
        run=run,
        gravity=vector(G * math.sin(slope), -G * math.cos(slope)),
        low=corner(0.1, 0.0, 0.1),
        high=corner(0.2, 0.06, 0.2),
        velocity=vector(speed, 0.0),
    )


def along(values: np.ndarray, dimension: int) -> np.ndarray:
    """The part of vectors along the direction that `block` slides in."""
    if dimension == 2:
        return values[..., 0]
    return values[..., 0] * math.cos(0.6) + values[..., 2] * math.sin(0.6)


def history(tmp_path: Path, text: str) -> dict[str, np.ndarray]:
    write(tmp_path, text)
    done = mpm3dpp("run", "case.toml", "--out", "out", "--no-pictures", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    return read_history(tmp_path / "out")


def momentum(rows: dict[str, np.ndarray], dimension: int) -> np.ndarray:
    return along(np.stack([rows[f"momentum_{a}"] for a in "xyz"], axis=-1), dimension)


@pytest.mark.parametrize(
    ("dimension", "basis"),
    [
        (2, "quadratic_bspline"),
        (2, "gimp"),
        (2, "linear"),
        pytest.param(3, "quadratic_bspline", marks=pytest.mark.slow),
    ],
)
def test_a_block_slides_and_comes_to_rest(tmp_path: Path, dimension: int, basis: str) -> None:
    """It slows down by mu g and stops after v / (mu g), 0.34 s: 2.5 % of the speed at the start.

    It shakes under its weight, which is there at once, and its trailing edge lifts a little; so the
    force is that of the law in the mean, and the end comes within some of its shear waves. Where
    the wall stops it in place of springs it is lifted more, and creeps on as it shakes.
    """
    rows = history(tmp_path, block(dimension, basis, end="0.5 s"))
    speed = momentum(rows, dimension) / momentum(rows, dimension)[0]
    time = rows["time"]
    expected = np.maximum(1.0 - 0.3 * G * time, 0.0)
    springs = basis == "quadratic_bspline"
    assert np.abs(speed - expected).max() < 0.025
    assert abs(speed[time > 0.45].mean()) < (2e-3 if springs else 0.01)
    kinetic = 0.5 * momentum(rows, dimension)[0]  # m v^2 / 2, 1 m/s
    assert rows["friction"][-1] == pytest.approx(kinetic, rel=0.03)
    assert np.abs(rows["residual"]).max() < 1e-10 * kinetic
    assert np.diff(rows["friction"]).min() > -1e-5 * kinetic  # Where it turns round within a step.


@pytest.mark.parametrize("run", ["", 'transfer = "flip"', 'transfer = "apic"', 'transfer = "pic"'])
def test_the_force_is_mu_times_the_pressure(tmp_path: Path, run: str) -> None:
    """Of the floor as a whole, in each row while the block slides: to rounding, but for PIC's.

    Transfers that take the grid's velocity change momentum at nodes that are mapped before contact
    and forces are known. What presses is as large to 1e-6 of the weight.
    """
    rows = history(tmp_path, block(end="0.1 s", run=run))
    pressing, rubbing = rows["wall_y_min_force_y"], rows["wall_y_min_force_x"]
    told = ~np.isnan(pressing)
    assert told.sum() > 5
    assert rubbing[told] == pytest.approx(-0.3 * pressing[told], abs=1e-6 * 60.0)


def test_a_block_in_a_corner(tmp_path: Path) -> None:
    """It is pushed against the wall by its weight's part there, without friction but on the floor.

    Each face has its own force: the wall that of the slope, the floor the weight's other part, and
    friction, which is none once all is at rest. 1 % of the weight.
    """
    text = block(
        slope=math.radians(-30.0),
        speed=0.0,
        friction="{ y_min = 0.3, x_min = 0 }",
        end="0.02 s",
        run='settle = { longest = "2 s" }',
    ).replace('{ y_min = "contact" }', '{ y_min = "contact", x_min = "contact" }')
    text = text.replace("[0.1, 0.0]", "[0.0, 0.0]")
    text = text.replace("upper = [0.2, 0.06]", "upper = [0.1, 0.06]")
    rows = history(tmp_path, text)
    told = ~np.isnan(rows["wall_y_min_force_y"])
    last = {name: rows[f"wall_{name}"][told][-1] for name in ("x_min_force_x", "y_min_force_y")}
    weight = 6.0 * G
    assert last["y_min_force_y"] == pytest.approx(-weight * math.cos(math.radians(30)), rel=0.01)
    # What friction of the floor takes is not the wall's: together they hold the slope's part.
    rubbed = rows["wall_y_min_force_x"][told][-1]
    assert abs(rubbed) < 0.31 * -last["y_min_force_y"]
    both = last["x_min_force_x"] + rubbed
    assert both == pytest.approx(-weight * math.sin(math.radians(30)), rel=0.01)
    assert abs(rows["wall_x_min_force_y"][told][-1]) < 1e-6 * weight  # no friction there


@pytest.mark.parametrize("dimension", [2, pytest.param(3, marks=pytest.mark.slow)])
@pytest.mark.parametrize(("slope", "slides"), [(15.0, False), (20.0, True)])
def test_a_slope_holds_what_is_less_steep_than_the_friction_angle(
    tmp_path: Path, dimension: int, slope: float, slides: bool
) -> None:
    """tan 16.7 degrees = 0.3: at 20 degrees it runs down with g (sin - mu cos), at 15 it stays.

    Settled first, so that it lies on the slope and does not fall on it. 3 % of the speed that it
    has without friction.
    """
    angle = math.radians(slope)
    text = block(dimension, slope=angle, speed=0.0, end="0.2 s", run='settle = { longest = "1 s" }')
    rows = history(tmp_path, text)
    mass = 6.0 if dimension == 2 else 0.6
    speed = momentum(rows, dimension)[-1] / mass
    free = G * math.sin(angle) * 0.2
    expected = G * (math.sin(angle) - 0.3 * math.cos(angle)) * 0.2 if slides else 0.0
    assert speed == pytest.approx(expected, abs=0.03 * free)


def test_a_disc_begins_to_roll(tmp_path: Path) -> None:
    """Thrown along the floor it slides until it rolls, at two thirds of its speed (a sphere: 5/7).

    After v / (3 mu g) = 0.11 s (Coriolis 1835). It turns against the clock where it goes to the
    left. 3 %: it is soft, and stands on some cells.
    """
    text = block(speed=-1.0, end="0.2 s", friction=0.3)
    before, _, after = text.partition("shape = ")
    text = f'{before}shape = {{ disc = {{ centre = [0.7, 0.06], radius = "60 mm" }} }}\n'
    text += after.partition("\n")[2]
    rows = history(tmp_path, text)
    last = rows["time"] > 0.15
    mass = 1000.0 * math.pi * 0.06**2
    speed = rows["momentum_x"][last].mean() / mass
    assert speed == pytest.approx(-2 / 3, rel=0.03)
    assert np.nanmean(rows["body_block_spin_z"][last]) == pytest.approx(2 / 3 / 0.06, rel=0.03)
    lost = 0.5 * mass / 3.0  # m v^2 / 2 (1 - 2/3)
    assert rows["friction"][-1] == pytest.approx(lost, rel=0.1)


def test_one_number_is_of_all_faces_that_touch() -> None:
    text = block(friction=0.3).replace(
        'y_min = "contact"', 'y_min = "contact", x_min = "contact", y_max = "fixed"'
    )
    grid = Case.from_text(text).grid
    assert grid.wall_friction(0.7) == (0.3, 0.0, 0.3, 0.0, 0.0, 0.0)
    again = Case.from_text(Case.from_text(text).text).grid
    assert again.wall_friction(0.7) == (0.3, 0.0, 0.3, 0.0, 0.0, 0.0)
    of_pairs = Case.from_text(block().replace("friction = 0.3\n", "")).grid
    assert of_pairs.wall_friction(0.7) == (0.0, 0.0, 0.7, 0.0, 0.0, 0.0)
    own = Case.from_text(block(friction="{ y_min = 0.0 }")).grid
    assert own.wall_friction(0.7) == (0.0,) * 6


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ("friction = -0.1", "grid.box.friction.y_min"),
        ('friction = "much"', "grid.box.friction.y_min"),
        ("friction = { x_max = 0.2 }", "is of a face that is free"),
        ("friction = { z_min = 0.2 }", "is of a face that is not there"),
        ("friction = { top = 0.2 }", "is not a known key"),
        ('friction = 0.3\nwalls = "fixed"', "needs a face of grid.box.walls that is contact"),
        ('friction = 0.3\nwalls = "slipp"', 'did you mean "slip"'),
        ("friction = true", "must be a table"),
    ],
)
def test_mistakes_are_told(given: str, said: str) -> None:
    text = block().replace("friction = 0.3\n", given + "\n")
    if "walls" in given:
        text = text.replace('walls = { y_min = "contact" }\n', "")
    with pytest.raises(CaseError, match=said):
        Case.from_text(text)


@pytest.mark.parametrize(
    ("height", "more", "said"),
    [
        ("20 mm", "", "both y faces, 2 cells apart"),
        ("80 mm", "coarsening = { tiles = 9 }", "1 cells apart, once they have doubled"),
        ("40 mm", "", None),
        ("120 mm", "coarsening = { tiles = 9, times = 2 }", None),
    ],
)
def test_faces_close_to_each_other(height: str, more: str, said: str | None) -> None:
    text = block().replace('"200 mm"', f'"{height}"').replace("[grid]\n", f"[grid]\n{more}\n")
    text = text.replace('y_min = "contact"', 'y_min = "contact", y_max = "contact"')
    if said is None:
        Case.from_text(text)
        return
    with pytest.raises(CaseError, match=said):
        Case.from_text(text)


SOFT = """
[body.soft]
material = "foam"
shape = { box = { lower = [0.8, 0.1], upper = [0.9, 0.2] } }
[material.foam]
density = "100 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
"""


def test_a_rigid_body_slides_and_check_says_so(tmp_path: Path) -> None:
    text = block(end="0.02 s").replace(
        'strength = { neo_hookean = { K = "1 MPa", G = "0.4 MPa" } }', "strength = { rigid = {} }"
    )
    text += SOFT
    write(tmp_path, text)
    done = mpm3dpp("check", "case.toml", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "body.block is rigid and slides on walls of the box without friction" in done.stdout
    simulation = Simulation(Case.from_text(text))
    simulation.advance(steps=100)
    assert simulation.column("block", "velocity")[:, 0] == pytest.approx(1.0, abs=1e-12)


BAR = """
[grid]
dimension = {dimension}
cell_size = "10 mm"
basis = "{basis}"
box = {{ lower = [{zeros}], upper = ["1 m", {sides}], walls = {{ x_min = "contact", {slips} }} }}
[run]
end_time = "15 ms"
[material.rubber]
density = "1000 kg/m^3"
strength = {{ elastic = {{ E = "10 MPa", nu = 0.3 }} }}
[body.bar]
material = "rubber"
shape = {{ box = {{ lower = [{low}], upper = [{high}] }} }}
velocity = [{velocity}]
"""


@pytest.mark.parametrize("basis", ["quadratic_bspline", "gimp", "linear"])
@pytest.mark.parametrize("dimension", [2, 3])
def test_a_bar_rebounds(tmp_path: Path, dimension: int, basis: str) -> None:
    """A bar that cannot widen hits a wall: it is pushed with rho c v A for 2 L / c, and flies back.

    (St. Venant 1883.) The wall yields by the compliance of an edge of a particle, half a cell in
    80, and fronts are rounded by the grid: 3 % of the force, 5 % of the time, and of the speed 4 %,
    which is what stays in the bar as vibration. Where it stops the nodes on its face, in place of
    springs, the energy of half a cell is lost, half a per cent of the speed.
    """
    sides = range(1, dimension)
    text = BAR.format(
        dimension=dimension,
        basis=basis,
        zeros=", ".join(["0"] * dimension),
        sides=", ".join(['"30 mm"' for _ in sides]),
        slips=", ".join(f'{"xyz"[a]}_{end} = "slip"' for a in sides for end in ("min", "max")),
        low=", ".join(["0.005"] + ["0" for _ in sides]),
        high=", ".join(["0.405"] + ["0.03" for _ in sides]),
        velocity=", ".join(["-1"] + ["0" for _ in sides]),
    )
    rows = history(tmp_path, text.replace("[run]\n", "[output]\nhistory_every = 1\n[run]\n"))
    c = math.sqrt(10e6 * 0.7 / (1.3 * 0.4) / 1000.0)
    area = 0.03 ** (dimension - 1)
    time, speed = rows["time"], rows["momentum_x"] / (1000.0 * 0.4 * area)
    lost = 0.04 if basis == "quadratic_bspline" else 0.045
    assert speed[-1] == pytest.approx(1.0, abs=lost)
    hit, lasts = 5e-3, 0.8 / c  # At 1 m/s it is 5 mm away: within the surface of its particles.
    middle = (time > hit + 0.3 * lasts) & (time < hit + 0.8 * lasts)
    slope = np.polyfit(time[middle], speed[middle], 1)[0]
    assert slope == pytest.approx(2.0 / lasts, rel=0.03)
    # The time for which it is pushed: that between a twentieth and 19 of the change of speed.
    first, last = (time[np.argmax(speed > s)] for s in (-0.9, 0.9))
    assert (last - first) / 0.9 == pytest.approx(lasts, rel=0.05)
    assert np.abs(rows["residual"]).max() < 1e-10 * 0.5 * 400.0 * area


@pytest.mark.parametrize(("wall", "height"), [("contact", 0.5 * 20.0 * 0.1**2), ("slip", 0.0)])
def test_a_rigid_body_may_leave(wall: str, height: float) -> None:
    """It lies on the floor for 0.1 s and is lifted then: by g t^2 / 2, if that touches it."""
    lift = "{ times = [0, 0.1, 0.1001, 1], values = [-20, -20, 20, 20] }"
    text = block(friction="{}", end="0.2 s").replace(f"-{G}", lift)
    text = text.replace('neo_hookean = { K = "1 MPa", G = "0.4 MPa" }', "rigid = {}").replace(
        'walls = { y_min = "contact" }', f'walls = {{ y_min = "{wall}" }}'
    )
    text += SOFT
    simulation = Simulation(Case.from_text(text.replace("velocity = [1.0, 0.0]\n", "")))
    low = simulation.column("block", "position")[:, 1].min()
    while simulation.time < 0.1:
        simulation.advance(10)
    assert simulation.column("block", "position")[:, 1].min() == pytest.approx(low, abs=1e-4)
    while simulation.time < 0.2 - 1e-9:
        simulation.advance(10)
    rise = simulation.column("block", "position")[:, 1].min() - low
    assert rise == pytest.approx(height, rel=0.02, abs=1e-4)


def test_a_sweep_counts_what_walls_take(tmp_path: Path) -> None:
    """m v^2 / 2 less what is left at 0.17 s, when it still slides; 3 %. And the floor's impulse."""
    write(tmp_path, block(end="0.17 s"))
    command = ["sweep", "case.toml", "--set", "grid.box.friction=0.15,0.3"]
    done = mpm3dpp(*command, "--number", "wall.y_min.impulse_y", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    table = np.genfromtxt(next(tmp_path.rglob("sweep.csv")), delimiter=",", names=True)
    names = {name.replace("_", "").replace(".", ""): name for name in table.dtype.names}
    work = table[names["frictionwork"]]
    assert work[1] == pytest.approx(3.0 * (1.0 - (1.0 - 0.3 * G * 0.17) ** 2), rel=0.03)
    assert 0.5 * work[1] < work[0] < work[1]
    given = table[names["wallyminimpulsey"]]
    assert given == pytest.approx(-6.0 * G * 0.17, rel=0.02)


def test_check_tells_of_springs_that_begin_without_a_force(tmp_path: Path) -> None:
    text = block(end="0.02 s", speed=0.0)
    text += 'initial = { stress = "geostatic" }\n'
    text = text.replace(
        'neo_hookean = { K = "1 MPa", G = "0.4 MPa" }', "elastic = { E = 1e6, nu = 0.3 }"
    )
    write(tmp_path, text)
    told = "faces of the box that are contact push only as it moves into them"
    assert told in " ".join(mpm3dpp("check", "case.toml", cwd=tmp_path).stdout.split())
    write(tmp_path, text.replace("[output]", 'settle = { longest = "5 s" }\n[output]'))
    assert told not in " ".join(mpm3dpp("check", "case.toml", cwd=tmp_path).stdout.split())
