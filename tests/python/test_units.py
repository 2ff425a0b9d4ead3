# SPDX-License-Identifier: BSD-3-Clause
"""Units: the fast table says what pint says, and conversion does not depend on the spelling."""

from __future__ import annotations

import math

import pytest
from pydantic import TypeAdapter

from mpm3dpp import _core
from mpm3dpp.base import units
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.expression import SpinField
from mpm3dpp.base.rules import Bounds, holds, requirement, within


@pytest.mark.parametrize("name", units.COMMON)
def test_table_agrees_with_pint(name: str) -> None:
    factor, unit = units.COMMON[name]
    # Both are decimal arithmetic, rounded once: the floats are equal, not only close.
    assert units._by_pint(f"1 {name}", "1", name, unit) == float(factor)


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("30 mm", "m", 0.03),
        ("3 cm", "m", 0.03),
        ("30mm", "m", 0.03),
        ("1/s", "1/s", 1.0),
        ("250 /s", "1/s", 250.0),
        ("1/ms", "1/s", 1000.0),
        ("0.9 mm", "m", 0.0009),  # 0.9 * 0.001 in floating point is another number.
        ("1.7 us", "s", 1.7e-6),
        ("3e-2 m", "m", 0.03),
        ("1 inch", "m", 0.0254),
        ("0.1 ms", "s", 1e-4),
        ("36 km/h", "m/s", 10.0),
        ("1.01 g/cm^3", "kg/m^3", 1010.0),
        ("1010 kg/m3", "kg/m^3", 1010.0),
        ("1010 kg m^-3", "kg/m^3", 1010.0),
        ("121.7 MPa", "Pa", 121.7e6),
        ("26.1 N/mm^2", "Pa", 26.1e6),
        ("-9.81 m/s^2", "m/s^2", -9.81),
        ("20 degC", "K", 293.15),
        ("0.3", "", 0.3),
        (7, "m", 7.0),
    ],
)
def test_values(text: object, unit: str, value: float) -> None:
    assert units.to_si(text, unit) == value


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [("180 deg", "rad", math.pi), ("60 rpm", "rad/s", 2 * math.pi), ("30 percent", "", 0.3)],
)
def test_values_with_irrational_factors(text: str, unit: str, value: float) -> None:
    assert units.to_si(text, unit) == pytest.approx(value, rel=4e-16)  # two roundings


@pytest.mark.parametrize("value", ["5 kg", "5", "five mm", "5 mm mm mm", "", "1,5 mm", "5 )", None])
def test_lengths_that_are_none(value: object) -> None:
    with pytest.raises(CaseError, match="length"):
        units.to_si(value, "m")


@pytest.mark.parametrize("value", ["nan m", "inf m", float("nan"), float("-inf"), "1e999 m"])
def test_not_finite(value: object) -> None:
    with pytest.raises(CaseError, match="must be finite"):
        units.to_si(value, "m")


def test_pint_quantity() -> None:
    assert units.to_si(units.registry().Quantity(30, "mm"), "m") == 0.03


def test_annotated_types_check_and_convert() -> None:
    assert TypeAdapter(units.Length).validate_python("30 mm") == 0.03
    assert TypeAdapter(units.Point).validate_python(["30 mm", 0.1]) == (0.03, 0.1)
    assert TypeAdapter(SpinField).validate_python("2 rad/s") == (2.0,)
    with pytest.raises(ValueError, match="must be > 0"):
        TypeAdapter(units.Density).validate_python("-1 kg/m^3")


@pytest.mark.parametrize(
    ("rule", "good", "bad"),
    [
        ("> 0", 1e-300, 0.0),
        (">= 0", 0.0, -1e-300),
        ("0 < f <= 1", 1.0, 0.0),
        ("-1 < nu < 0.5", 0.0, 0.5),
        (">= 0 and < 2", 0.0, 2.0),
    ],
)
def test_rules(rule: str, good: float, bad: float) -> None:
    assert holds(rule, good)
    assert not holds(rule, bad)
    assert requirement(rule).startswith("must ")


def test_a_rule_that_nobody_understands_is_no_rule() -> None:
    with pytest.raises(ValueError, match="no rule on a number"):
        holds("must be a finite number", -3.0)


def test_bounds_of_the_catalogue_say_what_its_rules_say() -> None:
    """The core gives each rule in words and as bounds; a value on a bound is in it if closed."""
    every = [p for model in _core.catalogue() for p in model.parameters]
    words = {p.rule: Bounds(*p.bounds) for p in every}
    assert {"must be > 0", "must be >= 0", "must lie between -1 and 0.5, both excluded"} <= set(
        words
    )
    for rule, bounds in words.items():
        middle = max(bounds.lower, -1.0) + 0.25
        assert within(bounds, middle), rule
        for edge, is_open, out in (
            (bounds.lower, bounds.lower_open, -math.inf),
            (bounds.upper, bounds.upper_open, math.inf),
        ):
            assert within(bounds, edge) is not is_open, rule
            assert math.isinf(edge) or not within(bounds, math.nextafter(edge, out)), rule
            named = math.isinf(edge) or f"{edge:g}" in rule
            assert named, rule
    poisson = words["must lie between -1 and 0.5, both excluded"]
    assert (poisson.lower, poisson.upper) == (-1.0, 0.5)
    assert words["must be >= 0"].lower_open is False
