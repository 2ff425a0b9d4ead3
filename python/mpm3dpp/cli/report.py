# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp report`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def report(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of a run.")],
    output: Annotated[
        Path | None,
        typer.Option(
            "--output", "--out", metavar="FILE", help="The page; default DIR/report.html."
        ),
    ] = None,
) -> None:
    """Write all that is known of a run on one page.

    One file of HTML with pictures, curves and tables, for a browser, to send or to print.

    mpm3dpp report results/rings
    """
    from mpm3dpp.reports import report as write

    typer.echo(write(folder, output))
