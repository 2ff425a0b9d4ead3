# SPDX-License-Identifier: BSD-3-Clause
"""The command `mpm3dpp bench`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import BenchDevice, BenchDevices, Json, Scheme

BENCH_NAMES = (
    "elastic2d, elastic3d, jc, debris, two_cubes, two_cubes_apart, spheres, spheres_apart or drum."
)


def bench(
    name: Annotated[str, typer.Argument(metavar="NAME", help=BENCH_NAMES)],
    size: Annotated[
        list[int] | None,
        typer.Option(
            min=1,
            help="Cells along an edge of two particles; how many spheres or discs. May be given "
            "again.",
        ),
    ] = None,
    threads: Annotated[
        list[int] | None, typer.Option(min=1, help="Threads; 1 if not given. May be given again.")
    ] = None,
    ranks: Annotated[
        list[int] | None,
        typer.Option(min=1, help="Processes, by MPI; 1 if not given. May be given again."),
    ] = None,
    basis: Annotated[
        str | None, typer.Option(help="grid.basis; each default is that of a case file.")
    ] = None,
    transfer: Annotated[str | None, typer.Option(help="run.transfer, such as flip.")] = None,
    scheme: Annotated[Scheme | None, typer.Option(help="run.scheme.")] = None,
    preset: Annotated[
        str | None, typer.Option(help="preset of a case: paper for its linear basis.")
    ] = None,
    frame: Annotated[
        str | None, typer.Option(help="frame of all bodies that deform: material or updated.")
    ] = None,
    device: BenchDevices = BenchDevice.cpu,
    steps: Annotated[int | None, typer.Option(min=1, help="Steps that are timed; 400.")] = None,
    json: Json = False,
    plot: Annotated[Path | None, typer.Option(help="Picture to write, a PNG.")] = None,
) -> None:
    """Measure the speed: time per particle-step and stage.

    With the numerics of a case file that says nothing of them, but where an option does.

    Memory and bandwidth too; with several sizes or numbers of threads or ranks, how these grow.

    mpm3dpp bench spheres --size 1000 --threads 1 --threads 2
    """
    from mpm3dpp.bench import Numerics
    from mpm3dpp.bench import main as measure

    said = None if scheme is None else scheme.value
    numerics = Numerics(basis, transfer, said, preset, frame)
    counts = ranks or (1,)
    sizes, workers = size or (), threads or (1,)
    measure(name, sizes, workers, numerics, steps, json, plot, counts, device.value)
