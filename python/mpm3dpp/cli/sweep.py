# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp sweep`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import CaseFile


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
    jobs: Annotated[int, typer.Option("--jobs", "-j", min=1, help="Runs at a time.")] = 1,
    threads: Annotated[
        int | None, typer.Option(min=1, help="Threads of each run; default: the cores shared out.")
    ] = None,
    number: Annotated[
        list[str] | None,
        typer.Option(
            help="A number to compare, such as ball.velocity_x or kinetic; may be repeated. "
            "All are in sweep.csv."
        ),
    ] = None,
    pictures: Annotated[
        bool, typer.Option("--pictures/--no-pictures", help="Draw those of each run.")
    ] = False,
) -> None:
    """Run a case with several values of some keys.

    Write a table and a picture.

    mpm3dpp sweep case.toml --set contact.friction=0,0.1,0.2 --jobs 2

    Runs that have been completed before are not made again.
    """
    from mpm3dpp.importers import load_any
    from mpm3dpp.io.folders import default_folder
    from mpm3dpp.sweep.sweep import run_sweep

    folder = out
    if folder is None:
        usual = default_folder(case)
        folder = usual.with_name(f"{usual.name}_sweep")
    done = run_sweep(
        load_any(case)[0],
        case,
        values or [],
        folder,
        jobs=jobs,
        threads=threads,
        numbers=number or [],
        pictures=pictures,
        say=lambda text: typer.echo(text, err=True),
    )
    for line in done.lines:
        typer.echo(line)
    for path in done.files:
        typer.echo(path)
    if done.failed:
        raise typer.Exit(1)
