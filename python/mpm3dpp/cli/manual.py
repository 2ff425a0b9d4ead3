# SPDX-License-Identifier: BSD-3-Clause
"""The commands `mpm3dpp docs` and `mpm3dpp examples list | copy | run`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

examples = typer.Typer(
    help="List, copy and run the examples.", no_args_is_help=True, rich_markup_mode=None
)
Name = Annotated[
    str, typer.Argument(metavar="NAME", help="Of the example, its number or a word of it.")
]


def docs(
    words: Annotated[
        list[str] | None,
        typer.Argument(metavar="[PAGE | WORDS]", help="A page to read, or words to look for."),
    ] = None,
) -> None:
    """Read the documentation that came with the package.

    A list of the pages, one of them, or the places where words stand.

    mpm3dpp docs angle of repose
    """
    from mpm3dpp.manual.pages import look_up, page_list

    typer.echo(look_up(words) if words else page_list())


@examples.command("list")
def list_examples() -> None:
    """List the examples.

    mpm3dpp examples list
    """
    from mpm3dpp.manual.examples import listing

    typer.echo(listing())


@examples.command()
def copy(
    name: Name,
    folder: Annotated[
        Path | None, typer.Argument(metavar="[DIR]", help="New folder; default its name, here.")
    ] = None,
) -> None:
    """Copy an example's case files, to change them.

    mpm3dpp examples copy hopper
    """
    from mpm3dpp.manual.examples import CASE
    from mpm3dpp.manual.examples import copy as make

    typer.echo(make(name, folder) / CASE)


@examples.command(
    "run",
    context_settings={"allow_extra_args": True, "ignore_unknown_options": True},
    options_metavar="[OPTIONS OF RUN]",
)
def run_example(context: typer.Context, name: Name) -> None:
    """Run an example, with the options of `mpm3dpp run`.

    mpm3dpp examples run hopper --threads 2
    """
    from mpm3dpp.manual.examples import CASE, folder_of

    words = ["run", str(folder_of(name) / CASE), *context.args]
    context.find_root().command.main(words, prog_name="mpm3dpp", standalone_mode=False)
