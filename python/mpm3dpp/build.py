# SPDX-License-Identifier: BSD-3-Clause
"""From a case to particles: bodies filled and checked, ready for the core."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .case import Body, Case
from .errors import CaseError
from .overlap import close_particles
from .shapes import fill, reference_volume

MASS_WARNING = 0.05  # Relative mass error above which a run warns ...
MASS_ERROR = 0.5  # ... and above which it does not start.
CLOSE = 0.25  # Particles of two bodies nearer than this share of their spacing overlap.
_SLACK = 1e-9  # How far, in cells, a particle may stand outside the box by rounding.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FilledBody:
    """The particles of one body at the start.

    Attributes:
        name, material: names in the case.
        positions: [m], shape (n, D).
        velocities: [m/s], shape (1, D) if all are equal, else (n, D).
        volumes: [m^3; in 2D m^2 times 1 m], shape (n,); all equal if a shape was filled.
        spacing: distance of neighbours [m].
        mass: sum over the particles [kg; in 2D per metre of thickness].
        shape_volume: the shape's volume [m^3; in 2D m^2]; None for particles given one by one.
        volume_is_exact: whether that is a closed form, else a fine lattice gave it.
        mass_error: mass / (density times shape_volume) - 1; 0 without a shape.
    """

    name: str
    material: str
    positions: Array
    velocities: Array
    volumes: Array
    spacing: float
    mass: float
    shape_volume: float | None
    volume_is_exact: bool
    mass_error: float


def build(case: Case) -> list[FilledBody]:
    """Fill all bodies of a case with particles, in the order of the case, and check them.

    Raises:
        CaseError: a body holds no particle, misses its mass by more than half, or reaches out of
            the box or of the region that is kept; or particles of two bodies stand in the same
            place.
    """
    from .case_checks import check_case
    from .errors import from_violation

    try:
        check_case(case)  # Again: objects may have been changed since the case was made.
    except ValueError as error:
        raise from_violation(error) from None
    bodies = [_filled(case, name, body) for name, body in case.body.items()]
    _check_overlap(case, bodies)
    return bodies


def warnings(bodies: list[FilledBody]) -> list[str]:
    """Return a sentence for every body whose mass is off by more than 5 %."""
    return [
        f"body.{body.name}: its particles have {body.mass_error:+.1%} of the mass of its shape; "
        "give more particles_per_cell, or a shape aligned with the cells"
        for body in bodies
        if abs(body.mass_error) > MASS_WARNING
    ]


def _filled(case: Case, name: str, body: Body) -> FilledBody:
    try:
        positions, volumes = fill(body, case.grid)
    except CaseError as error:
        raise case.error(("body", name, body.filling), error.rule, error.remedy) from None
    shape_volume, exact, mass_error = None, True, 0.0
    if body.shape is not None:
        volume = len(positions) * float(volumes[0])
        shape_volume, exact = reference_volume(body.shape)
        mass_error = volume / shape_volume - 1 if shape_volume > 0 else math.inf
        if abs(mass_error) > MASS_ERROR:
            rule = (
                f"is filled too coarsely: its particles have {mass_error:+.0%} of the shape's mass"
            )
            remedy = "give a smaller grid.cell_size or more particles_per_cell"
            raise case.error(("body", name, "shape"), rule, remedy)
    else:
        volume = float(volumes.sum())
    _check_box(case, name, positions)
    return FilledBody(
        name=name,
        material=body.material,
        positions=positions,
        velocities=_start(body, positions, volumes),
        volumes=volumes,
        spacing=body.particle_spacing(case.grid),
        mass=volume * case.material[body.material].density,
        shape_volume=shape_volume,
        volume_is_exact=exact,
        mass_error=mass_error,
    )


def initial_velocities(body: Body, positions: Array, volumes: Array) -> Array:
    """Return v + w x (x - x_mass centre) of each particle [m/s].

    Args:
        body: gives v and the spin w.
        positions: [m], shape (n, D).
        volumes: [m^3; in 2D m^2], shape (n,).

    Returns:
        Shape (1, D) without spin, else (n, D).
    """
    dimension = positions.shape[1]
    velocity = np.asarray(body.velocity or (0.0,) * dimension)
    spin = body.angular_velocity
    if not any(spin):
        return velocity.reshape(1, dimension).copy()
    equal = bool(np.all(volumes == volumes[0]))
    arm = positions - np.average(positions, axis=0, weights=None if equal else volumes)
    if dimension == 2:
        return velocity + spin[0] * np.column_stack([-arm[:, 1], arm[:, 0]])
    return velocity + np.cross(np.asarray(spin), arm)


def _start(body: Body, positions: Array, volumes: Array) -> Array:
    """Return the velocities at the start, those of a prescribed motion included."""
    if body.motion is None:
        return initial_velocities(body, positions, volumes)
    return body.motion.velocities(0.0, positions, body.motion.middle(positions, volumes))


def _check_box(case: Case, name: str, positions: Array) -> None:
    """Raise if a particle stands outside the box, or the region that is kept."""
    grid = case.grid
    if grid.box is not None:
        _check_inside(case, name, positions, "box", (grid.box.lower, grid.box.upper))
    _check_inside(case, name, positions, "keep", grid.kept)


def _check_inside(
    case: Case,
    name: str,
    positions: Array,
    region: str,
    corners: tuple[tuple[float, ...], tuple[float, ...]],
) -> None:
    slack = _SLACK * case.grid.cell_size
    what = "box" if region == "box" else "region"
    for d, axis in enumerate("xyz"[: case.grid.dimension]):
        x = positions[:, d]
        for limit, outside in ((corners[0][d], -x), (corners[1][d], x)):
            sign = 1 if limit == corners[1][d] else -1
            reach = float(outside.max())
            if reach > sign * limit + slack:
                count = int((outside > sign * limit + slack).sum())
                side = f"{axis} {'>' if sign > 0 else '<'} {limit:g} m"
                rule = f"reaches out of grid.{region}: {count} of its particles are at {side}"
                filling = case.body[name].filling
                remedy = f"move the {filling}, or enlarge the {what}"
                raise case.error(("body", name, filling), rule, remedy)


def _check_overlap(case: Case, bodies: list[FilledBody]) -> None:
    """Raise if particles of two bodies are closer than a quarter of their spacing."""
    lowers = np.array([body.positions.min(axis=0) for body in bodies])
    uppers = np.array([body.positions.max(axis=0) for body in bodies])
    for b in range(1, len(bodies)):
        second = bodies[b]
        reach = CLOSE * np.minimum(second.spacing, [body.spacing for body in bodies[:b]])[:, None]
        near = np.all((lowers[:b] < uppers[b] + reach) & (uppers[:b] > lowers[b] - reach), axis=1)
        for a in np.flatnonzero(near):
            first = bodies[a]
            if case.is_rigid(first.name) and case.is_rigid(second.name):
                continue  # They do not act on each other.
            distance = CLOSE * min(first.spacing, second.spacing)
            count = close_particles(first.positions, second.positions, distance)
            if count:
                rule = (
                    f"overlaps body.{first.name}: {count} of the particles of {second.name} are "
                    f"closer than a quarter spacing to particles of {first.name}"
                )
                remedy = "move one of the two, or cut one out of the other with difference"
                key = ("body", second.name, case.body[second.name].filling)
                raise case.error(key, rule, remedy)
