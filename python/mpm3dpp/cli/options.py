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
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Another value of a key of the case, such as contact.friction=0.2; may be repeated.",
    ),
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


def print_notes(notes: list[str]) -> None:
    """Tell what to know about a case, on the error output."""
    for note in notes:
        typer.echo(f"note: {note}", err=True)
