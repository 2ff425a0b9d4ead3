# SPDX-License-Identifier: BSD-3-Clause
"""`about.json` of a run's checkpoint: what it must hold, by names and types."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field, FiniteFloat, model_validator

from .history import ENERGIES

Check = Annotated[int, Field(ge=0, lt=2**32)]
Count = Annotated[int, Field(ge=0, lt=2**62)]


class _Strict(BaseModel):
    model_config = ConfigDict(strict=True, extra="forbid")


class Results(_Strict):
    """See `ResultsWriter.rows`."""

    frames: list[Annotated[list[Check], Field(min_length=1)]]
    units: dict[str, str]


class Table(_Strict):
    """Size and CRC-32 of a table."""

    size: Count
    check: Check


class Summary(_Strict):
    """See `HistoryWriter.summary`."""

    initial: dict[str, float]
    final: dict[str, float]
    kinetic_min: float
    residual_max: float
    numerical_max: float
    external_max: float
    momentum_drift: float

    @model_validator(mode="after")
    def _whole(self) -> Summary:
        if not set(self.initial) == set(self.final) == set(ENERGIES):
            raise ValueError("other energies")
        return self


class History(_Strict):
    """See `HistoryWriter.state`."""

    tables: Annotated[list[Table | None], Field(min_length=2, max_length=2)]
    summary: Summary | None
    momentum: list[float]
    bodies: list[list[float]]
    last_bodies: list[list[float]]

    @model_validator(mode="after")
    def _whole(self) -> History:
        if self.tables[0] is None or len(self.momentum) != (3 if self.summary else 0):
            raise ValueError("no whole history")
        return self


class Probe(_Strict):
    """See `Probes.state`."""

    table: Table
    next: FiniteFloat
    particle: Annotated[list[Count], Field(min_length=2, max_length=2)] | None


class Watch(_Strict):
    """See `Watch.state`."""

    probes: dict[str, Probe]
    stops: dict[str, bool]


class Run(_Strict):
    """Of the case: what is looked at before it is compared."""

    model_config = ConfigDict(strict=True, extra="allow")
    end_time: Annotated[FiniteFloat, Field(gt=0.0)]


class SomeCase(_Strict):
    """See `Case.content`."""

    model_config = ConfigDict(strict=True, extra="allow")
    run: Run


class About(_Strict):
    """All of it."""

    step: Count
    time: FiniteFloat  # before 0 while a run settles
    wall_time: Annotated[FiniteFloat, Field(ge=0.0)]
    results: Results
    history: History
    watch: Watch
    case: SomeCase
    made_by: dict[str, str]


def check_about(about: dict[str, Any]) -> None:
    """Raise `ValueError` if names or types are not those that a run writes."""
    About.model_validate(about)
