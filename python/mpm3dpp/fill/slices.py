# SPDX-License-Identifier: BSD-3-Clause
"""Bodies of which several processes have filled a slice each: what they know of them together."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.parts import equal_part
from mpm3dpp.ranks.world import World

from .parts import Array, Particles, Slice, Survey


def number_of_all(count: int, world: World | None) -> int:
    """Return the sum of a number that each process has."""
    sums = np.array([count])
    if world is not None:
        world.all_sum(sums)
    return int(sums[0])


def survey_of_slices(particles: Particles, world: World) -> tuple[Survey, Slice]:
    """Return what is to be known of a body, and where a slice of it is among all its particles."""
    positions, velocities = particles.positions, particles.velocities
    count, dimension = positions.shape
    lower = positions.min(axis=0, initial=np.inf)
    upper = positions.max(axis=0, initial=-np.inf)
    speed = np.sqrt(np.einsum("ij,ij->i", velocities, velocities).max(initial=0.0))
    volume = particles.volumes.max(initial=0.0)
    told = np.array(world.comm.allgather([count, *lower, *upper, speed, volume]))
    counts = told[:, 0].astype(np.int64)
    first = int(counts[: world.rank].sum())
    seen = Survey(
        np.array([counts.sum()]),
        told[:, 1 : 1 + dimension].min(axis=0)[None],
        told[:, 1 + dimension : -2].max(axis=0)[None],
        np.array([told[:, -2].max()]),
    )
    return seen, Slice(first, float(told[:, -1].max()), particles)


def near_points(
    own: Slice, points: Array, reach: float, world: World
) -> tuple[NDArray[np.int64], Array]:
    """Return the particles of a body within reach of points: their numbers and positions.

    Args:
        own: the slice of this process.
        points: [m], shape (m, D).
        reach: [m].
        world: all processes; each calls this.
    """
    from scipy.spatial import cKDTree

    positions = own.particles.positions
    if len(positions) and len(points):
        away, _ = cKDTree(points).query(positions, distance_upper_bound=reach)
        near = np.flatnonzero(np.isfinite(away))
    else:
        near = np.zeros(0, dtype=np.int64)
    told = world.comm.allgather((own.first + near, positions[near]))
    return (
        np.concatenate([numbers for numbers, _ in told]),
        np.concatenate([places for _, places in told]),
    )


def strips(
    first: Array, second: Array, corners: tuple[Array, Array], distance: float, world: World
) -> tuple[Array, Array]:
    """Return of two sets of points, of which all processes have some, those of a strip of a box.

    Args:
        first: [m], shape (n, D). Those outside the strip by up to a distance come too.
        second: [m], shape (m, D).
        corners: of the box, in which the points are.
        distance: [m].
        world: all processes, each of which gets a strip; each calls this.
    """
    axis = int(np.argmax(corners[1] - corners[0]))
    low, high = corners[0][axis], corners[1][axis]
    cuts = [low + (high - low) * k / world.size for k in range(1, world.size)]
    edges = np.array([-np.inf, *cuts, np.inf])

    def exchanged(points: Array, more: float) -> Array:
        x = points[:, axis]
        out: list[Any] = [
            points[(x >= edges[k] - more) & (x < edges[k + 1] + more)] for k in range(world.size)
        ]
        return np.concatenate(world.comm.alltoall(out))

    return exchanged(first, distance), exchanged(second, 0.0)


def of_one(points: Array, world: World) -> Array:
    """Return the part of points that all processes have by which each of them is there once."""
    begin, end = equal_part(len(points), world.rank, world.size)
    return points[begin:end]
