# SPDX-License-Identifier: BSD-3-Clause
"""Conditions under which a run ends before its end time."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import nearest, violation
from mpm3dpp.base.model import CaseModel, Text
from mpm3dpp.base.units import Quantity

if TYPE_CHECKING:
    from .case import Case

CONDITIONS = ("speed_below", "speed_above", "moved", "kinetic_below")
_Speed = Annotated[float, Quantity("m/s", "> 0")]


class Stop(CaseModel):
    """A condition under which a run ends before its end time, with all that it writes.

    It is looked at some 16 steps apart, and counts once it has been seen not to hold: a ball at
    rest may be hit before it is slow. Several are given as a list, of which the first that holds
    ends the run.

    Attributes:
        body: the name of a body, or of an entry of grains, all of which count as one.
        speed_below: the speed of its mass centre is below this [m/s].
        speed_above: that speed is above this [m/s].
        moved: its mass centre is farther than this from where it began [m].
        kinetic_below: its kinetic energy, without a body that of all, is below this [J; in 2D J per
            metre of thickness].
    """

    body: Text = ""
    speed_below: _Speed | None = None
    speed_above: _Speed | None = None
    moved: Annotated[float, Quantity("m", "> 0")] | None = None
    kinetic_below: Annotated[float, Quantity("J", "> 0")] | None = None

    @model_validator(mode="after")
    def _one_condition(self) -> Stop:
        given = [name for name in CONDITIONS if getattr(self, name) is not None]
        if len(given) > 1:
            rule = f"must not be given together with {given[0]}"
            raise violation(rule, "give two conditions, in a list", path=(given[1],))
        if not given:
            raise violation("has no condition", f"add one of {', '.join(CONDITIONS)}")
        if not self.body and given != ["kinetic_below"]:
            raise violation("is missing", "add this key", path=("body",))
        return self

    @property
    def condition(self) -> tuple[str, float]:
        """Name of the condition and its limit."""
        name = next(name for name in CONDITIONS if getattr(self, name) is not None)
        return name, float(getattr(self, name))


def one_or_more(data: Any) -> Any:
    """Return the table `run` with its stop as a list, which may be given as one table."""
    if isinstance(data, dict) and isinstance(data.get("stop"), (dict, Stop)):
        return {**data, "stop": [data["stop"]]}
    return data


def check_stops(case: Case) -> Iterator[PydanticCustomError]:
    """Yield a violation for each condition on a body that there is not."""
    parts = case.parts()
    for k, stop in enumerate(case.run.stop):
        if stop.body and stop.body not in parts:
            rule, remedy = "is not a body of this case", nearest(stop.body, parts)
            yield violation(rule, remedy, value=stop.body, path=("run", "stop", k, "body"))
