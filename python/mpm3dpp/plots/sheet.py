# SPDX-License-Identifier: BSD-3-Clause
"""How large the figure of a picture is."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .look import Look
from .style import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SIZED = (7.0, 4.5)  # Least inches of a picture whose pixels are given: its text grows with it.


def sheet(inches: tuple[float, float], dpi: float, look: Look) -> Figure:
    """A figure of a size in inches, or of the pixels that were asked for."""
    if look.size is None:
        return new_figure(*inches, dpi)
    dpi = min(pixels / least for pixels, least in zip(look.size, _SIZED, strict=True))
    width, height = ((pixels + 0.01) / dpi for pixels in look.size)  # Cut to whole ones.
    figure = new_figure(width, height, dpi)
    figure.whole = True
    return figure


def paper(aspect: float) -> tuple[float, float]:
    """Width and height in inches of a picture whose region has this width over height."""
    aspect = min(max(aspect, 0.25), 5.0)
    width = 7.0 if aspect >= 1.2 else 5.2
    height = width / aspect + 0.7
    return (width, height) if height <= 8.0 else (width * 8.0 / height + 1.0, 8.0)
