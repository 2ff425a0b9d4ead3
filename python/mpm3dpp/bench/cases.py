# SPDX-License-Identifier: BSD-3-Clause
"""The benchmarks: particles that strain and cross cells. SI units.

Each has a case, which says nothing of numerics: these are what a user's case has. Only `drum` takes
its bodies from there; of the others they are lattices that are made here.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp import _core
from mpm3dpp.case.case import Case
from mpm3dpp.ranks.world import World
from mpm3dpp.run.core_settings import core_settings
from mpm3dpp.run.simulation import Simulation

from . import debris, drum, spheres
from .numerics import DEFAULT, Numerics, case_of

Array = NDArray[np.float64]

CELL = 1e-3  # [m]
PER_AXIS = 2  # Particles per cell along each axis.
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
SPEED = {"usf": 190.0, "musl": 190.0, "usl": 0.0}
BREATHING = 5.0  # Amplitude of the breathing mode along each axis [m/s].
YIELDING = 100.0  # The same where most particles shall yield; it turns from axis to axis.
# Speed of each cube towards the other [m/s]. Elastic cubes part when the wave has crossed them and
# come back, after about 4 steps for each cell of the edge. At this speed they are then still so
# near that the nodes of the face stay overlapped to the end: the cost is in finding the contact.
APPROACH = 2.0
FRICTION = 0.2
FOREVER = 1e9  # End time that no benchmark reaches [s].


@dataclass(frozen=True)
class Bench:
    """A benchmark.

    Attributes:
        name: what the user types.
        about: one line for the user.
        dimension: 2 or 3.
        size: cells along the edge of a body, if the user gives none; of grains, how many.
        bodies: how many cubes (squares), side by side along x; 0 for grains.
        loose: whether the particles of the body lie apart at random (`debris`), as many as a cube
            of the given size has.
        contact: whether the bodies feel each other.
        twin: name of the benchmark that is measured in turn with this one, for their ratio.
        material: its table in a case.
        state: numbers that the material keeps for a particle besides its stress.
        law: name of the material in `operations.LAWS`.
        whole: gives the tables of the case of a size, if the bodies are those of a case.
    """

    name: str
    about: str
    dimension: int
    size: int
    bodies: int = 1
    contact: bool = False
    twin: str = ""
    material: dict[str, Any] = field(default_factory=lambda: ALUMINIUM)
    state: int = 0
    law: str = "elastic"
    loose: bool = False
    whole: Callable[[int], dict[str, Any]] | None = None

    def particles(self, size: int) -> int:
        """Return the number of particles of all bodies; of a whole case about how many."""
        if self.whole is not None:
            return drum.PARTICLES * size
        if self.bodies == 0:
            return spheres.PARTICLES * size
        return int(self.bodies * (PER_AXIS * size) ** self.dimension)

    def body_count(self, size: int) -> int:
        """Return the number of bodies."""
        return self.bodies or size

    def case(self, size: int, numerics: Numerics) -> Case:
        """Return the case that says what the numerics are; see `numerics.case_of` for errors."""
        cell = {"box": {"lower": [0.0] * self.dimension, "upper": [CELL] * self.dimension}}
        tables: dict[str, Any] = {
            "run": {},
            "material": {"its": self.material},
            "body": {"its": {"material": "its", "shape": cell}},
        }
        if self.whole is not None:
            tables = self.whole(size)
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
            contact=True,
            twin="spheres_apart",
        ),
        Bench("spheres_apart", "the same balls without contact", 3, 1000, bodies=0),
        Bench(
            "drum",
            "touching discs of 5.5 cells across in a drum that turns, contact with friction",
            2,
            1000,
            bodies=0,
            contact=True,
            whole=drum.tables,
        ),
    )
}


def positions(dimension: int, size: int, body: int) -> Array:
    """Return the lattice of a body, shape (n, D) [m]; body k stands k edges along x.

    The array is filled in its final shape, so that making it takes no second one.
    """
    edge = PER_AXIS * size
    lattice = np.empty((edge,) * dimension + (dimension,))
    places = (np.arange(edge) + 0.5) * (CELL / PER_AXIS)
    for axis in range(dimension):
        shift = body * size * CELL if axis == 0 else 0.0
        lattice[..., axis] = _along(places + shift, axis, dimension)
    return lattice.reshape(-1, dimension)


def velocities(
    dimension: int, size: int, speed: float, approach: float = 0.0, yielding: bool = False
) -> Array:
    """Return translation + breathing + approach along x, shape (n, D) [m/s].

    Breathing is v_a = A sin(pi (x_a - centre_a) / edge): smooth, of no momentum, and it strains
    every particle differently. Where particles shall yield it is inwards along x and outwards along
    the other axes.
    """
    edge = PER_AXIS * size
    field = np.empty((edge,) * dimension + (dimension,))
    mode = BREATHING * np.sin(math.pi * ((np.arange(edge) + 0.5) / edge - 0.5))
    mean = _translation(dimension, speed)
    mean[0] += approach
    for axis in range(dimension):
        sign = (-2.0 if axis == 0 else 1.0) * YIELDING / BREATHING if yielding else 1.0
        field[..., axis] = _along(sign * mode + mean[axis], axis, dimension)
    return field.reshape(-1, dimension)


def _translation(dimension: int, speed: float) -> Array:
    """Return the velocity of the translation [m/s], shape (D,)."""
    direction = np.array(DIRECTION[:dimension])
    return np.asarray(speed * direction / np.linalg.norm(direction))


def _along(values: NDArray[Any], axis: int, dimension: int) -> NDArray[Any]:
    """Return values as an array that varies along one axis of a lattice only."""
    return values.reshape([-1 if a == axis else 1 for a in range(dimension)])


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
    case = bench.case(size, numerics)
    if bench.whole is not None:
        return Simulation(case, threads, ranks=ranks, world=world).core
    settings = core_settings(case, threads)
    settings.execution.ranks = ranks
    simulation = _core.Simulation(settings, world.for_core() if world else None)
    material = simulation.add_material(
        **case.material["its"].for_core(), viscosity=(0.0, 0.0), damping=0.0
    )
    speed = SPEED[case.run.scheme]
    volume = np.array([(CELL / PER_AXIS) ** bench.dimension])
    at_rest = np.zeros((1, bench.dimension))
    if bench.bodies == 0:
        _add_grains(simulation, material, size, volume, speed)
    if bench.loose:
        edge = debris.SPREAD * size * CELL
        place = debris.positions(bench.particles(size), edge)
        motion = debris.velocities(place, edge, _translation(3, speed))
        simulation.add_body("debris", material, place, motion, volume)
        simulation.prepare()
        return simulation
    # One array at a time: the core has its own copy, and both are counted in the peak.
    for body in range(bench.bodies):
        place = positions(bench.dimension, size, body)
        simulation.add_body(f"body {body}", material, place, at_rest, volume)
        del place
        approach = APPROACH * (1 - 2 * body) if bench.bodies > 1 else 0.0
        motion = velocities(bench.dimension, size, speed, approach, bench.state > 0)
        simulation.set_velocity(body, motion)
        del motion
    simulation.prepare()
    return simulation


def _add_grains(simulation: Any, material: int, count: int, volume: Array, speed: float) -> None:
    spacing = CELL / PER_AXIS
    ball, places = spheres.ball(spacing), spheres.centres(count, spacing)
    translation = _translation(3, speed)
    for body, centre in enumerate(places):
        points = ball + centre
        motion = spheres.velocities(points, places.mean(axis=0), spacing, translation)
        simulation.add_body(f"ball {body}", material, points, motion, volume)
