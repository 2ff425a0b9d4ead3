# SPDX-License-Identifier: BSD-3-Clause
"""The pages of the documentation as text: all of them, one, and where they have some words."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.shipped import shipped

_GROUPS = {
    "": "Begin",
    "how-to": "Tasks",
    "coming-from": "Coming from another code",
    "reference": "Reference",
    "theory": "Theory",
    "decisions": "Decisions",
}
_SITE_ALONE = {"index.md", "how-to/index.md", "decisions/index.md"}
_MOST = 10  # places that are told
_WIDTH = 96
_IN_HEADING = 10  # times as much as in the text
_WEIGHTS = {"how-to": 2.0, "decisions": 0.1, "verification": 0.3}  # How, rather than why.


@dataclass(frozen=True)
class Section:
    """A part of a page, from one heading to the next."""

    page: str
    heading: str
    text: str


def page_list() -> str:
    """Return the names and titles of all pages, by group."""
    lines = []
    for group, title in _GROUPS.items():
        names = [name for name in _names() if name.rpartition("/")[0] == group]
        if group == "decisions":
            lines.append(f"\n{title}: {len(names)} pages, found by their words")
        elif names:
            width = max(map(len, names))
            lines += [f"\n{title}", *(f"  {name:{width}}  {_title(name)}" for name in names)]
    return "\n".join(lines).lstrip("\n")


def look_up(words: list[str]) -> str:
    """Return the page of a name, else where the words stand.

    Raises:
        CaseError: no page is called so, and none has all the words.
    """
    asked = " ".join(words).removesuffix(".md")
    names = [name for name in _names() if asked in (name, name.rpartition("/")[2])]
    if names:
        return _file(names[0]).read_text(encoding="utf-8")
    found = places([word.lower() for part in words for word in part.split()])
    if not found:
        rule = f"no page of the documentation has '{asked}'"
        raise CaseError(rule, "give other words, or none for a list of the pages")
    lines = []
    for section, line in found[:_MOST]:
        lines += [f"{section.page}: {section.heading}", f"    {line}"]
    more = f"\n{len(found) - _MOST} more pages have these words." if len(found) > _MOST else ""
    return "\n".join(lines) + f"{more}\nRead one:  mpm3dpp docs {found[0][0].page}"


def places(words: list[str]) -> list[tuple[Section, str]]:
    """Return the best section of each page, best first, with a line that has most of the words.

    More than half of the words are in each.

    Args:
        words: lower case.
    """
    best: dict[str, tuple[float, Section]] = {}
    for section in _sections():
        score = _score(section, words)
        if score > best.get(section.page, (0.0, section))[0]:
            best[section.page] = score, section
    ranked = sorted(best.values(), key=lambda scored: -scored[0])
    return [(section, _line_of(section, words)) for _, section in ranked]


def _score(section: Section, words: list[str]) -> float:
    """Return how well a section answers to some words, more than half of which it must have."""
    heading, text = f"{section.page} {section.heading}".lower(), section.text.lower()
    there = [word for word in words if word in heading or word in text]
    if 2 * len(there) <= len(words):
        return 0.0
    found = sum(_IN_HEADING * (word in heading) + min(text.count(word), 5) for word in there)
    group = section.page.partition("/")[0]
    return found * (len(there) / len(words)) ** 4 * _WEIGHTS.get(group, 1.0)


def _line_of(section: Section, words: list[str]) -> str:
    """Return the line of a section that has most of the words, cut to the width of a screen."""
    lines = [line.strip() for line in section.text.splitlines() if line.strip()] or [""]
    best = max(lines, key=lambda line: sum(word in line.lower() for word in words))
    first = min((at for word in words if (at := best.lower().find(word)) >= 0), default=0)
    begin = max(0, min(first - _WIDTH // 3, len(best) - _WIDTH))
    cut = best[begin : begin + _WIDTH]
    return f"{'...' if begin else ''}{cut}{'...' if begin + _WIDTH < len(best) else ''}"


def _names() -> list[str]:
    """Return the names of all pages, without .md."""
    folder = shipped("docs")
    found = sorted(
        name
        for path in folder.rglob("*.md")
        if not (name := path.relative_to(folder).as_posix()).startswith("_")
        and name not in _SITE_ALONE
    )
    if not found:
        rule = "the documentation did not come with this package"
        raise CaseError(rule, "install it with pip", place=str(folder))
    return [name.removesuffix(".md") for name in found]


def _file(name: str) -> Path:
    return shipped("docs") / f"{name}.md"


def _title(name: str) -> str:
    with _file(name).open(encoding="utf-8") as file:
        for line in file:
            if line.startswith("# "):
                return line[2:].strip().replace("`", "")
    return ""


def _sections() -> Iterator[Section]:
    for name in _names():
        heading, lines, in_code = "", list[str](), False
        for line in _file(name).read_text(encoding="utf-8").splitlines():
            in_code ^= line.startswith("```")
            if line.startswith("#") and not in_code:
                yield Section(name, heading, "\n".join(lines))
                heading, lines = line.lstrip("#").strip().replace("`", ""), []
            else:
                lines.append(line)
        yield Section(name, heading, "\n".join(lines))
