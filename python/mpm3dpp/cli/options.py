# SPDX-License-Identifier: BSD-3-Clause
"""Options that several commands have."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

CaseFile = Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML), or .mpm.")]
Units = Annotated[
    str | None,
    typer.Option(help="Units of an .mpm file: mm-g-N-ms (default), SI, cm-g-us."),
]
Threads = Annotated[
    int | None,
    typer.Option(min=1, help="Threads; default OMP_NUM_THREADS, else all cores."),
]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]
