# SPDX-License-Identifier: BSD-3-Clause
"""Probes: fields at a place, of a particle, in a box or of a body, written as the run goes on."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field, model_validator
from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import Path, nearest, violation
from mpm3dpp.base.model import CaseModel, Text
from mpm3dpp.base.outputs import COLUMNS, DERIVED
from mpm3dpp.base.units import Point, Time

if TYPE_CHECKING:
    from .case import Case

_LONGEST = 200  # bytes of a name, which is that of a file
SAMPLES = 500
"""Of a probe that says nothing else, in all of a run."""


class ProbeRegion(CaseModel):
    """A box that stays where it is.

    Attributes:
        lower, upper: opposite corners [m], D numbers.
    """

    lower: Point
    upper: Point


class Probe(CaseModel):
    """Fields at one place or of some particles over time, in `probes/NAME.csv`.

    One of point, particle, region or body must be given. Of a region or a body there are mean (by
    mass), least and largest; at a point the mean of the particles less than a cell away along each
    axis, by mass and nearness.

    Attributes:
        point: a place that stays where it is [m], D numbers.
        particle: the particle nearest to this place at the start [m], before the run settles,
            wherever it goes.
        region: the particles in a box.
        body: the name of a body, or of an entry of grains, that is looked at alone; with neither
            point nor particle nor region all of it.
        fields: what is looked at: "velocity", "stress", "pressure", "von_mises", "position" or any
            column of a material; by default the velocity, pressure and von Mises stress.
        every: time between two looks [s], each at the first step then or after; by default a
            500th of the run's end time.
    """

    point: Point = ()
    particle: Point = ()
    region: ProbeRegion | None = None
    body: Text = ""
    fields: Annotated[list[Text], Field(min_length=1)] = Field(
        default_factory=lambda: ["velocity", "pressure", "von_mises"]
    )
    every: Time | None = None

    @model_validator(mode="after")
    def _one_place(self) -> Probe:
        given = [name for name in ("point", "particle", "region") if getattr(self, name)]
        if len(given) > 1:
            rule = f"must not be given together with {given[0]}"
            raise violation(rule, "keep one of the two", path=(given[1],))
        if not given and not self.body:
            raise violation("looks at nothing", "give point, particle, region or body")
        return self

    @property
    def kind(self) -> str:
        """What it looks at, as the core calls it."""
        for name in ("point", "particle", "region"):
            if getattr(self, name):
                return name
        return "bodies"


def check_probes(
    case: Case, columns: Callable[[str], Iterable[str]]
) -> Iterator[PydanticCustomError]:
    """Yield a violation for each probe of a wrong dimension, body, field or name.

    Args:
        case: of the probes.
        columns: gives the names of those that the particles of a material have.
    """
    dimension, parts = case.grid.dimension, case.parts()
    for name, probe in case.probe.items():
        where: Path = ("probe", name)
        if not name.isprintable() or "/" in name or not 0 < len(name.encode()) <= _LONGEST:
            rule = "cannot be the name of a file"
            yield violation(rule, "use letters and digits", path=where)
        corners: list[tuple[Path, Any]] = [
            (("point",), probe.point),
            (("particle",), probe.particle),
        ]
        if probe.region is not None:
            corners += [(("region", k), getattr(probe.region, k)) for k in ("lower", "upper")]
        wrong = False
        for path, point in corners:
            if point and len(point) != dimension:
                rule = f"must have {dimension} numbers, as grid.dimension = {dimension}"
                remedy, wrong = f"it has {len(point)}, give {dimension}", True
                yield violation(rule, remedy, value=list(point), path=(*where, *path))
        if probe.region is not None and not wrong:
            for low, high in zip(probe.region.lower, probe.region.upper, strict=True):
                if not low < high:
                    rule, remedy = "must be > lower", "exchange the two corners"
                    path = (*where, "region", "upper")
                    yield violation(rule, remedy, value=list(probe.region.upper), path=path)
                    break
        if probe.body and probe.body not in parts:
            rule, remedy = "is not a body of this case", nearest(probe.body, parts)
            yield violation(rule, remedy, value=probe.body, path=(*where, "body"))
            continue
        seen = [probe.body] if probe.body else list(parts)
        stored = (column for part in seen for column in columns(parts[part].material))
        known = list(dict.fromkeys((*COLUMNS, *DERIVED, *stored)))
        for k, field in enumerate(probe.fields):
            if field in probe.fields[:k]:
                path = (*where, "fields", k)
                yield violation("is given twice", "leave one out", value=field, path=path)
            if field not in known:
                rule = "is no field of what the probe looks at"
                path = (*where, "fields", k)
                yield violation(rule, nearest(field, known), value=field, path=path)
