# SPDX-License-Identifier: BSD-3-Clause
"""What the tables of a manifest must hold, as far as readers use them: names and types."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, FiniteFloat

Count = Annotated[int, Field(ge=0, lt=2**62)]
Size = Annotated[FiniteFloat, Field(ge=0.0)]
Length = Annotated[FiniteFloat, Field(gt=0.0)]

Number = Annotated[float, BeforeValidator(lambda value: math.nan if value is None else value)]
"""A number that JSON may not have been able to hold: None stands for NaN then."""


class _Form(BaseModel):
    model_config = ConfigDict(strict=True, extra="allow", protected_namespaces=())


def _holds(form: type[BaseModel]) -> AfterValidator:
    """Return the check that a table has the form; the table stays as it is."""

    def check(table: dict[str, Any]) -> dict[str, Any]:
        form.model_validate(table)
        return table

    return AfterValidator(check)


class _Gone(_Form):
    mass: Number
    count: Count


class _Ranks(_Form):
    mpi: str | None
    ranks: Annotated[int, Field(ge=1)]
    share: FiniteFloat
    imbalance: FiniteFloat


class _Limiter(_Form):
    body: str
    particle: Count
    sound_speed: Number
    speed: Number


class _Ledger(_Form):
    kinetic: Number
    internal: Number
    external: Number = 0.0
    numerical: Number
    contact: Number


class _Energies(_Form):
    """Other keys are extremes over all steps."""

    __pydantic_extra__: dict[str, Number]
    initial: Annotated[dict[str, Number], _holds(_Ledger)]
    final: Annotated[dict[str, Number], _holds(_Ledger)]


class _BodyEnd(_Form):
    velocity_x: Number
    velocity_y: Number
    velocity_z: Number
    kinetic: Number


class _Body(_Form):
    initial: Annotated[dict[str, Number], _holds(_BodyEnd)]
    final: Annotated[dict[str, Number], _holds(_BodyEnd)]


class _CaseBox(_Form):
    walls: dict[str, Any] = {}


class _CaseGrid(_Form):
    dimension: Literal[2, 3] = 3
    box: _CaseBox = _CaseBox()


class _CaseRun(_Form):
    end_time: Length | None = None
    time_step: Length | None = None
    largest_time_step: Length | None = None
    cfl: Length | None = None
    transfer: str | dict[str, Any] = "flip"


class _CaseOutput(_Form):
    picture: str | None = None
    animation: bool | None = None


class _CaseMaterial(_Form):
    strength: dict[str, Any] | str | None = None


class _CasePart(_Form):
    material: str | None = None
    motion: Any = None


class _Case(_Form):
    title: str | None = None
    grid: _CaseGrid = _CaseGrid()
    run: _CaseRun = _CaseRun()
    output: _CaseOutput = _CaseOutput()
    contact: dict[str, Any] = {}
    material: dict[str, _CaseMaterial] = {}
    body: dict[str, _CasePart] = {}
    grains: dict[str, _CasePart] = {}
    load: dict[str, dict[str, Any]] = {}
    probe: dict[str, dict[str, Any]] = {}


def _table_of(form: type[BaseModel], may_be_empty: bool = False) -> Callable[[Any], Any]:
    """Return what reads a table by its form, with NaN for what JSON could not hold."""

    def read(table: dict[str, Any]) -> dict[str, Any]:
        if may_be_empty and not table:  # Nothing is recorded of it.
            return table
        return form.model_validate(table).model_dump()

    return read


Gone = Annotated[dict[str, Any], AfterValidator(_table_of(_Gone))]
Ranks = Annotated[dict[str, Any], AfterValidator(_table_of(_Ranks))]
Limiter = Annotated[dict[str, Any], AfterValidator(_table_of(_Limiter))]
Energies = Annotated[dict[str, Any], AfterValidator(_table_of(_Energies, may_be_empty=True))]
Ends = Annotated[dict[str, Any], AfterValidator(_table_of(_Body, may_be_empty=True))]
CaseTables = Annotated[dict[str, Any], _holds(_Case)]


def check_case(tables: dict[str, Any]) -> None:
    """Raise `ValueError` if the tables of a case have not the form that readers take them for."""
    _Case.model_validate(tables)
