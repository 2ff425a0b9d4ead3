# SPDX-License-Identifier: BSD-3-Clause
"""A page of HTML and its sections, of the pieces that `base.markup` makes."""

from __future__ import annotations

import html
from dataclasses import dataclass

from mpm3dpp.base.markup import Html
from mpm3dpp.base.ours import MARK

from .style import STYLE


@dataclass(frozen=True)
class Section:
    """A part of a page.

    Attributes:
        name: by which the table of contents points to it.
        title: in words.
        body: what follows the title.
    """

    name: str
    title: str
    body: Html


def document(title: str, body: str) -> str:
    """Return a page.

    Args:
        title: of the browser's window.
        body: HTML.
    """
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="generator" content="{MARK}">\n'
        '<meta name="color-scheme" content="light dark">\n'
        f"<title>{html.escape(title)}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<main>\n"
        f"{body}</main>\n</body>\n</html>\n"
    )
