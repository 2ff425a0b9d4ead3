# SPDX-License-Identifier: BSD-3-Clause
"""Material models: the catalogue of the core is the schema; nothing is listed here again."""

from __future__ import annotations

import importlib
from functools import lru_cache
from typing import Annotated, Any

from pydantic import BeforeValidator, SkipValidation, WithJsonSchema, model_validator

from .errors import CaseError, Path, nearest, violation
from .model import CaseModel
from .rules import requirement
from .units import DIMENSIONS, Quantity


@lru_cache(maxsize=1)
def catalogue() -> dict[str, Any]:
    """Return the strength models that the core knows, by name.

    Each has `name`, `doc`, `source`, `parameters` (each with `name`, `unit`, `meaning`, `default`
    or None, `rule`) and `state` (names of the columns that the model stores).
    """
    core = importlib.import_module("mpm3dpp._core")
    return {model.name: model for model in core.catalogue() if model.kind == "strength"}


def state_columns(models: set[str]) -> list[str]:
    """Return the names of the state columns that these models store, in the catalogue's order."""
    names = [s for name, model in catalogue().items() if name in models for s in model.state]
    return list(dict.fromkeys(names))


def check_parameters(model: str, given: Any) -> dict[str, float]:
    """Return all parameters of a model in SI units, defaults filled in.

    Args:
        model: name of a strength model.
        given: the user's table, parameter to value.

    Raises:
        PydanticCustomError: a violation, with its path below the model's table.
    """
    if not isinstance(given, dict):
        remedy = f"write {model} = {{ {_example(model)} }}"
        raise violation("must be a table of parameters", remedy, value=given)
    known = {parameter.name: parameter for parameter in catalogue()[model].parameters}
    for name in given:
        if name not in known:
            rule = f"is not a parameter of {model}"
            raise violation(rule, nearest(str(name), known), path=(str(name),))
    found: dict[str, float] = {}
    for name, parameter in known.items():
        if name in given:
            quantity = Quantity("" if parameter.unit == "1" else parameter.unit, parameter.rule)
            found[name] = _parsed(quantity, given[name], name)
        elif parameter.default is not None:
            found[name] = float(parameter.default)
        else:
            what = f"{parameter.meaning} [{parameter.unit or '1'}]"
            raise violation("is missing", f"add {name}, the {what}", path=(name,))
    return found


def _parsed(quantity: Quantity, value: Any, name: str) -> float:
    from pydantic_core import PydanticCustomError

    try:
        return quantity.parse(value)
    except PydanticCustomError as error:
        context = error.context or {}
        raise violation(context["rule"], context["remedy"], value=value, path=(name,)) from None


def _example(model: str) -> str:
    """Return a model's parameters with an example of each: `E = "26 MPa", nu = 0.3`."""
    return ", ".join(
        f"{p.name} = {DIMENSIONS.get(p.unit, ('', '1.0'))[1]}"
        for p in catalogue()[model].parameters
    )


class Strength(CaseModel):
    """A strength model with its parameters.

    Attributes:
        model: its name in the catalogue, for example "neo_hookean" (`mpm3dpp materials` lists it).
        parameters: all of its parameters, SI units.
    """

    model: str
    parameters: dict[str, SkipValidation[float]]

    @model_validator(mode="after")
    def _from_catalogue(self) -> Strength:
        if self.model not in catalogue():
            remedy = nearest(self.model, catalogue())
            raise violation("is not a known strength model", remedy, value=self.model)
        self.__dict__["parameters"] = check_parameters(self.model, self.parameters)
        return self

    def table(self) -> dict[str, Any]:
        """Return `{"neo_hookean": {"K": ..., "G": ...}}`, in SI units."""
        return {self.model: dict(self.parameters)}


def parse_strength(value: Any) -> Strength:
    """Return the strength model of a table such as `{"elastic": {"E": "1 GPa", "nu": 0.3}}`."""
    if isinstance(value, Strength):
        return value
    names = ", ".join(catalogue())
    if not isinstance(value, dict) or len(value) != 1:
        has = f" but has {len(value)}" if isinstance(value, dict) else ""
        model = next(iter(catalogue()))
        remedy = f"write {{ {model} = {{ {_example(model)} }} }}; the models are {names}"
        raise violation(f"must be a table with exactly one model{has}", remedy, value=value)
    [(model, given)] = value.items()
    if model not in catalogue():
        remedy = nearest(str(model), catalogue())
        raise violation("is not a known strength model", remedy, path=(str(model),))
    from pydantic_core import PydanticCustomError

    try:
        return Strength.model_construct(model=model, parameters=check_parameters(model, given))
    except PydanticCustomError as error:
        found: Any = error.context
        path: Path = (model, *found["path"])
        raise violation(found["rule"], found["remedy"], value=found["value"], path=path) from None


AnyStrength = Annotated[
    SkipValidation[Strength],
    BeforeValidator(parse_strength),
    WithJsonSchema({"type": "object", "minProperties": 1, "maxProperties": 1}),
]


def listing(name: str | None = None) -> str:
    """Return the catalogue as text: every model, or one, with parameters, units and source.

    Args:
        name: a model; None for all of them.

    Raises:
        CaseError: there is no such model.
    """
    if name is not None and name not in catalogue():
        raise CaseError("is not a known strength model", nearest(name, catalogue()), value=name)
    blocks = [_entry(model) for key, model in catalogue().items() if name in (None, key)]
    return "\n\n".join(blocks)


def _entry(model: Any) -> str:
    lines = [f"{model.name} (strength): {model.doc}", f"  source: {model.source}", "  parameters:"]
    wide = max([len(p.name) for p in model.parameters], default=0)
    for p in model.parameters:
        rule = f", {requirement(p.rule)}" if p.rule else ""
        default = "" if p.default is None else f", default {p.default:g}"
        lines.append(f"    {p.name:<{wide}}  [{p.unit or '1'}] {p.meaning}{rule}{default}")
    if model.state:
        lines.append(f"  stores {', '.join(model.state)} (for output.fields)")
    lines.append(f"  case file: strength = {{ {model.name} = {{ {_example(model.name)} }} }}")
    return "\n".join(lines)
