# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp validate`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import Threads


def validate(
    names: Annotated[
        list[str] | None, typer.Argument(metavar="[NAME]...", help="Benchmarks; default all.")
    ] = None,
    listed: Annotated[bool, typer.Option("--list", help="List them, and run none.")] = False,
    out: Annotated[
        Path | None, typer.Option(metavar="PAGE", help="Write a page in Markdown, too.")
    ] = None,
    threads: Threads = None,
) -> None:
    """Run benchmarks and compare them with published answers.

    mpm3dpp validate bouncing_ball

    Ends with 1 if a figure is missed of which that is not known.
    """
    from mpm3dpp.base.disk import write_atomically
    from mpm3dpp.base.errors import CaseError
    from mpm3dpp.validate.benchmark import benchmarks
    from mpm3dpp.validate.judge import MISSED, judge
    from mpm3dpp.validate.tell import last_line, lines_of, page_of

    chosen = list(benchmarks(names or []))
    if listed:
        width = max(len(one.name) for one in chosen)
        for one in chosen:
            typer.echo(f"{one.name.ljust(width)}  {one.problem.title}")
        return
    if out is not None and not out.resolve().parent.is_dir():
        rule, remedy = f"'{out.resolve().parent}' is no folder", "make it, or choose another --out"
        raise CaseError(rule, remedy)
    done = []
    for one in chosen:
        typer.echo(f"{one.name}: {one.problem.title}", err=True)
        done.append((one, judge(one, threads)))
        typer.echo("\n".join(lines_of(*done[-1])))
    figures = [figure for _, judged in done for figure in judged]
    typer.echo(last_line(figures))
    if out is not None:
        write_atomically(out, page_of(done))
    if any(figure.word == MISSED for figure in figures):
        raise typer.Exit(1)
