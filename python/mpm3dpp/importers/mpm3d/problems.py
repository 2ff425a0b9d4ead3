# SPDX-License-Identifier: BSD-3-Clause
"""The mistakes of a file, gathered so that the user hears of all of them at once."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from mpm3dpp.errors import CaseError

_SHOWN = 30  # Sentences; the count tells of the rest.

P = ParamSpec("P")
T = TypeVar("T")


class CaseErrors(CaseError):
    """Several mistakes: a line of text for each, by their lines in the file, then their count.

    Attributes:
        problems: the mistakes.
    """

    def __init__(self, name: str, problems: list[CaseError]) -> None:
        self.problems = problems
        super().__init__(f"has {len(problems)} problems", place=name)

    def sentence(self) -> str:
        """Return all sentences, a line of text each, and their count."""
        lines = [problem.sentence() for problem in self.problems[:_SHOWN]]
        left = len(self.problems) - len(lines)
        shown = f"; {left} are not shown" if left else ""
        return "\n".join([*lines, f"{self.place}: {len(self.problems)} problems{shown}"])


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
        both = [error, *getattr(error, "others", ())]
        self._others += error.problems if isinstance(error, CaseErrors) else both

    def judge(self) -> None:
        """Raise what has been gathered, if anything."""
        found = list(self._others)
        for (key, rule, remedy), lines in self._found.items():
            more = f" (and so {len(lines) - 1} times more)" if len(lines) > 1 else ""
            place = f"{self.name}:{lines[0]}"
            found.append(CaseError(rule + more, remedy, key=key, place=place))
        found.sort(key=_line)
        if len(found) == 1:
            raise found[0]
        if found:
            raise CaseErrors(self.name, found)


def _line(error: CaseError) -> int:
    tail = error.place.rpartition(":")[2]
    return int(tail) if tail.isdigit() else 0
