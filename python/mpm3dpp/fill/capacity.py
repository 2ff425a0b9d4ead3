# SPDX-License-Identifier: BSD-3-Clause
"""Before anything is filled: what a case would amount to, against the memory and the box."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import BODY_BYTES, MEMORY, PARTICLE_BYTES_WITH_GRID, memory_text
from mpm3dpp.case.case import Case
from mpm3dpp.grains import Grains
from mpm3dpp.grains.packing import ball_volume
from mpm3dpp.shapes.base import Shape
from mpm3dpp.shapes.filling import reference_volume
from mpm3dpp.shapes.lattice import LENGTHS_REMEDY
from mpm3dpp.shapes.shells import SHELLS, ball_count, shell_count

from .placement import CUT

MANY = 1e6
"""Particles from which it is worth while to look whether a shape is inside the box, before it is
filled: fewer are filled at once, and then looked at one by one."""
_SAMPLE = 1 << 16  # Points of a shape that are looked at.


def capacity_mistakes(case: Case, memory: float = MEMORY) -> Iterator[CaseError]:
    """Yield what makes it senseless to fill a case: too much for the memory, or out of the box.

    Args:
        case: what would be filled.
        memory: that there is for it, of all machines [bytes].
    """
    counts = {name: _particles(case, name, memory) for name in case.parts()}
    bodies = {n: p.count if isinstance(p, Grains) else 1 for n, p in case.parts().items()}
    needs = {n: counts[n] * PARTICLE_BYTES_WITH_GRID + bodies[n] * BODY_BYTES for n in counts}
    total = sum(needs.values())
    if not total <= memory:
        alone = (name for name, need in needs.items() if need > memory)
        name = next(alone, max(needs, key=lambda part: needs[part]))
        spacing = case.parts()[name].particle_spacing(case.grid)
        rule = (
            f"would need some {counts[name]:.0e} particles, {spacing:.3g} m apart; the whole case "
            f"would take {memory_text(total)} of memory, and there are {memory_text(memory)}"
        )
        yield case.error((*case.part_path(name), case.parts()[name].filling), rule, LENGTHS_REMEDY)
    for name, part in case.parts().items():
        rule = ""
        if isinstance(part, Grains):
            rule = _lattice_outside(case, part)
        elif part.shape is not None and counts[name] > MANY:
            rule = _shape_outside(case, part.shape, part.particle_spacing(case.grid))
        if rule:
            path = (*case.part_path(name), part.filling)
            cut = "" if isinstance(part, Grains) else f"{CUT}, "
            yield case.error(path, rule, f"move the {part.filling}, {cut}or enlarge the box")


def _particles(case: Case, name: str, memory: float) -> float:
    """Return about how many particles an entry will have, or a bound, if that is small."""
    part, dimension = case.parts()[name], case.grid.dimension
    spacing = part.particle_spacing(case.grid)
    cube, in_shells = spacing**dimension, case.filled_by(name) == SHELLS
    if isinstance(part, Grains):
        if in_shells:
            return ball_count(part.radii(), dimension, spacing)
        return max(float(ball_volume(part.radii(), dimension).sum()) / cube, part.count)
    if part.particles is not None:
        return len(part.particles.positions)
    assert part.shape is not None
    if in_shells:
        return shell_count(part.shape, spacing)
    lower, upper = part.shape.bounds()
    bound = float(np.prod(np.maximum(upper - lower, 0.0))) / cube
    if bound * PARTICLE_BYTES_WITH_GRID <= memory:
        return bound  # There is room for all of its bounds.
    return reference_volume(part.shape)[0] / cube


def _lattice_outside(case: Case, grains: Grains) -> str:
    """Return the rule that a lattice of grains breaks if centres lie outside the box, or ""."""
    lattice, box = grains.lattice, case.grid.box
    if lattice is None or box is None:
        return ""
    for low, high, x, y, axis in zip(*lattice.ends(), box.lower, box.upper, "xyz", strict=False):
        if low < x or high > y:
            return (
                f"reaches out of grid.box: centres stand from {axis} = {low:.6g} m to "
                f"{high:.6g} m, and the box is from {x:g} m to {y:g} m"
            )
    return ""


def _shape_outside(case: Case, shape: Shape, spacing: float) -> str:
    """Return the rule that a shape breaks if much of it lies outside the box, or ""."""
    box = case.grid.box
    if box is None:
        return ""
    lower, upper = shape.bounds()
    low, high = np.asarray(box.lower) - spacing, np.asarray(box.upper) + spacing
    if np.all(lower >= low) and np.all(upper <= high):
        return ""
    random = np.random.default_rng(0)
    points = lower + (upper - lower) * random.random((_SAMPLE, len(lower)))
    points = points[shape.contains(points)]
    outside = np.any((points < low) | (points > high), axis=1)
    if not outside.any():
        return ""
    edges = " x ".join(f"{edge:.4g}" for edge in upper - lower)
    return f"reaches out of grid.box: it measures {edges} m, and {outside.mean():.0%} lie outside"
