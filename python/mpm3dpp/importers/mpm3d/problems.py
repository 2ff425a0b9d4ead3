# SPDX-License-Identifier: BSD-3-Clause
"""The mistakes of a file, gathered so that the user hears of all of them at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from mpm3dpp.base.errors import CaseError, first_of

P = ParamSpec("P")
T = TypeVar("T")


class Problems:
    """Gathers mistakes; what is said in the same words of several lines is one of them."""

    def __init__(self, name: str) -> None:
        self.name = name
        self._found: dict[tuple[str, str, str], list[int]] = {}  # (key, rule, remedy): lines
        self._others: list[CaseError] = []

    def add(self, key: str, rule: str, remedy: str, line: int) -> None:
        """Add the mistake that a rule is broken at a line."""
        self._found.setdefault((key, rule, remedy), []).append(line)

    def caught(self, call: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T | None:
        """Return what a call gives; None, and its mistake added, if it makes one."""
        try:
            return call(*args, **kwargs)
        except CaseError as error:
            self.keep(error)
            return None

    def keep(self, error: CaseError) -> None:
        """Add a mistake that has been raised, and those that came with it."""
        self._others += [error, *error.others]

    def judge(self) -> None:
        """Raise what has been gathered, if anything: the first has the rest as its `others`."""
        found = list(self._others)
        for (key, rule, remedy), lines in self._found.items():
            more = f" (and so {len(lines) - 1} times more)" if len(lines) > 1 else ""
            place = f"{self.name}:{lines[0]}"
            found.append(CaseError(rule + more, remedy, key=key, place=place))
        found.sort(key=_line)
        if found:
            raise first_of(found)


def _line(error: CaseError) -> int:
    tail = error.place.rpartition(":")[2]
    return int(tail) if tail.isdigit() else 0
