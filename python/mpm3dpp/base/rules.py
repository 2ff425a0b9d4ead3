# SPDX-License-Identifier: BSD-3-Clause
"""Rules on numbers: in words for the case schema, as bounds for the catalogue of materials.

A rule in words is `> 0`, `>= 0`, `< 1`, `0 < f <= 1`, or several joined by `and`.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable
from functools import lru_cache
from typing import NamedTuple

_COMPARE: dict[str, Callable[[float, float], bool]] = {
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_PART = re.compile(
    rf"(?:(?P<left>{_NUMBER})\s*(?P<left_sign>[<>]=?)\s*)?(?:[A-Za-z_]\w*\s*)?"
    rf"(?:(?P<sign>[<>]=?)\s*(?P<right>{_NUMBER}))?"
)


class Bounds(NamedTuple):
    """The numbers from `lower` to `upper`; an open bound is not one of them."""

    lower: float
    upper: float
    lower_open: bool
    upper_open: bool


def within(bounds: Bounds, value: float) -> bool:
    """Return whether a number lies within bounds."""
    above = value > bounds.lower if bounds.lower_open else value >= bounds.lower
    below = value < bounds.upper if bounds.upper_open else value <= bounds.upper
    return above and below


@lru_cache(maxsize=256)
def _tests(rule: str) -> tuple[tuple[str, float, bool], ...]:
    """Return (sign, bound, bound is on the left) of each comparison in a rule."""
    tests: list[tuple[str, float, bool]] = []
    for part in re.split(r"\s+and\s+|,", rule.strip()):
        match = _PART.fullmatch(part.strip())
        if match is None:
            raise ValueError(f"no rule on a number: {rule}")
        if match["left"] is not None:
            tests.append((match["left_sign"], float(match["left"]), True))
        if match["right"] is not None:
            tests.append((match["sign"], float(match["right"]), False))
    return tuple(tests)


def holds(rule: str, value: float) -> bool:
    """Return whether a number obeys a rule; an empty rule always holds."""
    return all(
        _COMPARE[sign](bound, value) if left else _COMPARE[sign](value, bound)
        for sign, bound, left in _tests(rule)
    )


def requirement(rule: str) -> str:
    """Return a rule as the middle of a sentence: `must be > 0`, `must obey 0 < f <= 1`."""
    if rule.startswith("must "):
        return rule
    return f"must be {rule}" if rule[:1] in "<>" else f"must obey {rule}"
