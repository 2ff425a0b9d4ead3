# SPDX-License-Identifier: BSD-3-Clause
"""The section on pictures: those that lie in the folder, within the page."""

from __future__ import annotations

import base64
import html
import os
import re
from pathlib import Path
from urllib.parse import quote

from mpm3dpp.base.markup import Html, element, figure, joined, paragraph
from mpm3dpp.plots.labels import scaled

from .document import Section
from .found import Found

FORCES = "force_network.png"  # stands with the contacts
_DRAWN_ANEW = ("energies.png", "probes.png")  # as curves, in sections of their own
_MOST = 24  # pictures within the page
_LARGEST = 12 << 20  # bytes of a picture within the page
_SMALL_ANIMATION = 2 << 20  # bytes of one that is no link
_KINDS = {".png": (b"\x89PNG", "image/png"), ".gif": (b"GIF8", "image/gif")}
_FIRST = ("frame.png", "first_contact.png", "preview.png")


def pictures(found: Found, beside: Path) -> Section:
    """Return the section on pictures.

    Args:
        found: the run.
        beside: folder of the page, for links.
    """
    files = _files(found.folder)
    shown: list[Html] = []
    linked: list[Path] = []
    for path in files:
        drawn = embedded(found, path) if len(shown) < _MOST else None
        if drawn is None:
            linked.append(path)
        else:
            shown.append(drawn)
    if not files:
        text = f"There are none; `mpm3dpp plot {found.folder}` draws them."
        return Section("pictures", "Pictures", paragraph(text))
    links = [element("li", link(path, beside)) for path in linked]
    rest = element("ul", joined(links)) if links else Html("")
    return Section("pictures", "Pictures", joined([*shown, rest]))


def embedded(found: Found, path: Path) -> Html | None:
    """Return a picture with its caption; None if it is too large, none at all, or unreadable."""
    most = _SMALL_ANIMATION if path.suffix == ".gif" else _LARGEST
    try:
        if path.suffix not in _KINDS or path.stat().st_size > most:
            return None
        content = path.read_bytes()
    except OSError:
        return None
    begin, kind = _KINDS[path.suffix]
    if not content.startswith(begin):
        return None
    caption = _caption(found, path)
    data = f"data:{kind};base64,{base64.b64encode(content).decode()}"
    return figure(Html(f'<img src="{data}" alt="{html.escape(caption)}">'), caption)


def link(path: Path, beside: Path) -> Html:
    """Return a link to a file from the folder of the page."""
    way = Path(os.path.relpath(path.absolute(), beside.absolute())).as_posix()
    return element("a", path.name, href=quote(way))


def _files(folder: Path) -> list[Path]:
    """Return pictures and animations in the order of the page."""
    named = [folder / name for name in _FIRST]
    found = [p for p in sorted(folder.iterdir()) if p.suffix in (*_KINDS, ".mp4", ".webm")]
    found = [p for p in found if p.is_file() and p.name not in (*_DRAWN_ANEW, FORCES)]
    found = [p for p in found if not p.name.startswith(".")]  # Half a picture.
    return [p for p in named if p in found] + [p for p in found if p not in named]


def _caption(found: Found, path: Path) -> str:
    colour = str(found.case.get("output", {}).get("picture", "von_mises")).replace("_", " ")
    known = {
        "frame.png": f"The last frame that was drawn; the case asks for {colour} as its colours",
        "first_contact.png": "The first contact force, and the gap between the surfaces then",
        "force_network.png": "The forces between grains: a line for each contact, thicker where "
        "the force is larger",
        "preview.png": "The bodies before the run",
        "animation.gif": "All frames",
    }
    if path.name in known:
        return f"{known[path.name]} ({path.name})."
    number = re.fullmatch(r"frame_(\d+)", path.stem)
    times = [] if found.results is None else found.results.times.tolist()
    if number and int(number[1]) < len(times):
        return f"Frame {int(number[1])}, t = {scaled(times[int(number[1])], 's')} ({path.name})."
    return f"{path.name}."
