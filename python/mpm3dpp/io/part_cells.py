# SPDX-License-Identifier: BSD-3-Clause
"""The columns of `history.csv` for each body, and for the balance of angular momentum."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mpm3dpp import _core

PART_COLUMNS: dict[str, tuple[str, str]] = _core.part_columns
"""Unit and meaning of the core's `part_sums` of each body: columns `body_A_mass`, ..."""

TOTALS: dict[str, tuple[str, str]] = _core.total_columns
"""Unit and meaning of the columns before those of bodies."""

Sums = tuple[list[float], np.ndarray]
"""What `part_sums()` returns: TOTALS, and PART_COLUMNS of each body, shape (bodies, columns)."""

PART_LIMIT = 12
"""Most bodies, all grains of an entry being one, that get columns of their own."""


class PartCells:
    """Cells of a row of the history.

    Args:
        names: of the bodies, all grains of an entry being one.
    """

    def __init__(self, names: Sequence[str]) -> None:
        self._told = list(names) if len(names) <= PART_LIMIT else []

    @property
    def header(self) -> list[str]:
        """Names of the columns."""
        told = [f"body_{name}_{column}" for name in self._told for column in PART_COLUMNS]
        return [*TOTALS, *told]

    def cells(self, sums: Sums) -> list[str]:
        """Return the cells of a row.

        Args:
            sums: the core's `part_sums()`.
        """
        totals, parts = sums
        told = parts.ravel().tolist() if self._told else []
        return [repr(value) for value in [*totals, *told]]
