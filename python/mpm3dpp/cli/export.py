# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp export`."""

from __future__ import annotations

import enum
from pathlib import Path
from typing import Annotated

import typer

from mpm3dpp.base.errors import CaseError


class Format(str, enum.Enum):
    """See `io.export.export`."""

    csv = "csv"
    vtu = "vtu"
    vtp = "vtp"


def export(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of a run.")],
    kind: Annotated[
        Format, typer.Option("--format", help="csv: a row for each particle; vtu, vtp: for VTK.")
    ] = Format.csv,
    frame: Annotated[int, typer.Option(help="Frame; negative counts from the end.")] = -1,
    every: Annotated[bool, typer.Option("--all", help="All frames.")] = False,
    where: Annotated[
        str,
        typer.Option(
            help='Particles, such as "body=plate, pressure > 1 MPa": commas between, all must hold.'
        ),
    ] = "",
    strain: Annotated[
        bool, typer.Option("--strain", help="Add the strain since the first frame.")
    ] = False,
    out: Annotated[
        Path | None, typer.Option(help="The file; with --all the folder. Default: DIR/export.")
    ] = None,
) -> None:
    """Write frames of a run as CSV or for VTK.

    mpm3dpp export results/rings --where "body=left, velocity_x < 0"
    """
    from mpm3dpp.base.ours import refuse_link
    from mpm3dpp.io.export import export as write
    from mpm3dpp.io.export import file_name
    from mpm3dpp.io.results import open_results

    with open_results(folder) as results:
        if not every and not -len(results) <= frame < len(results):
            rule = f"is no frame: there are {len(results)}"
            raise CaseError(rule, "counted from 0", key="--frame", value=frame)
        folder = out if every and out is not None else folder / "export"
        if out is None:
            refuse_link(folder)
        for k in range(len(results)) if every else [results.number(frame)]:
            target = folder / file_name(k, kind.value)
            if out is not None and not every:
                target = out
            typer.echo(write(results, k, target, kind.value, where, strain=strain))
