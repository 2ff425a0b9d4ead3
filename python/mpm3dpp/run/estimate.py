# SPDX-License-Identifier: BSD-3-Clause
"""How long a run will take: a guess, by a few steps of a block of its material, made here."""

from __future__ import annotations

import math
import time

from mpm3dpp.base.machine import thread_count
from mpm3dpp.case.body import Body
from mpm3dpp.case.case import Case
from mpm3dpp.case.grid import Grid
from mpm3dpp.case.parts import Run
from mpm3dpp.fill.parts import Filled
from mpm3dpp.shapes import Box

from .simulation import Simulation
from .summary import time_step

_MOST = 20_000  # particles that are stepped: a step takes some milliseconds
_STEPS = 10
_ALONG = 2  # particles of a cell along each axis
_UNITS = ((172_800.0, 86_400.0, "days"), (7200.0, 3600.0, "h"), (120.0, 60.0, "min"))


def estimate_line(case: Case, bodies: Filled, ranks: int = 1) -> str:
    """Return the line about the time of a run here.

    A block at rest is stepped, with the material that most particles have and the case's grid and
    numerics. Contact, debris, frames and pictures come on top, and other runs on this machine.

    Args:
        case: of the run.
        bodies: those of the case.
        ranks: processes that share the particles, each with its threads.
    """
    threads = thread_count(None)
    each = _seconds_per_particle_step(case, bodies, threads)
    steps = math.ceil(case.run.end_time / time_step(case, bodies))
    seconds = each * bodies.particle_count * steps / ranks
    workers = f"{threads} thread{'s' if threads > 1 else ''}"
    if ranks > 1:
        workers = f"{ranks} ranks of {workers}"
    on_top = "contact and frames come" if case.contact_enabled else "frames come"
    return (
        f"estimate: {_in_words(seconds)} with {workers} on this machine "
        f"({1e9 * each:.3g} ns for a particle and step; {on_top} on top)"
    )


def _seconds_per_particle_step(case: Case, bodies: Filled, threads: int) -> float:
    D, cell = case.grid.dimension, case.grid.cell_size
    edge = max(1, round((min(bodies.particle_count, _MOST) / _ALONG**D) ** (1 / D)))  # [cells]
    name = _material_of_most(case, bodies)
    block = Body(
        material=name,
        shape=Box(lower=(0.0,) * D, upper=(edge * cell,) * D),
        particles_per_cell=_ALONG,
    )
    model = Case(
        grid=Grid(dimension=D, cell_size=cell, basis=case.grid.basis),
        run=Run(end_time=case.run.end_time, transfer=case.run.transfer, scheme=case.run.scheme),
        material={name: case.material[name]},
        body={"block": block},
    )
    simulation = Simulation(model, threads=threads)
    simulation.advance(2)
    return min(_seconds_of_step(simulation) for _ in range(_STEPS)) / simulation.core.particle_count


def _seconds_of_step(simulation: Simulation) -> float:
    begin = time.perf_counter()
    simulation.advance(1)
    return time.perf_counter() - begin


def _material_of_most(case: Case, bodies: Filled) -> str:
    """Return the material of most particles, one that deforms if there is one."""
    counts: dict[tuple[bool, str], int] = {}
    for name, part in bodies.parts.items():
        kind = not case.is_rigid(name), part.material
        counts[kind] = counts.get(kind, 0) + part.count
    return max(counts, key=lambda kind: (kind[0], counts[kind]))[1]


def _in_words(seconds: float) -> str:
    for least, unit, name in _UNITS:
        if seconds >= least:
            return f"about {seconds / unit:.2g} {name}"
    return f"about {math.ceil(seconds):.0f} s" if seconds >= 1.0 else "less than a second"
