# SPDX-License-Identifier: BSD-3-Clause
"""The parameters of a model as a user gives them, checked."""

from __future__ import annotations

from typing import Any

from mpm3dpp.base.errors import MISSING, below, nearest, report, violation
from mpm3dpp.base.rules import Bounds
from mpm3dpp.base.units import Quantity

from .catalogue import catalogue
from .examples import example


def check_parameters(kind: str, model: str, given: Any) -> dict[str, float]:
    """Return all parameters of a model in SI units, defaults filled in.

    Args:
        kind: "strength", "eos" or "failure".
        model: name of a model of that kind.
        given: the user's table, parameter to value.

    Raises:
        PydanticCustomError: a violation, with its path below the model's table.
    """
    if not isinstance(given, dict):
        remedy = f"write {model} = {example(kind, model)}"
        raise violation("must be a table of parameters", remedy, value=given)
    known = {parameter.name: parameter for parameter in catalogue(kind)[model].parameters}
    mistakes: list[Exception] = []
    for name in given:
        if name not in known:
            rule = f"is not a parameter of {model}"
            mistakes.append(violation(rule, _remedy(kind, str(name), known), path=(str(name),)))
    found: dict[str, float] = {}
    for name, parameter in known.items():
        if name in given:
            unit = "" if parameter.unit == "1" else parameter.unit
            quantity = Quantity(unit, parameter.rule, Bounds(*parameter.bounds))
            try:
                found[name] = quantity.parse(given[name])
            except ValueError as error:
                mistakes += below(error, (name,), value=given[name])
        elif parameter.default is not None:
            found[name] = float(parameter.default)
        elif not mistakes:
            what = f"{parameter.meaning} [{parameter.unit or '1'}]"
            mistakes.append(violation(MISSING, f"add {name}, the {what}", path=(name,)))
    report(mistakes)
    return found


def _remedy(kind: str, name: str, known: dict[str, Any]) -> str:
    """Return what to do about a name that is no parameter: another model may have it."""
    others = [
        model
        for model, entry in catalogue(kind).items()
        if any(parameter.name == name for parameter in entry.parameters)
    ]
    if not others:
        return nearest(name, known)
    return f"it belongs to {', '.join(others)}; valid here: {', '.join(known)}"
