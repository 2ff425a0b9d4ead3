# SPDX-License-Identifier: BSD-3-Clause
"""Rules on numbers, in the words that the catalogue of materials and the case schema share.

A rule is `> 0`, `>= 0`, `< 1`, `-1 < nu < 0.5`, `0 < f <= 1`, or several joined by `and`; it may
begin with `must be`. So may `must lie between -1 and 0.5, both excluded`.
"""

from __future__ import annotations

import operator
import re
from collections.abc import Callable
from functools import lru_cache

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


_BETWEEN = re.compile(
    rf"must lie between (?P<low>{_NUMBER}) and (?P<high>{_NUMBER}), "
    r"both (?P<ends>excluded|included)"
)


@lru_cache(maxsize=256)
def _tests(rule: str) -> tuple[tuple[str, float, bool], ...]:
    """Return (sign, bound, bound is on the left) of each comparison in a rule."""
    tests: list[tuple[str, float, bool]] = []
    between = _BETWEEN.fullmatch(rule.strip())
    if between is not None:
        sign = "<" if between["ends"] == "excluded" else "<="
        return ((sign, float(between["low"]), True), (sign, float(between["high"]), False))
    for part in re.split(r"\s+and\s+|,", rule.strip().removeprefix("must be ")):
        match = _PART.fullmatch(part.strip())
        if match is None:
            continue  # A rule in other words is checked by the core alone.
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
