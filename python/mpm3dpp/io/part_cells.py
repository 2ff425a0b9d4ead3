# SPDX-License-Identifier: BSD-3-Clause
"""The columns of `history.csv` for each body, and for the angular momentum of all."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mpm3dpp import _core

PART_COLUMNS: dict[str, tuple[str, str]] = _core.part_columns
"""Unit and meaning of the core's `part_sums` of each body: columns `body_A_mass`, ..."""

TOTALS: dict[str, tuple[str, str]] = {
    "angular_momentum_x": ("N m s", "of all that takes part, about the origin; 0 in 2D"),
    "angular_momentum_y": ("N m s", "likewise"),
    "angular_momentum_z": ("N m s", "likewise"),
}
"""Unit and meaning of the columns before those of bodies."""

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

    def cells(self, parts: np.ndarray) -> list[str]:
        """Return the cells of a row.

        Args:
            parts: the core's `part_sums()`, shape (bodies, PART_COLUMNS).
        """
        places = {name: k for k, name in enumerate(PART_COLUMNS)}
        centre, momentum, angular = (
            parts[:, [places[f"{name}_{axis}"] for axis in "xyz"]]
            for name in ("centre", "momentum", "angular_momentum")
        )
        total = np.sum(angular + np.cross(centre, momentum), axis=0)
        told = parts.ravel().tolist() if self._told else []
        return [repr(value) for value in [*total.tolist(), *told]]
