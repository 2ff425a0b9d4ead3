# SPDX-License-Identifier: BSD-3-Clause
"""Drawings of matplotlib as SVG within a page, in the colours of the page."""

from __future__ import annotations

import html
import io
import re
from typing import TYPE_CHECKING, Any

from mpm3dpp.base.markup import Html, element
from mpm3dpp.base.markup import figure as framed
from mpm3dpp.plots.style import styled

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Text stays text; of curves of a million rows what cannot be seen is left out.
_SETTINGS: Any = {"svg.fonttype": "none", "path.simplify_threshold": 0.2}
_GRID = "#e3e3e3"  # of the plots' style


def curves(figure: Figure, name: str, caption: str) -> Html:
    """Return a drawing with a caption.

    Args:
        figure: of matplotlib, on no background.
        name: of the drawing, which no other on the page has.
        caption: what it shows.
    """
    return framed(inline_svg(figure, name, caption), caption, "curves")


def inline_svg(figure: Figure, name: str, about: str) -> Html:
    """Return a drawing as an element `svg`; black becomes the colour of the page's text.

    Args:
        figure, name: see `curves`.
        about: what who cannot see it is told.
    """
    import matplotlib

    text = io.StringIO()
    with styled(), matplotlib.rc_context({**_SETTINGS, "svg.hashsalt": name}):
        figure.savefig(text, format="svg", transparent=True, metadata={"Date": None})
    svg = text.getvalue()
    svg = svg[svg.index("<svg") :]
    svg = re.sub(r"<metadata>.*?</metadata>|<style.*?</style>|<!--.*?-->", "", svg, flags=re.S)
    svg = svg.replace("#000000", "currentColor").replace(_GRID, "var(--rule)")
    # Names are of the page, not of the drawing.
    svg = re.sub(r'\bid="', f'id="{name}-', svg)
    svg = re.sub(r"url\(#", f"url(#{name}-", svg)
    svg = re.sub(r'xlink:href="#', f'href="#{name}-', svg)
    box = re.search(r'viewBox="[^"]*"', svg)
    inner = svg[svg.index(">") + 1 : svg.rindex("</svg>")]
    shown = f'fill="currentColor" role="img" aria-label="{html.escape(about)}"'
    return Html(f"<svg {box[0] if box else ''} {shown}>{inner.strip()}</svg>")


def bar(share: float) -> Html:
    """Return a bar that fills a share of the cell of a table, 0 to 1."""
    return Html(f'<span style="width: {100 * min(max(share, 0.0), 1.0):.2f}%"></span>')


def bar_cell(share: float) -> Html:
    """Return a bar, for a cell that `table` makes."""
    return element("div", bar(share), class_="bar")
