# SPDX-License-Identifier: BSD-3-Clause
"""The page of `mpm3dpp report`: a list of sections."""

from __future__ import annotations

from pathlib import Path

from mpm3dpp.base.markup import Html, element, joined

from .bodies import actions, bodies
from .case_text import case
from .contacts import contacts
from .document import Section, document
from .energies import energies
from .found import Found
from .pictures import pictures
from .probes import probes
from .record import record
from .stages import stages
from .summary import happened, head
from .time_step import time_step


def compose(found: Found, beside: Path) -> str:
    """Return the page.

    Args:
        found: the run.
        beside: folder of the page, for links to animations.
    """
    rest = [
        case(found),
        pictures(found, beside),
        energies(found),
        bodies(found),
        contacts(found),
        actions(found),
        time_step(found),
        stages(found),
        probes(found),
        record(found),
    ]
    top = head(found)
    first = happened(found)  # Last: it tells what could not be read.
    sections = [first, *(section for section in rest if section is not None)]
    return document(
        found.title or found.folder.resolve().name,
        joined([top, _contents(sections), *map(_section, sections), _foot()]) + "\n",
    )


def _contents(sections: list[Section]) -> Html:
    lines = [element("li", element("a", s.title, href=f"#{s.name}")) for s in sections]
    return element("nav", element("ol", joined(lines)), aria_label="Contents")


def _section(section: Section) -> Html:
    title = element("h2", section.title)
    return element("section", joined([title, section.body]), id=section.name)


def _foot() -> Html:
    from mpm3dpp import __version__

    return element("footer", f"Made by mpm3dpp report of MPM3Dpp {__version__}.")
