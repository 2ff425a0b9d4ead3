# SPDX-License-Identifier: BSD-3-Clause
"""The commands about pictures: `mpm3dpp preview` and `mpm3dpp plot`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from mpm3dpp.base.errors import CaseError

from .loading import load
from .options import CaseFile, Units


def preview(
    case: CaseFile,
    out: Annotated[Path | None, typer.Option(help="Picture; default in results/NAME.")] = None,
    units: Units = None,
) -> None:
    """Draw the particles of a case before it runs.

    mpm3dpp preview case.toml --out start.png
    """
    from mpm3dpp.io.folders import default_folder, writable_folder
    from mpm3dpp.plots import preview as draw

    loaded = load(case, units)
    target = out if out is not None else writable_folder(default_folder(case)) / "preview.png"
    typer.echo(draw(loaded, target))


def plot(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of a run.")],
    frame: Annotated[int, typer.Option(help="Frame; negative counts from the end.")] = -1,
    animation: Annotated[
        bool | None,
        typer.Option("--animation/--no-animation", help="animation.gif; default as the case."),
    ] = None,
    colour: Annotated[str | None, typer.Option(help="Column that colours particles.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder for the pictures.")] = None,
    section: Annotated[
        str | None,
        typer.Option(metavar="AXIS=PLACE", help="In 3D: cut away what is before y=5 mm."),
    ] = None,
    view: Annotated[
        str | None,
        typer.Option(metavar="AZIMUTH,ELEVATION", help="In 3D: from where, in degrees: -30,20."),
    ] = None,
    crop: Annotated[
        str | None,
        typer.Option(
            metavar="X0,X1,Y0,Y1[,Z0,Z1]", help="What is drawn: 0,10 mm,0,5 mm; numbers are in m."
        ),
    ] = None,
    range: Annotated[
        str | None,
        typer.Option(metavar="LOW,HIGH", help="Of the colours: 0,20 MPa; numbers are SI."),
    ] = None,
    size: Annotated[
        str | None, typer.Option(metavar="WIDTHxHEIGHT", help="Of the frame, in pixels.")
    ] = None,
    arrows: Annotated[bool, typer.Option("--arrows", help="Show velocities by arrows.")] = False,
    movie: Annotated[
        Path | None,
        typer.Option(help="All frames in this file alone: .mp4, .webm or .gif."),
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", help="No progress of the movie.")] = False,
) -> None:
    """Make the pictures of a run again.

    mpm3dpp plot results/rings --frame 10 --colour pressure

    mpm3dpp plot results/impact --section y=0 --view -30,20 --range 0,500MPa --movie impact.mp4
    """
    from mpm3dpp.plots.look import look_of, named_as_options
    from mpm3dpp.plots.run import draw_all

    if not folder.is_dir():
        rule = "is not a folder" if folder.exists() else "there is no such folder"
        raise CaseError(rule, "give the --out of a run", place=str(folder))
    with named_as_options():
        look = look_of(section, view, crop, range, size, arrows)
        for picture in draw_all(folder, frame, animation, colour, out, look, movie, quiet):
            typer.echo(picture)
