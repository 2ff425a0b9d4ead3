# SPDX-License-Identifier: BSD-3-Clause
"""From a case to particles: bodies filled and checked, ready for the core."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError, first_of
from mpm3dpp.base.machine import MEMORY
from mpm3dpp.case.body import Body
from mpm3dpp.case.case import Case
from mpm3dpp.grains import GrainFilling, Grains
from mpm3dpp.grains.packing import ball_volume
from mpm3dpp.ranks.world import World, agreed, share_of, together
from mpm3dpp.shapes import fill, reference_volume
from mpm3dpp.shapes.faces import FACES, cells_are_alike, fits_the_lattice
from mpm3dpp.shapes.filling import holds_none
from mpm3dpp.shapes.shells import LATTICE, SHELLS

from .capacity import capacity_mistakes
from .interference import interferences, too_deep
from .parts import Filled, FilledPart, Particles, Survey, joined, ranges, survey
from .placement import box_mistakes, overlap_mistakes
from .settling import settling_mistakes
from .slices import number_of_all, survey_of_slices
from .surface_notes import bond_mistakes
from .velocities import start_velocities

MASS_WARNING = 0.05  # Relative mass error above which a run warns ...
MASS_ERROR = 0.5  # ... and above which it does not start.

Array = NDArray[np.float64]


def build(case: Case, world: World | None = None) -> Filled:
    """Fill all bodies of a case with particles, in the order of the case, and check them.

    Grains come after the others. Their particles are made when they are asked for.

    Args:
        case: what is filled.
        world: processes that share the work; each calls this.

    Raises:
        CaseError: a body holds no particle, misses its mass by more than half, or reaches out of
            the box or of the region that is kept; or particles of two bodies stand in the same
            place; or nothing is left that could settle; or the case is too large. There may be
            `others`.
    """
    from mpm3dpp.base.errors import from_violation

    try:
        case.complete_and_check()  # Again: objects may have been changed since the case was made.
    except ValueError as error:
        raise from_violation(error) from None
    filled = fill_all(case, world)
    mistakes = [one for part in filled.parts.values() for one in box_mistakes(case, part, world)]
    mistakes += overlap_mistakes(case, filled, world)
    mistakes += bond_mistakes(case, filled)
    filled.interferences = interferences(case)
    mistakes += settling_mistakes(case, filled)
    if not mistakes:
        mistakes += too_deep(case, filled.interferences)
    if mistakes:
        raise first_of(mistakes)
    return filled


def fill_all(case: Case, world: World | None = None) -> Filled:
    """Fill all bodies as `build` does, but let them overlap and reach out of the box.

    Raises:
        CaseError: a body holds no particle or misses its mass by more than half, or the case is
            too large for the memory.
    """
    mistakes = list(capacity_mistakes(case, world.memory if world else MEMORY))
    if mistakes:
        raise first_of(mistakes)
    parts: list[FilledPart] = []
    for name, part in case.parts().items():
        try:
            if isinstance(part, Grains):
                parts.append(_filled_grains(case, name, part, world))
            else:
                parts.append(_filled(case, name, part, world))
        except CaseError as error:
            mistakes.append(error)
    if mistakes:
        raise first_of(mistakes)
    return Filled(parts)


def warnings(filled: Filled) -> list[str]:
    """Return a sentence for every body or entry of grains whose mass is off by more than 5 %."""
    found = []
    for name, part in filled.parts.items():
        worst = _worst(part.mass_errors)
        if abs(worst) <= MASS_WARNING:
            continue
        if part.balls is None:
            found.append(
                f"body.{name}: its particles have {worst:+.1%} of the mass of its shape; "
                "give more particles_per_cell, or a shape aligned with the cells"
            )
        else:
            found.append(
                f"grains.{name}: the particles of a grain have up to {worst:+.1%} of the mass of "
                "its shape; give more particles_per_cell, or another align"
            )
    return found


def _worst(errors: Array) -> float:
    return float(errors[np.argmax(np.abs(errors))])


def _filled_grains(case: Case, name: str, grains: Grains, world: World | None) -> FilledPart:
    path, grid = ("grains", name), case.grid
    spacing, density = grains.particle_spacing(grid), case.material[grains.material].density
    way, cube = case.filled_by(name), spacing**grid.dimension
    try:
        centres, radii = grains.place(grid.dimension)
        filling = GrainFilling(centres, radii, spacing, grid, way, grains.align or "between")
    except CaseError as error:
        raise case.error((*path, grains.filling), error.rule, error.remedy) from None
    exact = np.asarray(ball_volume(radii, grid.dimension))

    def make(first: int, last: int) -> Particles:
        try:
            positions, counts = filling.fill(first, last)
        except CaseError as error:
            raise case.error((*path, grains.filling), error.rule, error.remedy) from None
        each = exact[first:last] / counts if way == SHELLS else np.full(last - first, cube)
        each_particle = np.repeat(each, counts)
        velocities = start_velocities(case, name, positions, each_particle, counts)
        return Particles(counts, positions, velocities, each_particle)

    def surveys_of_share() -> list[Survey]:
        # How many particles there will be is known well enough to make some of them at a time.
        first, last = share_of(len(centres), world)
        about = np.ceil(exact[first:last] / cube)
        return [survey(make(first + a, first + b)) for a, b in ranges(about)]

    seen = joined([one for of_rank in together(surveys_of_share, world) for one in of_rank])
    each: Array = exact / seen.counts if way == SHELLS else np.full(len(exact), cube)
    volumes = seen.counts * each
    part = FilledPart(
        name=name,
        material=grains.material,
        names=grains.names(name),
        spacing=spacing,
        fill=way,
        survey=seen,
        volumes=each,
        masses=volumes * density,
        shape_volumes=exact,
        volume_is_exact=True,
        mass_errors=volumes / exact - 1,
        make=make,
        balls=(centres, radii),
    )
    worst = _worst(part.mass_errors)
    if abs(worst) > MASS_ERROR:
        rule = f"is filled too coarsely: particles have {worst:+.0%} of the mass of a grain"
        remedy = "give a smaller grid.cell_size or more particles_per_cell"
        raise case.error((*path, grains.filling), rule, remedy)
    return part


def _refuse_mass(case: Case, name: str, error: float) -> None:
    if abs(error) > MASS_ERROR:
        rule = f"is filled too coarsely: its particles have {error:+.0%} of the shape's mass"
        remedy = "give a smaller grid.cell_size or more particles_per_cell"
        raise case.error(("body", name, "shape"), rule, remedy)


def _filled(case: Case, name: str, body: Body, world: World | None) -> FilledPart:
    way, path = case.filled_by(name), ("body", name, body.filling)
    spacing = body.particle_spacing(case.grid)
    shape, weighted = body.shape, body.is_weighted(case.preset)
    # A slice has particles of one volume.
    alike = way != FACES or shape is None or cells_are_alike(shape, case.grid.origin, spacing)
    sliced = world if shape is not None and alike and not weighted else None

    def make(ranks: World | None = None) -> Particles:
        part, parts = (ranks.rank, ranks.size) if ranks else (0, 1)

        def filled() -> tuple[Array, Array]:
            try:
                return fill(body, case.grid, way, part, parts)
            except CaseError as error:
                raise case.error(path, error.rule, error.remedy) from None

        positions, volumes = agreed(filled, ranks)
        if body.shape is not None and not number_of_all(len(positions), ranks):
            error = holds_none(body.shape, spacing)
            raise case.error(path, error.rule, error.remedy)
        if weighted and shape is not None:
            volumes = volumes * (reference_volume(shape)[0] / volumes.sum())
        velocities = agreed(
            lambda: start_velocities(case, name, positions, volumes, world=ranks), ranks
        )
        return Particles(np.array([len(positions)]), positions, velocities, volumes)

    particles, own = make(sliced), None
    if sliced is not None:
        seen, own = survey_of_slices(particles, sliced)
    else:
        seen = survey(particles)
    if way == FACES and shape is not None and fits_the_lattice(shape, case.grid.origin, spacing):
        way = LATTICE
    count, volumes = int(seen.counts[0]), particles.volumes
    shape_volume, exact, mass_error = None, True, 0.0
    if own is not None or (shape is not None and bool(np.all(volumes == volumes[:1]))):
        volume = count * (own.volume if own else float(volumes[0]))
    else:
        volume = float(volumes.sum())
    if shape is not None:
        shape_volume, exact = reference_volume(shape)
        mass_error = volume / shape_volume - 1 if shape_volume > 0 else math.inf
        _refuse_mass(case, name, mass_error)
    return FilledPart(
        name=name,
        material=body.material,
        names=[name],
        spacing=spacing,
        fill=way if shape is not None else "",
        survey=seen,
        volumes=np.array([volume / count]),
        masses=np.array([volume * case.material[body.material].density]),
        shape_volumes=None if shape_volume is None else np.array([shape_volume]),
        volume_is_exact=exact,
        mass_errors=np.array([mass_error]),
        make=(lambda _first, _last: make()) if own else (lambda _first, _last: particles),
        own=own,
    )
