# SPDX-License-Identifier: BSD-3-Clause
"""What a number would be on ever finer grids, and how sure that is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

SAFETY = 1.25
"""Factor on the difference to the extrapolated value, for three grids or more (Roache 1994)."""
_LEAST, MOST = 0.5, 2.0
"""Orders that an extrapolation is made with: a lower one would lead far beyond the values, and a
higher one than the method's is chance (Eca & Hoekstra 2014)."""


@dataclass(frozen=True)
class Converged:
    """What the values of a number on some grids tell.

    Attributes:
        order: p of f = f_0 + C h^p by the three finest grids; None if they do not tell it.
        extrapolated: f_0, None without an order of 0.5 at least.
        uncertainty: of the value on the finest grid, in its unit; None if it cannot be told.
        said: why there is no order: "the same", "oscillates", "does not converge", or "".
    """

    order: float | None
    extrapolated: float | None
    uncertainty: float | None
    said: str = ""


def convergence(values: Sequence[float], ratio: float) -> Converged:
    """Return what values on grids tell, each finer than that before.

    The order is p = ln((f_3 - f_2) / (f_2 - f_1)) / ln r and the extrapolated value f_0 = f_1 +
    (f_1 - f_2) / (r^p - 1), with f_1 on the finest grid (Richardson 1911); the uncertainty is 1.25
    |f_1 - f_0| (the grid convergence index of Roache 1994, not divided by the value), with p = 2
    where it is more. Values that go up and down tell no order; their uncertainty is half of their
    range.

    Args:
        values: from the coarsest grid to the finest, three at least.
        ratio: r > 1, of a cell to that of the next grid.
    """
    third, second, first = values[-3:]
    before, last = second - third, first - second
    rounding = 1e-13 * max(map(abs, values[-3:]))
    half_range = 0.5 * (max(values[-3:]) - min(values[-3:]))
    if abs(before) <= rounding and abs(last) <= rounding:
        return Converged(None, first, half_range, "the same")
    if before * last <= 0.0:
        return Converged(None, None, half_range, "oscillates")
    order = math.log(before / last) / math.log(ratio)
    if order <= 0.0:
        return Converged(None, None, None, "does not converge")
    if order < _LEAST:
        return Converged(order, None, None, "too slow to tell")
    extrapolated = first + last / (ratio ** min(order, MOST) - 1.0)
    return Converged(order, extrapolated, SAFETY * abs(extrapolated - first))
