# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp sweep`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from .options import CaseFile

if TYPE_CHECKING:
    from mpm3dpp.sweep.sweep import Swept


Jobs = Annotated[int, typer.Option("--jobs", "-j", min=1, help="Runs at a time.")]
RunThreads = Annotated[
    int | None, typer.Option(min=1, help="Threads of each run; default: the cores shared out.")
]
Number = Annotated[
    list[str] | None,
    typer.Option(
        help="A number to compare, such as ball.velocity_x or kinetic; may be repeated. "
        "All are in the CSV file."
    ),
]
RunPictures = Annotated[
    bool, typer.Option("--pictures/--no-pictures", help="Draw those of each run.")
]


def sweep(
    case: CaseFile,
    values: Annotated[
        list[str] | None,
        typer.Option(
            "--set",
            metavar="KEY=VALUE,VALUE,...",
            help="Values of a key, such as contact.friction=0,0.1,0.2; with several keys "
            "every combination is run.",
        ),
    ] = None,
    out: Annotated[Path | None, typer.Option(help="Folder; default results/NAME_sweep.")] = None,
    jobs: Jobs = 1,
    threads: RunThreads = None,
    number: Number = None,
    pictures: RunPictures = False,
) -> None:
    """Run a case with several values of some keys.

    Write a table and a picture.

    mpm3dpp sweep case.toml --set contact.friction=0,0.1,0.2 --jobs 2

    Runs that have been completed before are not made again.
    """
    from mpm3dpp.importers import load_any
    from mpm3dpp.io.folders import beside_default
    from mpm3dpp.sweep.sweep import run_sweep

    tell(
        run_sweep(
            load_any(case)[0],
            case,
            values or [],
            out or beside_default(case, "sweep"),
            jobs=jobs,
            threads=threads,
            numbers=number or [],
            pictures=pictures,
            say=lambda text: typer.echo(text, err=True),
        )
    )


def tell(done: Swept) -> None:
    """Print what has come of several runs; end with 1 if some have failed."""
    for line in done.lines:
        typer.echo(line)
    for path in done.files:
        typer.echo(path)
    if done.failed:
        raise typer.Exit(1)
