# SPDX-License-Identifier: BSD-3-Clause
"""C5: a disc lies on two others that turn: it rolls with them, or slips until it does."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mpm3dpp import _core

from .figure import Figure, judge
from .points import ball
from .scene import Array, Scene, slope

RADIUS, DENSITY, YOUNG, POISSON, GRAVITY = 0.1, 1000.0, 1e6, 0.3, 9.81
TILT = math.radians(45.0)  # of the lines of centres from the vertical
FRICTION, SPIN = 0.5, 15.0  # [rad/s]
SETTLE, STOPS = 0.3, 24  # [s], and how often the disc is stopped meanwhile


def slip_rate(friction: float = FRICTION) -> float:
    """Angular acceleration [rad/s^2] of the disc while it slips on both supports.

    Both frictions turn it the same way and both push it to one side, so that the two normal forces
    differ; their sum is W / (cos(tilt) (1 + mu^2)), with which Euler's law gives the acceleration.
    """
    return 2.0 * friction * GRAVITY / (RADIUS * math.cos(TILT) * (1.0 + friction**2))


def turning(
    scheme: str, basis: str, cells: int, ramp: float, duration: float, factor: float = 0.25
) -> tuple[Array, Scene]:
    """Turn the supports up to `SPIN` in `ramp` [s], or from the start with `ramp` = 0.

    At first the disc is held from turning, and comes to rest on supports that stand or slip.

    Returns:
        Rows of the time since it may turn [s] and of its spin, backwards [rad/s], (n, 2).
    """
    h = RADIUS / cells
    scene = Scene(
        scheme, 2, basis, h, factor=factor, friction=FRICTION, gravity=[0.0, -GRAVITY, 0.0]
    )
    material = scene.material(DENSITY, "elastic", E=YOUNG, nu=POISSON)
    x, volume = ball([0.0, 0.0], RADIUS, h / 2)
    scene.body(material, x, [0.0, 0.0], volume)
    zero = _core.TimeFunction(0.0)
    spin = _core.TimeFunction(SPIN)
    if ramp:
        spin = _core.TimeFunction(0.0, 0.0, 0.0, 0.0, [SETTLE, SETTLE + ramp], [0.0, SPIN])
    for side in (-1.0, 1.0):
        centre = [side * 2 * RADIUS * math.sin(TILT), -2 * RADIUS * math.cos(TILT)]
        x, volume = ball(centre, RADIUS, h / 2)
        support = scene.body(material, x, [0.0, 0.0], volume)
        scene.core.set_motion(support, [zero] * 3, [zero, zero, spin], [*centre, 0.0])
    return turned(scene.start(), duration), scene


def turned(scene: Scene, duration: float) -> Array:
    """Hold the disc, body 0, until it rests; then return rows of time [s] and spin [rad/s]."""
    for k in range(1, STOPS + 1):
        scene.run(SETTLE * k / STOPS)
        scene.core.set_velocity(0, np.zeros_like(scene.v(0)))
    return scene.run(SETTLE + duration, lambda s: [s.time - SETTLE, -_spin(s, 0)], 5)


def _spin(scene: Scene, body: int) -> float:
    """Angular momentum about the mass centre over the moment of inertia [rad/s]."""
    m, x, v = scene.core.column(body, "mass"), scene.x(body), scene.v(body)
    x, v = x - (m * x).sum(0) / m.sum(), v - (m * v).sum(0) / m.sum()
    return float((m[:, 0] * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum() / (m * x * x).sum())


def rolling_on_discs(
    scheme: str, dimension: int, basis: str, cells: int = 16, factor: float = 0.25
) -> list[Figure]:
    """C5: a disc of `cells` a radius on supports that turn up slowly, and that turn at once."""
    assert dimension == 2
    return turning_figures(lambda *about: turning(scheme, basis, cells, *about, factor))


def turning_figures(of: Callable[[float, float], tuple[Array, Scene]]) -> list[Figure]:
    """Return the figures of what turns with a ramp [s], or 0, for a duration [s]."""
    revolution, ramp = 2 * math.pi / SPIN, 0.4
    said, scene = of(ramp, ramp + revolution)
    t, spin = said.T
    rising, steady = (t > 0.1 * ramp) & (t < 0.9 * ramp), t > ramp
    rate = slope(t[rising], spin[rising])
    turned = float((spin * np.diff(t, prepend=0.0)).sum())
    figures = [
        judge("C5", "sticks: spin-up over the supports'", rate * ramp / SPIN),
        judge("C5", "sticks: angle over the supports'", turned / (SPIN * (t[-1] - ramp / 2))),
        judge("C5", "sticks: spin in steady turning over the supports'",
              spin[steady].mean() / SPIN),
        judge("C5", "energy residual over the motions' work", _residual(scene)),
    ]  # fmt: skip
    ends = SPIN / slip_rate()  # [s] it slips so long
    said, scene = of(0.0, 1.5 * ends + revolution)
    t, spin = said.T
    slips, steady = (t > 0.1 * ends) & (t < 0.9 * ends), t > 1.5 * ends
    return [
        *figures,
        judge("C5", "slips: angular acceleration", slope(t[slips], spin[slips])),
        judge("C5", "slips, then sticks: spin over the supports'", spin[steady].mean() / SPIN),
        judge("C5", "energy residual over the motions' work", _residual(scene)),
    ]


def _residual(scene: Scene) -> float:
    rows = scene.history()
    return float(np.abs(rows["residual"]).max() / np.abs(rows["motion_work"]).max())
