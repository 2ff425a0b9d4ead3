# SPDX-License-Identifier: BSD-3-Clause
"""Pages of the repository outside docs/ as pages of the site, and links to them.

They are copied to docs/_repository/, which git ignores, before Sphinx reads its sources, with their
links rewritten. In pages of docs/ a link to such a page or to an example's folder leads to the
copy, so that the same link works where the files are read as they are.
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
COPIES = DOCS / "_repository"
LINK = re.compile(r"(\]\()([^)\s#:]+)((?:#[^)\s]*)?\))")
FENCE = re.compile(r"(^```.*?^```$)", re.M | re.S)


def sources() -> list[Path]:
    """Return the pages outside docs/ that the site has."""
    names = ("README.md", "ARCHITECTURE.md", "CONTRIBUTING.md", "CHANGELOG.md")
    return [*(ROOT / name for name in names), *sorted((ROOT / "examples").glob("*/README.md"))]


def place(target: Path) -> Path:
    """Return where the site has what a link names: a copy, the page of a folder, or itself."""
    for page in ("README.md", "index.md") if target.is_dir() else ():
        if (target / page).is_file():
            target = target / page
    return COPIES / target.relative_to(ROOT) if target in sources() else target


def relinked(text: str, home: Path, folder: Path) -> str:
    """Return the text of a page of the folder `home` with links for one of `folder`."""

    def new(link: re.Match[str]) -> str:
        target = Path(os.path.normpath(home / link[2]))
        if not target.exists():
            return link[0]  # Sphinx says so.
        return link[1] + Path(os.path.relpath(place(target), folder)).as_posix() + link[3]

    parts = FENCE.split(text)
    return "".join(part if n % 2 else LINK.sub(new, part) for n, part in enumerate(parts))


def copy_pages(app: Any) -> None:
    """Write the copies that are not up to date."""
    for page in sources():
        copy = COPIES / page.relative_to(ROOT)
        text = relinked(page.read_text(), page.parent, copy.parent)
        if page.parent != ROOT:
            text = f"---\norphan: true\n---\n{text}"  # Reached from the gallery, in no list.
        if not copy.exists() or copy.read_text() != text:
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(text)


def relink(app: Any, name: str, source: list[str]) -> None:
    """Turn the links of a page of docs/ to the copies."""
    folder = (DOCS / name).parent
    if COPIES not in folder.parents and folder != COPIES:
        source[0] = relinked(source[0], folder, folder)


def setup(app: Any) -> dict[str, bool]:
    """Called by Sphinx."""
    connect: Callable[[str, Any], Any] = app.connect
    connect("config-inited", lambda app, _: copy_pages(app))
    connect("source-read", relink)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
