# SPDX-License-Identifier: BSD-3-Clause
"""Options that several commands have."""

from __future__ import annotations

import enum
from pathlib import Path
from typing import Annotated

import typer

from mpm3dpp.base.readers import READERS, SUFFIXES

_FILES = " or ".join(("Case file (TOML),", *SUFFIXES))
_UNITS = "; ".join(f"Units of an {reader.suffix} file: {reader.units}" for reader in READERS)

CaseFile = Annotated[Path, typer.Argument(metavar="CASE", help=f"{_FILES}.")]
Units = Annotated[
    str | None,
    typer.Option(help=f"{_UNITS}."),
]
Changes = Annotated[
    list[str] | None,
    typer.Option(
        "--set",
        metavar="KEY=VALUE",
        help="Another value of a key of the case, such as contact.friction=0.2, or KEY= to take "
        "it out; may be repeated.",
    ),
]
Threads = Annotated[
    int | None,
    typer.Option(min=1, help="Threads; default OMP_NUM_THREADS, else all cores."),
]
Ranks = Annotated[
    int | None,
    typer.Option(
        min=1,
        help="Processes of this machine, by MPI, each with its share of the threads; on "
        "others start `mpiexec -n N mpm3dpp run CASE`.",
    ),
]


class Scheme(str, enum.Enum):
    """When the stress is updated; see `Run.scheme`."""

    usf = "usf"
    usl = "usl"
    musl = "musl"


class Device(str, enum.Enum):
    """Who makes the steps; see `mpm3dpp.run.device`."""

    cpu = "cpu"
    cuda = "cuda"
    auto = "auto"


class BenchDevice(str, enum.Enum):
    """Who makes the steps of a benchmark."""

    cpu = "cpu"
    cuda = "cuda"


Devices = Annotated[
    Device,
    typer.Option(
        "--device",
        help="Who makes the steps: the processor; cuda, an NVIDIA GPU, with the same results; "
        "auto, it if there is one that can, else the processor.",
    ),
]
BenchDevices = Annotated[
    BenchDevice,
    typer.Option("--device", help="Who makes the steps: the processor, or cuda, an NVIDIA GPU."),
]
Json = Annotated[bool, typer.Option("--json", help="Print the result as JSON.")]


def print_notes(notes: list[str]) -> None:
    """Tell what to know about a case, on the error output."""
    for note in notes:
        typer.echo(f"note: {note}", err=True)
