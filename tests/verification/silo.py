# SPDX-License-Identifier: BSD-3-Clause
"""C3: the pressure in a silo, carried by its walls (Janssen 1895)."""

from __future__ import annotations

import math

import numpy as np

from mpm3dpp import _core

from .figure import Figure, judge, report
from .points import block
from .scene import Scene

WIDTH, HEIGHT, DENSITY, FRICTION, GRAVITY = 0.2, 1.4, 1600.0, 0.3, 9.81
YOUNG, POISSON = 5e5, 1 / 3  # nu / (1 - nu) = 0.5 is the ratio of the stresses at rest


def janssen(scheme: str, dimension: int, basis: str, cells: int = 16) -> list[Figure]:
    """C3: a slot between two rough walls, filled; gravity grows slowly, so that it slips down."""
    assert dimension == 2
    h = WIDTH / cells
    height = math.ceil(HEIGHT / h) * h
    scene = Scene(
        scheme, 2, basis, h, friction=FRICTION, threads=2,
        box=([-4 * h, 0.0], [WIDTH + 4 * h, height + 4 * h]),
        walls=("free", "free", "slip", "free"),
    )  # fmt: skip
    material = scene.material(DENSITY, "elastic", E=YOUNG, nu=POISSON)
    x, volume = block([0.0, 0.0], [WIDTH, height], h / 2)
    fill = scene.body(material, x, [0.0, 0.0], volume)
    still = [_core.TimeFunction(0.0)] * 3
    for left in (-3 * h, WIDTH):
        x, volume = block([left, 0.0], [left + 3 * h, height + 2 * h], h / 2)
        wall = scene.body(material, x, [0.0, 0.0], volume)
        scene.core.set_motion(wall, still, still, [0.0, 0.0, 0.0])
    scene.start()
    ramp = 2.0  # while it lasts the fill slides down; behind it the friction falls below its limit
    while scene.time < ramp:
        pull = -GRAVITY * scene.time / ramp
        scene.core.set_gravity([_core.TimeFunction(g) for g in (0.0, pull, 0.0)])
        scene.step(20)
    place, stress = scene.x(fill), scene.stress(fill)
    top = place[:, 1].max() + h / 4
    depth = top - place[:, 1]

    def mean(z: float, component: int) -> float:
        return float(-stress[np.abs(depth - z) < h, component].mean())

    ratio = float(np.mean([mean(z, 0) / mean(z, 1) for z in (0.4, 0.6, 0.8, 1.0)]))
    reach = WIDTH / (2.0 * FRICTION * ratio)
    figures = [report("ratio of horizontal to vertical stress", ratio)]
    for z in (0.5, 1.0):
        law = DENSITY * GRAVITY * reach * (1.0 - math.exp(-z / reach))
        name = f"vertical stress over the law's, {z} m deep"
        figures.append(judge("C3", name, mean(z, 1) / law, remark=f"{mean(z, 1):.0f} Pa"))
    return [*figures, report("the same over the hydrostatic", mean(1.0, 1) / (DENSITY * GRAVITY))]
