# SPDX-License-Identifier: BSD-3-Clause
"""How long a run will take: a guess, by a few steps of its materials that are made here."""

from __future__ import annotations

import math
import os
import time
from collections.abc import Iterable

from mpm3dpp.base.machine import thread_count
from mpm3dpp.case.body import Body
from mpm3dpp.case.case import Case
from mpm3dpp.case.grid import Grid
from mpm3dpp.case.parts import Run
from mpm3dpp.fill.parts import Filled, FilledPart
from mpm3dpp.grains import GrainLattice, Grains
from mpm3dpp.shapes import Box

from .simulation import Simulation
from .summary import time_step

_MOST = 20_000  # particles that are stepped: a step takes some milliseconds
_STEPS = 10
_ALONG = 2  # particles of a cell along each axis
_GRAINS = {2: 10, 3: 4}  # along each axis
_UNITS = ((172_800.0, 86_400.0, "days"), (7200.0, 3600.0, "h"), (120.0, 60.0, "min"))


def estimate_line(case: Case, bodies: Filled, ranks: int = 1, threads: int | None = None) -> str:
    """Return the line about the time of a run here.

    Bodies cost what a block at rest does of the material that most of them have, and grains what a
    heap of theirs does that touch, with the case's grid and numerics. Contact of bodies, debris,
    frames and pictures come on top, and other runs on this machine.

    Args:
        case: of the run.
        bodies: those of the case.
        ranks: processes that share the particles, each with its threads.
        threads: see `thread_count`.
    """
    cores = len(os.sched_getaffinity(0))
    threads = thread_count(threads, max(1, cores // ranks))
    moving = [part for name, part in bodies.parts.items() if not case.is_rigid(name)]
    others = [part for part in moving if part.name not in case.grains]
    models = [
        (_heap(case, case.grains[part.name], part), part.count)
        for part in moving
        if part.name in case.grains
    ]
    if others:
        count = sum(part.count for part in others)
        models.append((_block(case, _material_of_most(others), count), count))
    stepped = sum(count for _, count in models)
    each = sum(_seconds(model, threads) * count for model, count in models) / stepped
    settling = case.run.settle.longest if case.run.settle is not None else 0.0
    whole = case.run.end_time + settling
    steps = math.ceil(whole / time_step(case, bodies))
    at_once = min(ranks, max(1, cores // threads))  # The others wait for a core.
    seconds = each * bodies.particle_count * steps / at_once
    workers = f"{threads} thread{'s' if threads > 1 else ''}"
    if ranks > 1:
        workers = f"{ranks} ranks of {workers}"
    on_top = "contact and frames come" if case.contact_enabled and others else "frames come"
    most = f", of which to settle at most {_in_words(seconds * settling / whole)}"
    return (
        f"estimate: {_in_words(seconds)} with {workers} on this machine"
        f"{most if settling else ''} "
        f"({1e9 * each:.3g} ns for a particle and step; {on_top} on top)"
    )


def _seconds(case: Case, threads: int) -> float:
    """Return the time of a step and particle of a case, the least of some steps [s]."""
    simulation = Simulation(case, threads=threads)
    simulation.advance(2)
    return min(_seconds_of_step(simulation) for _ in range(_STEPS)) / simulation.core.particle_count


def _seconds_of_step(simulation: Simulation) -> float:
    begin = time.perf_counter()
    simulation.advance(1)
    return time.perf_counter() - begin


def _block(case: Case, material: str, particles: int) -> Case:
    """Return a case of one body, at rest."""
    D, cell = case.grid.dimension, case.grid.cell_size
    edge = max(1, round((min(particles, _MOST) / _ALONG**D) ** (1 / D)))  # [cells]
    body = Body(
        material=material,
        shape=Box(lower=(0.0,) * D, upper=(edge * cell,) * D),
        particles_per_cell=_ALONG,
        frame=_frame_of(case, material),
    )
    return _with(case, material, body={"block": body})


def _heap(case: Case, grains: Grains, part: FilledPart) -> Case:
    """Return a case of some grains of an entry that touch, of their mean size."""
    D = case.grid.dimension
    along = min(_GRAINS[D], max(1, round(len(part.names) ** (1 / D))))
    lattice = GrainLattice(lower=(0.0,) * D, count=[along] * D, radius=float(grains.radii().mean()))
    heap = Grains(
        material=grains.material,
        lattice=lattice,
        spacing=part.spacing,
        fill=grains.fill,
        frame=grains.frame,
    )
    return _with(case, grains.material, grains={"heap": heap})


def _with(case: Case, material: str, **parts: dict[str, Body] | dict[str, Grains]) -> Case:
    """Return a case with the numerics of another one, and one of its materials."""
    # Nothing of it depends on a restitution, which is for one frame alone.
    run, contact = case.run, case.contact.model_copy(update={"pair": [], "restitution": 1.0})
    return Case(
        grid=Grid(
            dimension=case.grid.dimension, cell_size=case.grid.cell_size, basis=case.grid.basis
        ),
        run=Run(end_time=run.end_time, transfer=run.transfer, scheme=run.scheme),
        material={material: case.material[material]},
        contact=contact,
        **parts,
    )


def _frame_of(case: Case, material: str) -> str:
    """Return the frame of the bodies of a material; where they have both, that of the first."""
    return next(part.frame for part in case.parts().values() if part.material == material)


def _material_of_most(parts: Iterable[FilledPart]) -> str:
    counts: dict[str, int] = {}
    for part in parts:
        counts[part.material] = counts.get(part.material, 0) + part.count
    return max(counts, key=lambda name: counts[name])


def _in_words(seconds: float) -> str:
    for least, unit, name in _UNITS:
        if seconds >= least:
            return f"about {seconds / unit:.2g} {name}"
    return f"about {math.ceil(seconds):.0f} s" if seconds >= 1.0 else "less than a second"
