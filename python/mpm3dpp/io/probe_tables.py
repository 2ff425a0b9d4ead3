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
from mpm3dpp.base.reading import open_file

from .table import check_table, whole_lines

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
        with contextlib.suppress(OSError, CaseError), open_file(path) as file:
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
        header, *rows = csv.reader(whole_lines(path))
        table = np.array([list(map(float, row)) for row in rows], dtype=float)
        columns = table.reshape(len(rows), len(header))
        if missing := set(FIRST_COLUMNS) - set(header):
            raise ValueError(f"it has no column {sorted(missing)[0]}")
        if not np.isfinite(columns[:, header.index("time")]).all():
            raise ValueError("a row has no time")
    except FileNotFoundError as error:
        known = probe_names(folder)
        remedy = nearest(name, known) if known else "give the case a table [probe.NAME]"
        raise CaseError("is no probe of this run", remedy, value=name) from error
    except CaseError as error:
        raise CaseError(f"'{path}' {error.rule}", error.remedy) from error
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
