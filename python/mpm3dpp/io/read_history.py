# SPDX-License-Identifier: BSD-3-Clause
"""`history.csv` as it lies in a folder: whether it is there and whole, and what is in it."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.errors import CaseError

from .history import ENERGIES, MOMENTUM, PAIRS
from .table import check_table, whole_lines

_LATER = ("restitution",)  # Tables of older versions have it in another column.
_NEEDED = tuple(  # By summaries and pictures.
    name for name in ("time", "step", "dt", *ENERGIES, *MOMENTUM) if name not in _LATER
)


def has_no_history(folder: Path) -> bool:
    """Return whether there is no table in a folder."""
    return not any((folder / name).exists() for name in ("history.csv", PAIRS))


def check_history(folder: Path, state: Mapping[str, Any]) -> None:
    """Raise `CaseError` if a table has not the rows that it had, and say which.

    Args:
        folder: of the tables.
        state: `HistoryWriter.state` then.
    """
    for path, known in zip((folder / "history.csv", folder / PAIRS), state["tables"], strict=True):
        if known is not None:
            check_table(path, known)


def read_history(path: str | Path) -> dict[str, np.ndarray]:
    """The table as column name -> array (rows,), float64; empty cells are NaN.

    Terms of the ledger that an older version did not have are 0. A last row that a killed run left
    unfinished is dropped.

    Args:
        path: `history.csv` or the output folder that holds it.

    Raises:
        CaseError: the file is missing or is not a history table.
    """
    path = Path(path)
    if path.is_dir():
        path = path / "history.csv"
    try:
        lines = whole_lines(path)
        rows = list(csv.reader(lines))
        header = rows[0]
        table = [[float(cell or "nan") for cell in row] for row in rows[1:]]
        columns = np.array(table, dtype=float).reshape(len(table), len(header))
    except FileNotFoundError as error:
        raise CaseError(f"there is no file '{path}': give the output folder of a run") from error
    except CaseError as error:
        raise CaseError(f"'{path}' {error.rule}", error.remedy) from error
    except UnicodeDecodeError as error:
        raise CaseError(f"'{path}' is not a history table of mpm3dpp: it is no text") from error
    except (OSError, ValueError, IndexError, csv.Error) as error:
        raise CaseError(f"'{path}' is not a history table of mpm3dpp: {error}") from error
    forces = [n[:-1] for n in header if n.startswith("contact_") and n.endswith("_x")]
    for name in (*_NEEDED, *(n + x for n in forces for x in "xyz")):
        if name not in header:
            rule = (
                f"'{path}' is not a history table of mpm3dpp, or damaged: it has no column {name}"
            )
            raise CaseError(rule)
    for name in ("time", "step", "dt"):
        wrong = np.flatnonzero(~np.isfinite(columns[:, header.index(name)]))
        if len(wrong):
            rule = f"'{path}' is damaged: line {wrong[0] + 2} has no number for {name}"
            raise CaseError(rule, "take the line out, or run the case again")
    history = {name: columns[:, k] for k, name in enumerate(header)}
    return history | {name: np.zeros(len(columns)) for name in _LATER if name not in header}
