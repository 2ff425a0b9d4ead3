# SPDX-License-Identifier: BSD-3-Clause
"""`mpm3dpp report`: all that is known of a run, on one page of HTML that needs no other file."""

from __future__ import annotations

from pathlib import Path

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError


def report(folder: str | Path, path: str | Path | None = None) -> Path:
    """Write what is known of a run on one page of HTML, pictures included.

    Runs that were stopped, failed, were killed or still go on have a page of what is there.

    Args:
        folder: output folder of the run.
        path: of the page; default `report.html` in the folder.

    Returns:
        The path of the page.

    Raises:
        CaseError: there is no such folder or nothing of a run in it, or the page cannot be written;
            or a file of the run is damaged, once the page without it has been written.
    """
    from mpm3dpp.base.disk import write_atomically
    from mpm3dpp.base.ours import refuse_link, refuse_others
    from mpm3dpp.io.folders import REPORT, writable_folder
    from mpm3dpp.io.foreign import is_run

    from .found import look  # With what follows the slowest imports.
    from .page import compose

    folder = arguments.path("folder", folder)
    target = folder / REPORT if path is None else arguments.path("path", path)
    with look(folder) as found:
        _check_target(target)
        writable_folder(target.parent)
        if not (target.name == REPORT and is_run(target.parent)):
            refuse_others(target, b"<!DOCTYPE html>")
        refuse_link(target)
        write_atomically(target, compose(found, target.parent))
        problems = found.problems
    if problems:
        remedy = f"the rest is in '{target}'"
        raise CaseError("; ".join(problems), remedy)
    return target


def _check_target(target: Path) -> None:
    """Refuse names that are of no page: so no other file of the run is written over."""
    if target.suffix.lower() not in (".html", ".htm"):
        rule = "must end in .html, which tells browsers what it is"
        raise CaseError(rule, "give a name such as page.html", key=str(target))
    if target.is_dir():
        raise CaseError("is a folder", "give the page another name", key=str(target))


__all__ = ["report"]
