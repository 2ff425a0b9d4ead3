# SPDX-License-Identifier: BSD-3-Clause
"""E8 and E9: a block, a disc and a sphere on an inclined floor, with gravity turned instead."""

from __future__ import annotations

import math
from collections.abc import Callable

from .figure import Figure, judge, report
from .points import ball, block
from .scene import Array, Scene, slope

G, RHO, NU = 9.81, 1000.0, 0.3


def _floor(
    scheme: str, dimension: int, basis: str, h: float, length: float, width: float, angle: float,
    mu: float, factor: float, normal: str, modulus: float, thick: int = 2,
) -> tuple[Scene, int, list[float], list[float]]:  # fmt: skip
    """A floor `thick` cells deep, its top at 0, fixed below and at its ends."""

    up = dimension - 1
    lower = [0.0, *[-width / 2] * (dimension - 2), -thick * h]
    upper = [length, *[width / 2] * (dimension - 2), 0.0]
    walls = ["fixed", "fixed", *["slip"] * (2 * dimension - 4), "fixed", "free"]
    pull = [0.0] * dimension
    pull[up] = -G * math.cos(angle)
    full = [G * math.sin(angle), *pull[1:]]
    scene = Scene(
        scheme, dimension, basis, h, factor=factor, friction=mu, walls=walls,
        normal=normal, gravity=full,
        box=(lower, [*upper[:-1], upper[-1] + length]),
    )  # fmt: skip
    material = scene.material(RHO, "elastic", E=modulus, nu=NU)
    x, volume = block(lower, upper, h / 2)
    scene.body(material, x, [0.0] * 3, volume)
    return scene, material, pull, full


def slide(
    scheme: str, dimension: int, basis: str, angle: float, mu: float, duration: float = 0.5,
    across: int = 8, normal: str = "plane", factor: float = 0.25, settle: float = 0.4,
) -> tuple[Array, Array, Array, Scene]:  # fmt: skip
    """Slide a block 0.4 long, 0.2 high; return times, displacements and velocities."""
    h, radians = 0.4 / across, math.radians(angle)
    length = math.ceil((1.0 + 0.5 * G * math.sin(radians) * duration**2) / h) * h
    scene, material, pull, full = _floor(
        scheme, dimension, basis, h, length, 0.4 + 4 * h, radians, mu, factor, normal, 1e6
    )
    start = math.ceil(0.3 / h) * h
    side = [-0.2] * (dimension - 2), [0.2] * (dimension - 2)
    x0, volume = block([start, *side[0], 0.0], [start + 0.4, *side[1], 0.2], h / 2)
    a = scene.body(material, x0, [0.0] * 3, volume)
    scene.start().settle(settle, pull, full)
    return (*slid(scene, a, duration), scene)


def slid(scene: Scene, block: int, duration: float) -> tuple[Array, Array, Array]:
    """Let a block slide; return times, displacements and velocities."""
    begin, x0 = scene.time, scene.x(block)[:, 0].mean()
    said = scene.run(
        begin + duration,
        lambda s: [s.time - begin, s.x(block)[:, 0].mean() - x0, s.mean_velocity(block)[0]],
        20,
    )
    return said[:, 0], said[:, 1], said[:, 2]


def sliding_block(
    scheme: str, dimension: int, basis: str, across: int = 8, normal: str = "plane",
    factor: float = 0.25,
) -> list[Figure]:  # fmt: skip
    """E8: acceleration of sliding blocks."""
    more = {"across": across, "normal": normal, "factor": factor}
    return sliding_figures(lambda *about: slide(scheme, dimension, basis, *about, **more))


def sliding_figures(of: Callable[[float, float], tuple[Array, ...]]) -> list[Figure]:
    """Return E8's figures of what slides at an angle [degrees] with a friction."""
    figures = []
    for angle, mu in ((30, 0.1), (30, 0.3), (45, 0.2)):
        t, _, v, scene = of(angle, mu)
        pair = scene.core.contact_pairs()[0]
        figures.append(judge("E8", f"{angle} degrees, mu {mu}", slope(t, v),
                             remark=f"friction work {pair.friction_work:.4g} J"))  # fmt: skip
    return figures


def infinite_slope(scheme: str, dimension: int, basis: str, across: int = 8) -> list[Figure]:
    """C4: a block on a slope of 35 degrees with an angle of friction of 25 degrees."""
    t, _, v, _ = slide(scheme, dimension, basis, 35, math.tan(math.radians(25.0)), across=across)
    return [judge("C4", "acceleration", slope(t, v))]


def sticking_block(
    scheme: str, dimension: int, basis: str, across: int = 8, normal: str = "plane",
    factor: float = 0.25, duration: float = 1.0,
) -> list[Figure]:  # fmt: skip
    """E8: a block that must stay where it is."""
    t, u, v, _ = slide(scheme, dimension, basis, 20, 0.5, duration, across, normal, factor)
    return sticking_figures(t, u, v)


def sticking_figures(t: Array, u: Array, v: Array) -> list[Figure]:
    """Return E8's figures of a block at 20 degrees: of times, displacements and velocities."""
    free = 0.5 * G * math.sin(math.radians(20)) * t[-1] ** 2
    name = "20 degrees, mu 0.5 sticks: drift in 1 s over g sin t^2/2"
    return [judge("E8", name, u[-1] / free, remark=f"velocity at the end {v[-1]:.3g} m/s")]


def roll(
    scheme: str, dimension: int, basis: str, angle: float, mu: float, cells: int = 8,
    duration: float = 0.4, normal: str = "plane", factor: float = 0.25, modulus: float = 1e6,
) -> tuple[float, float]:  # fmt: skip
    """Roll a disc or sphere of radius 0.1 with `cells` a radius; return a and R alpha [m/s^2]."""
    radius = 0.1
    h, radians = radius / cells, math.radians(angle)
    length = math.ceil((4 * radius + 0.5 * G * math.sin(radians) * duration**2) / h) * h
    width = 12 * h if dimension == 3 else 0.0
    scene, material, pull, full = _floor(
        scheme, dimension, basis, h, length, width, radians, mu, factor, normal, modulus
    )
    centre = [2 * radius, *[0.0] * (dimension - 2), radius]
    x, volume = ball(centre, radius, h / 2)
    a = scene.body(material, x, [0.0] * 3, volume)
    scene.start().settle(0.2, pull, full)
    return rolled(scene, a, radius, duration)


def rolled(scene: Scene, body: int, radius: float, duration: float) -> tuple[float, float]:
    """Let a disc or sphere roll; return a and R alpha [m/s^2]."""
    begin = scene.time

    def watch(s: Scene) -> list[float]:
        x, v = s.x(body)[:, [0, -1]], s.v(body)[:, [0, -1]]
        x, v = x - x.mean(0), v - v.mean(0)
        turn = (x[:, 1] * v[:, 0] - x[:, 0] * v[:, 1]).sum() / (x * x).sum()
        return [s.time - begin, s.mean_velocity(body)[0], turn * radius]

    said = scene.run(begin + duration, watch, 20)
    return slope(said[:, 0], said[:, 1]), slope(said[:, 0], said[:, 2])


def rolling(
    scheme: str, dimension: int, basis: str, cells: int = 8, normal: str = "plane",
    factor: float = 0.25, modulus: float = 1e6,
) -> list[Figure]:  # fmt: skip
    """E9: a disc (2D) or sphere (3D) that sticks at 30 degrees and slips at 45."""
    more = {"cells": cells, "normal": normal, "factor": factor, "modulus": modulus}
    return rolling_figures(
        "disc" if dimension == 2 else "sphere",
        lambda *about: roll(scheme, dimension, basis, *about, **more),
    )


def rolling_figures(what: str, of: Callable[[float, float], tuple[float, float]]) -> list[Figure]:
    """Return E9's figures of what rolls at an angle [degrees] with a friction."""
    stick, stick_turn = of(30, 0.3)
    slip, slip_turn = of(45, 0.1)
    return [
        judge("E9", f"{what}, 30 degrees, mu 0.3 sticks", stick),
        report(f"{what}, 30 degrees: R alpha over a", stick_turn / stick),
        judge("E9", "45 degrees, mu 0.1 slips", slip),
        judge("E9", f"{what}, 45 degrees, mu 0.1: R alpha", slip_turn),
    ]
