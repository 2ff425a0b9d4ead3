# SPDX-License-Identifier: BSD-3-Clause
"""The short echo of a case before it runs: what `mpm3dpp check` prints."""

from __future__ import annotations

import math
import textwrap

from mpm3dpp.case.case import Case
from mpm3dpp.case.frame import all_in_bodies, in_body
from mpm3dpp.case.load_pieces import pieces
from mpm3dpp.case.matter import liquids_that_meet, parts_by_matter
from mpm3dpp.fill.advisories import fastest, notes
from mpm3dpp.fill.build import warnings
from mpm3dpp.fill.parts import Filled, FilledPart
from mpm3dpp.fill.point_warnings import point_warnings
from mpm3dpp.fill.surface_points import MOST_CFL, surfaces_touch
from mpm3dpp.materials import Failure, catalogue
from mpm3dpp.plots.labels import scaled
from mpm3dpp.shapes.faces import FACES
from mpm3dpp.shapes.shells import SHELLS

from .memory import memory_bytes, occupied_cells, process_bytes, rank_line
from .summary_conditions import (
    chosen_frames,
    condition_lines,
    load_in_words,
    motion_in_words,
    vector_in_words,
)

_FRAME_BYTES = (
    4 * 14
)  # Of a particle, without further fields: position, velocity, stress, two more.


def time_step(case: Case, bodies: Filled) -> float:
    """Return the expected first time step [s]: that given, or f h / max(c + |v|) as bounded."""
    if case.run.time_step is not None:
        return float(case.run.time_step)
    bound = case.run.largest_time_step or math.inf
    return min(_cfl(case, bodies) * case.grid.cell_size / fastest(case, bodies), bound)


def _cfl(case: Case, bodies: Filled) -> float:
    """Return `run.cfl`, or what contact between surfaces bears of it."""
    most = MOST_CFL if surfaces_touch(case, bodies.parts.values()) else math.inf
    return min(case.run.cfl, most)


def steps_in_words(case: Case, bodies: Filled) -> str:
    """Return the number of steps: `about` or, where the time step may fall, `at least` so many.

    It falls where waves become faster in what is compressed or burns (an equation of state),
    bodies become faster (gravity), or surfaces meet.
    """
    compressible = any(
        case.material[part.material].eos is not None for part in bodies.parts.values()
    )
    meets = surfaces_touch(case, bodies.parts.values())
    may_fall = case.run.time_step is None and (compressible or any(case.run.gravity) or meets)
    word, step = "at least" if may_fall else "about", time_step(case, bodies)
    steps = f"{word} {math.ceil(case.run.end_time / step):,} steps"
    if case.run.settle is None:
        return steps
    return f"up to {math.ceil(case.run.settle.longest / step):,} steps to settle, then {steps}"


def _stepping(case: Case) -> str:
    """Return how what deforms is stepped, in its own frame or by the transfer of the run."""
    updated = f"{case.run.scheme}, {case.run.transfer.word}"
    if not in_body(case):
        return updated
    return "leapfrog of nodes in bodies" + ("" if all_in_bodies(case) else f"; {updated}")


def _step_rule(case: Case, bodies: Filled) -> str:
    if case.run.time_step is not None:
        return ""
    most = _cfl(case, bodies)
    held = f" ({most:g} with contact between surfaces)" if most < case.run.cfl else ""
    return f"cfl {case.run.cfl:g}{held}, "


def frame_count(case: Case, bodies: Filled) -> int:
    """Return the number of frames, of which there is one at a step at most."""
    steps = math.ceil(case.run.end_time / time_step(case, bodies))
    return min(len(case.frame_times()), steps + 1)


def frames_in_words(case: Case, bodies: Filled) -> str:
    """Return the number of frames, and the room that they need on the disk.

    Those at first contacts come on top: nobody knows yet how many.
    """
    count, particles = frame_count(case, bodies), bodies.particle_count
    room = count * _FRAME_BYTES * particles
    size = f"{room / 2**30:,.1f} GiB" if room > 2**30 else f"{room / 2**20:,.1f} MiB"
    touching = case.contact_enabled and (len(case.body) > 1 or case.grains)
    return (
        f"{count:,} frames of {size} together{' and one at each first contact' if touching else ''}"
    )


def material_lines(case: Case) -> list[str]:
    """Return the numbers of each material that a body has, those of the library included."""
    lines = []
    for name in case.materials_used:
        material = case.material[name]
        parts = [f"density {material.density:.6g} kg/m^3"]
        chosen = [("strength", material.strength), ("eos", material.eos)]
        for kind, model in [*chosen, *(("failure", f) for f in material.failure)]:
            if model is None:
                continue
            units = {p.name: p.unit for p in catalogue(kind)[model.model].parameters}
            given = model.parameters.items()
            numbers = [
                f"{key} {scaled(v, units[key], 9 if not units[key] else 6)}".strip()
                for key, v in given
            ]
            action = [f"action {model.action}"] if isinstance(model, Failure) else []
            parts.append(
                f"{kind} {' '.join([model.model, ', '.join([*numbers, *action])])}".strip()
            )
        text = f"material {name}: {'; '.join(parts)}"
        lines += textwrap.wrap(text, 100, subsequent_indent="  ", break_on_hyphens=False)
    return lines


def _body_line(case: Case, part: FilledPart, per_metre: str) -> str:
    against = "exact" if part.volume_is_exact else "measured on a fine lattice"
    source = f"{_off(part.mass_errors[0])} of the shape's ({against})"
    if part.shape_volumes is None:
        source = "given one by one"
    return (
        f"body {part.name}: {part.count:,} particles {_apart(part)}, "
        f"{part.material}, mass {part.masses[0]:.6g} kg{per_metre}, {source}"
        f"{motion_in_words(case, part.name)}"
    )


def _apart(part: FilledPart) -> str:
    """Return how far apart the particles of a body are, and in what they stand but a lattice."""
    how = {SHELLS: f" in {SHELLS}", FACES: " or nearly so, to end at its faces"}
    return f"{part.spacing:.4g} m apart{how.get(part.fill, '')}"


def _off(error: float) -> str:
    """Return a relative error as text; one of rounding is none, of either sign."""
    return f"{round(error, 12) + 0.0:+.3%}"


def _grains_line(grains: FilledPart, per_metre: str) -> str:
    least, most = grains.survey.counts.min(), grains.survey.counts.max()
    each = f"{least:,} each" if least == most else f"{least:,} to {most:,} each"
    mass = float(grains.masses.sum())
    exact = float((grains.masses / (1.0 + grains.mass_errors)).sum())
    return (
        f"grains {grains.name}: {len(grains.names):,} bodies, {grains.count:,} particles ({each}) "
        f"{_apart(grains)}, {grains.material}, mass {mass:.6g} kg{per_metre}, "
        f"{_off(mass / exact - 1.0)} of the shapes' (exact)"
    )


def _body_lines(case: Case, bodies: Filled, per_metre: str) -> list[str]:
    """Return the lines about bodies, grains and loads."""
    lines = []
    own = in_body(case)
    for name, part in bodies.parts.items():
        line = (
            _grains_line(part, per_metre)
            if name in case.grains
            else _body_line(case, part, per_metre)
        )
        lines.append(line + (", on nodes of its own" if name in own else ""))
    for name, load in case.load.items():
        body = bodies.parts[load.body].body(0)
        found = pieces(case, name, body.positions, body.spacing)
        where = f"on {load.side} of {load.body}, {found.area:.6g} m^2{per_metre}"
        if load.at_point:
            where = f"at {vector_in_words(load.point, 'm')} of {load.body}"
        count = len(found.particles)
        lines.append(
            f"load {name}: {load_in_words(case, name)} {where}, "
            f"carried by {count:,} particle{'s' if count > 1 else ''}"
        )
    return lines


def _response(case: Case) -> str:
    """Return how bodies in contact part, with the names of those that flow where that decides."""
    if case.contact.response != "by_matter":
        return case.contact.response
    gases = ", ".join(f'"{name}"' for name in parts_by_matter(case)["gas"])
    others = [f"at {gases}"] if gases else []
    if liquids_that_meet(case):
        others.append("between liquids")
    return f"springs, but impulses {' and '.join(others)}" if others else "springs"


def echo(case: Case, bodies: Filled, ranks: int = 1) -> str:
    """Return what the case amounts to: bodies, materials, memory, cells, time step, steps."""
    per_metre = " per metre" if case.grid.dimension == 2 else ""
    lines = [case.title] if case.title else []
    lines += _body_lines(case, bodies, per_metre) + material_lines(case)
    particles, core = bodies.particle_count, memory_bytes(case, bodies)
    mass = sum(float(part.masses.sum()) for part in bodies.parts.values())
    cells, frames = occupied_cells(case, bodies), frame_count(case, bodies)
    box = case.grid.box_cells
    bounds = " x ".join(str(n) for n in box) + " cells" if box else "no bounds"
    meets = surfaces_touch(case, bodies.parts.values())
    contact = "none, the bodies are bonded" if case.contact.bonded else "none"
    if case.contact_enabled:
        contact = f"{case.contact.detection} detection, {_response(case)}"
        if in_body(case):
            surfaces = f"between surfaces, restitution {case.contact.restitution:g}"
            contact = surfaces if all_in_bodies(case) else f"{surfaces}; in space {contact}"
        contact += f", friction {case.contact.friction:g}"
    elif meets:
        contact = f"of surfaces with themselves and walls, restitution {case.contact.restitution:g}"
    lines += [
        f"total: {particles:,} particles, mass {mass:.6g} kg{per_metre}, "
        f"memory about {process_bytes(core, frames, meets) / 2**20:,.0f} MiB, of which the core "
        f"{core / 2**20:,.1f} MiB",
        *([rank_line(core, ranks)] if ranks > 1 else []),
        f"grid: {case.grid.dimension}D, cells of {case.grid.cell_size:.4g} m, {cells:,} occupied, "
        f"{bounds}, {case.grid.basis} basis",
        *chosen_frames(case),
        *condition_lines(case),
        f"contact: {contact}",
        f"time: {_stepping(case)}, {_step_rule(case, bodies)}"
        f"end {case.run.end_time:.6g} s, "
        f"step about {time_step(case, bodies):.3g} s, "
        f"{steps_in_words(case, bodies)}, {frames_in_words(case, bodies)}",
    ]
    sentences = [*warnings(bodies), *point_warnings(case, bodies)]
    lines += [f"warning: {sentence}" for sentence in sentences]
    return "\n".join([*lines, *(f"note: {sentence}" for sentence in notes(case, bodies))])
