# SPDX-License-Identifier: BSD-3-Clause
"""A case in another world: mirrored, turned, with other axes, or with other numbers.

What a world does to a case is exact: coordinates change sign or place, and bodies and particles
their order. So a run there differs from the one here by the rounding of sums alone.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp import Body, Case, GridBox, Particles, Simulation, Walls
from mpm3dpp.base.expression import Expression
from mpm3dpp.case.box import WallFriction
from mpm3dpp.case.loads import Load

Array = NDArray[np.float64]
PLACES = {
    6: ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1)),
    4: ((0, 0), (1, 1), (2, 2), (0, 1)),
}
"""Places of the numbers of a symmetric tensor, in the order of the columns: 4 in plane strain."""


@dataclass(frozen=True)
class World:
    """Another world.

    Attributes:
        axes: which axis here becomes axis k there, and its sign: ((1, -1), (0, 1)) is a quarter
            turn, x' = -y and y' = x.
        reversed_bodies: bodies are numbered from the last to the first.
        shuffled: particles of each body are numbered in a random order.
    """

    axes: tuple[tuple[int, int], ...]
    reversed_bodies: bool = False
    shuffled: bool = False

    def matrix(self) -> Array:
        """Q of x' = Q x, shape (D, D)."""
        q = np.zeros((len(self.axes),) * 2)
        for k, (axis, sign) in enumerate(self.axes):
            q[k, axis] = sign
        return q

    def order(self, particles: int) -> NDArray[np.int64]:
        """Which particle here is number k there, shape (n,)."""
        random = np.random.default_rng(1)
        return random.permutation(particles) if self.shuffled else np.arange(particles)

    def case(self, here: Case, filled: Simulation) -> Case:
        """The case there; `filled` is the simulation of the case here, before its first step."""
        q, d = self.matrix(), here.grid.dimension
        names = sorted(filled.bodies, reverse=True) if self.reversed_bodies else filled.bodies
        bodies = {}
        for name in names:
            part = filled.parts[filled.bodies.index(name)]
            entry: Any = here.grains[part] if part in here.grains else here.body[part]
            positions = filled.column(name, "position")
            density = here.material[entry.material].density
            volumes = filled.column(name, "mass")[:, 0] / density
            there = self.order(len(positions))
            velocities = (filled.column(name, "velocity") @ q.T)[there]
            bodies[name] = Body(
                material=entry.material,
                particles=Particles((positions @ q.T)[there], volumes[there], velocities),
                initial=entry.initial if isinstance(entry, Body) else None,  # geostatic ones
                body_force=self._force(entry.body_force),
                damping=entry.damping,
                frame=entry.frame,
            )
        grid = here.grid.model_copy(update={"box": self._box(here)})
        gravity = tuple((q @ np.array([float(g) for g in here.run.gravity or (0.0,) * d])).tolist())
        return Case(
            grid=grid,
            run=here.run.model_copy(update={"gravity": gravity}),
            contact=here.contact,
            material=here.material,
            body=bodies,
            load={name: self._load(load) for name, load in here.load.items()},
        )

    def _load(self, load: Load) -> Load:
        """A load there: those at points, of forces that are numbers."""
        point, force = (self.matrix() @ np.array(v, dtype=float) for v in (load.point, load.force))
        return Load(body=load.body, point=tuple(point), force=tuple(force))

    def _force(self, force: Any) -> Any:
        """A body force there: its components, as formulas of the places there."""
        if force is None:
            return None
        names = {}  # What a place here is there: x = -y', say.
        for k, (axis, sign) in enumerate(self.axes):
            for letters in ("xyz", "XYZ"):
                names[letters[axis]] = f"({sign}*{letters[k]})"
        texts = [value.text if isinstance(value, Expression) else repr(value) for value in force]
        return [
            {"expression": f"{sign}*({_renamed(texts[axis], names)})"} for axis, sign in self.axes
        ]

    def _box(self, here: Case) -> GridBox | None:
        box = here.grid.box
        if box is None:
            return None
        sides, friction = {}, {}
        lower, upper = [], []
        for k, (axis, sign) in enumerate(self.axes):
            faces = [getattr(box.walls, f"{'xyz'[axis]}_{end}") for end in ("min", "max")]
            rubs = [getattr(box.friction, f"{'xyz'[axis]}_{end}") for end in ("min", "max")]
            sides[f"{'xyz'[k]}_min"], sides[f"{'xyz'[k]}_max"] = faces[::sign]
            friction[f"{'xyz'[k]}_min"], friction[f"{'xyz'[k]}_max"] = rubs[::sign]
            low, high = sorted((sign * box.lower[axis], sign * box.upper[axis]))
            lower.append(low)
            upper.append(high)
        return GridBox(
            lower=lower, upper=upper, walls=Walls(**sides), friction=WallFriction(**friction)
        )

    def seen_from_here(self, column: Array, name: str = "") -> Array:
        """A column of a body there, as it would be here."""
        q = self.matrix()
        d, components = len(q), column.shape[1] if column.ndim > 1 else 1
        back = np.empty_like(column)
        back[self.order(len(column))] = column
        if components == d:
            return back @ q
        if name in ("affine_velocity", "deformation_gradient"):  # which are not symmetric
            gradient: Array = q.T @ back.reshape(-1, d, d) @ q
            return gradient.reshape(len(back), -1)
        if components in PLACES:
            places = PLACES[components]
            whole = np.eye(3)
            whole[:d, :d] = q
            tensor = np.zeros((len(back), 3, 3))
            for k, (i, j) in enumerate(places):
                tensor[:, i, j] = tensor[:, j, i] = back[:, k]
            tensor = whole.T @ tensor @ whole
            return np.stack([tensor[:, i, j] for i, j in places], axis=1)
        assert components == 1, "a column that no test has had yet"
        return back


def _renamed(text: str, names: dict[str, str]) -> str:
    return re.sub(r"\b[xyzXYZ]\b", lambda found: names[found.group()], text)


def largest_differences(here: Simulation, there: Simulation, world: World) -> dict[str, float]:
    """Of each column the largest difference of two runs over its largest size in any body here."""
    sizes: dict[str, float] = {}
    apart: dict[str, float] = {}
    for number, name in enumerate(here.bodies):
        for column in here.core.columns(number):
            if column.name == "surface_opposite":
                continue  # the number of a body
            mine = here.column(name, column.name)
            theirs = world.seen_from_here(there.column(name, column.name), column.name)
            sizes[column.name] = max(sizes.get(column.name, 0.0), float(np.abs(mine).max()))
            difference = float(np.abs(mine - theirs).max())
            apart[column.name] = max(apart.get(column.name, 0.0), difference)
    return {name: apart[name] / (sizes[name] or 1.0) for name in apart}


X, Y, Z = 0, 1, 2
# Those that it and all others are made of, by doing one after another.
GENERATING = {
    2: [
        World(((X, -1), (Y, 1)), shuffled=True),
        World(((Y, -1), (X, 1)), reversed_bodies=True),
    ],
    3: [
        World(((X, -1), (Y, 1), (Z, 1)), shuffled=True),
        World(((Y, 1), (Z, 1), (X, 1)), reversed_bodies=True),
    ],
}
# Mirrored, turned and numbered anew at once.
COMPOSED = {
    2: [World(((Y, 1), (X, 1)), reversed_bodies=True, shuffled=True)],
    3: [World(((Y, 1), (Z, -1), (X, 1)), reversed_bodies=True, shuffled=True)],
}


TOLERANCE = 1e-10


def check_worlds(
    case: Case,
    steps: int,
    text: str,
    meet: bool = True,
    worlds: dict[int, list[World]] = COMPOSED,
) -> None:
    """Run a case, and the same in other worlds, and compare."""
    filled, here = Simulation(case), Simulation(case)
    here.advance(steps)
    assert here.step == steps
    assert (here.core.contact_summary()["overlapped_nodes"] > 50) == meet
    assert "erode" not in text or here.eroded()["count"] > 0
    for world in worlds[case.grid.dimension]:
        there = Simulation(world.case(case, filled))
        there.advance(steps)
        apart = largest_differences(here, there, world)
        assert max(apart.values()) <= TOLERANCE, (world, apart)
