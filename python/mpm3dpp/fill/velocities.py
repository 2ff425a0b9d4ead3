# SPDX-License-Identifier: BSD-3-Clause
"""Velocities of particles at the start: numbers, formulas of place, or a prescribed motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import Path as KeyPath
from mpm3dpp.base.expression import Expression
from mpm3dpp.base.mean import mass_centre
from mpm3dpp.case.body import Body
from mpm3dpp.case.case import Case

Array = NDArray[np.float64]
_LARGEST = 1e100  # As of all quantities in a case.


def start_velocities(
    case: Case,
    part: str,
    positions: Array,
    volumes: Array,
    counts: NDArray[np.int64] | None = None,
    world: Any = None,
) -> Array:
    """Return v + w x (x - x_mass centre) of each particle of a body, or of some grains [m/s].

    Args:
        case: gives v and the spin w, or the prescribed motion, or velocities one by one.
        part: name of the body, or of the entry of grains that they belong to.
        positions: [m], shape (n, D), one body after another.
        volumes: of the particles [m^3; in 2D m^2], shape (n,); those of a grain are equal.
        counts: how many each grain has; None for a body.
        world: processes that have others of its particles.

    Returns:
        Shape (1, D) if all are equal by the case, else (n, D).

    Raises:
        CaseError: a formula gives no finite number at a particle.
    """
    entry = case.parts()[part]
    if isinstance(entry, Body) and entry.motion is not None:
        return entry.motion.velocities(
            0.0, positions, entry.motion.middle(positions, volumes, world)
        )
    if isinstance(entry, Body) and entry.particles is not None:
        given = entry.particles.velocities
        if given is not None:
            return given
    spins = any(entry.angular_velocity)
    if not spins and not any(isinstance(value, Expression) for value in entry.velocity):
        return np.array([entry.velocity], dtype=float)
    dimension = positions.shape[1]
    arm = arms_of(positions, volumes, counts, world)
    places = places_of(positions, arm)

    def values(name: str) -> list[Any]:
        path = (*case.part_path(part), name)
        given = enumerate(getattr(entry, name))
        return [value_at(case, value, places, (*path, index)) for index, value in given]

    velocity = np.stack(np.broadcast_arrays(*values("velocity")), axis=-1)
    velocity = velocity.reshape(-1, dimension).copy()
    if not spins:
        return velocity
    spin = values("angular_velocity")
    if dimension == 2:
        return velocity + np.asarray(spin[0])[..., None] * np.column_stack([-arm[:, 1], arm[:, 0]])
    return velocity + np.cross(np.stack(np.broadcast_arrays(*spin), axis=-1), arm)


def arms_of(
    positions: Array, volumes: Array, counts: NDArray[np.int64] | None, world: Any = None
) -> Array:
    """Return the ways from the mass centre of its body to each particle [m]; see above."""
    if counts is None:
        return positions - mass_centre(positions, volumes, world)
    # In the same way for one grain as for many: they may be made in any groups.
    sums = np.add.reduceat(positions, np.cumsum(counts) - counts, axis=0)
    return positions - np.repeat(sums / counts[:, None], counts, axis=0)


def places_of(positions: Array, arm: Array) -> dict[str, Array]:
    """Return the variables of formulas at the start, by name."""
    places = dict(zip("xyz", positions.T, strict=False))
    places["r"] = np.sqrt((arm**2).sum(axis=1))
    return places


def value_at(
    case: Case, value: float | Expression, places: Mapping[str, Array], path: KeyPath
) -> float | Array:
    """Return a number, or the values of a formula at particles, shape (n,)."""
    if not isinstance(value, Expression):
        return value
    found = value.at(places)
    good = np.abs(found) < _LARGEST
    if good.all():
        return found
    worst = int(np.argmin(good))
    where = ", ".join(f"{name} = {at[worst]:g} m" for name, at in places.items())
    rule = f"gives {found[worst]:g} at {where}, which is no finite number"
    raise case.error(
        (*path, "expression"), rule, "write one that has a value there", value=value.text
    )
