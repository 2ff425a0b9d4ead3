# SPDX-License-Identifier: BSD-3-Clause
"""Quantities that depend on time: a number, a table, a sine or a ramp, with units.

>>> load = TimeFunction.parse({"ramp": {"from": 0, "to": "5 m/s", "end": "1 ms"}}, "m/s")
>>> load.at(0.0005)
2.5
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np

from .errors import CaseError, Path, nearest, violation
from .units import Quantity, Vector, to_si

FORMS = ("times", "sine", "ramp")
_EXAMPLE = '{ times = ["0 s", "1 ms"], values = [...] }'


@dataclass(frozen=True)
class TimeFunction:
    """A quantity as a function of time, in SI units.

    It is mean + table(t) + amplitude sin(2 pi frequency t + phase). The table is linear between
    its times and held before the first and after the last.

    Attributes:
        times: of the table [s], increasing; empty for none.
        values: of the table, as many as times.
        amplitude, frequency, phase, mean: of the sine; frequency [Hz], phase [rad].
        written: the table of a case file that says the same, in SI units.
    """

    written: dict[str, Any]
    times: tuple[float, ...] = ()
    values: tuple[float, ...] = ()
    amplitude: float = 0.0
    frequency: float = 0.0
    phase: float = 0.0
    mean: float = 0.0

    @classmethod
    def parse(cls, value: Any, unit: str) -> float | TimeFunction:
        """Return what a case file gives for a quantity that may depend on time.

        Args:
            value: a quantity, or a table of one of three forms:
                `{ times = [...], values = [...] }`,
                `{ sine = { amplitude, frequency or period, phase, mean } }` or
                `{ ramp = { from, to, start, end } }`.
            unit: SI unit of the quantity.

        Returns:
            A number for a constant.

        Raises:
            PydanticCustomError: the violation, with its path below the quantity.
        """
        if isinstance(value, TimeFunction):
            return value
        if not isinstance(value, dict):
            return _number(value, unit, ())
        known = ("times", "values") if "times" in value or "values" in value else FORMS
        for key in value:
            if key not in known:
                raise violation("is not a known key", nearest(str(key), known), path=(str(key),))
        if len(value) != (2 if known != FORMS else 1):
            rule = "must have times and values, or one of sine and ramp"
            raise violation(rule, f"for example {_EXAMPLE}")
        if known != FORMS:
            return _table(value, unit)
        [(form, given)] = value.items()
        if not isinstance(given, dict):
            raise violation(
                "must be a table", f"write {form} = {{ ... }}", value=given, path=(form,)
            )
        return _sine(given, unit) if form == "sine" else _ramp(given, unit)

    def at(self, time: float) -> float:
        """Return the value at a time [s]."""
        table = float(np.interp(time, self.times, self.values)) if self.times else 0.0
        return (
            self.mean
            + table
            + self.amplitude * math.sin(2 * math.pi * self.frequency * time + self.phase)
        )

    def bound(self) -> float:
        """Return a number that the absolute value never exceeds."""
        return abs(self.mean) + abs(self.amplitude) + max(map(abs, self.values), default=0.0)

    def lowest(self) -> float:
        """Return a number that it never falls below; of a sine beside a table not the closest."""
        return self.mean + min(self.values, default=0.0) - abs(self.amplitude)

    def highest(self) -> float:
        """Return a number that it never exceeds, likewise."""
        return self.mean + max(self.values, default=0.0) + abs(self.amplitude)

    def for_core(self) -> dict[str, Any]:
        """Return what the core's `TimeFunction` is made of."""
        return {
            "constant": self.mean,
            "amplitude": self.amplitude,
            "frequency": self.frequency,
            "phase": self.phase,
            "times": list(self.times),
            "values": list(self.values),
        }

    def table(self) -> dict[str, Any]:
        """Return the table of a case file, in SI units."""
        return self.written


def at(value: float | TimeFunction, time: float) -> float:
    """Return a number, or the value of a function at a time [s]."""
    return value.at(time) if isinstance(value, TimeFunction) else value


def bound(value: float | TimeFunction) -> float:
    """Return a number that the absolute value of a quantity never exceeds."""
    return value.bound() if isinstance(value, TimeFunction) else abs(value)


def lowest(value: float | TimeFunction) -> float:
    """Return a number that a quantity never falls below."""
    return value.lowest() if isinstance(value, TimeFunction) else value


def highest(value: float | TimeFunction) -> float:
    """Return a number that a quantity never exceeds."""
    return value.highest() if isinstance(value, TimeFunction) else value


def _number(value: Any, unit: str, path: Path) -> float:
    try:
        return to_si(value, unit)
    except CaseError as error:
        raise violation(error.rule, error.remedy, value=value, path=path) from None


def _table(value: dict[str, Any], unit: str) -> TimeFunction:
    lists: dict[str, tuple[float, ...]] = {}
    for key, each in (("times", "s"), ("values", unit)):
        items = value[key]
        if not isinstance(items, Sequence | np.ndarray) or isinstance(items, str) or not len(items):
            rule = "must be a list of at least one number"
            raise violation(rule, f"for example {_EXAMPLE}", value=items, path=(key,))
        lists[key] = tuple(_number(x, each, (key, k)) for k, x in enumerate(items))
    times, values = lists["times"], lists["values"]
    if len(times) != len(values):
        rule = f"must have as many numbers as times, {len(times)}"
        raise violation(rule, f"it has {len(values)}", value=list(values), path=("values",))
    for k in range(1, len(times)):
        if times[k] <= times[k - 1]:
            rule = f"must be > the time before it, {times[k - 1]:g} s"
            remedy = "give increasing times; a jump is two times close together"
            raise violation(rule, remedy, value=times[k], path=("times", k))
    written = {"times": list(times), "values": list(values)}
    return TimeFunction(written, times=times, values=values)


def _entries(
    given: dict[str, Any], form: str, units: dict[str, str], needed: Sequence[str]
) -> dict[str, float]:
    """Return the numbers of a table in SI units."""
    for key in given:
        if key not in units:
            remedy = nearest(str(key), units)
            raise violation("is not a known key", remedy, path=(form, str(key)))
    for key in needed:
        if key not in given:
            raise violation("is missing", "add this key", path=(form, key))
    return {key: _number(value, units[key], (form, key)) for key, value in given.items()}


def _sine(given: dict[str, Any], unit: str) -> TimeFunction:
    units = {"amplitude": unit, "frequency": "Hz", "period": "s", "phase": "rad", "mean": unit}
    found = _entries(given, "sine", units, ("amplitude",))
    if ("frequency" in found) == ("period" in found):
        rule = "must have either frequency or period"
        raise violation(rule, 'for example frequency = "50 Hz"', path=("sine",))
    key = "frequency" if "frequency" in found else "period"
    if found[key] <= 0.0:
        raise violation("must be > 0", "give a larger one", value=given[key], path=("sine", key))
    return TimeFunction(
        {"sine": found},
        amplitude=found["amplitude"],
        frequency=found["frequency"] if key == "frequency" else 1.0 / found["period"],
        phase=found.get("phase", 0.0),
        mean=found.get("mean", 0.0),
    )


def _ramp(given: dict[str, Any], unit: str) -> TimeFunction:
    units = {"from": unit, "to": unit, "start": "s", "end": "s"}
    found = {"from": 0.0, "start": 0.0} | _entries(given, "ramp", units, ("to", "end"))
    if found["end"] <= found["start"]:
        rule = f"must be > start = {found['start']:g} s"
        raise violation(rule, "give a later end", value=given["end"], path=("ramp", "end"))
    return TimeFunction(
        {"ramp": found},
        times=(found["start"], found["end"]),
        values=(found["from"], found["to"]),
    )


@dataclass(frozen=True)
class Timed:
    """Annotation of a model's field: a quantity that may depend on time."""

    unit: str

    def parse(self, value: Any) -> float | TimeFunction:
        """Return the number or the function, or raise the violation that pydantic collects."""
        return TimeFunction.parse(value, self.unit)

    def __get_pydantic_core_schema__(self, _source: Any, _handler: Any) -> Any:
        from pydantic_core import core_schema

        return core_schema.no_info_plain_validator_function(self.parse)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        form = Quantity(self.unit).__get_pydantic_json_schema__(None, None)
        text = f"{form['description']} or a function of time"
        return {"anyOf": [*form["anyOf"], {"type": "object"}], "description": text}


@dataclass(frozen=True)
class TimedVector(Vector):
    """Annotation of a field: two or three quantities that may depend on time, stored as a tuple."""

    things: ClassVar[str] = "numbers or functions of time"

    def item(self, value: Any) -> float | TimeFunction:
        """Return the number or the function, or raise the violation that pydantic collects."""
        return TimeFunction.parse(value, self.unit)

    def item_schema(self) -> dict[str, Any]:
        """Return the JSON schema of a component."""
        return Timed(self.unit).__get_pydantic_json_schema__(None, None)


TimedAcceleration = Annotated[tuple[float | TimeFunction, ...], TimedVector("m/s^2")]
TimedVelocity = Annotated[tuple[float | TimeFunction, ...], TimedVector("m/s")]
TimedSpin = Annotated[tuple[float | TimeFunction, ...], TimedVector("rad/s", scalar=True)]
