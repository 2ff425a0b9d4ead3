# SPDX-License-Identifier: BSD-3-Clause
"""The command line: `mpm3dpp run | check | preview | import | plot | bench | materials | ...`.

`command.main` is what runs it. Heavy modules are imported by the command that needs them, so that
`--help` is fast.
"""

from __future__ import annotations

import enum
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from mpm3dpp.base.errors import CaseError

from .export import export
from .import_file import import_file
from .materials import material_test, materials
from .options import (
    BenchDevice,
    BenchDevices,
    CaseFile,
    Changes,
    Device,
    Devices,
    Json,
    Ranks,
    Scheme,
    Threads,
    Units,
    print_notes,
)
from .report import report
from .study import study
from .sweep import sweep

if TYPE_CHECKING:
    from mpm3dpp.case.case import Case

app = typer.Typer(
    name="mpm3dpp",
    help="Material point method: impact and frictional contact of any number of bodies.",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,  # It takes as long to load as all else.
    pretty_exceptions_enable=False,
)


def _load(
    path: Path, units: str | None, quiet: bool = False, changes: list[str] | None = None
) -> Case:
    """Return the case of a file; what to know about it goes to stderr."""
    from mpm3dpp.importers import load_any

    loaded, notes = load_any(path, units)
    if not quiet:
        print_notes(notes)
    if changes:
        from mpm3dpp.case.changes import changes_of, with_changes

        loaded = with_changes(loaded, changes_of(changes))
    return loaded


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
            help="Begin anew, though the folder holds an unfinished run or another case's.",
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
    from mpm3dpp.run.resume import refuse_to_begin_anew

    count = ranks or 1
    # Of several one will tell the notes.
    loaded = _load(case, units, quiet or count > 1, changes)
    folder = out if out is not None else default_folder(case)
    if resume and anew:
        raise CaseError("--resume and --anew cannot be given together", "give one of them")
    if device == Device.cuda and count > 1:
        from mpm3dpp.run.device import ONE_PROCESS

        raise CaseError(f"{ONE_PROCESS}: leave --ranks out")
    with folder_of_run(folder):
        if not resume and not anew:
            refuse_to_begin_anew(folder, loaded)
        if count > 1:
            raise typer.Exit(_on_ranks(count, threads))
        from mpm3dpp.run.run import run_case  # The slowest import: after the mistakes.

        run_case(
            *(loaded, folder, threads, quiet, json, not no_pictures, resume), device=device.value
        )


def _on_ranks(ranks: int, threads: int | None) -> int:
    """Run this command again, on several ranks, and return its exit code."""
    from mpm3dpp.ranks.launch import launch
    from mpm3dpp.ranks.launcher import started

    words, skips = [], False
    for word in sys.argv[1:]:
        if not skips and word != "--ranks" and not word.startswith("--ranks="):
            words.append(word)
        skips = word == "--ranks"
    if started() is not None:
        rule = "--ranks is for one process, and mpiexec has started several"
        raise CaseError(rule, "leave out --ranks")
    return launch(ranks, words, threads)


@app.command()
def check(
    case: CaseFile,
    units: Units = None,
    changes: Changes = None,
    ranks: Annotated[int, typer.Option(min=1, help="Memory and time of so many processes.")] = 1,
) -> None:
    """Check a case and say what it amounts to.

    mpm3dpp check case.toml
    """
    from mpm3dpp.fill.advisories import refuse_time_step
    from mpm3dpp.fill.build import build
    from mpm3dpp.run.estimate import estimate_line
    from mpm3dpp.run.summary import echo

    loaded = _load(case, units, changes=changes)
    bodies = build(loaded)
    typer.echo(echo(loaded, bodies, ranks))
    refuse_time_step(loaded, bodies)
    typer.echo(estimate_line(loaded, bodies, ranks))


@app.command()
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

    loaded = _load(case, units)
    target = out if out is not None else writable_folder(default_folder(case)) / "preview.png"
    typer.echo(draw(loaded, target))


@app.command()
def plot(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="Output folder of a run.")],
    frame: Annotated[int, typer.Option(help="Frame; negative counts from the end.")] = -1,
    animation: Annotated[
        bool | None,
        typer.Option("--animation/--no-animation", help="animation.gif; default as the case."),
    ] = None,
    colour: Annotated[str | None, typer.Option(help="Column that colours particles.")] = None,
    out: Annotated[Path | None, typer.Option(help="Folder for the pictures.")] = None,
) -> None:
    """Make the pictures of a run again.

    mpm3dpp plot results/rings --frame 10 --colour pressure
    """
    from mpm3dpp.plots.run import draw_all

    if not folder.is_dir():
        rule = "is not a folder" if folder.exists() else "there is no such folder"
        raise CaseError(rule, "give the --out of a run", place=str(folder))
    for picture in draw_all(folder, frame, animation, colour, out):
        typer.echo(picture)


BENCH_NAMES = (
    "elastic2d, elastic3d, gimp2d, gimp3d, jc, debris, two_cubes, two_cubes_apart, spheres or "
    "spheres_apart."
)


@app.command()
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


class Size(str, enum.Enum):
    """How large the paper's examples are run; see `reproduce`."""

    quick = "quick"
    paper = "paper"


@app.command()
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


app.command("import")(import_file)
app.command()(export)
app.command()(report)
app.command()(sweep)
app.command()(study)
app.command()(materials)
app.command("material-test")(material_test)
