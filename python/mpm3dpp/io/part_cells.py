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
    """What the history holds of the bodies.

    Args:
        names: of the bodies, all grains of an entry being one.
        first: rows of the first sums of a run that goes on; none if it begins.
    """

    def __init__(self, names: Sequence[str], first: Sequence[Sequence[float]] = ()) -> None:
        self._names = list(names)
        self._told = self._names if len(names) <= PART_LIMIT else []
        self.first = np.array(first) if len(first) else None
        self._last = self.first

    @property
    def header(self) -> list[str]:
        """Names of the columns."""
        told = [f"body_{name}_{column}" for name in self._told for column in PART_COLUMNS]
        return [*TOTALS, *told]

    def note(self, sums: Sums) -> None:
        """Keep the core's `part_sums()` if they are the first, and as the last."""
        self._last = sums[1]
        if self.first is None:
            self.first = sums[1]

    def cells(self, sums: Sums) -> list[str]:
        """Return the cells of a row.

        Args:
            sums: the core's `part_sums()`.
        """
        totals, parts = sums
        told = parts.ravel().tolist() if self._told else []
        return [repr(value) for value in [*totals, *told]]

    def records(self) -> dict[str, dict[str, dict[str, float]]]:
        """Return of each body what PART_COLUMNS were, `initial` and `final`."""
        found = {}
        for which, rows in (("initial", self.first), ("final", self._last)):
            if rows is not None:
                found[which] = [dict(zip(PART_COLUMNS, row, strict=True)) for row in rows.tolist()]
        return {
            name: {which: rows[k] for which, rows in found.items()}
            for k, name in enumerate(self._names)
        }
