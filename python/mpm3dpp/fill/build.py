# SPDX-License-Identifier: BSD-3-Clause
"""From a case to particles: bodies filled and checked, ready for the core."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError, first_of
from mpm3dpp.case.body import Body
from mpm3dpp.case.case import Case
from mpm3dpp.grains import Grains, fill_grains
from mpm3dpp.grains.packing import ball_volume
from mpm3dpp.shapes import fill, reference_volume
from mpm3dpp.shapes.shells import SHELLS

from .capacity import capacity_mistakes
from .placement import box_mistakes, overlap_mistakes
from .velocities import start_velocities

MASS_WARNING = 0.05  # Relative mass error above which a run warns ...
MASS_ERROR = 0.5  # ... and above which it does not start.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class FilledBody:
    """The particles of one body at the start.

    Attributes:
        name: of the body.
        part: its name in the case: of the entry of `grains` if it is a grain, else its own.
        material: name in the case.
        positions: [m], shape (n, D).
        velocities: [m/s], shape (1, D) if all are equal, else (n, D).
        volumes: [m^3; in 2D m^2 times 1 m], shape (n,); all equal if a shape was filled.
        spacing: distance of neighbours [m], in shells about that.
        fill: "lattice" or "shells"; "" for particles given one by one.
        mass: sum over the particles [kg; in 2D per metre of thickness].
        shape_volume: the shape's volume [m^3; in 2D m^2]; None for particles given one by one.
        volume_is_exact: whether that is a closed form, else a fine lattice gave it.
        mass_error: mass / (density times shape_volume) - 1; 0 without a shape.
        ball: centre [m], shape (D,), and radius [m] of a grain; None for others.
    """

    name: str
    part: str
    material: str
    positions: Array
    velocities: Array
    volumes: Array
    spacing: float
    fill: str
    mass: float
    shape_volume: float | None
    volume_is_exact: bool
    mass_error: float
    ball: tuple[Array, float] | None = None


def build(case: Case) -> list[FilledBody]:
    """Fill all bodies of a case with particles, in the order of the case, and check them.

    Grains come after the others.

    Raises:
        CaseError: a body holds no particle, misses its mass by more than half, or reaches out of
            the box or of the region that is kept; or particles of two bodies stand in the same
            place; or the case is too large. There may be `others`.
    """
    from mpm3dpp.base.errors import from_violation

    try:
        case.complete_and_check()  # Again: objects may have been changed since the case was made.
    except ValueError as error:
        raise from_violation(error) from None
    bodies = fill_all(case)
    told: dict[str, list[CaseError]] = {}
    for body in bodies:  # Of the grains of an entry, the first that is wrong speaks for all.
        if not told.get(body.part):
            told[body.part] = list(box_mistakes(case, body))
    mistakes = [mistake for found in told.values() for mistake in found]
    mistakes += overlap_mistakes(case, bodies)
    if mistakes:
        raise first_of(mistakes)
    return bodies


def fill_all(case: Case) -> list[FilledBody]:
    """Fill all bodies as `build` does, but let them overlap and reach out of the box.

    Raises:
        CaseError: a body holds no particle or misses its mass by more than half, or the case is
            too large for the memory.
    """
    mistakes = list(capacity_mistakes(case))
    if mistakes:
        raise first_of(mistakes)
    bodies: list[FilledBody] = []
    for name, part in case.parts().items():
        try:
            if isinstance(part, Grains):
                bodies += _filled_grains(case, name, part)
            else:
                bodies.append(_filled(case, name, part))
        except CaseError as error:
            mistakes.append(error)
    if mistakes:
        raise first_of(mistakes)
    return bodies


def warnings(bodies: list[FilledBody]) -> list[str]:
    """Return a sentence for every body or entry of grains whose mass is off by more than 5 %."""
    found = []
    for part, members in by_part(bodies).items():
        worst = max((body.mass_error for body in members), key=abs)
        if abs(worst) <= MASS_WARNING:
            continue
        if members[0].name == part:
            found.append(
                f"body.{part}: its particles have {worst:+.1%} of the mass of its shape; "
                "give more particles_per_cell, or a shape aligned with the cells"
            )
        else:
            found.append(
                f"grains.{part}: the particles of a grain have up to {worst:+.1%} of the mass of "
                "its shape; give more particles_per_cell, or another align"
            )
    return found


def by_part(bodies: list[FilledBody]) -> dict[str, list[FilledBody]]:
    """Return the bodies of each entry of the case: one, or all the grains."""
    found: dict[str, list[FilledBody]] = {}
    for body in bodies:
        found.setdefault(body.part, []).append(body)
    return found


def _filled_grains(case: Case, part: str, grains: Grains) -> list[FilledBody]:
    path, grid = ("grains", part), case.grid
    spacing, density = grains.particle_spacing(grid), case.material[grains.material].density
    bodies: list[FilledBody] = []
    way, cube = case.filled_by(part), spacing**grid.dimension
    try:
        centres, radii = grains.place(grid.dimension)
        align = grains.align or "between"
        filled = list(fill_grains(centres, radii, spacing, grid, way, align))
    except CaseError as error:
        raise case.error((*path, grains.filling), error.rule, error.remedy) from None
    volumes = ball_volume(radii, grid.dimension).tolist()
    for k, (name, positions) in enumerate(zip(grains.names(part), filled, strict=True)):
        each = volumes[k] / len(positions) if way == SHELLS else cube
        particle_volumes = np.broadcast_to(each, (len(positions),))
        volume = len(positions) * each
        bodies.append(
            FilledBody(
                name=name,
                part=part,
                material=grains.material,
                positions=positions,
                velocities=start_velocities(case, part, positions, particle_volumes),
                volumes=particle_volumes,
                spacing=spacing,
                fill=way,
                mass=volume * density,
                shape_volume=volumes[k],
                volume_is_exact=True,
                mass_error=volume / volumes[k] - 1,
                ball=(centres[k], float(radii[k])),
            )
        )
    worst = max((body.mass_error for body in bodies), key=abs)
    if abs(worst) > MASS_ERROR:
        rule = f"is filled too coarsely: particles have {worst:+.0%} of the mass of a grain"
        remedy = "give a smaller grid.cell_size or more particles_per_cell"
        raise case.error((*path, grains.filling), rule, remedy)
    return bodies


def _filled(case: Case, name: str, body: Body) -> FilledBody:
    try:
        positions, volumes = fill(body, case.grid, case.filled_by(name))
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
    return FilledBody(
        name=name,
        part=name,
        material=body.material,
        positions=positions,
        velocities=start_velocities(case, name, positions, volumes),
        volumes=volumes,
        spacing=body.particle_spacing(case.grid),
        fill=case.filled_by(name) if body.shape is not None else "",
        mass=volume * case.material[body.material].density,
        shape_volume=shape_volume,
        volume_is_exact=exact,
        mass_error=mass_error,
    )
