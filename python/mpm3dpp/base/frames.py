# SPDX-License-Identifier: BSD-3-Clause
"""Where the nodes of a body lie."""

from __future__ import annotations

UPDATED = "updated"
"""In space: particles pass them."""
MATERIAL = "material"
"""In the body: they keep its motion."""
AUTO = "auto"
"""In the body where its material and what it touches allow that, else in space."""
FRAMES = (UPDATED, MATERIAL, AUTO)

ALONG, ALONG_FEW = 2, 3
"""Particles per cell along each direction, and those of balls of few cells in a frame of their own:
cut cells with two vibrate, which takes two to four per cent of a hit."""

FEW_CELLS = 8.0
"""Cells a radius, below which a ball has few."""


def particles_along(frame: str, cells_a_radius: float) -> int:
    """Return how many particles a cell has along each direction where a case does not say.

    Args:
        frame: of the body.
        cells_a_radius: of a disc or a ball; infinity of others.
    """
    return ALONG_FEW if frame == MATERIAL and cells_a_radius < FEW_CELLS else ALONG
