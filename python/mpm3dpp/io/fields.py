# SPDX-License-Identifier: BSD-3-Clause
"""The arrays of one frame, as they are stored: each is made when its turn comes, and then dropped.

A particle has a number of them for every eight that the core holds, so that all at once, or in
doubles, would be the larger part of a run's memory.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.names import grain_numbers, numbered
from mpm3dpp.base.outputs import CHANGING, COLUMNS, CONSTANT, DERIVED, ON_REQUEST, STANDARD, UNITS
from mpm3dpp.base.parts import equal_part

from .frame_tables import Table, tables_of
from .rows import FROM_VTK

_PLACES = {2: (0, 1), 4: (0, 1, 2, 3), 6: FROM_VTK}
"""Where VTK has our components: vectors have three there, tensors xx yy zz xy yz xz."""


class Column(NamedTuple):
    """An array that is made when its turn comes.

    Attributes:
        name: of the array.
        bytes: that it takes.
        make: gives the array, float32 or int32, a row for each particle.
    """

    name: str
    bytes: int
    make: Callable[[], np.ndarray]


@dataclass(frozen=True)
class Frame:
    """What a simulation holds at one time, as it is stored.

    Attributes:
        time: [s].
        step: number of steps made until then.
        rows: particles in each part that is a file of its own; the columns are those of one of
            them.
        columns: "position" first; all bodies one after another in their original order.
        tables: see `frame_tables.tables_of`.
    """

    time: float
    step: int
    rows: list[int]
    columns: Iterable[Column]
    tables: Mapping[str, Table] = field(default_factory=dict)


def frame_of(
    simulation: Any,
    fields: Sequence[str] = (),
    names: Sequence[str] = (),
    materials: Sequence[int] = (),
    constants: bool = True,
    writers: Sequence[int] = (0,),
    part: int | None = 0,
) -> Frame:
    """Return the present state of the core's `Simulation`; its columns are made as they are taken.

    Args:
        simulation: the core's; it must not step until the last column has been taken.
        fields: names of further columns of the core, e.g. "left_cauchy_green"; NaN where the model
            of a body has no such column.
        names: of each body; bodies of one name are grains.
        materials: number of the material of each body.
        constants: whether the columns that do not change are among them.
        writers: the ranks that write frames, each a slice of the particles; all ranks ask for the
            same columns at once.
        part: which of the slices, None for no particles.

    Returns:
        A frame with position [m] and velocity [m/s] (n, 3), z = 0 in 2D; stress [Pa] (n, 6) in
        VTK's order xx yy zz xy yz xz; pressure and von_mises [Pa] (n,); further columns with their
        own number of components; and, if constant: id (n,), the particle's number among all; body
        and material (n,); grain (n,), the body's number among those of its name, if any name comes
        twice; size [m] (n,), the edge of the square or cube of the particle's volume at the
        start.

    Raises:
        CaseError: no body has a column of that name.
    """
    stored = {name: _components(simulation, name) for name in COLUMNS}
    stored |= {
        name: _components(simulation, name)
        for name in fields
        if name not in (*STANDARD, *ON_REQUEST)
    }
    widths = {name: _width(name, components) for name, components in stored.items()}
    ends = [
        equal_part(int(simulation.particle_count), k, len(writers)) for k in range(len(writers))
    ]
    first, last = (0, 0) if part is None else ends[part]
    of_slice = partial(_column, simulation, list(writers))

    def column(name: str, make: Callable[[], np.ndarray], width: int = 1) -> Column:
        return Column(name, 4 * width * (last - first), make)

    columns = [
        column(name, partial(of_slice, name, stored[name], width), width)
        for name, width in widths.items()
    ]
    derived = partial(_derived, simulation, list(writers))
    asked = [name for name in ON_REQUEST if name in fields]
    columns += [
        column(name, partial(derived, name), DERIVED[name]["components"])
        for name in (*CHANGING, *asked)
    ]
    if constants:
        fixed = _constants(simulation, names, materials, first, last)
        columns += [column(name, make) for name, make in fixed.items()]
        columns += [column(name, partial(derived, name)) for name in CONSTANT]
    rows = [end - begin for begin, end in ends]
    tables = tables_of(simulation, names)
    return Frame(float(simulation.time), int(simulation.step), rows, columns, tables)


def column_components(simulation: Any) -> dict[str, int]:
    """Return the components of every column that bodies of this simulation have, by name."""
    bodies = range(simulation.body_count)
    return {c.name: int(c.components) for b in bodies for c in simulation.columns(b)}


def column_units(simulation: Any) -> dict[str, str]:
    """Unit of every array that a frame of this simulation can have, name -> unit."""
    units = dict(UNITS)
    for b in range(simulation.body_count):
        units.update({c.name: c.unit for c in simulation.columns(b) if c.name not in units})
    return units


def _column(
    simulation: Any, writers: list[int], name: str, components: int, width: int
) -> np.ndarray:
    """Return a column of the core as it is stored."""
    places = _PLACES.get(components, tuple(range(components)))
    elsewhere = 0.0 if name in STANDARD else math.nan
    if components < width:  # The third component of vectors in 2D.
        elsewhere = 0.0
    column: np.ndarray = simulation.rounded_column(name, list(places), width, elsewhere, writers)
    return column if width > 1 else column[:, 0]


def _components(simulation: Any, name: str) -> int:
    """Return those of a column of the core. Raises `CaseError` where no body has it."""
    components = column_components(simulation)
    if name in components:
        return components[name]
    known = set(components)
    raise CaseError(
        f"output.fields: no material of this case stores '{name}'; "
        f"choose from {', '.join(sorted(known - set(STANDARD))) or 'the standard fields only'}"
    )


def _width(name: str, components: int) -> int:
    """Return the numbers that are stored of a column: vectors have three, stress six, in 2D too."""
    if name == "stress":
        return 6
    return 3 if components == 2 else components


def _constants(
    simulation: Any, names: Sequence[str], materials: Sequence[int], first: int, last: int
) -> dict[str, Callable[[], np.ndarray]]:
    """Return what makes the columns of bodies that do not change, by name, of a slice."""
    counts = [int(simulation.body_particle_count(b)) for b in range(simulation.body_count)]
    ends = np.cumsum([0, *counts]).clip(first, last)  # of each body, in the slice

    def of_body(numbers: Sequence[int]) -> Callable[[], np.ndarray]:
        return lambda: np.repeat(np.asarray(numbers, dtype=np.int32), np.diff(ends))

    different, numbers = numbered(names)
    made = {
        "id": lambda: np.arange(first, last, dtype=np.int32),
        "body": of_body(numbers),
        "material": of_body(materials),
    }
    if len(different) < len(numbers):
        made["grain"] = of_body(grain_numbers(names))
    return made


def _derived(simulation: Any, writers: list[int], name: str) -> np.ndarray:
    values: np.ndarray = simulation.rounded_derived(name, writers)
    return values if values.shape[1] > 1 else values[:, 0]
