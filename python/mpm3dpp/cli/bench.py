# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp bench`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import BenchDevice, BenchDevices, Json, Scheme

BENCH_NAMES = (
    "elastic2d, elastic3d, gimp2d, gimp3d, jc, debris, two_cubes, two_cubes_apart, spheres or "
    "spheres_apart."
)


def bench(
    name: Annotated[str, typer.Argument(metavar="NAME", help=BENCH_NAMES)],
    size: Annotated[
        list[int] | None,
        typer.Option(
            min=1,
            help="Cells along an edge of two particles; how many spheres. May be given again.",
        ),
    ] = None,
    threads: Annotated[
        list[int] | None, typer.Option(min=1, help="Threads; 1 if not given. May be given again.")
    ] = None,
    ranks: Annotated[
        list[int] | None,
        typer.Option(min=1, help="Processes, by MPI; 1 if not given. May be given again."),
    ] = None,
    scheme: Annotated[Scheme, typer.Option(help="Scheme.")] = Scheme.musl,
    device: BenchDevices = BenchDevice.cpu,
    steps: Annotated[int | None, typer.Option(min=1, help="Steps that are timed; 400.")] = None,
    json: Json = False,
    plot: Annotated[Path | None, typer.Option(help="Picture to write, a PNG.")] = None,
) -> None:
    """Measure the speed: time per particle-step and stage.

    Memory and bandwidth too; with several sizes or numbers of threads or ranks, how these grow.

    mpm3dpp bench spheres --size 1000 --threads 1 --threads 2
    """
    from mpm3dpp.bench import main as measure

    counts = ranks or (1,)
    sizes, workers = size or (), threads or (1,)
    measure(name, sizes, workers, scheme.value, steps, json, plot, counts, device.value)
