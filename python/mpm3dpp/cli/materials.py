# SPDX-License-Identifier: BSD-3-Clause
"""The commands about materials: `mpm3dpp materials` and `mpm3dpp material-test`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import Json, Units


def materials(
    name: Annotated[
        str | None, typer.Argument(metavar="[NAME]", help="A model or a named material, in detail.")
    ] = None,
) -> None:
    """List material models and named materials.

    With NAME: parameters, units and sources.
    """
    from mpm3dpp.materials import listing

    typer.echo(listing(name))


def material_test(
    material: Annotated[
        str,
        typer.Argument(
            metavar="MATERIAL",
            help="A named material (copper_ofhc), case.toml:NAME or file.mpm:NAME.",
        ),
    ],
    test: Annotated[
        str,
        typer.Option(
            help="uniaxial-strain, uniaxial-stress, triaxial, shear, compression-release or "
            "hugoniot."
        ),
    ] = "uniaxial-strain",
    rate: Annotated[
        float | None, typer.Option(help="Rate of strain in 1/s, such as 1e3; default 1.")
    ] = None,
    to: Annotated[
        float | None,
        typer.Option(
            help="Last strain (logarithmic, negative in compression) or shear, such as 0.5; "
            "for hugoniot the last particle velocity in m/s, such as 2000."
        ),
    ] = None,
    steps: Annotated[int | None, typer.Option(help="Number of steps, such as 500.")] = None,
    temperature: Annotated[
        float | None, typer.Option(help="Temperature at the start in K, such as 500.")
    ] = None,
    pressure: Annotated[
        float | None,
        typer.Option(help="In the cell of the test triaxial, in Pa; default 100e3 (100 kPa)."),
    ] = None,
    units: Units = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for CSV and PNG; default results/material_test.")
    ] = None,
    json: Json = False,
) -> None:
    """Draw stress-strain curves and Hugoniots of a point.

    mpm3dpp material-test copper_ofhc --test uniaxial-stress --rate 1e4 --to 0.5

    mpm3dpp material-test case.toml:plate --test hugoniot --to 2000
    """
    from mpm3dpp.material_test import Options
    from mpm3dpp.material_test import main as do_test

    options = Options(test, rate, to, steps, temperature, pressure)
    typer.echo(do_test(material, options, out, json, units))
