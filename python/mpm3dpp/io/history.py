# SPDX-License-Identifier: BSD-3-Clause
"""`history.csv`: one row per step with energies, ledger, momenta and contact per pair."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp import _core
from mpm3dpp.base.disk import make_folder
from mpm3dpp.base.names import numbered

from .pair_columns import pairs_with_columns
from .part_cells import PartCells, Sums
from .table import Table

TERMS: dict[str, dict[str, str]] = _core.history_terms
"""The columns of the table, before those of pairs: `unit`, `meaning`, `role` in the balance of the
ledger ("energy", "error", "supply", "residual", "other") and the column that it is `part_of`."""

ENERGIES = tuple(name for name, term in TERMS.items() if term["role"] != "other")
"""Those that the balance of the ledger has [J]."""

PAIR_MEANINGS: dict[str, tuple[str, str]] = {
    "contact_force_A_B_x": ("N", "force of the step on body A from body B; `_y`, `_z` follow"),
    "contact_impulse_A_B_x": ("N s", "its impulse so far; `_y`, `_z` follow"),
}
"""Unit and meaning of the columns that follow for each pair of bodies A and B with contact."""

ERROR_PARTS = tuple(name for name, term in TERMS.items() if term["part_of"] == "numerical")
"""The named parts of `numerical` [J]."""

PAIRS = "contact_pairs.csv"

MOMENTUM = tuple(f"momentum_{x}" for x in "xyz")
"""Those of the momentum of all bodies [N s]."""

_AXES = ("x", "y", "z")
_LARGEST = ("residual", "numerical", "external")  # of which the largest size is kept


class HistoryWriter:
    """Writes `history.csv` and, with very many bodies, `contact_pairs.csv` beside it.

    The pairs' columns are `contact_force_<a>_<b>_x/y/z` [N] and `contact_impulse_<a>_<b>_x/y/z`
    [N s], both on the first body (per metre of thickness in 2D). They and the columns of bodies
    stand in the last row of each block given to `append`; cells of the rows before it stay empty.

    Args:
        path: the file; its folder is made, an old file replaced.
        columns: of the rows, the core's `history_columns`.
        bodies: name of each body. Bodies of one name, grains, are taken together, and what they
            do to each other has no columns.
        contact: whether the run has contact; without it there are no pairs' columns.
        parts: whether there are columns of bodies and walls, and of the angular momentum of all.
        walls: names of the faces of the box that are not free.
        every: keep the rows whose step is a multiple of this, and the last of each block.
        state: of a run that goes on, `state()` then; the files have what it says
            (`check_history`), and rows written later are cut off.
        anew: the tables begin anew, though the run goes on: they have been lost.

    Raises:
        CaseError: the file cannot be written; the rows written before stay readable.
    """

    def __init__(
        self,
        path: str | Path,
        *,
        columns: Sequence[str],
        bodies: Sequence[str],
        contact: bool = True,
        parts: bool = False,
        walls: Sequence[str] = (),
        every: int = 1,
        state: Mapping[str, Any] | None = None,
        anew: bool = False,
    ) -> None:
        self.path = Path(path)
        self._every = max(1, every)
        self._bodies = list(bodies)
        names, numbers = numbered(bodies)
        firsts = [numbers.index(k) for k in range(len(names))]
        pairs = pairs_with_columns(firsts if contact else [])
        self._pairs = {pair: k for k, pair in enumerate(pairs or [])}
        header = list(columns)
        ends = [state["bodies"], state["last_bodies"]] if state else [(), ()]
        self._parts = PartCells(names, walls, *ends) if parts else None
        self._part_cells = self._parts.header if self._parts else []
        header += self._part_cells
        for both in (f"{self._bodies[a]}_{self._bodies[b]}" for a, b in self._pairs):
            header += [f"contact_{k}_{both}_{x}" for k in ("force", "impulse") for x in _AXES]
        make_folder(self.path.parent)
        known = [None, None] if state is None or anew else state["tables"]
        self._table = Table(self.path, header, known[0])
        self._long: Table | None = None
        if pairs is None:
            values = [f"contact_{kind}_{x}" for kind in ("force", "impulse") for x in _AXES]
            path = self.path.with_name(PAIRS)
            self._long = Table(path, ["step", "time", "body_a", "body_b", *values], known[1])
        self._index = {name: k for k, name in enumerate(columns)}
        self._summary: dict[str, Any] = dict(state["summary"] or {}) if state else {}
        self._momentum = np.array(state["momentum"] if state else [])

    def append(
        self,
        rows: np.ndarray,
        pairs: Sequence[Any] | None = (),
        parts: Sums | None = None,
    ) -> None:
        """Write the rows of the steps made since the last call, and flush.

        Args:
            rows: the core's `history()`, shape (steps, columns).
            pairs: the core's `contact_groups()` after the last of these steps; None: not known.
            parts: `part_cells.sums_of` it then; None: not asked for.
        """
        if parts is not None:
            self.note_bodies(parts)
        if len(rows) == 0:
            return
        table = np.asarray(rows, dtype=float)
        self._note(table)
        empty = [""] * (len(self._part_cells) + 6 * len(self._pairs))
        lines = []
        for k, row in enumerate(table.tolist()):
            last = k == len(table) - 1
            if not last and int(row[0]) % self._every:
                continue
            cells = [repr(int(row[0])), *map(repr, row[1:])]
            lines.append(cells + (self._last_cells(pairs, parts) if last else empty))
        self._table.append(lines)
        if self._long is not None and pairs is not None:
            self._long.append(self._pair_lines(table[-1], pairs))

    def state(self) -> dict[str, Any]:
        """Return what a writer needs to go on from here, for JSON; it is on the disk then."""
        tables = [table.saved() if table else None for table in (self._table, self._long)]
        summary = self.summary() or None
        ends = [self._parts.first, self._parts.last] if self._parts else [None, None]
        first, last = ([] if rows is None else rows.tolist() for rows in ends)
        return {
            "tables": tables,
            "summary": summary,
            "momentum": self._momentum.tolist(),
            "bodies": first,
            "last_bodies": last,
        }

    def summary(self) -> dict[str, Any]:
        """Energies of the whole run for the manifest [J], J per metre in 2D.

        `initial` and `final` hold every energy of the first and last step,
        `kinetic_min`, `residual_max`, `numerical_max` and `external_max` the extremes over all
        steps (absolute values for the last three), `momentum_drift` the largest change of total
        momentum [N s].
        """
        return dict(self._summary)

    def note_bodies(self, parts: Sums) -> None:
        """Take these sums for the last that is known of the bodies."""
        if self._parts:
            self._parts.note(parts)

    def begin_bodies(self) -> None:
        """Take the next sums for the first of the bodies: a run that has settled begins then."""
        if self._parts:
            self._parts.first = None

    @property
    def first_bodies(self) -> np.ndarray:
        """Rows of what bodies had when the run began, shape (bodies, PART_COLUMNS)."""
        return np.array(self._parts.first if self._parts else [])

    def bodies(self) -> dict[str, dict[str, dict[str, float]]]:
        """Return `initial` and `final` numbers of each body, grains of an entry together.

        They are those of PART_COLUMNS, by name: mass, centre, velocity and so on.
        """
        return self._parts.records() if self._parts else {}

    def close(self) -> None:
        """Close the files."""
        self._table.close()
        if self._long is not None:
            self._long.close()

    def __enter__(self) -> HistoryWriter:
        return self

    def __exit__(self, *about: object) -> None:
        self.close()

    def _last_cells(self, pairs: Sequence[Any] | None, parts: Sums | None) -> list[str]:
        """Return the cells of bodies and of pairs, empty where nothing is known."""
        of_parts, of_pairs = [""] * len(self._part_cells), [""] * (6 * len(self._pairs))
        if self._parts and parts is not None:
            of_parts = self._parts.cells(parts)
        return of_parts + (of_pairs if pairs is None else self._pair_cells(pairs))

    def _pair_cells(self, pairs: Sequence[Any]) -> list[str]:
        values = np.zeros((len(self._pairs), 6))
        for pair in pairs:
            a, b = pair.bodies
            sign = 1.0 if a < b else -1.0
            k = self._pairs.get((min(a, b), max(a, b)))
            if k is not None:
                values[k, :3] = sign * np.asarray(_three(pair.force))
                values[k, 3:] = sign * np.asarray(_three(pair.impulse))
        return [repr(v) for v in values.ravel().tolist()]

    def _pair_lines(self, row: np.ndarray, pairs: Sequence[Any]) -> list[list[str]]:
        lines = []
        for pair in pairs:
            if any(pair.force):
                names = [self._bodies[b] for b in pair.bodies]
                values = [*_three(pair.force), *_three(pair.impulse)]
                lines.append([repr(int(row[0])), repr(float(row[1])), *names, *map(repr, values)])
        return lines

    def _note(self, table: np.ndarray) -> None:
        column = {name: table[:, k] for name, k in self._index.items()}
        momentum = table[:, [self._index[name] for name in MOMENTUM]]
        new = self._summary
        if not new:
            new["initial"] = {name: float(column[name][0]) for name in ENERGIES}
            new["kinetic_min"] = float("inf")
            new |= dict.fromkeys((*(f"{name}_max" for name in _LARGEST), "momentum_drift"), 0.0)
            self._momentum = momentum[0].copy()
        new["final"] = {name: float(column[name][-1]) for name in ENERGIES}
        new["kinetic_min"] = min(new["kinetic_min"], float(column["kinetic"].min()))
        for name in _LARGEST:
            new[f"{name}_max"] = max(new[f"{name}_max"], float(np.abs(column[name]).max()))
        drift = np.linalg.norm(momentum - self._momentum, axis=1).max()
        new["momentum_drift"] = max(new["momentum_drift"], float(drift))


def _three(vector: Sequence[float]) -> list[float]:
    """A vector of two or three components as three Python floats."""
    values = [float(v) for v in vector]
    return values + [0.0] * (3 - len(values))
