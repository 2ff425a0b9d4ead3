# SPDX-License-Identifier: BSD-3-Clause
"""The benchmarks: particles that strain and cross cells. SI units.

Each is a case, which says nothing of numerics: these are what a user's case has.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.frames import UPDATED, particles_along
from mpm3dpp.case.case import Case
from mpm3dpp.ranks.world import World
from mpm3dpp.run.simulation import Simulation

from . import debris, drum, spheres
from .numerics import CELL, DEFAULT, PER_AXIS, Numerics, case_of

Array = NDArray[np.float64]
Tables = dict[str, Any]

# Tables of a case.
ALUMINIUM: dict[str, Any] = {
    "density": 2700.0,
    "strength": {"elastic": {"E": 70e9, "nu": 0.3}},
}
# OFHC copper: Johnson & Cook 1983; shock data of Steinberg 1996.
COPPER: dict[str, Any] = {
    "density": 8960.0,
    "strength": {
        "johnson_cook": {
            "E": 124e9, "nu": 0.34, "A": 90e6, "B": 292e6, "n": 0.31, "C": 0.025, "m": 1.09,
            "T_melt": 1356.0, "cp": 383.0,
        }
    },
    "eos": {"mie_gruneisen": {"c0": 3940.0, "s": 1.49, "gamma0": 1.96}},
}  # fmt: skip
# A wave speed below that of the translation: the cloud of `debris` hardly feels its stress.
SOFT: dict[str, Any] = {**ALUMINIUM, "strength": {"elastic": {"E": 70e6, "nu": 0.3}}}
DIRECTION = (3.0, 2.0, 1.0)  # Of the translation: oblique to the grid.
# Speed of the translation [m/s]. With USL and the linear basis a particle that enters an empty cell
# moves a node of almost no mass, and the run is unstable within thirty steps. So with USL the
# bodies stay in place, and the figure holds no particles that cross cells.
SPEED = 190.0
BREATHING = 5.0  # Amplitude of the breathing mode along each axis [m/s].
YIELDING = 100.0  # The same where most particles shall yield; it turns from axis to axis.
# Speed of each cube towards the other [m/s]. Elastic cubes part when the wave has crossed them and
# come back, after about 4 steps for each cell of the edge. At this speed they are then still so
# near that the nodes of the face stay overlapped to the end: the cost is in finding the contact.
APPROACH = 2.0
FRICTION = 0.2
FOREVER = 1e9  # End time that no benchmark reaches [s].


def cubes(bench: Bench, size: int, translation: Array) -> Tables:
    """Return cubes (squares) side by side along x that fly, breathe, and approach each other.

    Breathing is v_a = A sin(pi (x_a - centre_a) / edge): smooth, of no momentum, and it strains
    every particle differently. Where particles shall yield it is inwards along x and outwards along
    the other axes.
    """
    edge, axes = size * CELL, "xyz"[: bench.dimension]
    amplitudes = YIELDING * np.array([-2.0, 1.0, 1.0]) if bench.state else np.full(3, BREATHING)
    bodies = {}
    for k in range(bench.bodies):
        lower, mean = edge * k * np.eye(bench.dimension)[0], translation.copy()
        mean[0] += APPROACH * (1 - 2 * k) if bench.bodies > 1 else 0.0
        velocity = [
            {"expression": f"{v:.17g} + {a} * sin(pi * ({x} - {middle:.17g}) / {edge:.17g})"}
            for v, a, x, middle in zip(mean, amplitudes, axes, lower + 0.5 * edge, strict=False)
        ]
        box = {"lower": lower.tolist(), "upper": (lower + edge).tolist()}
        bodies[f"body_{k}"] = {"material": "its", "shape": {"box": box}, "velocity": velocity}
    return {"body": bodies}


@dataclass(frozen=True)
class Bench:
    """A benchmark.

    Attributes:
        name: what the user types.
        about: one line for the user.
        dimension: 2 or 3.
        size: cells along the edge of a body, if the user gives none; of grains, how many.
        bodies: how many cubes (squares), side by side along x; 0 for grains.
        grain: particles of a grain in the updated frame, about.
        loose: whether the particles of the body lie apart at random (`debris`), as many as a cube
            of the given size has.
        flies: whether the bodies fly through the grid.
        contact: whether the bodies feel each other.
        twin: name of the benchmark that is measured in turn with this one, for their ratio.
        material: its table in a case.
        state: numbers that the material keeps for a particle besides its stress.
        law: name of the material in `operations.LAWS`.
        tables: gives the tables of bodies that are no cubes, of a size and the velocity at which
            they fly [m/s], and of what else the case has of its own.
    """

    name: str
    about: str
    dimension: int
    size: int
    bodies: int = 1
    grain: int = 0
    contact: bool = False
    twin: str = ""
    material: Tables = field(default_factory=lambda: ALUMINIUM)
    state: int = 0
    law: str = "elastic"
    loose: bool = False
    flies: bool = True
    tables: Callable[[int, Array], Tables] | None = None

    def particles(self, size: int, frame: str | None = None) -> int:
        """Return the number of particles of all bodies; of grains about how many."""
        if self.bodies == 0:
            finer = particles_along(frame or UPDATED, cells_a_radius=1.0) / PER_AXIS
            return round(self.grain * finer**self.dimension) * size
        return int(self.bodies * (PER_AXIS * size) ** self.dimension)

    def body_count(self, size: int) -> int:
        """Return the number of bodies."""
        return self.bodies or size

    def case(self, size: int, numerics: Numerics) -> Case:
        """Return the case of a size; see `numerics.case_of` for errors."""
        direction = np.array(DIRECTION[: self.dimension])
        speed = 0.0 if numerics.scheme == "usl" else SPEED
        translation = speed * direction / np.linalg.norm(direction)
        tables: Tables = {"run": {}, "material": {"its": self.material}}
        tables |= (self.tables or partial(cubes, self))(size, translation)
        tables["grid"] = {"dimension": self.dimension, "cell_size": CELL}
        tables["run"] |= {"end_time": FOREVER, "outside_limit": 1.0, "volume_limit": 1.0}
        tables["contact"] = {"enabled": self.contact, "friction": FRICTION}
        return case_of(tables, numerics)


BENCHES = {
    bench.name: bench
    for bench in (
        Bench("elastic2d", "a square that flies and breathes", 2, 360),
        Bench("elastic3d", "a cube that flies and breathes", 3, 40),
        Bench(
            "jc",
            "the same cube of Johnson-Cook and Mie-Grueneisen copper, yielding",
            3,
            40,
            twin="elastic3d",
            material=COPPER,
            state=3,
            law="johnson_cook",
        ),
        Bench(
            "debris",
            "loose particles in no order, which cross a cell every few steps",
            3,
            40,
            twin="elastic3d",
            material=SOFT,
            loose=True,
            tables=debris.tables,
        ),
        Bench(
            "two_cubes",
            "two cubes pressed together, contact with friction",
            3,
            32,
            bodies=2,
            contact=True,
            twin="two_cubes_apart",
        ),
        Bench("two_cubes_apart", "the same two cubes without contact", 3, 32, bodies=2),
        Bench(
            "spheres",
            "touching balls of 5 cells across, pressed together, contact with friction",
            3,
            1000,
            bodies=0,
            grain=spheres.PARTICLES,
            contact=True,
            twin="spheres_apart",
            tables=spheres.tables,
        ),
        Bench(
            "spheres_apart",
            "the same balls without contact",
            3,
            1000,
            bodies=0,
            grain=spheres.PARTICLES,
            tables=spheres.tables,
        ),
        Bench(
            "drum",
            "touching discs of 5.5 cells across in a drum that turns, contact with friction",
            2,
            1000,
            bodies=0,
            grain=drum.PARTICLES,
            contact=True,
            flies=False,
            tables=lambda count, _: drum.tables(count),
        ),
    )
}


def make(
    bench: Bench,
    size: int,
    threads: int = 1,
    numerics: Numerics = DEFAULT,
    world: World | None = None,
    ranks: int = 1,
) -> Any:
    """Return the core's simulation of a benchmark, ready to step.

    Args:
        bench: which one.
        size: cells along the edge of a body, or the number of grains.
        threads: how many.
        numerics: what is said of them.
        world: all processes that work on it.
        ranks: how many threads do as ranks, without any `world`.
    """
    return Simulation(bench.case(size, numerics), threads, ranks=ranks, world=world).core
