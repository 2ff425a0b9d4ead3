# SPDX-License-Identifier: BSD-3-Clause
"""The models of a material as a case holds them: strength, equation of state, failure."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar, cast

from pydantic import BeforeValidator, SkipValidation, WithJsonSchema, model_validator

from mpm3dpp import _core
from mpm3dpp.base.errors import below, nearest, report, violation
from mpm3dpp.base.model import CaseModel, Choice

from .catalogue import KINDS, catalogue
from .examples import example
from .html import model_html
from .parameters import check_parameters

ACTIONS: dict[str, str] = _core.failure_actions[0]
"""What failure may do to a particle, `action` in a failure model's table."""

_OTHER_NAMES = {
    **dict.fromkeys(("newtonian", "viscous", "liquid", "water", "gas", "null"), "fluid"),
    **dict.fromkeys(("hyperelastic", "rubber", "mooney_rivlin"), "neo_hookean"),
    **dict.fromkeys(("plastic", "elastoplastic", "elastic_plastic", "von_mises"), "j2"),
    **dict.fromkeys(("hooke", "linear_elastic"), "elastic"),
    "gruneisen": "mie_gruneisen",
}
"""Names that other programs and books have for models."""


class ChosenModel(CaseModel):
    """A model of the catalogue with its parameters.

    Attributes:
        model: its name, for example "neo_hookean" (`mpm3dpp materials` lists them).
        parameters: all of its parameters, SI units.
    """

    kind: ClassVar[str] = "strength"
    model: str
    parameters: dict[str, SkipValidation[float]]

    @model_validator(mode="after")
    def _from_catalogue(self) -> ChosenModel:
        if self.model not in catalogue(self.kind):
            remedy = nearest(self.model, catalogue(self.kind))
            raise violation(f"is not a known {KINDS[self.kind]}", remedy, value=self.model)
        self.__dict__["parameters"] = check_parameters(self.kind, self.model, self.parameters)
        return self

    def table(self) -> dict[str, Any]:
        """Return `{"neo_hookean": {"K": ..., "G": ...}}`, in SI units."""
        return {self.model: dict(self.parameters)}

    def _repr_html_(self) -> str:
        """What a notebook shows: the parameters with their units and meanings."""
        action = getattr(self, "action", "")
        notes = f", {action}" if action else ""
        return model_html(self.kind, self.model, self.parameters, notes)


class Strength(ChosenModel):
    """A strength model with its parameters; `Strength(model="elastic", parameters={...})`."""


class Eos(ChosenModel):
    """An equation of state with its parameters, which gives the pressure."""

    kind: ClassVar[str] = "eos"


class Failure(ChosenModel):
    """A failure model with its parameters.

    Attributes:
        action: what becomes of a particle that fails: "no_tension" (the default; it bears
            compression only), "no_shear" (it keeps its whole pressure, like a liquid) or "erode"
            (it takes no part any more; the ledger keeps its energy in `eroded`).
    """

    kind: ClassVar[str] = "failure"
    action: Annotated[str, Choice(tuple(ACTIONS))] = "no_tension"

    def table(self) -> dict[str, Any]:
        """Return `{"plastic_strain": {"limit": ..., "action": ...}}`, in SI units."""
        return {self.model: {**self.parameters, "action": self.action}}


def _chosen(kind: type[ChosenModel], model: Any, given: Any) -> ChosenModel:
    """Return the model of `{model: given}`; violations have their path from there."""
    word, known = kind.kind, catalogue(kind.kind)
    if model not in known:
        rule = f"is not a known {KINDS[word]}"
        own = _OTHER_NAMES.get(str(model).lower(), "")
        remedy = nearest(own if own in known else str(model), known)
        raise violation(rule, remedy, path=(str(model),))
    mistakes: list[Exception] = []
    extra: dict[str, Any] = {}
    if kind is Failure and isinstance(given, dict) and "action" in given:
        try:
            extra = {"action": Choice(tuple(ACTIONS)).parse(given["action"])}
        except ValueError as error:
            mistakes += below(error, (model, "action"), value=given["action"])
        given = {key: value for key, value in given.items() if key != "action"}
    try:
        parameters = check_parameters(word, model, given)
    except ValueError as error:
        mistakes += below(error, (model,))
    report(mistakes)
    return kind.model_construct(model=model, parameters=parameters, **extra)


def _parse_one(kind: type[ChosenModel]) -> Any:
    def parse(value: Any) -> ChosenModel | None:
        """Return the model of a table such as `{"elastic": {"E": "1 GPa", "nu": 0.3}}`."""
        if value is None or isinstance(value, kind):
            return value
        names = ", ".join(catalogue(kind.kind))
        if not isinstance(value, dict) or len(value) != 1:
            has = f" but has {len(value)}" if isinstance(value, dict) else ""
            model = next(iter(catalogue(kind.kind)))
            remedy = f"write {{ {model} = {example(kind.kind, model)} }}; the models are {names}"
            if has and len(value) > 1 and set(value) <= set(catalogue(kind.kind)):
                remedy = f"keep {' or '.join(value)}"
            raise violation(f"must be a table with exactly one model{has}", remedy, value=value)
        [(model, given)] = value.items()
        return _chosen(kind, model, given)

    return parse


def _parse_failures(value: Any) -> list[Failure]:
    """Return the failure models of a table such as `{"plastic_strain": {"limit": 1.5}}`."""
    if isinstance(value, list) and all(isinstance(item, Failure) for item in value):
        names = [item.model for item in value]
        for name in names:
            if names.count(name) > 1:
                rule = "stands here twice, and a material has each failure model once"
                raise violation(rule, "leave one of them out", path=(name,))
        return value
    if not isinstance(value, dict):
        model = next(iter(catalogue("failure")))
        remedy = f"write {{ {model} = {example('failure', model)} }}"
        raise violation("must be a table of failure models", remedy, value=value)
    chosen: list[Failure] = []
    mistakes: list[Exception] = []
    for model, given in value.items():
        try:
            chosen.append(cast(Failure, _chosen(Failure, model, given)))
        except ValueError as error:
            mistakes += below(error, ())
    report(mistakes)
    return chosen


_ONE = WithJsonSchema({"type": "object", "minProperties": 1, "maxProperties": 1})
AnyStrength = Annotated[SkipValidation[Strength], BeforeValidator(_parse_one(Strength)), _ONE]
AnyEos = Annotated[SkipValidation[Eos | None], BeforeValidator(_parse_one(Eos)), _ONE]
AnyFailure = Annotated[
    SkipValidation[list[Failure]],
    BeforeValidator(_parse_failures),
    WithJsonSchema({"anyOf": [{"type": "object", "minProperties": 1}, {"enum": ["library"]}]}),
]
