# SPDX-License-Identifier: BSD-3-Clause
"""C7: a column of separate discs collapses on a rough floor and runs out."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from mpm3dpp import _core
from mpm3dpp.base.neighbours import near_pairs
from mpm3dpp.grains.packing import pack

from .figure import Figure, judge, report
from .points import ball, block
from .scene import Array, Scene

RADIUS, SPREAD = 0.01, 0.2  # mean radius [m], and by what share the radii differ from it
DENSITY, YOUNG, POISSON, FRICTION, GRAVITY = 1000.0, 5e5, 0.3, 0.5, 9.81
SETTLE = 0.3  # [s]
LAW = 1.2
"""Run-out (L - L0) / L0 over the aspect H0 / L0, which is below 2.3 (Lube et al. 2005) or 3
(Lajeunesse et al. 2005)."""
GATE_SPEED = 4.0  # [m/s]: twice that of the discs that follow it


@dataclass(frozen=True)
class Column:
    """Discs behind a gate, ready to run.

    Attributes:
        scene: with the discs as its first bodies, then the floor and the gate.
        radii: of the discs [m], shape (n,).
        width: of the column, L0 [m].
    """

    scene: Scene
    radii: Array
    width: float

    def centres(self) -> Array:
        """Mass centres of the discs [m], shape (n, 2)."""
        core, discs = self.scene.core, range(len(self.radii))
        mass = [core.column(k, "mass") for k in discs]
        return np.array([(mass[k] * self.scene.x(k)).sum(0) / mass[k].sum() for k in discs])

    def front(self) -> float:
        """Where the deposit, followed from the wall, is first thinner than one layer of discs [m].

        Thinner means: less of discs than a row of touching ones of the mean diameter has, within
        three diameters. Discs that have rolled ahead one by one are thus left out.
        """
        x, area = self.centres()[:, 0], math.pi * self.radii**2
        width = 6 * RADIUS
        places = np.arange(width / 2, x.max() + width, 0.05 * RADIUS)
        there = np.abs(x - places[:, None]) < width / 2
        return float(places[np.argmax(there @ area / width < math.pi * RADIUS / 2)])

    def hanging_together(self) -> float:
        """How far the discs reach that touch others back to the heap [m].

        They count as touching when less than a tenth of the mean diameter is between them.
        """
        x, gap = self.centres(), 0.2 * RADIUS
        a, b = near_pairs(x, 2 * RADIUS * (1 + SPREAD) + gap)
        close = np.linalg.norm(x[a] - x[b], axis=1) < self.radii[a] + self.radii[b] + gap
        a, b = a[close], b[close]
        part = np.arange(len(x))  # the lowest number of those that hang together
        before = np.full_like(part, -1)
        while not np.array_equal(part, before):
            before = part.copy()
            least = np.minimum(part[a], part[b])
            np.minimum.at(part, a, least)
            np.minimum.at(part, b, least)
        heap = part == np.bincount(part).argmax()
        return float((x[:, 0] + self.radii)[heap].max())

    def height(self) -> float:
        """Of the highest disc's top [m]."""
        return float((self.centres()[:, 1] + self.radii).max())


def build(
    scheme: str, basis: str, discs: int, aspect: float, cells: float, threads: int = 2
) -> Column:
    """Pack discs in a column of about an aspect; `cells` are those of a mean diameter."""
    h = 2 * RADIUS / cells
    area = discs * math.pi * RADIUS**2 * (1 + SPREAD**2 / 3) / 0.8
    width = math.ceil(math.sqrt(area / aspect) / h) * h
    least, most = RADIUS * (1 - SPREAD), RADIUS * (1 + SPREAD)
    high = 1.15 * area / width
    centres, radii = pack((0.0, 0.0), (width, high), least, most, discs, 0.0, 0.1 * h, 1)
    scene = Scene(
        scheme, 2, basis, h, factor=0.4, friction=FRICTION, threads=threads,
        gravity=[0.0, -GRAVITY, 0.0], box=([0.0, -8 * h], [200 * h, 200 * h]),
        walls=("slip", "free", "free", "free"),
    )  # fmt: skip
    material = scene.material(DENSITY, "elastic", E=YOUNG, nu=POISSON)
    for centre, radius in zip(centres, radii, strict=True):
        x, volume = ball(centre, radius, h / 2)
        scene.body(material, x, [0.0, 0.0], volume)
    zero = _core.TimeFunction(0.0)
    bumps = [ball([(2 * k + 1) * RADIUS, -RADIUS], RADIUS, h / 2) for k in range(60)]
    x, volume = (np.concatenate(parts) for parts in zip(*bumps, strict=True))
    upper = x[:, 1] > -RADIUS
    floor = scene.body(material, x[upper], [0.0, 0.0], volume[upper])
    scene.core.set_motion(floor, [zero] * 3, [zero] * 3, [0.0] * 3)
    x, volume = block([width, 0.0], [width + 2 * h, 1.5 * high], h / 2)
    gate = scene.body(material, x, [0.0, 0.0], volume)
    times, speeds = [SETTLE, SETTLE + 1e-3], [0.0, GATE_SPEED]
    away = _core.TimeFunction(0.0, 0.0, 0.0, 0.0, times, speeds)
    scene.core.set_motion(gate, [away, zero, zero], [zero] * 3, [width, 0.0, 0.0])
    for k in range(discs):
        scene.core.set_friction(gate, k, 0.0)
        if k:
            scene.core.set_group(k, 0)
    scene.start()
    return Column(scene, radii, width)


def settle(column: Column, stops: int = 20) -> float:
    """Let the discs come to rest behind the gate; return the height of the column, H0 [m].

    It is twice the height of the centre of mass.
    """
    scene = column.scene
    for k in range(1, stops + 1):
        scene.run(SETTLE * k / stops)
        for disc in range(len(column.radii)):
            scene.core.set_velocity(disc, np.zeros_like(scene.v(disc)))
    area = column.radii**2
    return float(2 * (area * column.centres()[:, 1]).sum() / area.sum())


def run_out(
    scheme: str, dimension: int, basis: str, discs: int = 240, aspect: float = 1.0,
    cells: float = 4.0,
) -> list[Figure]:  # fmt: skip
    """C7: the gate goes away; the deposit after 4 (H0 / g)^(1/2), when it has all but stopped."""
    assert dimension == 2
    column = build(scheme, basis, discs, aspect, cells)
    high = settle(column)
    scene, aspect = column.scene, high / column.width
    scene.run(SETTLE + 4 * math.sqrt(high / GRAVITY))
    rows = scene.history()
    run, touching = (
        (end / column.width - 1) / aspect for end in (column.front(), column.hanging_together())
    )
    name, left = "height left over the first one", column.height() / high
    return [
        judge("C7", "run-out over the law's", run / LAW, remark=f"{run:.2f} a, a = {aspect:.2f}"),
        judge("C7", name, left) if aspect < 1.15 else report(name, left),
        report("run-out of discs less than d/10 apart, over the law's", touching / LAW),
        report("kinetic energy left, over the energy at rest", _speed(column) / (GRAVITY * high)),
        judge("C7", "energy residual over gravity's work",
              np.abs(rows["residual"]).max() / rows["external"].max()),
    ]  # fmt: skip


def _speed(column: Column) -> float:
    """Mean square of the velocities of the discs' centres [m^2/s^2]."""
    v = [column.scene.mean_velocity(k) for k in range(len(column.radii))]
    return float((column.radii**2 @ (np.array(v) ** 2).sum(1)) / (column.radii**2).sum())
