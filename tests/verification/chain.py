# SPDX-License-Identifier: BSD-3-Clause
"""C6: a wave runs along a column of touching discs, against a chain of masses and contact laws."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mpm3dpp import _core

from .figure import Figure, judge
from .points import ball, block
from .scene import Array, Scene

RADIUS, YOUNG, POISSON, DENSITY, DISCS = 0.1, 1e7, 0.3, 1000.0, 10
SPEED = 1.5  # of the piston [m/s]
PLATE = YOUNG / (1.0 - POISSON**2)
MASS = DENSITY * math.pi * RADIUS**2


def approach(force: Array) -> Array:
    """Approach [m] of the centres of two equal discs that press each other with a force [N/m].

    Johnson (1985), eq. (5.57), for a cylinder in plane strain between two contacts, of which each
    of the two discs has a half on either side: (2 P / pi E') (2 ln(4 R / a) - 1), with the half
    width of the contact a^2 = 4 P R / (pi E') of eq. (4.43) and E' = E / (1 - nu^2).
    """
    width = np.sqrt(4.0 * force * RADIUS / (math.pi * PLATE))
    return 2.0 * force / (math.pi * PLATE) * (2.0 * np.log(4.0 * RADIUS / width) - 1.0)


def force_law() -> tuple[Array, Array]:
    """Return a table of approaches [m] and forces [N/m], from nothing to well above those here."""
    force = np.concatenate([[0.0], np.geomspace(1e-9, 0.1, 2000) * PLATE * RADIUS])
    return np.concatenate([[0.0], approach(force[1:])]), force


def chain_of_masses(times: Array, discs: int = DISCS) -> tuple[Array, Array]:
    """Integrate the chain: masses, `approach` between them, and half of it before the piston.

    Args:
        times: evenly spaced [s], from 0, shape (n,).

    Returns:
        Velocities of the masses [m/s], (n, discs), and the force on the piston [N/m], (n,).
    """
    closer, force = force_law()
    x, v = np.zeros(discs), np.zeros(discs)

    def forces(t: float, x: Array) -> Array:
        """Of the piston on the first disc, of each on the next, and nothing at the free end."""
        first = np.interp(2.0 * (SPEED * t - x[0]), closer, force)
        return np.array([first, *np.interp(x[:-1] - x[1:], closer, force), 0.0])

    def rate(t: float, x: Array, v: Array) -> tuple[Array, Array]:
        return v, -np.diff(forces(t, x)) / MASS

    velocities, piston = [v], [0.0]
    dt = float(times[1] - times[0])
    for t in times[:-1]:  # Runge and Kutta's fourth order
        k1 = rate(t, x, v)
        k2 = rate(t + dt / 2, x + dt / 2 * k1[0], v + dt / 2 * k1[1])
        k3 = rate(t + dt / 2, x + dt / 2 * k2[0], v + dt / 2 * k2[1])
        k4 = rate(t + dt, x + dt * k3[0], v + dt * k3[1])
        x = x + dt / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        v = v + dt / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
        velocities.append(v)
        piston.append(forces(t + dt, x)[0])
    return np.array(velocities), np.array(piston)


def column(
    scheme: str, basis: str, cells: int, until: float, factor: float = 0.25, threads: int = 1
) -> tuple[Array, Scene]:
    """Drive a rigid plate into the column; return rows of time, velocities and impulse."""
    h = 2 * RADIUS / cells
    scene = Scene(scheme, 2, basis, h, factor=factor, threads=threads)
    material = scene.material(DENSITY, "elastic", E=YOUNG, nu=POISSON)
    for k in range(DISCS):
        x, volume = ball([(2 * k + 1) * RADIUS, 0.0], RADIUS, h / 2)
        scene.body(material, x, [0.0, 0.0], volume)
    x, volume = block([-3 * h, -RADIUS], [0.0, RADIUS], h / 2)
    plate = scene.body(material, x, [0.0, 0.0], volume)
    zero = _core.TimeFunction(0.0)
    speed = _core.TimeFunction(SPEED)
    scene.core.set_motion(plate, [speed, zero, zero], [zero] * 3, [0.0, 0.0, 0.0])
    return driven(scene.start(), until), scene


def driven(scene: Scene, until: float) -> Array:
    """Run to a time [s]; return rows of time, velocities of the discs, bodies 0 to 9, impulse."""
    impulse = scene.core.history_columns.index("motion_impulse_x")

    def watch(s: Scene) -> list[float]:
        speeds = [s.mean_velocity(k)[0] for k in range(DISCS)]
        return [s.time, *speeds, s.rows[-1][-1, impulse]]

    return scene.run(until, watch, 5)


def disc_column(
    scheme: str, dimension: int, basis: str, cells: int = 20, factor: float = 0.25
) -> list[Figure]:
    """C6: the wave's speed, times of arrival and force, and the velocities that it leaves."""
    assert dimension == 2
    return chain_figures(lambda until: column(scheme, basis, cells, until, factor))


def chain_figures(of: Callable[[float], tuple[Array, Scene]]) -> list[Figure]:
    """Return the figures of a column that is driven until a time [s]."""
    times = np.linspace(0.0, 0.03, 6001)
    velocities, piston = chain_of_masses(times)
    arrivals = [_arrival(times, v) for v in velocities.T[:9]]
    # So long that a wave as slow as is tolerated arrives.
    said, scene = of(1.1 * arrivals[8])
    ours = [_arrival(said[:, 0], v) for v in said.T[1:10]]
    figures = [
        judge("C6", f"arrival at disc {k}, over the chain's", ours[k - 1] / arrivals[k - 1])
        for k in (3, 6, 9)
    ]
    wave = (arrivals[8] - arrivals[2]) / (ours[8] - ours[2])
    remark = f"{12 * RADIUS / (ours[8] - ours[2]):.1f} m/s"
    figures.append(judge("C6", "speed of the wave, over the chain's", wave, remark=remark))
    inside = (times >= arrivals[2]) & (times <= arrivals[8])
    start, end = np.interp([arrivals[2], arrivals[8]], said[:, 0], said[:, -1])
    force = (end - start) / (arrivals[8] - arrivals[2]) / piston[inside].mean()
    figures.append(judge("C6", "mean force on the piston, over the chain's", force))
    until = 1.02 * arrivals[8]
    peak = said[said[:, 0] <= until, 6].max() / velocities[times <= until, 5].max()
    figures.append(judge("C6", "largest velocity of disc 6, over the chain's", peak))
    rows = scene.history()
    kept = rows["momentum_x"] - rows["motion_impulse_x"]
    return [
        *figures,
        judge("C6", "momentum less the piston's impulse, largest change",
              np.ptp(kept) / rows["momentum_x"].max()),
        judge("C6", "energy residual over the piston's work",
              np.abs(rows["residual"]).max() / rows["motion_work"].max()),
    ]  # fmt: skip


def _arrival(times: Array, velocities: Array) -> float:
    """When a disc first has half of the piston's velocity [s]."""
    after = int(np.argmax(velocities >= 0.5 * SPEED))
    pair = slice(after - 1, after + 1)
    return float(np.interp(0.5 * SPEED, velocities[pair], times[pair]))
