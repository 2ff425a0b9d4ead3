# SPDX-License-Identifier: BSD-3-Clause
"""The blocks of code in the pages for users, for the tests that run them.

A block that no test can run has `<!-- not run: reason -->` on the line before it, which readers do
not see.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).parents[1]
DOCS = ROOT / "docs"
FENCE = re.compile(
    r"(?:^<!-- not run: (?P<reason>[^\n]+) -->\n)?"
    r"^```(?P<language>\w*)\n(?P<text>.*?)^```$",
    re.M | re.S,
)
SHELL = ("sh", "bash", "console")


@dataclass(frozen=True)
class Block:
    """A fenced block.

    Attributes:
        page: path of its page below the repository.
        line: its first line there.
        language: "toml", "sh", "python", "text", ...; empty if the fence has none.
        text: what is in it.
        reason: why it is not run; empty if it is.
    """

    page: str
    line: int
    language: str
    text: str
    reason: str

    def __str__(self) -> str:
        return f"{self.page}:{self.line}"

    @property
    def is_case(self) -> bool:
        """Whether it is a whole case file."""
        return self.language == "toml" and all(f"[{t}]" in self.text for t in ("grid", "run"))


def pages() -> list[str]:
    """Return the pages for users; those for people who change the code are not among them."""
    folders = ("how-to", "coming-from")
    found = [page for folder in folders for page in sorted((DOCS / folder).glob("*.md"))]
    users = [page for page in found if not page.name.startswith("write-a-")]
    first = [ROOT / "README.md", DOCS / "quick-start.md", DOCS / "tutorial.md"]
    return [page.relative_to(ROOT).as_posix() for page in first + users]


def blocks(page: str) -> list[Block]:
    """Return the blocks of a page, in their order."""
    text = (ROOT / page).read_text()
    found = []
    for fence in FENCE.finditer(text):
        line = text.count("\n", 0, fence.start("text")) + 1
        what = (fence["language"], fence["text"], fence["reason"] or "")
        found.append(Block(page, line, *what))
    return found


def every(*languages: str, run: bool = True) -> list[Block]:
    """Return the blocks of all pages in these languages that are run, or those that are not."""
    found = [block for page in pages() for block in blocks(page)]
    return [b for b in found if b.language in languages and run == (not b.reason)]


def commands(text: str) -> Iterator[list[str]]:
    """Yield the words of each command of a shell block, without comments."""
    for line in text.replace("\\\n", " ").splitlines():
        words = shlex.split(line.removeprefix("$ "), comments=True)
        if words:
            yield words


def unknown_keys(schema: dict[str, Any], table: dict[str, Any]) -> list[str]:
    """Return the keys of a part of a case file that the schema does not have.

    A part may begin with the keys of any of the tables: `velocity = [...]`.
    """
    inner = [name for part in schema["$defs"].values() for name in part.get("properties", {})]
    top = schema["properties"]
    found = [name for name in table if name not in top and name not in inner]
    for name, value in table.items():
        found += _unknown(schema, top.get(name, {}), value, name)
    return found


def _unknown(schema: dict[str, Any], part: dict[str, Any], value: Any, place: str) -> list[str]:
    if "$ref" in part:
        part = schema["$defs"][part["$ref"].rpartition("/")[2]]
    if isinstance(value, list):
        item = part.get("items", {})
        return [name for each in value for name in _unknown(schema, item, each, place)]
    if not isinstance(value, dict):
        return []
    if part.get("type") == "array":  # One table in place of a list of one.
        return _unknown(schema, part["items"], value, place)
    choices = [p for p in part.get("anyOf", []) if "$ref" in p]
    if len(choices) == 1:
        return _unknown(schema, choices[0], value, place)
    own, named = part.get("properties"), part.get("additionalProperties")
    found = []
    for name, inner in value.items():
        where = f"{place}.{name}"
        if own and name in own:
            found += _unknown(schema, own[name], inner, where)
        elif isinstance(named, dict):
            found += _unknown(schema, named, inner, where)
        elif own:
            found.append(where)
    return found
