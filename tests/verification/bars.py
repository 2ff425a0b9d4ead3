# SPDX-License-Identifier: BSD-3-Clause
"""E2, E2b, the energy of a head-on rod impact, and E9b's five bars: waves and contact in a line."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .figure import Figure, judge
from .points import block
from .scene import Scene, on_time

RHO, E, LENGTH = 1000.0, 1e6, 0.5
PASSAGE = LENGTH / (E / RHO) ** 0.5  # time of a wave along a bar of unit length 0.5 [s]


def line_of_bars(
    scheme: str, dimension: int, basis: str, cells: int, lengths: Sequence[float],
    speeds: Sequence[float], factor: float, offset: float = 0.0, points: int = 2,
) -> Scene:  # fmt: skip
    """Touching bars in a row along x, two cells wide; `offset` of the row in cells."""
    h = LENGTH / cells
    wide = [2 * h] * (dimension - 1)
    room = 2 * LENGTH
    scene = Scene(
        scheme, dimension, basis, h, factor=factor,
        box=([-room - offset * h, *[0.0] * (dimension - 1)],
             [sum(lengths) + room - offset * h, *wide]),
        walls=("free", "free", *["slip"] * 4),
    )  # fmt: skip
    material, start = scene.material(RHO, "elastic", E=E, nu=0.0), 0.0
    for length, speed in zip(lengths, speeds, strict=True):
        low = [start, *[0.0] * (dimension - 1)]
        x, volume = block(low, [start + length, *wide], h / points)
        scene.body(material, x, [speed, 0.0, 0.0], volume)
        start += length
    return scene.start()


def two_bars(
    scheme: str, dimension: int, basis: str, cells: int = 50, speed: float = 1.0,
    factor: float = 0.25, points: int = 2,
) -> list[Figure]:  # fmt: skip
    """E2: two equal bars, the first at speed v against rest; stress and velocities over v."""
    scene = line_of_bars(
        scheme, dimension, basis, cells, [LENGTH] * 2, [speed, 0.0], factor, 0.0, points
    )
    return two_bars_figures(scene, cells, speed)


def two_bars_figures(scene: Scene, cells: int, speed: float) -> list[Figure]:
    """Let the bars of E2 meet and part, and return the figures."""
    area = (2 * LENGTH / cells) ** (scene.dimension - 1)
    said = scene.run(
        2.6 * PASSAGE,
        lambda s: [s.time, -s.impulse()[0], *(s.mean_velocity(k)[0] for k in (0, 1))],
        2,
    )
    t, impulse = said[:, 0], said[:, 1] / area / speed
    # Mean over the middle of the contact, so that the ringing of its ends does not count.
    inner = np.interp([0.3 * PASSAGE, 1.7 * PASSAGE], t, impulse)
    begin, end = on_time(t, impulse)
    return [
        judge("E2", "contact stress", (inner[1] - inner[0]) / (1.4 * PASSAGE)),
        judge("E2", "contact lasts", end - begin),
        judge("E2", "first bar's velocity after", said[-1, 2] / speed),
        judge("E2", "second bar's velocity after", said[-1, 3] / speed),
        scene.energy_figure(),
    ]


def unequal_bars(
    scheme: str, dimension: int, basis: str, cells: int = 25, factor: float = 0.25,
    offsets: Sequence[float] = (0.0, 0.25, 0.5, 0.75), speed: float = 1.0,
) -> list[Figure]:  # fmt: skip
    """E2b: the second bar twice as long; the worst over offsets of the contact within a cell."""
    row = scheme, dimension, basis, cells, [LENGTH, 2 * LENGTH], [speed, 0.0], factor
    return unequal_bars_figures({offset: line_of_bars(*row, offset) for offset in offsets}, speed)


def unequal_bars_figures(scenes: dict[float, Scene], speed: float) -> list[Figure]:
    """Let the bars of E2b part at each offset [cells], and return the worst figures of all."""
    first, second, energy = [], [], []
    for scene in scenes.values():
        scene.run(4.6 * PASSAGE)
        first.append(scene.mean_velocity(0)[0] / speed)
        second.append(scene.mean_velocity(1)[0] / speed)
        h = scene.history()
        inside = h["kinetic"] + h["internal"]
        energy.append(inside[-1] / inside[0])
    worst = max(second, key=lambda v: abs(v - 0.5))
    return [
        judge(
            "E2b",
            "second bar's mean velocity over v",
            worst,
            remark=f"offsets {tuple(scenes)} cells",
        ),
        judge("E2b", "first bar's velocity over v", max(first, key=abs)),
        judge("E2b", "energy after over before", max(energy, key=lambda e: abs(e - 1.0))),
    ]


def rod_energy(
    scheme: str, dimension: int, basis: str, cells: int = 50, factor: float = 0.5,
    speed: float = 1.0,
) -> list[Figure]:  # fmt: skip
    """Two equal rods head-on at v/2 each: they part with all their kinetic energy."""
    scene = line_of_bars(
        scheme, dimension, basis, cells, [LENGTH] * 2, [speed / 2, -speed / 2], factor
    )
    return rod_figures(scene)


def rod_figures(scene: Scene) -> list[Figure]:
    """Let two equal rods meet and part, and return the figures."""
    scene.run(2.6 * PASSAGE)
    kinetic = scene.history()["kinetic"]
    mass = scene.core.total_mass / 2
    bulk = sum(mass * scene.mean_velocity(k)[0] ** 2 / 2 for k in (0, 1))
    return [
        judge("rod", "kinetic energy after over before", kinetic[-1] / kinetic[0],
              remark=f"that of the mean velocities alone: {bulk / kinetic[0]:.4f}"),
    ]  # fmt: skip


def five_bars(
    scheme: str, dimension: int, basis: str, cells: int = 25, factor: float = 0.25,
    speed: float = 1.0,
) -> list[Figure]:  # fmt: skip
    """E9b: five equal touching bars, the first at v: the last leaves with v, the others rest."""
    scene = line_of_bars(
        scheme, dimension, basis, cells, [LENGTH] * 5, [speed, 0.0, 0.0, 0.0, 0.0], factor
    )
    return five_bars_figures(scene, speed)


def five_bars_figures(scene: Scene, speed: float) -> list[Figure]:
    """Let a wave pass five bars, and return the figures."""
    before = scene.core.total_mass / 5 * speed
    scene.run(6.0 * PASSAGE)
    v = [scene.mean_velocity(k)[0] / speed for k in range(5)]
    momentum = scene.history()["momentum_x"]
    return [
        judge("E9b bars", "last bar's velocity over v", v[4]),
        judge("E9b bars", "largest velocity of the others over v", max(v[:4], key=abs)),
        judge("E9b bars", "momentum, largest change over the start",
              np.abs(momentum / before - 1.0).max()),
        judge("E9b bars", "energy made over the start", scene.energy_made()),
    ]  # fmt: skip
