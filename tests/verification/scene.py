# SPDX-License-Identifier: BSD-3-Clause
"""A small layer over the compiled core: bodies from points, walls by name, history by name."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from mpm3dpp import _core
from mpm3dpp.case import choices

from .figure import Figure, judge, report
from .numerics import Numerics

Array = np.ndarray


class Failed(RuntimeError):
    """The run has become unstable: the core's sentence."""


class Scene:
    """A simulation of bodies given by points, for problems that need more than a case file.

    Args:
        scheme: "usf", "usl" or "musl".
        dimension: 2 (plane strain) or 3.
        basis: "linear", or another basis that the core has; also with transfer and factor
            (numerics.py).
        cell_size: [m].
        factor: of the critical time step.
        box: lower corner [m] and upper corner [m] of the box of walls; whole cells.
        walls: of the box: "free", "slip" or "fixed", for x-, x+, y-, y+, z-, z+.
        gravity: [m/s^2].
        friction: coefficient of every pair.
        contact: are there contacts between bodies?
        settings: any other setting of the core's settings.
    """

    steps_made = 0  # of all scenes

    def __init__(
        self,
        scheme: str,
        dimension: int,
        basis: str,
        cell_size: float,
        *,
        factor: float = 0.25,
        box: tuple[Sequence[float], Sequence[float]] | None = None,
        walls: Sequence[str] = ("free",) * 6,
        gravity: Sequence[float] = (0.0, 0.0, 0.0),
        friction: float = 0.0,
        contact: bool = True,
        **settings: Any,
    ) -> None:
        s = _core.Settings()
        s.grid.dimension, s.grid.cell_size, s.run.scheme = dimension, cell_size, scheme
        Numerics.named(basis).give_core(s, factor)
        if box is not None:
            lower, upper = box
            cells = [round((u - o) / cell_size) for o, u in zip(lower, upper, strict=True)]
            s.grid.origin, s.grid.box_cells = _three(lower), [int(c) for c in _three(cells)]
        s.grid.walls = [*walls, *["free"] * 6][:6]
        s.run.gravity = _three(gravity)
        s.contact.enabled, s.contact.friction = contact, friction
        s.run.energy_growth_limit, s.run.outside_limit, s.run.volume_limit = 5.0, 1.0, 1.0
        planes = settings.get("normal_refresh_distance", 0.0) == 0.0
        if settings.get("detection", "gap") != "gap" or not planes:
            s.contact.response = choices.OTHER_RESPONSE  # As a case file has it.
        for name, value in settings.items():
            table = next(t for t in (s.grid, s.run, s.contact, s.execution) if hasattr(t, name))
            setattr(table, name, value)
        self.scheme, self.dimension, self.cell_size = scheme, dimension, cell_size
        self.core = _core.Simulation(s)
        self.rows: list[Array] = []

    def material(self, density: float, model: str, **parameters: float) -> int:
        """Add a material."""
        return self.core.add_material(
            density, model, parameters, eos=None, failures=[], viscosity=(0.0, 0.0),
            damping=0.0,
            volume_averaging=False,
        )  # fmt: skip

    def body(
        self, material: int, points: Array, velocity: Sequence[float] | Array, volume: Any
    ) -> int:
        """Add a body of points (n, D) [m] with one velocity or (n, D) [m/s], volumes [m^3]."""
        v = np.atleast_2d(np.asarray(velocity, dtype=float))[:, : self.dimension]
        volumes = np.atleast_1d(np.asarray(volume, dtype=float))
        name = f"body {self.core.body_count + 1}"
        return self.core.add_body(
            name, material, np.ascontiguousarray(points), np.ascontiguousarray(v), volumes
        )

    def start(self) -> Scene:
        """Close the list of bodies."""
        self.core.prepare()
        return self

    def step(self, steps: int, end: float = 1e30) -> int:
        """Make up to `steps` steps; return how many. Raises Failed."""
        made = self.core.advance(steps, end)
        Scene.steps_made += made
        self.rows.append(self.core.history())
        if self.core.failure is not None:
            raise Failed(self.core.failure.message)
        return made

    def run(self, end: float, watch: Callable[[Scene], Any] | None = None, every: int = 4000):
        """Step to a time [s]; return what `watch` said every so many steps, as an array."""
        said = []
        while self.core.time < end and self.step(every, end):
            if watch is not None:
                said.append(watch(self))
        return np.array(said)

    def settle(self, duration: float, normal: Sequence[float], full: Sequence[float]) -> None:
        """Come to rest under the normal part of gravity alone, then turn on the whole of it.

        A few times on the way, and at the end, all velocities are set to zero. A core without
        `set_gravity` gets the whole of gravity and has its bodies held along x at every step.
        """
        turn = hasattr(self.core, "set_gravity")
        if turn:
            self.core.set_gravity(_three(normal))
        start, bodies = self.time, range(self.core.body_count)
        for k in range(1, 9):
            end = start + duration * k / 8
            if turn:
                self.run(end)
            while self.time < end and self.step(1, end):
                for body in bodies:
                    v = self.v(body)
                    v[:, 0] = 0.0
                    self.core.set_velocity(body, v)
            for body in bodies:
                self.core.set_velocity(body, np.zeros_like(self.v(body)))
        if turn:
            self.core.set_gravity(_three(full))

    @property
    def time(self) -> float:
        """Time reached [s]."""
        return self.core.time

    def history(self) -> dict[str, Array]:
        """Return every step so far: columns of history.csv by name."""
        rows = np.concatenate(self.rows)
        return {name: rows[:, k] for k, name in enumerate(self.core.history_columns)}

    def x(self, body: int) -> Array:
        """Positions (n, D) [m]."""
        return self.core.column(body, "position")

    def v(self, body: int) -> Array:
        """Velocities (n, D) [m/s]."""
        return self.core.column(body, "velocity")

    def stress(self, body: int) -> Array:
        """Stresses (n, 6) [Pa]."""
        return self.core.column(body, "stress")

    def mean_velocity(self, body: int) -> Array:
        """Velocity of the centre of mass [m/s] of a body of one density, (D,)."""
        m = self.core.column(body, "mass")
        return (m * self.v(body)).sum(0) / m.sum()

    def impulse(self, pair: int = 0) -> Array:
        """Impulse of a pair so far [N s] on the first of its bodies, (3,); zero before contact."""
        pairs = self.core.contact_pairs()
        return np.array(pairs[pair].impulse if len(pairs) > pair else [0.0, 0.0, 0.0])

    def energy_made(self) -> float:
        """Largest rise of the mechanical energy above start and supply, over the start."""
        h = self.history()
        inside = h["kinetic"] + h["internal"] - h["external"]
        return float((inside - inside[0]).max() / (h["kinetic"] + h["internal"])[0])

    def energy_figure(self) -> Figure:
        """Return the energy that the numerics made: judged for MUSL, reported for the others."""
        name, made = "energy made over the start", self.energy_made()
        return judge("energy", name, made) if self.scheme == "musl" else report(name, made)


def _three(values: Sequence[float]) -> list[float]:
    return [*[float(v) for v in values], 0.0, 0.0, 0.0][:3]


def on_time(times: Array, values: Array) -> tuple[float, float]:
    """First and last time at which a growing impulse changes by more than rounding."""
    change = np.abs(np.diff(values)) > 1e-6 * np.abs(values[-1])
    at = np.flatnonzero(change)
    return float(times[at[0]]), float(times[at[-1] + 1])


def slope(times: Array, values: Array) -> float:
    """Slope of the straight line of least squares."""
    return float(np.polyfit(times, values, 1)[0])
