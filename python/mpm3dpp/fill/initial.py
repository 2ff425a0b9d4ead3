# SPDX-License-Identifier: BSD-3-Clause
"""Stresses and states of particles at the start."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import Path as KeyPath
from mpm3dpp.base.expression import Expression
from mpm3dpp.base.time_functions import at
from mpm3dpp.case.case import Case, Material
from mpm3dpp.case.initial import GEOSTATIC, PARTS, Initial, allowed
from mpm3dpp.case.initial_fields import STRESS, InitialFields
from mpm3dpp.ranks.world import World

from .parts import Filled, FilledPart
from .velocities import arms_of, places_of, value_at

Array = NDArray[np.float64]


@dataclass(frozen=True)
class _Layer:
    """A body as gravity sees it: its bottom and its top in each column of cells.

    Attributes:
        first: numbers of the first column along the other axes, shape (D - 1,).
        bottom, top: along the axis of gravity, against it [m], shape of the columns.
        weight: rho |g| [N/m^3].
    """

    first: Array
    bottom: Array
    top: Array
    weight: float


@dataclass(frozen=True)
class Overburden:
    """What presses on a place: all that deforms and stands above it, grains left out.

    A body reaches, in each column of cells, from its lowest to its highest particle and half their
    distance further: level layers give the weight exactly, whatever stands beside them.
    """

    axis: int
    up: float  # 1 or -1: against gravity
    cell: float
    layers: list[_Layer]

    def at(self, positions: Array) -> Array:
        """Return the vertical pressure at places (n, D) [Pa], shape (n,)."""
        height = self.up * positions[:, self.axis]
        columns = _columns(positions, self.axis, self.cell)
        total = np.zeros(len(positions))
        for layer in self.layers:
            places = (columns - layer.first).astype(np.int64)
            inside = ((places >= 0) & (places < layer.top.shape)).all(axis=1)
            of_column = tuple(places[inside].T)
            bottom, top = layer.bottom[of_column], layer.top[of_column]
            above = np.maximum(top - np.maximum(height[inside], bottom), 0.0)
            total[inside] += layer.weight * np.where(np.isfinite(above), above, 0.0)
        return total


def overburden(case: Case, filled: Filled, world: World | None = None) -> Overburden | None:
    """Return what presses on the bodies of a case; None if no stress is geostatic.

    Args:
        case: checked.
        filled: its bodies.
        world: processes that have slices of them; each calls this.
    """
    if not any(b.initial and b.initial.stress == GEOSTATIC for b in case.body.values()):
        return None
    gravity = [at(g, 0.0) for g in case.run.gravity]
    axis = int(np.argmax(np.abs(gravity)))
    up, cell = -math.copysign(1.0, gravity[axis]), case.grid.cell_size
    layers = [
        _layer(
            part, axis, up, cell, case.material[part.material].density * abs(gravity[axis]), world
        )
        for name, part in filled.parts.items()
        if name in case.body and case.body[name].motion is None and not case.is_rigid(name)
    ]
    return Overburden(axis, up, cell, layers)


def _columns(positions: Array, axis: int, cell: float) -> Array:
    """Return the numbers of the columns of cells along the other axes, shape (n, D - 1)."""
    return np.floor(np.delete(positions, axis, axis=1) / cell)


def _layer(
    part: FilledPart, axis: int, up: float, cell: float, weight: float, world: World | None
) -> _Layer:
    ends = np.stack([part.survey.lower.min(axis=0), part.survey.upper.max(axis=0)])
    first, last = _columns(ends, axis, cell)
    shape = tuple(int(n) for n in last - first + 1)
    top, below = np.full(shape, -np.inf), np.full(shape, -np.inf)
    for some in part.chunks():
        height = up * some.positions[:, axis]
        places = tuple((_columns(some.positions, axis, cell) - first).astype(np.int64).T)
        np.maximum.at(top, places, height)
        np.maximum.at(below, places, -height)
    if world is not None:
        world.all_max(top)
        world.all_max(below)
    half = 0.5 * part.spacing
    return _Layer(first, -below - half, top + half, weight)


def start_columns(
    case: Case, part: FilledPart, positions: Array, volumes: Array, above: Overburden | None,
    world: World | None,
) -> dict[str, Array]:  # fmt: skip
    """Return the columns of a body that its `initial` gives: name -> values, (n,) or (n, parts).

    Args:
        case: gives them.
        part: the body.
        positions, volumes: of its particles, or those of this process, (n, D) [m] and (n,).
        above: what presses on it, of `overburden`.
        world: processes that have others of its particles.

    Raises:
        CaseError: a formula gives no finite number at a particle.
    """
    initial = case.body[part.name].initial
    if initial is None:
        return {}
    places = places_of(positions, arms_of(positions, volumes, None, world))
    path = (*case.part_path(part.name), "initial")

    def column(value: float | Expression, *keys: str | int) -> Array:
        found = value_at(case, value, places, (*path, *keys))
        return np.broadcast_to(np.asarray(found, dtype=float), len(positions)).copy()

    found = {name: column(value, "state", name) for name, value in initial.state.items()}
    if initial.fields is not None:
        found |= _of_fields(case, initial.fields, positions, path)
    for name in initial.state:
        values = found[name]
        least, most = allowed(name)
        if values.size and not (least <= values.min() and values.max() <= most):
            rule = f"gives values from {values.min():g} to {values.max():g}"
            remedy = "it must be between 0 and 1" if most == 1.0 else "it must be >= 0"
            raise case.error((*path, "state", name), rule, remedy)
    if initial.stress == GEOSTATIC and above is not None:
        K0 = at_rest(case.material[part.material], initial)
        vertical = above.at(positions)
        stress = np.zeros((len(positions), len(PARTS[case.grid.dimension])))
        for k in range(3):
            stress[:, k] = -vertical if k == above.axis else -K0 * vertical
        found["stress"] = stress
    elif initial.stress is not None:
        parts = [column(value, "stress", k) for k, value in enumerate(initial.stress)]  # type: ignore[arg-type]
        found["stress"] = np.column_stack(parts)
    return found


def _of_fields(
    case: Case, fields: InitialFields, positions: Array, path: KeyPath
) -> dict[str, Array]:
    """Return the columns of a body that a file gives."""
    try:
        given = fields.at(positions)
    except ValueError as error:
        remedy = "give places around the body, or on a grid of axes"
        raise case.error((*path, "fields"), str(error), remedy, value=fields.file) from None
    if fields.has_stress:
        parts = PARTS[case.grid.dimension]
        given["stress"] = np.column_stack([given.pop(f"{STRESS}{part}") for part in parts])
    return given


def at_rest(material: Material, initial: Initial) -> float:
    """Return K0: that given, else nu / (1 - nu) of the elastic part."""
    nu: float = material.strength.parameters.get("nu", 0.0)
    return nu / (1.0 - nu) if initial.K0 is None else initial.K0
