# SPDX-License-Identifier: BSD-3-Clause
"""The page docs/gallery.md, from the READMEs of the examples."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PICTURE = re.compile(r"!\[([^\]]*)\]\(\.\./\.\./docs/(images/[^)]+)\)")
COMMANDS = re.compile(r"^```sh\n(mpm3dpp run .*?)\n", re.M)


def gallery_page(note: str) -> str:
    """Return the page: of each example the title, first sentences, picture, command and links."""
    lines = [
        "# Gallery",
        f"*{note}*",
        "",
        "Each example is a case file and a page with its results beside what is known.",
    ]
    for readme in sorted((ROOT / "examples").glob("*/README.md")):
        lines += ["", *entry(readme)]
    return "\n".join(lines) + "\n"


def entry(readme: Path) -> list[str]:
    """Return the lines of one example."""
    text = readme.read_text()
    title, _, rest = text.partition("\n")
    about = " ".join(rest.strip().split("\n\n")[0].split())
    picture, command = PICTURE.search(text), COMMANDS.search(text)
    if picture is None or command is None:
        raise ValueError(f"{readme} needs a picture of docs/images and a block of `mpm3dpp run`")
    folder = f"../examples/{readme.parent.name}"
    cases = sorted(path.name for path in readme.parent.glob("*.toml"))
    links = [f"[{name}]({folder}/{name})" for name in cases]
    return [
        f"## {title.removeprefix('# ')}",
        about,
        "",
        f"![{picture[1]}]({picture[2]})",
        "",
        "```sh",
        command[1],
        "```",
        f"[Its page]({folder}/README.md); {', '.join(links)}",
    ]
