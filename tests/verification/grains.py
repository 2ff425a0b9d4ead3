# SPDX-License-Identifier: BSD-3-Clause
"""C1 and C2: elastic spheres meet a rigid wall, and one another in a row (Hertz 1882)."""

from __future__ import annotations

import numpy as np

from .figure import Figure, judge, report
from .points import ball
from .scene import Array, Scene, on_time

RADIUS, YOUNG, POISSON, DENSITY = 0.1, 1e7, 0.3, 1000.0
ANSWER_LASTS = {1.0: 1.2305e-2, 0.5: 1.4134e-2}


def _scene(scheme: str, basis: str, cells: int, factor: float) -> tuple[Scene, int, float]:
    """Return an empty scene, the material of the spheres, and the cell size [m]."""
    cell = 2 * RADIUS / cells
    scene = Scene(scheme, 3, basis, cell, factor=factor, threads=2)
    return scene, scene.material(DENSITY, "elastic", E=YOUNG, nu=POISSON), cell


def hertz_wall(
    scheme: str, dimension: int, basis: str, cells: int = 20, factor: float = 0.25
) -> list[Figure]:
    """C1: a sphere of `cells` a diameter on a rigid wall, the plane between it and its mirror."""
    assert dimension == 3
    speeds = (1.0, 0.5)
    return hertz_figures({v: _bounce(scheme, basis, cells, v, factor) for v in speeds})


def hertz_figures(found: dict[float, list[float]]) -> list[Figure]:
    """Return the figures of C1 from what `bounce` gives for both speeds [m/s]."""
    figures = []
    for speed, (lasts, depth, force, back) in found.items():
        figures += [
            judge("C1", f"lasts, v = {speed}", lasts),
            judge("C1", f"depth, v = {speed}", depth),
            judge("C1", f"force, v = {speed}", force),
            report(f"speed after, v = {speed}", back / speed, "v"),
        ]
    ratios = [a / b for a, b in zip(found[1.0], found[0.5], strict=True)]
    for name, ratio in zip(("duration", "depth", "force"), ratios, strict=False):
        figures.append(judge("C1", f"ratio of {name}, v = 1.0 to 0.5", ratio))
    return figures


def _bounce(scheme: str, basis: str, cells: int, speed: float, factor: float) -> list[float]:
    """Return duration [s], depth [m], force [N] and the speed after [m/s]."""
    scene, material, cell = _scene(scheme, basis, cells, factor)
    away = RADIUS + 0.1 * cell
    for side in (-1.0, 1.0):
        x, volume = ball([side * away, 0.0, 0.0], RADIUS, cell / 2)
        scene.body(material, x, [-side * speed, 0.0, 0.0], volume)
    return bounced(scene.start(), speed)


def bounced(scene: Scene, speed: float, every: int = 4) -> list[float]:
    """Let the first sphere hit at a speed [m/s] and part; return what `bounce` does.

    It is looked at after so many steps, by which the duration is known.
    """
    said = scene.run(
        1.3 * ANSWER_LASTS[speed],
        lambda s: [s.time, abs(s.impulse()[0]), -_centre(s), s.mean_velocity(0)[0]],
        every,
    )
    return bounce(said)


def bounce(said: Array) -> list[float]:
    """Return duration [s], depth [m], force [N] and the speed after [m/s].

    Args:
        said: of the first sphere, at some times: time [s], impulse so far [N s], distance of its
            centre from the plane of contact [m] and velocity [m/s], shape (n, 4).
    """
    begin, end = on_time(said[:, 0], said[:, 1])
    depth = RADIUS - said[:, 2].min()
    smooth = np.convolve(np.gradient(said[:, 1], said[:, 0]), np.ones(5) / 5, "same")
    return [end - begin, depth, smooth.max(), -said[-1, 3]]


def _centre(scene: Scene) -> float:
    """Return x of the first sphere's mass centre [m]."""
    mass = scene.core.column(0, "mass")[:, 0]
    return float(mass @ scene.x(0)[:, 0] / mass.sum())


def hertz_chain(
    scheme: str, dimension: int, basis: str, cells: int = 20, factor: float = 0.25
) -> list[Figure]:
    """C2: five touching spheres in a row, the first at 1 m/s."""
    assert dimension == 3
    scene, material, cell = _scene(scheme, basis, cells, factor)
    for k in range(5):
        x, volume = ball([2 * RADIUS * (k - 2), 0.0, 0.0], RADIUS, cell / 2)
        scene.body(material, x, [1.0 if k == 0 else 0.0, 0.0, 0.0], volume)
    return chain_figures(scene.start())


def chain_figures(scene: Scene) -> list[Figure]:
    """Let the first of five spheres hit the others, and return the figures."""
    scene.run(0.06)
    speeds = [scene.mean_velocity(k)[0] for k in range(5)]
    figures = [judge("C2", f"final velocity of sphere {k + 1}", v) for k, v in enumerate(speeds)]
    return [*figures, scene.energy_figure()]
