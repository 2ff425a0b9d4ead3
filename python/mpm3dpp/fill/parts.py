# SPDX-License-Identifier: BSD-3-Clause
"""The filled bodies of a case: what is known of all of them, and their particles when asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, overload

import numpy as np
from numpy.typing import NDArray

from .interference import Interference

Array = NDArray[np.float64]
Counts = NDArray[np.int64]

_AT_ONCE = 1 << 18  # Particles of grains that are made together.


@dataclass(frozen=True)
class Particles:
    """Those of some bodies, one body after another.

    Attributes:
        counts: how many each of m bodies has, shape (m,).
        positions: [m], shape (n, D).
        velocities: [m/s], shape (1, D) if all are equal by the case, else (n, D).
        volumes: of each [m^3; in 2D m^2 times 1 m], shape (n,).
    """

    counts: Counts
    positions: Array
    velocities: Array
    volumes: Array


@dataclass(frozen=True)
class FilledBody:
    """The particles of one body at the start.

    Attributes:
        name: of the body.
        part: its name in the case: of the entry of `grains` if it is a grain, else its own.
        material: name in the case.
        positions: [m], shape (n, D).
        velocities: [m/s], shape (1, D) if all are equal, else (n, D).
        volumes: [m^3; in 2D m^2 times 1 m], shape (n,).
        spacing: distance of neighbours [m], in shells about that.
        fill: "lattice", "faces" or "shells"; "" for particles given one by one.
        mass: sum over the particles [kg; in 2D per metre of thickness].
        shape_volume: the shape's volume [m^3; in 2D m^2]; None for particles given one by one.
        volume_is_exact: whether that is a closed form, else a fine lattice gave it.
        mass_error: mass / (density times shape_volume) - 1; 0 without a shape.
        ball: centre [m], shape (D,), and radius [m] of a grain; None for others.
    """

    name: str
    part: str
    material: str
    positions: Array
    velocities: Array
    volumes: Array
    spacing: float
    fill: str
    mass: float
    shape_volume: float | None
    volume_is_exact: bool
    mass_error: float
    ball: tuple[Array, float] | None = None


@dataclass(frozen=True)
class Survey:
    """What is known of each of m bodies without its particles.

    Attributes:
        counts: of their particles, shape (m,).
        lower, upper: least and largest coordinates of these [m], shape (m, D).
        speeds: of their fastest ones [m/s], shape (m,).
    """

    counts: Counts
    lower: Array
    upper: Array
    speeds: Array


@dataclass(frozen=True)
class Slice:
    """The particles of a body that one of several processes has filled.

    Attributes:
        first: number of the first of them in the body.
        volume: of each of the body's particles [m^3; in 2D m^2 times 1 m].
        particles: these.
    """

    first: int
    volume: float
    particles: Particles


@dataclass(frozen=True)
class FilledPart:
    """The bodies of an entry of a case at the start: one, or all the grains, m in number.

    Attributes:
        name: of the entry.
        material: name in the case.
        names: of the bodies, m of them.
        spacing: distance of neighbouring particles [m], in shells about that.
        fill: "lattice", "faces" or "shells"; "" for particles given one by one.
        survey: counts, places and speeds.
        volumes: of a particle of each, on average [m^3; in 2D m^2 times 1 m], shape (m,).
        masses: [kg; in 2D per metre of thickness], shape (m,).
        shape_volumes: [m^3; in 2D m^2], shape (m,); None for particles given one by one.
        volume_is_exact: whether these are a closed form, else a fine lattice gave them.
        mass_errors: mass / (density times shape volume) - 1, shape (m,); 0 without a shape.
        make: gives the particles of the bodies from one to the one before another.
        balls: centres [m], shape (m, D), and radii [m], shape (m,), of grains; None for others.
        own: of a body of which each of several processes has filled a slice, that of this one.
    """

    name: str
    material: str
    names: list[str]
    spacing: float
    fill: str
    survey: Survey
    volumes: Array
    masses: Array
    shape_volumes: Array | None
    volume_is_exact: bool
    mass_errors: Array
    make: Callable[[int, int], Particles]
    balls: tuple[Array, Array] | None = None
    own: Slice | None = None

    @property
    def count(self) -> int:
        """Number of the particles of all its bodies."""
        return int(self.survey.counts.sum())

    def chunks(self) -> Iterator[Particles]:
        """Yield the particles of all its bodies, or of a slice, those of some bodies at a time."""
        if self.own is not None:
            yield self.own.particles
            return
        for first, last in ranges(self.survey.counts):
            yield self.make(first, last)

    def share(self, first: int, last: int) -> Particles:
        """Return the particles of the bodies from one to the one before another, as one array."""
        counts = self.survey.counts[first:last]
        positions = np.empty((int(counts.sum()), self.survey.lower.shape[1]))
        velocities: list[Array] = []
        at = 0
        for a, b in ranges(counts):
            some = self.make(first + a, first + b)
            positions[at : at + len(some.positions)] = some.positions
            at += len(some.positions)
            velocities.append(some.velocities)
        alike = all(len(v) == 1 for v in velocities)
        return Particles(
            counts,
            positions,
            velocities[0] if velocities and alike else np.concatenate([*velocities, positions[:0]]),
            np.repeat(self.volumes[first:last], counts),
        )

    def body(self, k: int) -> FilledBody:
        """Return one of the bodies, with its particles."""
        some = self.make(k, k + 1)
        volumes, balls = self.shape_volumes, self.balls
        return FilledBody(
            name=self.names[k],
            part=self.name,
            material=self.material,
            positions=some.positions,
            velocities=some.velocities,
            volumes=some.volumes,
            spacing=self.spacing,
            fill=self.fill,
            mass=float(self.masses[k]),
            shape_volume=None if volumes is None else float(volumes[k]),
            volume_is_exact=self.volume_is_exact,
            mass_error=float(self.mass_errors[k]),
            ball=None if balls is None else (balls[0][k], float(balls[1][k])),
        )


class Filled(Sequence[FilledBody]):
    """All bodies of a case, in the order of their numbers: grains after the others.

    Attributes:
        parts: the entries of the case, by name, in the order of the bodies.
        interferences: which of them are drawn into each other.
    """

    def __init__(self, parts: list[FilledPart], interferences: Sequence[Interference] = ()) -> None:
        self.parts = {part.name: part for part in parts}
        self.interferences = list(interferences)

    def __len__(self) -> int:
        return sum(len(part.names) for part in self.parts.values())

    @overload
    def __getitem__(self, index: int) -> FilledBody: ...
    @overload
    def __getitem__(self, index: slice) -> list[FilledBody]: ...
    def __getitem__(self, index: int | slice) -> FilledBody | list[FilledBody]:
        """Return a body, whose particles are made for it."""
        if isinstance(index, slice):
            return [self[k] for k in range(*index.indices(len(self)))]
        left = index if index >= 0 else index + len(self)
        for part in self.parts.values() if left >= 0 else ():
            if left < len(part.names):
                return part.body(left)
            left -= len(part.names)
        raise IndexError(f"there are {len(self)} bodies")

    @property
    def particle_count(self) -> int:
        """Number of all particles."""
        return sum(part.count for part in self.parts.values())


def ranges(counts: NDArray[Any]) -> Iterator[tuple[int, int]]:
    """Yield ranges of bodies that have not too many particles together, one at least."""
    ends, first = np.cumsum(counts), 0
    while first < len(counts):
        before = ends[first - 1] if first else 0
        last = max(first + 1, int(np.searchsorted(ends, before + _AT_ONCE, "right")))
        yield first, last
        first = last


def survey(particles: Particles) -> Survey:
    """Return what is to be known of the bodies that these are of."""
    counts = particles.counts
    starts = np.cumsum(counts) - counts
    speeds = np.sqrt(np.einsum("ij,ij->i", particles.velocities, particles.velocities))
    one = len(speeds) == 1
    return Survey(
        counts,
        np.minimum.reduceat(particles.positions, starts, axis=0),
        np.maximum.reduceat(particles.positions, starts, axis=0),
        np.broadcast_to(speeds, counts.shape) if one else np.maximum.reduceat(speeds, starts),
    )


def joined(surveys: list[Survey]) -> Survey:
    """Return what is known of bodies that follow one another."""
    fields = ("counts", "lower", "upper", "speeds")
    return Survey(*(np.concatenate([getattr(one, name) for one in surveys]) for name in fields))
