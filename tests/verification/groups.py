# SPDX-License-Identifier: BSD-3-Clause
"""E9b, E10 and oblique impact: several bodies at once; directions, sums and numbering."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from .figure import Figure, judge, reference
from .points import ball, block
from .scene import Array, Scene


def three_discs(
    scheme: str, dimension: int, basis: str, cells: int = 40, factor: float = 0.25
) -> list[Figure]:
    """E9b: three equal discs (in 3D spheres) meet in the middle from 120 degrees."""
    h, speed = 1.0 / cells, 0.05
    scene = Scene(scheme, dimension, basis, h, factor=factor)
    material = scene.material(1000.0, "elastic", E=1000.0, nu=0.3)
    angles = np.radians([90.0, 210.0, 330.0])
    outward = np.zeros((3, dimension))
    outward[:, 0], outward[:, 1] = np.cos(angles), np.sin(angles)
    for e in outward:
        # A fill that turns with the disc, so that only the grid breaks the symmetry.
        x, volume = _turned_ball(0.3 * e, 0.2, h / 2, e)
        scene.body(material, x, -speed * e, volume)
    scene.start().run(3.6)
    v = np.array([scene.mean_velocity(k) for k in range(3)])
    radial = (v * outward).sum(1)
    off = np.degrees(np.arccos(radial / np.linalg.norm(v, axis=1)))
    return [
        judge("E9b discs", "spread of the radial speeds over their mean",
              np.ptp(radial) / radial.mean(), remark=f"mean {radial.mean() / speed:.3f} v"),
        judge("E9b discs", "largest deviation from the radial direction", off.max()),
        _momentum(scene, 3 * scene.core.total_mass / 3 * speed),
        judge("E9b discs", "energy made over the start", scene.energy_made()),
    ]  # fmt: skip


def _turned_ball(centre: Array, radius: float, spacing: float, along: Array) -> tuple[Array, float]:
    x, volume = ball([0.0] * len(centre), radius, spacing)
    turned = x.copy()
    turned[:, 0] = along[0] * x[:, 0] - along[1] * x[:, 1]
    turned[:, 1] = along[1] * x[:, 0] + along[0] * x[:, 1]
    return turned + centre, volume


def crowd(
    scheme: str, dimension: int, basis: str, bodies: int = 25, steps: int = 2000,
    cells: int = 4, factor: float = 0.25, order: Sequence[int] | None = None,
    friction: float = 0.2, speed: float = 0.05,
) -> tuple[Scene, Array, Array]:  # fmt: skip
    """Discs or spheres of `cells` radii on a lattice with random velocities, in a given order."""
    random = np.random.default_rng(20100101)
    side = math.ceil(bodies ** (1 / dimension))
    centres, _ = block([0.0] * dimension, [2.1 * side] * dimension, 2.1)
    velocities = speed * random.uniform(-1.0, 1.0, (bodies, dimension))
    velocities -= 0.5 * speed * (centres[:bodies] / (1.05 * side) - 1.0)  # Towards the middle.
    scene = Scene(scheme, dimension, basis, 1.0 / cells, factor=factor, friction=friction)
    material = scene.material(1.0, "elastic", E=1.0, nu=0.3)
    order = list(range(bodies)) if order is None else list(order)
    for k in order:
        x, volume = ball(centres[k], 1.0, 0.5 / cells)
        scene.body(material, x, velocities[k], volume)
    scene.start()
    made = 0
    while made < steps:
        made += scene.step(min(1000, steps - made))
    x, v = [None] * bodies, [None] * bodies
    for number, k in enumerate(order):
        x[k], v[k] = scene.x(number), scene.v(number)
    return scene, np.array(x), np.array(v)


def many_bodies(
    scheme: str, dimension: int, basis: str, bodies: int = 25, steps: int = 2000,
    cells: int = 4, factor: float = 0.25,
) -> list[Figure]:  # fmt: skip
    """E9b: discs with random velocities and friction."""
    scene, _, _ = crowd(scheme, dimension, basis, bodies, steps, cells, factor)
    met = scene.core.contact_summary()["bodies_per_node_max"]
    pairs = len(scene.core.contact_pairs())
    first = scene.history()["kinetic"][0]
    size = math.sqrt(2 * first * scene.core.total_mass)
    return [
        _momentum(scene, size, f"{pairs} pairs touched, up to {met} bodies at a node"),
        judge("E9b discs", "energy made over the start", scene.energy_made()),
    ]


def renumbering(
    scheme: str, dimension: int, basis: str, bodies: int = 9, steps: int = 300, cells: int = 4,
    factor: float = 0.25,
) -> list[Figure]:  # fmt: skip
    """The same bodies in another order."""
    order = np.random.default_rng(1).permutation(bodies)
    _, x, v = crowd(scheme, dimension, basis, bodies, steps, cells, factor)
    _, y, w = crowd(scheme, dimension, basis, bodies, steps, cells, factor, order)
    return [
        judge("E9b discs", "renumbered: largest difference of position over the cell",
              np.abs(x - y).max() * cells),
        judge("E9b discs", "renumbered: largest difference of velocity",
              np.abs(v - w).max() / np.abs(v).max()),
    ]  # fmt: skip


def _momentum(scene: Scene, size: float, remark: str = "") -> Figure:
    h = scene.history()
    p = np.stack([h[f"momentum_{a}"] for a in "xyz"], axis=1)
    drift = np.abs(p - p[0]).max() / size
    return judge("E9b discs", "momentum, largest change", drift, remark=remark)


def offset_spheres(
    scheme: str, dimension: int, basis: str, cells: int = 8, speed: float = 0.3,
    offsets: Sequence[str] = ("0", "0.25", "0.5", "0.75"), factor: float = 0.25,
) -> list[Figure]:  # fmt: skip
    """E10: a smooth sphere meets an equal one at rest; offset b over 2R."""
    radius, turn, fast, remark = 0.1, 0.0, 0.0, []
    h = radius / cells
    for b in offsets:
        sine = float(b)
        apart = 2 * radius * np.array([math.sqrt(1 - sine**2), sine, 0.0])
        scene = Scene(scheme, dimension, basis, h, factor=factor)
        material = scene.material(1000.0, "elastic", E=1e7, nu=0.3)
        for centre, v in (([0.0] * 3, speed), (apart + np.array([0.5 * h, 0.0, 0.0]), 0.0)):
            x, volume = ball(centre, radius, h / 2)
            scene.body(material, x, [v, 0.0, 0.0], volume)
        scene.start().run(0.5 * h / speed + 0.03)
        expected = np.array(reference()["E10"]["b"][b]).reshape(2, 2)
        for body in (0, 1):
            got, want = scene.mean_velocity(body)[:2] / speed, expected[body]
            error = np.linalg.norm(got) - np.linalg.norm(want)
            fast = max(fast, error, key=abs)
            if np.linalg.norm(want) > 0.05:
                cosine = got @ want / np.linalg.norm(got) / np.linalg.norm(want)
                turn = max(turn, math.degrees(math.acos(min(cosine, 1.0))))
            remark.append("({:.3f}, {:.3f})".format(*got))
    note = "; ".join(remark)
    return [
        judge("E10", "largest error of direction", turn),
        judge("E10", "largest error of speed", fast, remark=note),
        scene.energy_figure(),
    ]


def oblique_impact(
    scheme: str, dimension: int, basis: str, mu: float = 0.2, slip: float = 1.0,
    cells: int = 8, factor: float = 0.25, normal: str = "plane",
) -> list[Figure]:  # fmt: skip
    """A block falls obliquely on a wider one with Coulomb friction; sliding throughout or not."""

    h, speed = 1.0 / cells, 0.5
    scene = Scene(
        scheme, dimension, basis, h, factor=factor, friction=mu,
        normal=normal,
    )  # fmt: skip
    material = scene.material(1000.0, "elastic", E=1e6, nu=0.0)
    across = [0.0] * (dimension - 2), [1.0] * (dimension - 2)
    wide = [-h] * (dimension - 2), [1.0 + h] * (dimension - 2)
    low, volume = block([-1.0, *wide[0], -1.0], [2.0, *wide[1], 0.0], h / 2)
    top, _ = block([0.0, *across[0], 0.0], [1.0, *across[1], 1.0], h / 2)
    scene.body(material, low, [0.0] * 3, volume)
    motion = [slip, *[0.0] * (dimension - 2), -speed]
    b = scene.body(material, top, motion, volume)
    scene.start()
    mass = 1000.0 * volume * len(top)
    before = mass * np.array(motion)
    scene.run(0.12)
    gained = mass * scene.mean_velocity(b) - before
    impulse = -scene.impulse()[:dimension]
    ratio = np.linalg.norm(impulse[:-1]) / abs(impulse[-1]) / mu
    name = "sliding" if slip > mu * 4 * speed else "sticking"
    h_ = scene.history()
    work = scene.core.contact_pairs()[0].friction_work
    return [
        judge("oblique", f"{name}: tangential over normal impulse, over mu", ratio),
        judge("oblique", "impulse of the pair against the change of momentum",
              np.abs(impulse - gained).max() / np.linalg.norm(gained)),
        judge("oblique", "friction work against loss of the balance",
              abs(h_["friction"][-1] - work) / work),
        scene.energy_figure(),
    ]  # fmt: skip
