# SPDX-License-Identifier: BSD-3-Clause
"""Quantities with units: the only place where units are converted; everything inside is SI.

A quantity is a plain number in SI units or text such as `"30 mm"`. The commonest units are in a
table, so that pint (half a second to import) is loaded for the others only; a test holds the table
against pint. Numbers are converted in decimal arithmetic, so `"30 mm"`, `"3 cm"` and `0.03` are
the same float.
"""

from __future__ import annotations

import math
import numbers
import re
from dataclasses import dataclass
from decimal import Decimal
from functools import lru_cache
from typing import Annotated, Any, ClassVar

from .errors import NO_VALUE, CaseError, below, report, violation
from .rules import Bounds, holds, requirement, within

# What a quantity of an SI unit is called, and an example of it.
DIMENSIONS: dict[str, tuple[str, str]] = {
    "m": ("a length", '"30 mm"'),
    "s": ("a time", '"3.5 ms"'),
    "m/s": ("a velocity", '"30 m/s"'),
    "kg/m^3": ("a density", '"1000 kg/m^3"'),
    "Pa": ("a pressure", '"26 MPa"'),
    "m/s^2": ("an acceleration", '"-9.81 m/s^2"'),
    "rad/s": ("an angular velocity", '"10 rad/s"'),
    "rad": ("an angle", '"30 deg"'),
    "": ("a plain number", "0.3"),
    "kg": ("a mass", '"2 kg"'),
    "K": ("a temperature", '"293 K"'),
    "N": ("a force", '"5 N"'),
    "J": ("an energy", '"5 J"'),
    "Pa*s": ("a dynamic viscosity", '"1 mPa*s"'),
    "J/m^3": ("an energy per volume", '"7 GJ/m^3"'),
    "J/kg": ("a specific energy", '"5 kJ/kg"'),
    "J/kg/K": ("a specific heat", '"383 J/kg/K"'),
    "1/s": ("a rate", '"1 1/s"'),
    "Hz": ("a frequency", '"50 Hz"'),
    "m^2": ("an area", '"5 mm^2"'),
    "m^3": ("a volume", '"5 mm^3"'),
}

# Factor to SI and SI unit of the commonest units.
COMMON: dict[str, tuple[Decimal, str]] = {
    name: (Decimal(factor), unit)
    for unit, factors in {
        "m": {"m": "1", "cm": "1e-2", "mm": "1e-3", "um": "1e-6", "km": "1e3"},
        "s": {"s": "1", "ms": "1e-3", "us": "1e-6", "ns": "1e-9"},
        "m/s": {"m/s": "1", "mm/s": "1e-3", "cm/s": "1e-2", "km/s": "1e3", "mm/ms": "1"},
        "kg/m^3": {"kg/m^3": "1", "g/cm^3": "1e3", "kg/m3": "1"},
        "Pa": {"Pa": "1", "kPa": "1e3", "MPa": "1e6", "GPa": "1e9"},
        "m/s^2": {"m/s^2": "1", "mm/s^2": "1e-3"},
        "rad/s": {"rad/s": "1"},
        "rad": {"rad": "1"},
        "kg": {"kg": "1", "g": "1e-3"},
        "K": {"K": "1"},
        "Hz": {"Hz": "1", "kHz": "1e3"},
    }.items()
    for name, factor in factors.items()
}

# Sizes that no case needs; products of such numbers would overflow in double precision.
_LEAST = 1e-100

# Names of units: words, and powers of one or two digits. The rest pint works out, at any cost.
_UNIT = re.compile(
    r"1?(?:[\s*/()·.-]|[^\W\d]\d{0,2}(?!\d)"
    r"|(?:\^|\*\*)\s*\(?[+-]?\d{1,2}(?!\d)(?!\)?\s*(?:\^|\*\*)))*"
)
_POWER = re.compile(r"(?<=m)(?=[234]\b)")  # m3 is m^3, mm2 is mm^2.
_LONGEST = 200  # Characters of a quantity.

_NUMBER = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|[+-]?(?:nan|inf))(.*)", re.S)


def to_si(value: Any, unit: str) -> float:
    """Return a quantity in SI units.

    Args:
        value: a plain number (already SI), text such as `"30 mm"`, or a pint quantity.
        unit: the SI unit wanted, for example `m`, `kg/m^3`, or empty for a plain number.

    Returns:
        The finite number in `unit`.

    Raises:
        CaseError: the value is not a number, not finite, or of another dimension.
    """
    if isinstance(value, str):
        number = _from_text(value, unit)
    elif isinstance(value, numbers.Real) and not isinstance(value, bool):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    elif hasattr(value, "to_base_units"):
        number = _from_text(f"{value.magnitude:.17g} {value.units}", unit)
    else:
        raise CaseError(f"must be {_name(unit)}", _give(unit), value=value)
    if not math.isfinite(number):
        raise CaseError("must be finite", _give(unit), value=value)
    if number != 0 and not _LEAST < abs(number) < 1 / _LEAST:
        rule = f"must be zero or between {_LEAST:g} and {1 / _LEAST:g} in SI units"
        raise CaseError(rule, _give(unit), value=value)
    return number


@lru_cache(maxsize=4096)
def _from_text(text: str, unit: str) -> float:
    """Return the SI number of text such as `30 mm`."""
    match = _NUMBER.fullmatch(text) if len(text) <= _LONGEST else None
    if match is None:
        raise CaseError(f"must be {_name(unit)}", _give(unit), value=text)
    number, name = match.group(1), match.group(2).strip()
    if name.startswith("/"):  # "250/s", a number per second
        name = f"1{name}"
    if name == "" and unit != "":
        raise CaseError(f"has no unit but must be {_name(unit)}", _give(unit), value=text)
    if name == "":
        return float(number)
    try:
        if name in COMMON and COMMON[name][1] == unit:
            return float(Decimal(number) * COMMON[name][0])
        return _by_pint(text, number, name, unit)
    except ArithmeticError:  # An exponent of thousands of digits.
        return math.inf


@lru_cache(maxsize=1)
def registry() -> Any:
    """Return pint's registry, made at the first call (it takes half a second)."""
    import pint

    return pint.UnitRegistry(non_int_type=Decimal)


def _by_pint(text: str, number: str, name: str, unit: str) -> float:
    """Return the SI number as pint converts it."""
    import pint

    unknown, remedy = f'has the unit "{name}", which is not known', _give(unit)
    letters = [known for known, (_, of) in COMMON.items() if of == unit]
    if meant := next((known for known in letters if known.lower() == name.lower()), None):
        remedy = f'did you mean "{number} {meant}"? Capitals count; {remedy}'
    if _UNIT.fullmatch(name) is None:
        raise CaseError(unknown, remedy, value=text)
    try:
        given = registry().Quantity(Decimal(number), registry().parse_units(_POWER.sub("^", name)))
    except Exception as error:  # pint's parser raises many kinds for text that is no unit
        raise CaseError(unknown, remedy, value=text) from error
    if unit == "" and "radian" in str(
        given.to_base_units().units
    ):  # Which is a plain number to pint.
        rule = f'has the unit "{name}" ({_name("rad")}) but must be {_name(unit)}'
        raise CaseError(rule, _give(unit), value=text)
    try:
        return float(given.to(unit or "dimensionless").magnitude)
    except pint.DimensionalityError:
        what = next((f" ({_name(u)})" for u in DIMENSIONS if u and given.check(_dimension(u))), "")
        rule = f'has the unit "{name}"{what} but must be {_name(unit)}'
        raise CaseError(rule, _give(unit), value=text) from None


def _dimension(unit: str) -> Any:
    return registry().get_dimensionality(registry().parse_units(unit))


def _name(unit: str) -> str:
    return DIMENSIONS[unit][0] if unit in DIMENSIONS else f"a quantity in {unit}"


def _give(unit: str) -> str:
    if unit == "":
        return "give a number without a unit"
    if unit in DIMENSIONS:
        return f"give {_name(unit)} such as {DIMENSIONS[unit][1]}, or a plain number in {unit}"
    return f"give a number in {unit}"


@dataclass(frozen=True)
class Quantity:
    """Annotation of a model's field: a number in an SI unit under a rule such as `> 0`.

    Attributes:
        unit: SI unit of the stored number.
        rule: what the number must obey (see `rules.holds`); empty for no rule.
        bounds: the same as numbers, where the core gives them; the rule is then only for messages.
    """

    unit: str
    rule: str = ""
    bounds: Bounds | None = None

    def parse(self, value: Any) -> float:
        """Return the number in SI units, or raise the violation that pydantic collects."""
        try:
            number = to_si(value, self.unit)
        except CaseError as error:
            raise violation(error.rule, error.remedy, value=value) from None
        if not self._allows(number):
            raise violation(requirement(self.rule), self._obeying(), value=value)
        return number

    def _allows(self, number: float) -> bool:
        return holds(self.rule, number) if self.bounds is None else within(self.bounds, number)

    def _obeying(self) -> str:
        """Return the remedy for a number that breaks the rule."""
        if self.unit != "":
            return _give(self.unit)
        fits = next((n for n in (0.3, 2, -0.3) if self._allows(n)), None)
        return "give another number" + (f" such as {fits:g}" if fits is not None else "")

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        text = f"{_name(self.unit)} [{self.unit or '1'}] {self.rule}".strip()
        return {"anyOf": [{"type": "number"}, {"type": "string"}], "description": text}


@dataclass(frozen=True)
class Vector(Quantity):
    """Annotation of a model's field: two (2D) or three (3D) quantities, stored as a tuple.

    With `scalar`, one quantity alone is taken too, as a tuple of one.
    """

    scalar: bool = False

    things: ClassVar[str] = "numbers"

    def item(self, value: Any) -> Any:
        """Return a component in SI units, or raise the violation that pydantic collects."""
        try:
            return to_si(value, self.unit)
        except CaseError as error:
            shown = NO_VALUE if isinstance(value, dict) else value
            raise violation(error.rule, error.remedy, value=shown) from None

    def parse(self, value: Any) -> tuple[Any, ...]:  # type: ignore[override]
        """Return the components in SI units, or raise the violation that pydantic collects."""
        if isinstance(value, str | dict) or not hasattr(value, "__len__"):
            if self.scalar:
                return (self.item(value),)
            raise violation(
                f"must be a list of {self.things}", _give_vector(self.unit), value=value
            )
        if len(value) not in ((0, 1, 2, 3) if self.scalar else (2, 3)):
            rule = "must have two numbers in 2D and three in 3D"
            raise violation(rule, _give_vector(self.unit), value=value)
        return self.items(value)

    def items(self, value: Any) -> tuple[Any, ...]:
        """Return all components in SI units, or raise every violation in them."""
        found, mistakes = [], []
        for index, item in enumerate(value):
            try:
                found.append(self.item(item))
            except ValueError as error:
                mistakes += below(error, (index,))
        report(mistakes)
        return tuple(found)

    def item_schema(self) -> dict[str, Any]:
        """Return the JSON schema of a component."""
        return super().__get_pydantic_json_schema__(None, None)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        item = self.item_schema()
        vector = {"type": "array", "items": item, "minItems": 2, "maxItems": 3}
        return {"anyOf": [item, vector]} if self.scalar else vector


def _give_vector(unit: str) -> str:
    example = DIMENSIONS.get(unit, ("", "1.0"))[1]
    return f"give a list such as [0, {example}]"


Length = Annotated[float, Quantity("m")]
PositiveLength = Annotated[float, Quantity("m", "> 0")]
Time = Annotated[float, Quantity("s", "> 0")]
Velocity = Annotated[float, Quantity("m/s")]
Density = Annotated[float, Quantity("kg/m^3", "> 0")]
Pressure = Annotated[float, Quantity("Pa")]
Acceleration = Annotated[float, Quantity("m/s^2")]
AngularVelocity = Annotated[float, Quantity("rad/s")]
Angle = Annotated[float, Quantity("rad")]
Number = Annotated[float, Quantity("")]
NonNegative = Annotated[float, Quantity("", ">= 0")]
Point = Annotated[tuple[float, ...], Vector("m")]
AccelerationVector = Annotated[tuple[float, ...], Vector("m/s^2")]
Direction = Annotated[tuple[float, ...], Vector("")]
