# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that will be stretched until their particles are too far apart, as far as that is known.

A body in which no cell between two particles holds one comes apart there, whatever its material.
Known before a run are the velocities at the start and the motions that are prescribed.
"""

from __future__ import annotations

import math
from itertools import combinations

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.case.case import Case
from mpm3dpp.case.material import Material
from mpm3dpp.case.moduli import moduli_of
from mpm3dpp.case.pairs import is_bonded

from .parts import Filled, FilledPart

Array = NDArray[np.float64]
# Cells between particles from which a note is due. They come apart from about a cell on; strains
# are not even, and that of two halves that part is found from a wave of small strain.
_FAR = 0.75
_SOME = 1.1  # A stretch of which there is a note at all.
_GOOD = 0.5  # Cells between particles at the largest stretch that are advised.
_MOST = 8  # Particles in a cell along an axis that are advised at most.
_TIMES = 200  # At which prescribed motions are looked at.
_YIELD = ("Y0", "A", "sigma_y")  # Yield stresses of metals, by their names.


def stretch_notes(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence for each body that is stretched too far for its particles.

    Args:
        case: a checked case.
        bodies: its bodies, filled.
    """
    found = []
    for name, part in bodies.parts.items():
        if part.balls is not None or part.own is not None or case.is_rigid(name):
            continue
        material = case.material[part.material]
        if material.failure or not _is_solid(material):
            continue
        ways = {
            "its velocities at the start": _by_velocities(part, material),
            "the motions of the bodies that it is bonded to": _by_motions(case, name, bodies),
        }
        why, stretch = max(ways.items(), key=lambda item: item[1])
        cells = part.spacing / case.grid.cell_size
        if stretch > _SOME and stretch * cells > _FAR:
            found.append(_sentence(name, why, stretch, cells))
    return found


def _sentence(name: str, why: str, stretch: float, cells: float) -> str:
    wanted = math.ceil(stretch / _GOOD)
    remedy = f"give particles_per_cell = {wanted}"
    if wanted > _MOST:
        remedy = f"give more particles_per_cell ({_MOST} hold up to a stretch of {_MOST * _FAR:g})"
    return (
        f"body.{name}: {why} stretch it by a factor of {stretch:.2g} or more, and particles that "
        f"are {cells:.2g} cells apart are {stretch * cells:.2g} then; from about a cell on a body "
        f"comes apart between them, whatever its material; {remedy}"
    )


def _is_solid(material: Material) -> bool:
    given = material.strength.parameters
    return "E" in given or "G" in given


def _by_velocities(part: FilledPart, material: Material) -> float:
    """Return the stretch that velocities at the start make: 1 if they only move and turn the body.

    Two halves that part at v on either side are strained by v over the speed of waves in a bar,
    or until yield has taken their energy, rho v^2 / 2 = Y strain.
    """
    some = part.make(0, 1)
    if len(some.velocities) == 1:
        return 1.0
    x = some.positions - some.positions.mean(axis=0)
    v = some.velocities - some.velocities.mean(axis=0)
    gradient, _, rank, _ = np.linalg.lstsq(x, v, rcond=None)  # v = x gradient
    if rank < x.shape[1]:
        return 1.0
    rates, ways = np.linalg.eigh(0.5 * (gradient + gradient.T))
    if not rates[-1] > 0.0:
        return 1.0
    strained = v - x @ (0.5 * (gradient - gradient.T))  # without what turns it
    along = strained @ ways[:, -1]
    half = 0.5 * float(np.ptp(along))
    strain = half / _speed_in_a_bar(material)
    for key in _YIELD:
        strength = material.strength.parameters.get(key, 0.0)
        if strength > 0.0:
            strain = max(strain, 0.5 * material.density * half**2 / strength)
    return 1.0 + strain


def _speed_in_a_bar(material: Material) -> float:
    moduli = moduli_of(material)
    modulus = moduli.E if moduli else 3.0 * material.strength.parameters.get("G", 0.0)
    return math.sqrt(modulus / material.density) if modulus else material.sound_speed()


def _by_motions(case: Case, name: str, bodies: Filled) -> float:
    """Return the largest stretch between two bodies with prescribed motions that hold a body."""
    grips = [
        other
        for other, body in case.body.items()
        if body.motion is not None and is_bonded(case, name, other)
    ]
    return max((_between(case, *pair, bodies) for pair in combinations(grips, 2)), default=1.0)


def _between(case: Case, first: str, second: str, bodies: Filled) -> float:
    one, other = bodies.parts[first], bodies.parts[second]
    gaps = np.maximum(other.survey.lower - one.survey.upper, one.survey.lower - other.survey.upper)
    gap = gaps[0] - 0.5 * (one.spacing + other.spacing)
    axis = int(np.argmax(gap))
    if not gap[axis] > 0.0:
        return 1.0
    sign = 1.0 if other.survey.lower[0, axis] > one.survey.upper[0, axis] else -1.0
    way = sign * (_path(case, second) - _path(case, first)) / gap[axis]
    strained = np.tile(np.eye(len(gap)), (len(way), 1, 1))
    strained[:, :, axis] += way
    return float(np.linalg.svd(strained, compute_uv=False)[:, 0].max())


def _path(case: Case, name: str) -> Array:
    """Return how far a body has been moved at some times, shape (_TIMES + 1, D) [m]."""
    motion, dimension = case.body[name].motion, case.grid.dimension
    assert motion is not None
    times = np.linspace(0.0, case.run.end_time, _TIMES + 1)
    still = motion.model_copy(update={"angular_velocity": ()})
    zero = np.zeros((1, dimension))
    v = np.concatenate([still.velocities(float(t), zero, zero[0]) for t in times])
    steps = 0.5 * (v[1:] + v[:-1]) * np.diff(times)[:, None]
    return np.concatenate([zero, np.cumsum(steps, axis=0)])
