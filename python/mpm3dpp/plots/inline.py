# SPDX-License-Identifier: BSD-3-Clause
"""Figures that a notebook shows without pyplot."""

from __future__ import annotations

import io
from typing import Any

import matplotlib
from matplotlib.figure import Figure


class InlineFigure(Figure):
    """A figure that a notebook shows as the picture that `style.save` would write.

    Attributes:
        settings: of matplotlib, with which it is drawn.
        whole: whether it has the size that was asked for, so that no margin is cut off.
    """

    settings: Any = None
    whole: bool = False

    def _repr_png_(self) -> bytes:
        """What a notebook shows."""
        file = io.BytesIO()
        cut: dict[str, Any] = {} if self.whole else {"bbox_inches": "tight", "pad_inches": 0.06}
        with matplotlib.rc_context(self.settings):
            self.savefig(file, format="png", dpi="figure", **cut)
        return file.getvalue()
