# SPDX-License-Identifier: BSD-3-Clause
"""E1 and E11: one elastic bar, free to move along one axis."""

from __future__ import annotations

import math

import numpy as np

from .figure import Figure, judge, report
from .points import block
from .scene import Scene, slope

RHO, LENGTH, E, SPEED = 1.0, 25.0, 100.0, 0.1
G, SOFT = 9.81, 1000.0  # gravity [m/s^2] and density [kg/m^3] of the column


def vibration(
    scheme: str, dimension: int, basis: str, cells: int = 13, factor: float = 0.2
) -> list[Figure]:
    """E1: bar fixed at its left end in its first mode, v(x) = 0.1 sin(pi x / 50); ten periods."""
    h = LENGTH / cells
    wide = [2 * h] * (dimension - 1)
    scene = Scene(
        scheme, dimension, basis, h, factor=factor, contact=False,
        box=([0.0] * dimension, [LENGTH + 2 * h, *wide]), walls=("fixed", "free", *["slip"] * 4),
    )  # fmt: skip
    x, volume = block([0.0] * dimension, [LENGTH, *wide], h / 2)
    v = np.zeros_like(x)
    v[:, 0] = SPEED * np.sin(np.pi * x[:, 0] / (2 * LENGTH))
    scene.body(scene.material(RHO, "elastic", E=E, nu=0.0), x, v, volume)
    return vibration_figures(scene.start(), math.prod(wide))


def vibration_figures(scene: Scene, area: float) -> list[Figure]:
    """Let the bar of E1 vibrate ten times, and return its figures; `area` across it [m^2]."""
    scene.run(101.0)
    h_ = scene.history()
    t, momentum = h_["time"], h_["momentum_x"] / scene.core.total_mass
    down = np.flatnonzero((momentum[:-1] > 0) & (momentum[1:] <= 0))
    share = momentum[down] / (momentum[down] - momentum[down + 1])
    zeros = t[down] + share * (t[down + 1] - t[down])
    last = np.abs(momentum[(t > 94.0) & (t < 101.0)]).max()
    energy = (h_["kinetic"] + h_["internal"]) / area
    return [
        judge("E1", "period", slope(np.arange(len(zeros)), zeros)),
        judge("E1", "velocity of the centre of mass at the start", momentum[0]),
        judge("E1", "amplitude after 10 periods over the first", last / 0.06366197723675814),
        judge("E1", "energy per unit area at the start", energy[0]),
        report("energy after 10 periods over the start", energy[t <= 100.0][-1] / energy[0]),
    ]


def under_gravity(
    scheme: str, dimension: int, basis: str, cells: int = 25, factor: float = 0.2
) -> list[Figure]:
    """E11: column of height 1 on a fixed floor when gravity is suddenly on; one period."""
    h = 1.0 / cells
    up = dimension - 1
    lower, upper = [0.0] * dimension, [2 * h] * dimension
    upper[up] = 1.0
    gravity = [0.0] * dimension
    gravity[up] = -G
    walls = ["slip"] * (2 * dimension)
    walls[-2:] = ["fixed", "free"]
    scene = Scene(
        scheme, dimension, basis, h, factor=factor, contact=False,
        box=(lower, [*upper[:-1], 1.0 + 2 * h]), walls=walls, gravity=gravity,
    )  # fmt: skip
    x0, volume = block(lower, upper, h / 2)
    scene.body(scene.material(SOFT, "elastic", E=1e6, nu=0.0), x0, [0.0] * 3, volume)
    return column_figures(scene.start(), cells)


def column_figures(scene: Scene, cells: int) -> list[Figure]:
    """Let the column of E11, body 0, swing twice, and return its figures."""
    h, up, period = 1.0 / cells, scene.dimension - 1, 4.0 / math.sqrt(1e6 / SOFT)
    x0 = scene.x(0)
    top = x0[:, up] > 1.0 - 0.3 * h

    def watch(s: Scene) -> list[float]:
        return [s.time, (s.x(0) - x0)[top, up].mean(), *s.stress(0)[:, up]]

    said = scene.run(2.2 * period, watch, 1)
    t, moved, sigma = said[:, 0], -said[:, 1], said[:, 2:]
    cycles = t <= 2 * period
    mean = np.trapezoid(sigma[cycles], t[cycles], axis=0) / (t[cycles][-1] - t[0])
    # With the linear basis a cell has one stress: compare the mean of its points with the exact
    # stress at its centre.
    cell = np.floor(x0[:, up] / h).astype(int)
    ours = np.bincount(cell, mean) / np.bincount(cell)
    error = np.abs(ours + SOFT * G * (1.0 - (np.arange(cells) + 0.5) * h)).max() / (SOFT * G)
    return [
        judge("E11", "period", _middle(t, moved, period)),
        judge("E11", "largest displacement of the top", moved[cycles].max()),
        judge("E11", "displacement after one period over the largest",
              np.interp(period, t, moved) / moved.max()),
        judge("E11", "mean stress against rho g (H - y), largest difference over rho g H", error),
    ]  # fmt: skip


def _middle(t: np.ndarray, moved: np.ndarray, period: float) -> float:
    """Middle between falling through half of the largest value and rising through it again."""
    above = moved > 0.5 * moved.max()
    falls = t[1:][above[:-1] & ~above[1:]]
    rises = t[1:][~above[:-1] & above[1:]]
    last = falls[(falls > 0.5 * period) & (falls < period)][-1]
    first = rises[(rises > period) & (rises < 1.5 * period)][0]
    return float(last + first) / 2.0
