# SPDX-License-Identifier: BSD-3-Clause
"""E9b, E10 and oblique impact: several bodies at once; directions, sums and numbering."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

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
    return three_figures(scene.start(), outward, speed)


def three_figures(scene: Scene, outward: Array, speed: float) -> list[Figure]:
    """Let three discs meet that come along `outward`, (3, D), and return the figures."""
    scene.run(3.6)
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
    centres, velocities = places(dimension, bodies, speed)
    scene = Scene(scheme, dimension, basis, 1.0 / cells, factor=factor, friction=friction)
    material = scene.material(1.0, "elastic", E=1.0, nu=0.3)
    order = list(range(bodies)) if order is None else list(order)
    for k in order:
        x, volume = ball(centres[k], 1.0, 0.5 / cells)
        scene.body(material, x, velocities[k], volume)
    return crowded(scene.start(), order, steps)


def places(dimension: int, bodies: int, speed: float) -> tuple[Array, Array]:
    """Return centres [m] and velocities [m/s] of bodies of radius 1, (bodies, D)."""
    random = np.random.default_rng(20100101)
    side = math.ceil(bodies ** (1 / dimension))
    centres, _ = block([0.0] * dimension, [2.1 * side] * dimension, 2.1)
    velocities = speed * random.uniform(-1.0, 1.0, (bodies, dimension))
    # Towards the middle.
    return centres[:bodies], velocities - 0.5 * speed * (centres[:bodies] / (1.05 * side) - 1.0)


def crowded(scene: Scene, order: Sequence[int], steps: int) -> tuple[Scene, Array, Array]:
    """Make steps; return the scene, and positions and velocities of bodies in the first order."""
    made = 0
    while made < steps:
        made += scene.step(min(1000, steps - made))
    x, v = [None] * len(order), [None] * len(order)
    for number, k in enumerate(order):
        x[k], v[k] = scene.x(number), scene.v(number)
    return scene, np.array(x), np.array(v)


def many_bodies(
    scheme: str, dimension: int, basis: str, bodies: int = 25, steps: int = 2000,
    cells: int = 4, factor: float = 0.25,
) -> list[Figure]:  # fmt: skip
    """E9b: discs with random velocities and friction."""
    return many_figures(crowd(scheme, dimension, basis, bodies, steps, cells, factor)[0])


def many_figures(scene: Scene) -> list[Figure]:
    """Return what many bodies that have met have kept."""
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
    return renumbering_figures((x, v), (y, w), cells)


def renumbering_figures(
    first: tuple[Array, Array], second: tuple[Array, Array], cells: int
) -> list[Figure]:
    """Return by how much positions and velocities of two runs differ; `cells` of a metre."""
    (x, v), (y, w) = first, second
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
    radius = 0.1
    h = radius / cells

    def scene_of(b: str) -> Scene:
        sine = float(b)
        apart = 2 * radius * np.array([math.sqrt(1 - sine**2), sine, 0.0])
        scene = Scene(scheme, dimension, basis, h, factor=factor)
        material = scene.material(1000.0, "elastic", E=1e7, nu=0.3)
        for centre, v in (([0.0] * 3, speed), (apart + np.array([0.5 * h, 0.0, 0.0]), 0.0)):
            x, volume = ball(centre, radius, h / 2)
            scene.body(material, x, [v, 0.0, 0.0], volume)
        return scene.start()

    return offset_figures(scene_of, offsets, speed, 0.5 * h / speed + 0.03)


def offset_figures(
    of: Callable[[str], Scene], offsets: Sequence[str], speed: float, until: float
) -> list[Figure]:
    """Let spheres meet at offsets b over 2R until a time [s]; return the worst figures of all."""
    turn, fast, remark = 0.0, 0.0, []
    for b in offsets:
        scene = of(b)
        scene.run(until)
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
    scene.body(material, top, motion, volume)
    return oblique_figures(scene.start(), mu, slip, speed)


def oblique_figures(scene: Scene, mu: float, slip: float, speed: float) -> list[Figure]:
    """Let the block, body 1, of 1 m a side hit the other, body 0, and return the figures."""
    motion = np.array([slip, *[0.0] * (scene.dimension - 2), -speed])
    scene.run(0.12)
    gained = 1000.0 * (scene.mean_velocity(1) - motion)  # The block has 1000 kg.
    impulse = -scene.impulse()[: scene.dimension]
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
