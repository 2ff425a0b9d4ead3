# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp study`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import CaseFile, Changes
from .sweep import Jobs, Number, RunPictures, RunThreads, tell


def study(
    case: CaseFile,
    cells: Annotated[int, typer.Option(help="Sizes of cells, 3 at least.")] = 3,
    ratio: Annotated[float, typer.Option(help="Of a size to the next.")] = 2.0,
    finest: Annotated[
        str | None,
        typer.Option(metavar="LENGTH", help='Smallest cells, such as "1 mm"; default the case\'s.'),
    ] = None,
    changes: Changes = None,
    out: Annotated[Path | None, typer.Option(help="Folder; default results/NAME_study.")] = None,
    jobs: Jobs = 1,
    threads: RunThreads = None,
    number: Number = None,
    pictures: RunPictures = False,
) -> None:
    """Run a case on several grids: order and uncertainty.

    The case's own cells are the finest, so that its results get an error bar.

    mpm3dpp study case.toml --cells 3 --number ball.speed

    Runs that have been completed before are not made again.
    """
    from mpm3dpp.importers import load_any
    from mpm3dpp.io.folders import beside_default
    from mpm3dpp.sweep.study import run_study

    tell(
        run_study(
            load_any(case)[0],
            case,
            cells,
            ratio,
            finest,
            changes or [],
            out or beside_default(case, "study"),
            jobs=jobs,
            threads=threads,
            numbers=number or [],
            pictures=pictures,
            say=lambda text: typer.echo(text, err=True),
        )
    )
