# SPDX-License-Identifier: BSD-3-Clause
"""The tables of probes: `probes/NAME.csv` in the folder of a run."""

from __future__ import annotations

import contextlib
import csv
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp.base.errors import CaseError, nearest

from .table import check_table

PROBES = "probes"
FIRST_COLUMNS = ("time", "step", "particles", "mass")
"""Of every table; those of the fields follow."""


def probe_path(folder: Path, name: str) -> Path:
    """Return the table of a probe."""
    return folder / PROBES / f"{name}.csv"


def tables_of_probes(folder: Path) -> list[Path]:
    """Return the tables of probes in the folder of a run, in order; other files are the user's."""
    found = []
    for path in sorted((folder / PROBES).glob("*.csv")):
        with contextlib.suppress(OSError), open(path, "rb") as file:
            if file.readline().startswith(",".join(FIRST_COLUMNS).encode()):
                found.append(path)
    return found


def probe_names(folder: Path) -> list[str]:
    """Return the names of the probes of a run by its folder, in order."""
    return [path.stem for path in tables_of_probes(folder)]


def read_probe(folder: Path, name: str) -> dict[str, np.ndarray]:
    """Return the table of a probe: column name -> array (rows,), float64; NaN where it saw nothing.

    A last row that a killed run left unfinished is dropped.

    Raises:
        CaseError: there is no such probe, or its table is none of ours.
    """
    path = probe_path(folder, name)
    try:
        lines = path.read_text(encoding="utf-8").split("\n")[:-1]  # A whole row ends with one.
        header, *rows = csv.reader(lines)
        table = np.array([list(map(float, row)) for row in rows], dtype=float)
        columns = table.reshape(len(rows), len(header))
    except FileNotFoundError as error:
        known = probe_names(folder)
        remedy = nearest(name, known) if known else "give the case a table [probe.NAME]"
        raise CaseError("is no probe of this run", remedy, value=name) from error
    except (OSError, ValueError, csv.Error) as error:
        raise CaseError(f"'{path}' is not a table of a probe: {error}") from error
    return {title: columns[:, k] for k, title in enumerate(header)}


def check_probe(folder: Path, name: str, state: Mapping[str, Any]) -> None:
    """Raise `CaseError` if the table of a run that goes on has not the rows that it had.

    It may be gone altogether, and begins anew then.
    """
    path = probe_path(folder, name)
    if path.exists():
        check_table(path, state["table"])
