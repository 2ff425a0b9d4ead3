# SPDX-License-Identifier: BSD-3-Clause
"""The arrays of one frame: copied from a simulation body by body, and what follows from them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mpm3dpp.errors import CaseError

STANDARD = ("position", "velocity", "stress", "pressure", "von_mises", "body", "material")
"""Arrays that every frame has."""

UNITS = {
    "position": "m",
    "velocity": "m/s",
    "stress": "Pa",
    "pressure": "Pa",
    "von_mises": "Pa",
    "size": "m",
    "body": "",
    "grain": "",
    "material": "",
}
"""Unit of each standard array; the columns of the core bring their own."""


def pressure(stress: np.ndarray) -> np.ndarray:
    """Mean compressive stress -(xx + yy + zz)/3 [Pa], shape (n,).

    Args:
        stress: Cauchy stress [Pa], shape (n, 6), order xx yy zz yz xz xy, tension positive.
    """
    return -(stress[:, 0] + stress[:, 1] + stress[:, 2]) / 3.0


def von_mises(stress: np.ndarray) -> np.ndarray:
    """Equivalent stress sqrt(3/2 s:s), s the deviator [Pa], shape (n,) (von Mises, 1913).

    Args:
        stress: Cauchy stress [Pa], shape (n, 6), order xx yy zz yz xz xy.
    """
    xx, yy, zz, yz, xz, xy = stress.T
    normal = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2
    shear = yz**2 + xz**2 + xy**2
    return np.sqrt(0.5 * normal + 3.0 * shear)


def three(vectors: np.ndarray) -> np.ndarray:
    """Vectors of shape (n, 2) or (n, 3) as (n, 3), with z = 0 in two dimensions."""
    if vectors.shape[1] == 3:
        return vectors
    return np.column_stack([vectors, np.zeros(len(vectors))])


def numbered(names: Sequence[str]) -> tuple[list[str], list[int]]:
    """Return the different names in their order, and the number of each name in that list."""
    numbers = {name: k for k, name in enumerate(dict.fromkeys(names))}
    return list(numbers), [numbers[name] for name in names]


def particle_sizes(simulation: Any, dimension: int) -> np.ndarray:
    """Edge length of the square or cube of each particle's volume [m], shape (n,)."""
    volumes = [_flat(simulation.column(b, "volume")) for b in range(simulation.body_count)]
    return np.concatenate(volumes) ** (1.0 / dimension)


@dataclass(frozen=True)
class Frame:
    """A copy of what a simulation held at one time; `frame_arrays` makes of it what is stored.

    Attributes:
        time: [s].
        step: number of steps made until then.
        counts: particles of each body.
        columns: position [m], velocity [m/s], stress [Pa] and further columns by name, all bodies
            one after another in their original order.
    """

    time: float
    step: int
    counts: list[int]
    columns: dict[str, np.ndarray]


def copy_frame(simulation: Any, fields: Sequence[str] = ()) -> Frame:
    """Copy the present state of the core's `Simulation`.

    Args:
        simulation: the core's.
        fields: names of further columns of the core, e.g. "left_cauchy_green"; NaN where the model
            of a body has no such column.

    Raises:
        CaseError: no body has a column of that name.
    """
    bodies = range(simulation.body_count)
    counts = [int(simulation.body_particle_count(b)) for b in bodies]
    columns = {
        name: np.concatenate([simulation.column(b, name) for b in bodies])
        for name in ("position", "velocity", "stress")
    }
    for name in fields:
        if name not in STANDARD:
            columns[name] = _optional(simulation, name, counts)
    return Frame(float(simulation.time), int(simulation.step), counts, columns)


def frame_arrays(
    frame: Frame, names: Sequence[str], materials: Sequence[int]
) -> dict[str, np.ndarray]:
    """Every array that is stored of a frame.

    Args:
        frame: the copy.
        names: of each body; bodies of one name are grains.
        materials: number of the material of each body, one per body.

    Returns:
        name -> array with n rows: position [m] and velocity [m/s] (n, 3), z = 0 in 2D;
        stress [Pa] (n, 6) in the order xx yy zz yz xz xy; pressure and von_mises [Pa] (n,);
        body and material (n,) int32; grain (n,) int32, the body's number among those of its
        name, if any name comes twice; the further columns of the frame with their own number of
        components.
    """

    def of_body(numbers: Sequence[int]) -> np.ndarray:
        return np.repeat(np.asarray(numbers, dtype=np.int32), frame.counts)

    columns = dict(frame.columns)
    stress = columns.pop("stress")
    different, numbers = numbered(names)
    arrays = {
        "position": three(columns.pop("position")),
        "velocity": three(columns.pop("velocity")),
        "stress": stress,
        "pressure": pressure(stress),
        "von_mises": von_mises(stress),
        "body": of_body(numbers),
        "material": of_body(materials),
    }
    if len(different) < len(numbers):
        firsts = [numbers.index(k) for k in range(len(different))]
        arrays["grain"] = of_body([b - firsts[k] for b, k in enumerate(numbers)])
    return arrays | columns


def column_units(simulation: Any) -> dict[str, str]:
    """Unit of every array that a frame of this simulation can have, name -> unit."""
    units = dict(UNITS)
    for b in range(simulation.body_count):
        units.update({c.name: c.unit for c in simulation.columns(b) if c.name not in units})
    return units


def _optional(simulation: Any, name: str, counts: Sequence[int]) -> np.ndarray:
    """A column that only some of the bodies have; NaN for the particles of the others."""
    columns = [{c.name: c for c in simulation.columns(b)} for b in range(len(counts))]
    found = [c[name] for c in columns if name in c]
    if not found:
        known = sorted({key for c in columns for key in c} - set(STANDARD))
        raise CaseError(
            f"output.fields: no material of this case stores '{name}'; "
            f"choose from {', '.join(known) or 'the standard fields only'}"
        )
    parts = []
    for b, count in enumerate(counts):
        if name in columns[b]:
            parts.append(np.asarray(simulation.column(b, name)).reshape(count, -1))
        else:
            parts.append(np.full((count, found[0].components), np.nan))
    whole = np.concatenate(parts)
    if whole.shape[1] == 1:
        return whole[:, 0]
    return three(whole) if whole.shape[1] == 2 else whole


def _flat(column: np.ndarray) -> np.ndarray:
    return np.asarray(column).reshape(-1)
