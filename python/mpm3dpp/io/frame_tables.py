# SPDX-License-Identifier: BSD-3-Clause
"""Tables in the file of a frame, which have rows of their own: of bodies, grains and contacts."""

from __future__ import annotations

import zlib
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp import _core
from mpm3dpp.base.names import grain_numbers, numbered

from .open_h5 import own
from .part_cells import PART_COLUMNS, PART_LIMIT

if TYPE_CHECKING:
    import h5py

Table = np.ndarray
"""A structured array: a row for each thing that the table is of, columns by name."""

GRAIN_COLUMNS: dict[str, tuple[str, str]] = {
    "entry": ("1", "number of its entry of the case, as the names of `Results.bodies` count"),
    "grain": ("1", "its number among the grains of the entry, 0 for a body"),
    **_core.grain_columns,
}
"""Unit and meaning of the columns of a frame's table `grains`, a row for each body."""

CONTACT_COLUMNS: dict[str, tuple[str, str]] = _core.contact_columns
"""Unit and meaning of the columns of a frame's table `contacts`; bodies are rows of `grains`."""

_WHOLE = {"entry", "grain", "contacts", "a", "b"}


def tables_of(simulation: Any, names: Sequence[str]) -> dict[str, Table]:
    """Return the tables of the present state of the core's `Simulation`; all ranks ask at once.

    Args:
        simulation: the core's.
        names: of each body; bodies of one name are grains. With more than one body there are
            tables `grains` of GRAIN_COLUMNS and `contacts` of CONTACT_COLUMNS, and with more than
            PART_LIMIT names, of which the history has no columns, `bodies` of PART_COLUMNS.
    """
    tables: dict[str, Table] = {}
    if len(names) > 1:
        grains, contacts = simulation.grains_and_contacts()
        told = np.column_stack([numbered(names)[1], grain_numbers(names), grains])
        tables["grains"] = _table(told, list(GRAIN_COLUMNS))
        tables["contacts"] = _table(contacts, list(CONTACT_COLUMNS))
    if len(set(names)) > PART_LIMIT:
        tables["bodies"] = _table(simulation.part_sums()[1], list(PART_COLUMNS))
    return tables


def write_tables(file: h5py.File, tables: Mapping[str, Table]) -> dict[str, int]:
    """Write tables into the file of a frame; return the check sum of each."""
    for name, table in tables.items():
        file.create_dataset(f"tables/{name}", data=table)
    return {name: zlib.crc32(table.tobytes()) for name, table in tables.items()}


def columns_of(file: h5py.File, name: str, check: int) -> dict[str, np.ndarray]:
    """Return a table in the file of a frame, columns by name.

    Raises:
        ValueError: it is not what was written.
    """
    table = own(file[f"tables/{name}"])[()]
    if zlib.crc32(table.tobytes()) != check:
        raise ValueError(name)
    return {key: np.ascontiguousarray(table[key]) for key in table.dtype.names}


def _table(rows: np.ndarray, names: Sequence[str]) -> Table:
    kinds = [(name, np.int32 if name in _WHOLE else np.float64) for name in names]
    table = np.empty(len(rows), dtype=kinds)
    for k, name in enumerate(names):
        table[name] = rows[:, k]
    return table
