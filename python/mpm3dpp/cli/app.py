# SPDX-License-Identifier: BSD-3-Clause
"""The command line: `mpm3dpp run | check | preview | import | plot | bench | materials | ...`.

`command.main` is what runs it. Heavy modules are imported by the command that needs them, so that
`--help` is fast.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from mpm3dpp.base.errors import CaseError

from .bench import bench
from .export import export
from .import_file import import_file
from .loading import load
from .manual import docs, examples
from .materials import material_test, materials
from .options import CaseFile, Changes, Device, Devices, Json, Ranks, Threads, Units
from .pictures import plot, preview
from .report import report
from .reproduce import reproduce
from .study import study
from .sweep import sweep
from .validate import validate

app = typer.Typer(
    name="mpm3dpp",
    help="Material point method: impact and frictional contact of any number of bodies.",
    no_args_is_help=True,
    add_completion=True,
    rich_markup_mode=None,  # It takes as long to load as all else.
    pretty_exceptions_enable=False,
)


def _version(wanted: bool) -> None:
    if not wanted:
        return
    from mpm3dpp import __version__

    typer.echo(f"mpm3dpp {__version__}")
    try:
        from mpm3dpp import _core
    except ImportError:
        typer.echo("core: not built")
    else:
        for name, value in _core.build_info().items():
            typer.echo(f"{name}: {value}")
    raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", callback=_version, is_eager=True, help="Version and build."),
    ] = False,
) -> None:
    """Options before the command."""


@app.command()
def run(
    case: CaseFile,
    out: Annotated[
        Path | None,
        typer.Option(
            help="Folder; default results/NAME, of the file or, for case.toml, its folder."
        ),
    ] = None,
    threads: Threads = None,
    ranks: Ranks = None,
    device: Devices = Device.cpu,
    quiet: Annotated[bool, typer.Option("--quiet", help="Print nothing but errors.")] = False,
    json: Json = False,
    changes: Changes = None,
    units: Units = None,
    resume: Annotated[
        bool, typer.Option("--resume", help="Go on from the checkpoint in the folder.")
    ] = False,
    anew: Annotated[
        bool,
        typer.Option(
            "--anew",
            help="Begin anew, though the folder holds an unfinished run or another case's; other "
            "files are never written over.",
        ),
    ] = False,
    no_pictures: Annotated[
        bool, typer.Option("--no-pictures", help="Draw none; `mpm3dpp plot` draws them later.")
    ] = False,
) -> None:
    """Run a case: frames, history, manifest and pictures.

    mpm3dpp run case.toml --set contact.friction=0.2 --out results/rough
    """
    from mpm3dpp.io.folders import default_folder, folder_of_run
    from mpm3dpp.io.foreign import refuse_foreign
    from mpm3dpp.run.resume import refuse_to_begin_anew

    count = ranks or 1
    # Of several one will tell the notes.
    loaded = load(case, units, quiet or count > 1, changes)
    folder = out if out is not None else default_folder(case)
    if resume and anew:
        raise CaseError("--resume and --anew cannot be given together", "give one of them")
    if device == Device.cuda and count > 1:
        from mpm3dpp.run.device import ONE_PROCESS

        raise CaseError(f"{ONE_PROCESS}: leave --ranks out")
    with folder_of_run(folder):
        refuse_foreign(folder, loaded.probe)
        if not resume and not anew:
            refuse_to_begin_anew(folder, loaded)
        if count > 1:
            raise typer.Exit(_on_ranks(count, threads, folder))
        from mpm3dpp.run.run import run_case  # The slowest import: after the mistakes.

        run_case(
            *(loaded, folder, threads, quiet, json, not no_pictures, resume), device=device.value
        )


def _on_ranks(ranks: int, threads: int | None, folder: Path) -> int:
    """Run this command again, on several ranks, and return its exit code."""
    from mpm3dpp.ranks.launch import launch
    from mpm3dpp.ranks.launcher import started
    from mpm3dpp.run.resume import has_checkpoint

    words, skips = [], False
    for word in sys.argv[1:]:
        if not skips and word != "--ranks" and not word.startswith("--ranks="):
            words.append(word)
        skips = word == "--ranks"
    if started() is not None:
        rule = "--ranks is for one process, and mpiexec has started several"
        raise CaseError(rule, "leave out --ranks")
    return launch(ranks, words, threads, lambda: has_checkpoint(folder))


@app.command()
def check(
    case: CaseFile,
    units: Units = None,
    changes: Changes = None,
    ranks: Annotated[int, typer.Option(min=1, help="Memory and time of so many processes.")] = 1,
    threads: Threads = None,
) -> None:
    """Check a case and say what it amounts to.

    mpm3dpp check case.toml
    """
    from mpm3dpp.fill.advisories import refuse_time_step
    from mpm3dpp.fill.build import build
    from mpm3dpp.run.estimate import estimate_line
    from mpm3dpp.run.summary import echo

    loaded = load(case, units, changes=changes)
    bodies = build(loaded)
    typer.echo(echo(loaded, bodies, ranks))
    refuse_time_step(loaded, bodies)
    typer.echo(estimate_line(loaded, bodies, ranks, threads))


app.command()(preview)
app.command()(plot)
app.command("import")(import_file)
app.command()(export)
app.command()(report)
app.command()(sweep)
app.command()(study)
app.command()(materials)
app.command("material-test")(material_test)
app.command()(bench)
app.command()(reproduce)
app.command()(validate)
app.command()(docs)
app.add_typer(examples, name="examples")
