# SPDX-License-Identifier: BSD-3-Clause
"""Numbers as they stand in the tables of a page."""

from __future__ import annotations

import math
from collections.abc import Sequence

NONE = "\N{EN DASH}"


def number(value: float | None, digits: int = 6) -> str:
    """Return a number; a dash where there is none."""
    if value is None or math.isnan(value):
        return NONE
    return f"{value + 0.0:.{digits}g}"


def vector(values: Sequence[float], dimension: int, digits: int = 5) -> str:
    """Return the components of a vector, as many as there are dimensions.

    Those that are rounding beside the others are 0.
    """
    parts = list(values)[:dimension]
    least = 1e-12 * max((abs(v) for v in parts), default=0.0)
    return ", ".join(number(v if abs(v) > least else 0.0, digits) for v in parts)


def duration(seconds: float) -> str:
    """Return a time of the clock in words."""
    if seconds < 100.0:
        return f"{seconds:.3g} s"
    hours, rest = divmod(round(seconds), 3600)
    minutes, left = divmod(rest, 60)
    return f"{hours} h {minutes:02d} min" if hours else f"{minutes} min {left:02d} s"


def counted(count: int, one: str, many: str = "") -> str:
    """Return how many there are of something: `1 body`, `12 bodies`."""
    return f"{count:,} {one if count == 1 else many or one + 's'}"
