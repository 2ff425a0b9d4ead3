# SPDX-License-Identifier: BSD-3-Clause
"""Options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mpm3dpp.base.readers import READERS, SUFFIXES

_FILES = " or ".join(("Case file (TOML),", *SUFFIXES))
_UNITS = "; ".join(f"Units of an {reader.suffix} file: {reader.units}" for reader in READERS)

CaseFile = Annotated[Path, typer.Argument(metavar="CASE", help=f"{_FILES}.")]
Units = Annotated[
    str | None,
    typer.Option(help=f"{_UNITS}."),
]
Threads = Annotated[
    int | None,
    typer.Option(min=1, help="Threads; default OMP_NUM_THREADS, else all cores."),
]
Ranks = Annotated[
    int | None,
    typer.Option(
        min=1,
        help="Processes of this machine, by MPI, each with its share of the threads; on "
        "others start `mpiexec -n N mpm3dpp run CASE`.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
