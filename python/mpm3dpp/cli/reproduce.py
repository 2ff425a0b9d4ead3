# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp reproduce`."""

from __future__ import annotations

import enum
from pathlib import Path
from typing import Annotated

import typer

from .options import Threads


class Size(str, enum.Enum):
    """How large the paper's examples are run; see `reproduce`."""

    quick = "quick"
    paper = "paper"


def reproduce(
    out: Annotated[Path, typer.Option(help="Folder of the page.")] = Path("results/reproduce"),
    size: Annotated[
        Size, typer.Option(help="quick: coarser, shorter, fewer bodies; paper: as they are.")
    ] = Size.quick,
    only: Annotated[
        list[str] | None,
        typer.Option(help="penetration, spheres, grains or rings; may be given again."),
    ] = None,
    steps: Annotated[int, typer.Option(min=1, help="Steps that are timed.")] = 100,
    threads: Threads = None,
    examples: Annotated[
        Path | None, typer.Option(help="Folder of the example cases, in place of our own.")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")] = False,
) -> None:
    """Run the examples of Ma, Zhang & Huang (2010).

    Make a page with their tables and figures.

    mpm3dpp reproduce --only rings --only spheres
    """
    from mpm3dpp.reproduce import reproduce as make

    for path in make(out, size.value, only or (), steps, threads, examples, quiet):
        if not quiet:
            typer.echo(path)
