# SPDX-License-Identifier: BSD-3-Clause
"""Problems as cases of bodies on nodes of their own that touch: discs, spheres, blocks, friction.

All else is what a case gets that says nothing. What does not deform has a prescribed motion.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from . import chain, discs, grains, groups, incline, rolling
from .figure import Figure
from .in_body import InBody, Table, box, matter, soft
from .scene import Array, Scene

BALL = {2: "disc", 3: "sphere"}


def ball(centre: Sequence[float], radius: float, velocity: Any = None) -> Table:
    """Return a disc (2D) or sphere (3D) that deforms."""
    about = {"centre": [float(x) for x in centre], "radius": radius}
    return soft(BALL[len(about["centre"])], about, velocity)


def moved(body: Table, motion: Any = "fixed") -> Table:
    """Return a body that goes as is prescribed, in place of one that deforms."""
    return {"shape": body["shape"], "motion": motion}


def sulsky_discs(
    scheme: str, dimension: int, basis: str, cells: int = 40, model: str = "neo_hookean"
) -> list[Figure]:
    """E5: two discs meet along the diagonal; cells of 1/`cells`."""
    E, nu = 1000.0, 0.3
    parameters = {"E": E, "nu": nu}
    if model == "neo_hookean":
        parameters = {"K": E / (3 - 6 * nu), "G": E / (2 + 2 * nu)}
    pair = {
        "first": ball([0.2] * 2, 0.2, [0.1] * 2),
        "second": ball([0.8] * 2, 0.2, [-0.1] * 2),
    }
    scene = InBody(dimension, 1.0 / cells, 3.4, pair, matter(1000.0, model, **parameters))
    return discs.sulsky_figures(scene, model)


def rings(scheme: str, dimension: int, basis: str, cell_mm: float = 0.8) -> list[Figure]:
    """E6: two rings of radii 30 and 40 mm meet at 60 m/s."""
    h, pair = cell_mm * 1e-3, {}
    for name, centre, speed in (("first", 0.05, 30.0), ("second", 0.15, -30.0)):
        about = {"centre": [centre, 0.05], "inner_radius": 0.03, "outer_radius": 0.04}
        pair[name] = soft("ring", about, [speed, 0.0])
    rubber = matter(1010.0, "neo_hookean", K=121.7e6, G=26.1e6)
    return discs.ring_figures(InBody(dimension, h, 3.6e-3, pair, rubber), h / 2)


def three_discs(scheme: str, dimension: int, basis: str, cells: int = 40) -> list[Figure]:
    """E9b: three equal discs meet in the middle from 120 degrees."""
    speed, angles = 0.05, np.radians([90.0, 210.0, 330.0])
    outward = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    bodies = {f"disc{k}": ball(0.3 * e, 0.2, (-speed * e).tolist()) for k, e in enumerate(outward)}
    rubber = matter(1000.0, "elastic", E=1000.0, nu=0.3)
    scene = InBody(dimension, 1.0 / cells, 3.6, bodies, rubber)
    return groups.three_figures(scene, outward, speed)


def crowd(
    dimension: int, bodies: int, steps: int, cells: int, order: Sequence[int] | None = None
) -> tuple[Scene, Array, Array]:
    """Discs or spheres of `cells` radii on a lattice with random velocities, in a given order."""
    centres, velocities = groups.places(dimension, bodies, 0.05)
    order = list(range(bodies)) if order is None else list(order)
    many = {f"body{k}": ball(centres[k], 1.0, velocities[k].tolist()) for k in order}
    rubber = matter(1.0, "elastic", E=1.0, nu=0.3)
    scene = InBody(dimension, 1.0 / cells, 1e6, many, rubber, contact={"friction": 0.2})
    return groups.crowded(scene, order, steps)


def many_bodies(
    scheme: str, dimension: int, basis: str, bodies: int = 25, steps: int = 2000, cells: int = 4
) -> list[Figure]:
    """E9b: discs with random velocities and friction."""
    return groups.many_figures(crowd(dimension, bodies, steps, cells)[0])


def renumbering(
    scheme: str, dimension: int, basis: str, bodies: int = 9, steps: int = 300, cells: int = 4
) -> list[Figure]:
    """The same bodies in another order."""
    order = np.random.default_rng(1).permutation(bodies)
    found = [crowd(dimension, bodies, steps, cells, own)[1:] for own in (None, order)]
    return groups.renumbering_figures(*found, cells)


def offset_spheres(
    scheme: str, dimension: int, basis: str, cells: int = 8, speed: float = 0.3,
    offsets: Sequence[str] = ("0", "0.25", "0.5", "0.75"),
) -> list[Figure]:  # fmt: skip
    """E10: a smooth sphere meets an equal one at rest; offset b over 2R."""
    radius = 0.1
    h, rubber = radius / cells, matter(1000.0, "elastic", E=1e7, nu=0.3)
    until = 0.5 * h / speed + 0.03

    def scene_of(b: str) -> Scene:
        sine = float(b)
        apart = [2 * radius * math.sqrt(1 - sine**2) + 0.5 * h, 2 * radius * sine, 0.0]
        pair = {
            "first": ball([0.0] * 3, radius, [speed, 0.0, 0.0]),
            "second": ball(apart, radius),
        }
        return InBody(dimension, h, until, pair, rubber)

    return groups.offset_figures(scene_of, offsets, speed, until)


def oblique_impact(
    scheme: str, dimension: int, basis: str, mu: float = 0.2, slip: float = 1.0, cells: int = 8
) -> list[Figure]:
    """A block falls obliquely on a wider one with Coulomb friction; sliding throughout or not."""
    h, speed, across = 1.0 / cells, 0.5, dimension - 2
    wide = [-h] * across, [1.0 + h] * across
    pair = {
        "low": box([-1.0, *wide[0], -1.0], [2.0, *wide[1], 0.0]),
        "top": box([0.0] * dimension, [1.0] * dimension, [slip, *[0.0] * across, -speed]),
    }
    rubber, friction = matter(1000.0, "elastic", E=1e6, nu=0.0), {"friction": mu}
    scene = InBody(dimension, h, 0.12, pair, rubber, contact=friction)
    return groups.oblique_figures(scene, mu, slip, speed)


def on_an_incline(
    h: float, length: float, width: float, body: Table, angle: float, mu: float, end: float
) -> InBody:
    """A body comes to rest on a floor that does not move, body 0; then gravity is turned."""
    dimension = 3 if width else 2
    across, radians = [width / 2] * (dimension - 2), math.radians(angle)
    floor = box([0.0, *(-w for w in across), -2 * h], [length, *across, 0.0])
    along = {"times": [0.0, 1e-9], "values": [0.0, incline.G * math.sin(radians)]}
    run = {
        "gravity": [along, *[0.0] * (dimension - 2), -incline.G * math.cos(radians)],
        "settle": {"longest": 20.0},
    }
    scene = InBody(
        dimension, h, end, {"floor": moved(floor), "body": body},
        matter(incline.RHO, "elastic", E=1e6, nu=incline.NU), run=run, contact={"friction": mu},
    )  # fmt: skip
    scene.rest()
    return scene


def slide(angle: float, mu: float, across: int, duration: float = 0.5) -> tuple[Any, ...]:
    """Slide a block 0.4 long, 0.2 high; return times, displacements, velocities and the scene."""
    h = 0.4 / across
    length = 1.0 + 0.5 * incline.G * math.sin(math.radians(angle)) * duration**2
    start = math.ceil(0.3 / h) * h
    block = box([start, 0.0], [start + 0.4, 0.2])
    scene = on_an_incline(h, math.ceil(length / h) * h, 0.0, block, angle, mu, duration)
    return (*incline.slid(scene, 1, duration), scene)


def sliding_block(scheme: str, dimension: int, basis: str, across: int = 8) -> list[Figure]:
    """E8: acceleration of sliding blocks."""
    return incline.sliding_figures(lambda angle, mu: slide(angle, mu, across))


def sticking_block(scheme: str, dimension: int, basis: str, across: int = 8) -> list[Figure]:
    """E8: a block that must stay where it is."""
    return incline.sticking_figures(*slide(20, 0.5, across, 1.0)[:3])


def roll_down(
    scheme: str, dimension: int, basis: str, cells: int = 8, duration: float = 0.4
) -> list[Figure]:
    """E9: a disc (2D) or sphere (3D) that sticks at 30 degrees and slips at 45."""
    radius = 0.1
    h = radius / cells

    def roll(angle: float, mu: float) -> tuple[float, float]:
        length = 4 * radius + 0.5 * incline.G * math.sin(math.radians(angle)) * duration**2
        body = ball([2 * radius, *[0.0] * (dimension - 2), radius], radius)
        width = 12 * h if dimension == 3 else 0.0
        about = math.ceil(length / h) * h, width, body, angle, mu, duration
        return incline.rolled(on_an_incline(h, *about), 1, radius, duration)

    return incline.rolling_figures(BALL[dimension], roll)


def hertz_wall(scheme: str, dimension: int, basis: str, cells: int = 20) -> list[Figure]:
    """C1: a sphere of `cells` a diameter on a wall of the box that stops it."""
    radius, h = grains.RADIUS, 2 * grains.RADIUS / cells
    rubber = matter(grains.DENSITY, "elastic", E=grains.YOUNG, nu=grains.POISSON)
    far = math.ceil(0.3 / h) * h
    room = {"lower": [-far] * 3, "upper": [0.0, far, far], "walls": {"x_max": "contact"}}

    def hit(speed: float) -> list[float]:
        body = ball([-radius - 0.1 * h, 0.0, 0.0], radius, [speed, 0.0, 0.0])
        end = 1.3 * grains.ANSWER_LASTS[speed]
        return grains.bounced(InBody(3, h, end, {"ball": body}, rubber, {"box": room}), speed, 1)

    return grains.hertz_figures({speed: hit(speed) for speed in (1.0, 0.5)})


def hertz_chain(scheme: str, dimension: int, basis: str, cells: int = 20) -> list[Figure]:
    """C2: five touching spheres in a row, the first at 1 m/s."""
    radius = grains.RADIUS
    row = {
        f"ball{k}": ball([2 * radius * (k - 2), 0.0, 0.0], radius, [float(k == 0), 0.0, 0.0])
        for k in range(5)
    }
    rubber = matter(grains.DENSITY, "elastic", E=grains.YOUNG, nu=grains.POISSON)
    return grains.chain_figures(InBody(3, 2 * radius / cells, 0.06, row, rubber))


def turning(cells: int, ramp: float, duration: float) -> tuple[Array, Scene]:
    """Turn the supports of C5 up to their spin in `ramp` [s], or from the start with `ramp` = 0.

    Return rows of the time since the disc may turn [s] and of its spin, backwards [rad/s].
    """
    radius, tilt, settle = rolling.RADIUS, rolling.TILT, rolling.SETTLE
    spin: Any = rolling.SPIN
    if ramp:
        spin = {"times": [settle, settle + ramp], "values": [0.0, rolling.SPIN]}
    bodies = {"disc": ball([0.0, 0.0], radius)}
    for name, side in (("left", -1.0), ("right", 1.0)):
        centre = [2 * radius * side * math.sin(tilt), -2 * radius * math.cos(tilt)]
        motion = {"angular_velocity": spin, "centre": centre}
        bodies[name] = moved(ball(centre, radius), motion)
    scene = InBody(
        2, radius / cells, settle + duration, bodies,
        matter(rolling.DENSITY, "elastic", E=rolling.YOUNG, nu=rolling.POISSON),
        run={"gravity": [0.0, -rolling.GRAVITY]}, contact={"friction": rolling.FRICTION},
    )  # fmt: skip
    return rolling.turned(scene, duration), scene


def rolling_on_discs(scheme: str, dimension: int, basis: str, cells: int = 16) -> list[Figure]:
    """C5: a disc of `cells` a radius on supports that turn up slowly, and that turn at once."""
    return rolling.turning_figures(lambda ramp, duration: turning(cells, ramp, duration))


def disc_column(scheme: str, dimension: int, basis: str, cells: int = 20) -> list[Figure]:
    """C6: the wave's speed, times of arrival and force, and the velocities that it leaves."""
    radius = chain.RADIUS
    h = 2 * radius / cells
    row = {f"disc{k}": ball([(2 * k + 1) * radius, 0.0], radius) for k in range(chain.DISCS)}
    row["piston"] = moved(box([-3 * h, -radius], [0.0, radius]), {"velocity": [chain.SPEED, 0.0]})
    rubber = matter(chain.DENSITY, "elastic", E=chain.YOUNG, nu=chain.POISSON)

    def driven(until: float) -> tuple[Array, Scene]:
        scene = InBody(2, h, until, row, rubber)
        return chain.driven(scene, until), scene

    return chain.chain_figures(driven)
