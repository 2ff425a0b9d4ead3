# SPDX-License-Identifier: BSD-3-Clause
"""What a number would be on ever finer grids, and how sure that is."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

SAFETY, CAREFUL = 1.25, 3.0
"""Factors on the difference to the extrapolated value, for three grids and more (Roache 1998), and
where the order is more than the method's (Eca & Hoekstra 2014)."""
_LEAST, MOST = 0.5, 2.0
"""Orders that an extrapolation is made with: a lower one would lead far beyond the values, and a
higher one than the method's is chance."""
_CREDIBLE = 2.1


@dataclass(frozen=True)
class Converged:
    """What the values of a number on some grids tell.

    Attributes:
        order: p of f = f_0 + C h^p by the three finest grids; None if they do not tell it.
        extrapolated: f_0; None if it cannot be told.
        uncertainty: of the value on the finest grid, in its unit; None if it cannot be told.
        said: what is missing: "the same" (all values are equal), "oscillates", "does not
            converge", "too slow to tell" (an order below a half), "no number"; or "".
    """

    order: float | None
    extrapolated: float | None
    uncertainty: float | None
    said: str = ""


def convergence(values: Sequence[float], ratio: float) -> Converged:
    """Return what values on grids tell, each finer than that before.

    The order is p = ln((f_3 - f_2) / (f_2 - f_1)) / ln r and the extrapolated value f_0 = f_1 +
    (f_1 - f_2) / (r^p - 1), with f_1 on the finest grid and p = 2 where it is more; the uncertainty
    is 1.25 |f_1 - f_0|, or 3 |f_1 - f_0| where p is more than 2.1 (Roache 1998, the grid
    convergence index, not divided by the value). Values that swing less and less tell no order;
    their uncertainty is half of their range (Stern, Wilson, Coleman & Paterson 2001).

    Args:
        values: from the coarsest grid to the finest, three at least.
        ratio: r > 1, of a cell to that of the next grid.
    """
    third, second, first = values[-3:]
    if not all(map(math.isfinite, (third, second, first))):
        return Converged(None, None, None, "no number")
    before, last = second - third, first - second
    rounding = 1e-13 * max(map(abs, (third, second, first)))
    half_range = 0.5 * (max(values[-3:]) - min(values[-3:]))
    if abs(before) <= rounding and abs(last) <= rounding:
        return Converged(None, first, half_range, "the same")
    if abs(last) >= abs(before):
        return Converged(None, None, None, "does not converge")
    if last == 0.0 or before * last < 0.0:
        return Converged(None, None, half_range, "oscillates")
    order = math.log(before / last) / math.log(ratio)
    if order < _LEAST:
        return Converged(order, None, None, "too slow to tell")
    extrapolated = first + last / (ratio ** min(order, MOST) - 1.0)
    factor = SAFETY if order <= _CREDIBLE else CAREFUL
    return Converged(order, extrapolated, factor * abs(extrapolated - first))
