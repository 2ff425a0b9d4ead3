# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp import`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mpm3dpp.base.readers import PROGRAMS

from .options import Units, print_notes


def import_file(
    file: Annotated[Path, typer.Argument(metavar="FILE", help=f"Input file of {PROGRAMS}.")],
    out: Annotated[
        Path | None, typer.Option("-o", "--out", help="Case file; default NAME.toml here.")
    ] = None,
    units: Units = None,
    force: Annotated[
        bool, typer.Option("--force", help="Write over files that are there.")
    ] = False,
) -> None:
    """Write an input file of MPM3D as a case file in SI units."""
    from mpm3dpp.importers import import_file as read
    from mpm3dpp.importers.write import write_case

    found = read(file, units)
    target = out if out is not None else Path(f"{file.stem}.toml")
    written = write_case(found, target, force)
    print_notes(found.notes)
    for path in written:
        typer.echo(path)
