# SPDX-License-Identifier: BSD-3-Clause
"""Quantities that are formulas of place and time, with units; the core evaluates them.

>>> Expression.parse({"expression": "2 * x^2"}, "m/s", ("x", "y")).at({"x": [0.0, 3.0]})
array([ 0., 18.])

The text is parsed by Python's own parser and translated into a program for the core; only what is
listed here and in the core's `operations` is taken, and nothing is ever executed by Python.
"""

from __future__ import annotations

import ast
import math
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp import _core

from .errors import CaseError, nearest, show, violation
from .units import Quantity, Vector, to_si

Array = NDArray[np.float64]
Program = tuple[tuple[str, float], ...]

CONSTANTS = {"pi": math.pi, "e": math.e}
_OPERATORS: dict[type, str] = {
    ast.Add: "add",
    ast.Sub: "subtract",
    ast.Mult: "multiply",
    ast.Div: "divide",
    ast.Pow: "pow",
}
_OPERANDS: dict[str, int] = _core.operations
FUNCTIONS = [name for name in _OPERANDS if name not in {*_OPERATORS.values(), "negate"} - {"pow"}]
"""What a formula may call."""
_LENGTHS = ("x", "y", "z", "r", "X", "Y", "Z")
_LONGEST = 1000  # Characters of a formula.
_KEYS = ("expression", "unit", "length")
_EXAMPLE = '{ expression = "0.1 * sin(pi * x)" }'


class _Refused(Exception):
    """Rule and remedy for what is no formula."""


@dataclass(frozen=True)
class Expression:
    """A quantity as a formula of place and time.

    Attributes:
        text: the formula.
        unit: of its value.
        length: unit of the lengths in it.
        program: the same for the core, in SI units: instructions in postfix order.
        variables: of which it is a formula.
        written: the table of a case file.
    """

    text: str
    unit: str
    length: str
    program: Program
    variables: frozenset[str]
    written: dict[str, str]

    @classmethod
    def parse(cls, value: Any, unit: str, variables: tuple[str, ...]) -> Expression:
        """Return what a case file gives as a formula.

        Args:
            value: a table `{ expression = "...", unit = "...", length = "..." }`; the units may
                be left out: they are SI then.
            unit: SI unit of the quantity.
            variables: that it may be a formula of.

        Raises:
            PydanticCustomError: the violation, with its path below the quantity.
        """
        if isinstance(value, Expression):
            return value
        for key in value:
            if key not in _KEYS:
                raise violation("is not a known key", nearest(str(key), _KEYS), path=(str(key),))
        if "expression" not in value:
            raise violation("is missing", f"for example {_EXAMPLE}", path=("expression",))
        units = {"unit": unit, "length": "m"}
        factors = {key: _factor(value.get(key, si), key, si) for key, si in units.items()}
        given = value["expression"]
        try:
            program = _translated(given, variables, factors["length"])
        except _Refused as refused:
            rule, remedy = refused.args
            raise violation(rule, remedy, value=given, path=("expression",)) from None
        if factors["unit"] != 1.0:
            program += (("number", factors["unit"]), ("multiply", 0.0))
        written = {"expression": "".join(given.split())}
        written |= {key: value[key] for key in units if factors[key] != 1.0}
        names = frozenset(word for word, _ in program if word in variables)
        return cls(
            written["expression"],
            value.get("unit", unit),
            value.get("length", "m"),
            program,
            names,
            written,
        )

    def at(self, places: Mapping[str, Any]) -> Array:
        """Return the values in SI units, shape (n,).

        Args:
            places: the numbers of each variable [SI], shape (n,), of those that it needs or more.
        """
        rows = np.array([places[name] for name in places], dtype=float)
        return np.asarray(_core.evaluate(list(self.program), list(places), rows))[:, 0]

    @property
    def is_of_start(self) -> bool:
        """Whether it is a formula of the place at the start."""
        return bool(self.variables & {"X", "Y", "Z"})

    def table(self) -> dict[str, str]:
        """Return the table of a case file."""
        return self.written


def program_of(value: float | Expression) -> list[tuple[str, float]]:
    """Return a number or a formula as a program for the core."""
    return list(value.program) if isinstance(value, Expression) else [("number", float(value))]


def _factor(unit: Any, key: str, si: str) -> float:
    """Return how many SI units a unit is."""
    what = 'a unit of length such as "mm"' if key == "length" else f"a unit of {si}"
    if not isinstance(unit, str):
        raise violation("must be text", f"give {what}", value=unit, path=(key,))
    try:
        return to_si(f"1 {unit}", si)
    except CaseError:
        rule = "is no unit of length" if key == "length" else f"is no unit that fits {si}"
        raise violation(rule, f"give {what}", value=unit, path=(key,)) from None


def _translated(text: Any, variables: tuple[str, ...], length: float) -> Program:
    """Return the program of a formula.

    Args:
        text: the formula.
        variables: that it may be of.
        length: the unit of lengths in it [m].
    """
    if not isinstance(text, str) or not text.strip():
        raise _Refused("must be a formula", f"for example {_EXAMPLE}")
    if len(text) > _LONGEST:
        rule = f"has {len(text):,} characters, and {_LONGEST:,} is the most that is read"
        raise _Refused(rule, "write a shorter formula")
    source = " ".join(text.split()).replace("^", "**")
    try:
        if "#" in source:
            raise SyntaxError("a comment")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            tree = ast.parse(source, mode="eval")
        program = tuple(_instructions(tree.body, variables, length))
        _core.evaluate(list(program), [], np.zeros((0, 0)))
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        reason = str(error) if isinstance(error, ValueError) else ""
        if "deep" in reason or isinstance(error, RecursionError | MemoryError):
            raise _Refused("is nested too deeply", "write a simpler formula") from None
        raise _Refused("is not a formula that can be read", f"for example {_EXAMPLE}") from None
    return program


def _instructions(
    node: ast.expr, variables: tuple[str, ...], length: float
) -> Iterator[tuple[str, float]]:
    """Yield the program of a part of a formula: its operands, then what is done with them."""
    if isinstance(node, ast.Constant):
        yield "number", _number(node.value)
    elif isinstance(node, ast.Name):
        yield from _named(node.id, variables, length)
    elif isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        yield from _instructions(node.left, variables, length)
        yield from _instructions(node.right, variables, length)
        yield _OPERATORS[type(node.op)], 0.0
    elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub | ast.UAdd):
        yield from _instructions(node.operand, variables, length)
        if isinstance(node.op, ast.USub):
            yield "negate", 0.0
    elif isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        yield from _called(node.func.id, node.args, variables, length)
    else:
        rule = "has something that is neither a number nor a name, an operator or a function"
        raise _Refused(rule, f"valid here: + - * / ^ ( ), {', '.join(FUNCTIONS)}")


def _number(value: Any) -> float:
    try:
        number = float(value) if type(value) in (int, float) else math.nan
    except OverflowError:
        number = math.inf
    if not math.isfinite(number):
        raise _Refused(f"has {show(str(value))}, which is no finite number", "write another number")
    return number


def _named(name: str, variables: tuple[str, ...], length: float) -> Iterator[tuple[str, float]]:
    if name in CONSTANTS:
        yield "number", CONSTANTS[name]
        return
    if name not in variables:
        rule = f"has the name {show(name)}, which is not known"
        raise _Refused(rule, nearest(name, [*variables, *CONSTANTS]))
    yield name, 0.0
    if name in _LENGTHS and length != 1.0:
        yield "number", length
        yield "divide", 0.0


def _called(
    name: str, given: list[ast.expr], variables: tuple[str, ...], length: float
) -> Iterator[tuple[str, float]]:
    if name not in FUNCTIONS:
        raise _Refused(
            f"has the function {show(name)}, which is not known", nearest(name, FUNCTIONS)
        )
    wanted = _OPERANDS[name]
    if len(given) != wanted and not (name in ("min", "max") and len(given) > wanted):
        rule = f"gives {name} {len(given)} numbers, and it takes {wanted}"
        raise _Refused(rule, f"write {name}({', '.join(['x', '2'][:wanted])})")
    for index, node in enumerate(given):
        yield from _instructions(node, variables, length)
        if index >= wanted - 1:
            yield name, 0.0


@dataclass(frozen=True)
class Field(Vector):
    """Annotation of a model's field: two or three quantities, each a number or a formula."""

    variables: tuple[str, ...] = ()

    def item(self, value: Any) -> float | Expression:
        """Return the number or the formula, or raise the violation that pydantic collects."""
        if isinstance(value, dict | Expression):
            return Expression.parse(value, self.unit, self.variables)
        return float(super().item(value))

    def item_schema(self) -> dict[str, Any]:
        """Return the JSON schema of a component."""
        form = Quantity(self.unit).__get_pydantic_json_schema__(None, None)
        text = f"{form['description']} or a formula of {', '.join(self.variables)}"
        return {"anyOf": [*form["anyOf"], {"type": "object"}], "description": text}


AT_START = ("x", "y", "z", "r")
"""Variables of a formula of the place at the start: r is the distance from the mass centre."""
VelocityField = Annotated[tuple[float | Expression, ...], Field("m/s", variables=AT_START)]
ForceField = Annotated[
    tuple[float | Expression, ...],
    Field("m/s^2", variables=("x", "y", "z", "X", "Y", "Z", "t")),
]
TotalForce = Annotated[tuple[float | Expression, ...], Field("N", variables=("t",))]
SpinField = Annotated[
    tuple[float | Expression, ...], Field("rad/s", scalar=True, variables=AT_START)
]
