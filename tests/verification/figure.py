# SPDX-License-Identifier: BSD-3-Clause
"""A figure beside its answer, and the answers themselves (reference.json, with their origin)."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Figure:
    """One measured number.

    Attributes:
        name: what was measured.
        unit: its unit; "" for a pure number.
        ours: what we measured.
        answer: what it should be; None for a figure that is only reported.
        tolerance: largest absolute difference; a pair (lowest, highest) admits a range instead.
        source: where the answer and the tolerance come from.
        remark: what a reader should know.
    """

    name: str
    unit: str
    ours: float
    answer: float | None
    tolerance: float | tuple[float, float] | None
    source: str
    remark: str = ""

    @property
    def judged(self) -> bool:
        """Is there a tolerance to meet?"""
        return self.tolerance is not None

    @property
    def passed(self) -> bool:
        """Within the tolerance; a figure without one passes if it is finite, and NaN never."""
        if self.tolerance is None:
            return self.ours == self.ours
        if isinstance(self.tolerance, tuple):
            return self.tolerance[0] <= self.ours <= self.tolerance[1]
        assert self.answer is not None
        return abs(self.ours - self.answer) <= self.tolerance


@cache
def reference() -> dict[str, Any]:
    """Return the contents of reference.json: answers and tolerances by problem."""
    return json.loads((Path(__file__).parent / "reference.json").read_text())


def judge(problem: str, name: str, ours: float, unit: str = "", remark: str = "") -> Figure:
    """Return a figure with the answer, tolerance and origin that reference.json gives it."""
    entry = reference()[problem]
    answer = entry["answers"][name]
    if "within" in answer:
        tolerance: Any = tuple(answer["within"])
    elif "relative" in answer:
        tolerance = answer["relative"] * abs(answer["value"])
    else:
        tolerance = answer.get("absolute")
    return Figure(
        name,
        answer.get("unit", unit),
        float(ours),
        answer.get("value"),
        tolerance,
        answer.get("origin", entry["origin"]),
        remark,
    )


def report(name: str, ours: float, unit: str = "", remark: str = "") -> Figure:
    """Return a figure that is only reported."""
    return Figure(name, unit, float(ours), None, None, "", remark)
