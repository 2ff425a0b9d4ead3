# SPDX-License-Identifier: BSD-3-Clause
"""Pieces of HTML. Text is escaped by whoever makes it a piece: what is `Html` is whole."""

from __future__ import annotations

import html
from collections.abc import Iterable, Sequence


class Html(str):
    """Text that is HTML already."""


def escaped(text: str) -> Html:
    """Return text as HTML; what is HTML as it is."""
    return text if isinstance(text, Html) else Html(html.escape(str(text)))


def joined(parts: Iterable[str], between: str = "\n") -> Html:
    """Return pieces one after the other; empty ones are left out."""
    return Html(between.join(escaped(part) for part in parts if part))


def element(name: str, inner: str, **attributes: str) -> Html:
    """Return `<name attributes>inner</name>`; `class_` stands for `class`."""
    words = "".join(
        f' {key.rstrip("_").replace("_", "-")}="{html.escape(value)}"'
        for key, value in attributes.items()
        if value
    )
    return Html(f"<{name}{words}>{escaped(inner)}</{name}>")


def paragraph(text: str, class_: str = "") -> Html:
    """Return a paragraph."""
    return element("p", text, class_=class_)


def bullets(items: Sequence[str]) -> Html:
    """Return a list of sentences; nothing if there are none."""
    inner = joined([element("li", item) for item in items])
    return element("ul", inner) if items else Html("")


def table(head: Sequence[str], rows: Sequence[Sequence[str]], words: int = 1) -> Html:
    """Return a table that scrolls sideways where it is too wide.

    Args:
        head: titles of the columns.
        rows: of cells.
        words: how many of the first columns hold words; the others hold numbers.
    """
    kinds = ["" if k < words else "number" for k in range(len(head))]

    def line(cells: Sequence[str], name: str, **more: str) -> Html:
        found = [element(name, c, class_=k, **more) for c, k in zip(cells, kinds, strict=True)]
        return element("tr", joined(found, ""))

    inner = joined(
        [
            element("thead", line(head, "th", scope="col")),
            element("tbody", joined(line(row, "td") for row in rows)),
        ]
    )
    return element("div", element("table", inner), class_="wide")


def details(title: str, inner: str) -> Html:
    """Return what is shown when its title is clicked."""
    return element("details", joined([element("summary", title), inner]))


def figure(picture: Html, caption: str, class_: str = "") -> Html:
    """Return a picture with a caption."""
    return element("figure", joined([picture, element("figcaption", caption)]), class_=class_)
