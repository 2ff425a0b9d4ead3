# SPDX-License-Identifier: BSD-3-Clause
"""Tables in the file of a frame, which have rows of their own: of bodies, where there are many."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from .part_cells import PART_COLUMNS, PART_LIMIT

if TYPE_CHECKING:
    import h5py

Table = Mapping[str, np.ndarray]
"""Columns by name, a row in each for each thing that the table is of."""


def tables_of(simulation: Any, bodies: int) -> dict[str, Table]:
    """Return the tables of the present state of the core's `Simulation`; all ranks ask at once.

    Args:
        simulation: the core's.
        bodies: how many there are, all grains of an entry being one; with more than PART_LIMIT,
            whose columns the history does not have, there is a table `bodies` of PART_COLUMNS.
    """
    if bodies <= PART_LIMIT:
        return {}
    rows = simulation.part_sums()[1]
    return {"bodies": {name: rows[:, k].copy() for k, name in enumerate(PART_COLUMNS)}}


def write_tables(file: h5py.File, tables: Mapping[str, Table]) -> dict[str, dict[str, int]]:
    """Write tables into the file of a frame; return the check sum of each column."""
    checks: dict[str, dict[str, int]] = {}
    for name, columns in tables.items():
        group = file.create_group(f"tables/{name}")
        checks[name] = {}
        for key, column in columns.items():
            group.create_dataset(key, data=column)
            checks[name][key] = zlib.crc32(np.ascontiguousarray(column).data)
    return checks


def columns_of(file: h5py.File, name: str, checks: Mapping[str, int]) -> dict[str, np.ndarray]:
    """Return a table in the file of a frame. Raises `ValueError` if it is not what was written."""
    columns = {key: file[f"tables/{name}/{key}"][()] for key in checks}
    for key, column in columns.items():
        if zlib.crc32(column.data) != checks[key]:
            raise ValueError(key)
    return columns
