# SPDX-License-Identifier: BSD-3-Clause
"""A benchmark: one TOML file with a case, what is taken from its run, and the answers.

```toml
title = "A disc slides, then rolls"
source = "Newton's and Euler's laws"
[constants]
v0 = 0.1
[case.grid]                 # and all other tables of a case file, below `case`
...
[take]
v = { column = "body_disc_velocity_x" }               # of history.csv, at the end
[[figure]]
title = "speed as it rolls, over that at the start"
value = "v / v0"                                      # a formula of constants and takes
answer = "2 / 3"
tolerance = "1 %"                                     # of the answer, or a number
why = "the disc yields where it is pressed: 1 % at 6 cells a radius"
```
A table `[variant.NAME]` makes a further run: `set` has keys of the case with other values,
`constants` other constants. Where there are variants nothing else is run.
"""

from __future__ import annotations

import ast
import copy
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

from pydantic import Field, model_validator

from mpm3dpp.base.errors import CaseError, nearest, violation
from mpm3dpp.base.expression import Expression
from mpm3dpp.base.model import CaseModel, Choice, Text
from mpm3dpp.case import file as case_file
from mpm3dpp.case.case import Case

FOLDER = Path(__file__).parent / "problems"
AT = ("end", "start", "largest", "smallest")
"""Of a column which number is taken."""


class Take(CaseModel):
    """A number of a run.

    Attributes:
        column: of `history.csv`, or of a probe's table.
        probe: whose table; empty for `history.csv`.
        at: which of its numbers: at the "end" or the "start", the "largest" or the "smallest".
        after, before: times between which it is taken [s]; default the whole run.
    """

    column: Text
    probe: Text = ""
    at: Annotated[str, Choice(AT)] = "end"
    after: float | None = None
    before: float | None = None


class Figure(CaseModel):
    """What is held to an answer.

    Attributes:
        title: in words.
        value: a formula of what was taken and of constants.
        answer: a number, or such a formula.
        tolerance: how far off the value may be: a number, or "2 %" of the answer.
        why: of the tolerance.
        missed: why it is known to be missed; empty where it is not.
    """

    title: Text
    value: Text
    answer: float | Text
    tolerance: float | Text
    why: Text
    missed: Text = ""

    @property
    def share(self) -> float | None:
        """The tolerance over the answer, if it is given so."""
        if isinstance(self.tolerance, str):
            return float(self.tolerance.removesuffix("%")) / 100.0
        return None

    @model_validator(mode="after")
    def _tolerance_can_be_read(self) -> Figure:
        try:
            good = self.share is None or (str(self.tolerance).endswith("%") and self.share > 0.0)
        except ValueError:
            good = False
        if not good:
            rule, remedy = "must be a number or a share of the answer", 'write 0.1 or "2 %"'
            raise violation(rule, remedy, value=self.tolerance, path=("tolerance",))
        return self


class Variant(CaseModel):
    """A further run.

    Attributes:
        set: keys of the case, such as "body.disc.velocity", with other values.
        constants: other constants.
    """

    set: Annotated[dict[str, Any], Field(default_factory=dict)]
    constants: Annotated[dict[str, float], Field(default_factory=dict)]


class Problem(CaseModel):
    """The file of a benchmark; see the module."""

    title: Text
    source: Text
    about: Text = ""
    constants: Annotated[dict[str, float], Field(default_factory=dict)]
    case: Annotated[dict[str, Any], Field()]
    take: Annotated[dict[str, Take], Field()]
    figure: list[Figure]
    variant: Annotated[dict[str, Variant], Field(default_factory=dict)]


@dataclass(frozen=True)
class Benchmark:
    """A benchmark with its name.

    Attributes:
        name: of its file.
        problem: what the file has.
    """

    name: str
    problem: Problem = field(repr=False)

    @classmethod
    def read(cls, path: Path) -> Benchmark:
        """Return the benchmark of a file.

        Raises:
            CaseError: the file cannot be read, or what in it is wrong.
        """
        text = case_file.read_text(path)
        found = cls(path.stem, Problem(**case_file.parse(text, str(path))))
        for variant in found.variants:
            found.case(variant)
            known = found.constants(variant) | dict.fromkeys(found.problem.take, 1.0)
            for one in found.problem.figure:
                for text in (one.value, str(one.answer)):
                    value_of(text, known)
        return found

    @cached_property
    def variants(self) -> tuple[str, ...]:
        """The names of its runs, "" if there is one."""
        return tuple(self.problem.variant) or ("",)

    def constants(self, variant: str) -> dict[str, float]:
        """Return the constants of a run."""
        own = self.problem.variant[variant].constants if variant else {}
        return {**self.problem.constants, **own}

    def case(self, variant: str) -> Case:
        """Return the case of a run.

        Raises:
            CaseError: what in it is wrong.
        """
        tables = copy.deepcopy(self.problem.case)
        for key, value in (self.problem.variant[variant].set if variant else {}).items():
            *above, last = key.split(".")
            table = tables
            for word in above:
                table = table.setdefault(word, {})
            table[last] = value
        return Case.from_tables(tables, f"{self.name}.toml", {})


def value_of(text: str, numbers: Mapping[str, float]) -> float:
    """Return what a formula of numbers comes to; NaN where one of these is.

    Raises:
        CaseError: it is no formula of them.
    """
    try:
        tree = _Numbers(numbers).visit(ast.parse(text.replace("^", "**"), mode="eval"))
        found = Expression.parse({"expression": ast.unparse(tree)}, "", ())
    except (SyntaxError, ValueError, RecursionError) as error:
        raise CaseError(f"is no formula of {', '.join(numbers)}: {error}", value=text) from None
    if not all(math.isfinite(number) for number in numbers.values()):
        return math.nan
    return float(found.at({"x": [0.0]})[0])


class _Numbers(ast.NodeTransformer):
    """Puts numbers in the place of names."""

    def __init__(self, numbers: Mapping[str, float]) -> None:
        self._numbers = numbers

    def visit_Name(self, node: ast.Name) -> ast.expr:
        if node.id not in self._numbers:
            return node
        number = self._numbers[node.id]
        size = ast.Constant(abs(number) if math.isfinite(number) else 1.0)
        return ast.UnaryOp(ast.USub(), size) if number < 0.0 else size


def names() -> list[str]:
    """Return the names of all benchmarks."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def benchmarks(wanted: list[str]) -> Iterator[Benchmark]:
    """Yield the benchmarks that are named, or all.

    Raises:
        CaseError: there is none of a name.
    """
    known = names()
    for name in wanted:
        if name not in known:
            raise CaseError("is no benchmark", nearest(name, known), value=name)
    for name in wanted or known:
        yield Benchmark.read(FOLDER / f"{name}.toml")
