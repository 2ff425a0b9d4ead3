# SPDX-License-Identifier: BSD-3-Clause
"""Cases as commands take them: a file of ours or of MPM3D, with --set."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .options import print_notes

if TYPE_CHECKING:
    from mpm3dpp.case.case import Case


def load(
    path: Path, units: str | None, quiet: bool = False, changes: list[str] | None = None
) -> Case:
    """Return the case of a file; what to know about it goes to stderr."""
    from mpm3dpp.base.readers import reader_of
    from mpm3dpp.importers import load_any

    if changes:
        from mpm3dpp.case.changes import changed_file, changes_of, with_changes

        if units is None and reader_of(path) is None:  # A change may mend the file.
            from mpm3dpp.case.case import Case

            return changed_file(Case, path, changes_of(changes))
    loaded, notes = load_any(path, units)
    if not quiet:
        print_notes(notes)
    return with_changes(loaded, changes_of(changes)) if changes else loaded
