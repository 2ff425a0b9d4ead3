# SPDX-License-Identifier: BSD-3-Clause
"""Material models: the catalogue of the core is the schema; nothing is listed here again."""

from __future__ import annotations

import importlib
from functools import lru_cache
from typing import Any

from mpm3dpp.base.errors import MISSING, below, nearest, report, violation
from mpm3dpp.base.rules import Bounds
from mpm3dpp.base.units import Quantity

KINDS = {
    "strength": "strength model",
    "eos": "equation of state",
    "failure": "failure model",
}
"""Kinds of models, as the key of a material, and in words."""


@lru_cache(maxsize=len(KINDS))
def catalogue(kind: str = "strength") -> dict[str, Any]:
    """Return the models of a kind that the core knows, by name.

    Each has `name`, `doc`, `source`, `parameters` (each with `name`, `unit`, `meaning`, `default`
    or None, `rule` in words, `bounds`) and `state` (the columns that the model stores, each with
    `name` and `unit`); a strength model also has `eos`, whether it "never", "may" or "must" have an
    equation of state.
    """
    core = importlib.import_module("mpm3dpp._core")
    return {model.name: model for model in core.catalogue() if model.kind == kind}


def state_columns(models: set[str]) -> list[str]:
    """Return the names of the state columns that these models store, in the catalogue's order."""
    every = [item for kind in KINDS for item in catalogue(kind).items()]
    names = [s.name for name, model in every if name in models for s in model.state]
    return list(dict.fromkeys(names))


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
        from .examples import example

        remedy = f"write {model} = {example(kind, model)}"
        raise violation("must be a table of parameters", remedy, value=given)
    known = {parameter.name: parameter for parameter in catalogue(kind)[model].parameters}
    mistakes: list[Exception] = []
    for name in given:
        if name not in known:
            rule, remedy = f"is not a parameter of {model}", nearest(str(name), known)
            mistakes.append(violation(rule, remedy, path=(str(name),)))
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
