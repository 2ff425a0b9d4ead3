# SPDX-License-Identifier: BSD-3-Clause
"""What a body begins with beside its velocity: stress and state (`initial` of a body)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Field
from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import Path, below, nearest, report, violation
from mpm3dpp.base.expression import AT_START, Expression
from mpm3dpp.base.expression import Field as Components
from mpm3dpp.base.model import CaseModel
from mpm3dpp.base.time_functions import at
from mpm3dpp.base.units import Quantity
from mpm3dpp.materials import catalogue, state_columns
from mpm3dpp.materials.catalogue import KINDS

from .initial_fields import STRESS, InitialFields, any_fields

if TYPE_CHECKING:
    from .body import Body
    from .case import Case

GEOSTATIC = "geostatic"
PARTS = {2: ("xx", "yy", "zz", "xy"), 3: ("xx", "yy", "zz", "yz", "xz", "xy")}
"""Components of the stress, in the order of the core."""


class _Stress(Components):
    """The word `geostatic`, or four components in 2D and six in 3D."""

    def parse(self, value: Any) -> Any:
        if isinstance(value, str) and value == GEOSTATIC:
            return value
        if isinstance(value, str) or not hasattr(value, "__len__") or len(value) not in (4, 6):
            rule = f'must be "{GEOSTATIC}", or four numbers in 2D and six in 3D'
            order = "; ".join(f"{', '.join(parts)} in {D}D" for D, parts in PARTS.items())
            raise violation(rule, f"the order is {order}", value=value)
        return self.items(value)

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        return {"description": f'`"{GEOSTATIC}"`, or a list of 4 numbers in 2D and 6 in 3D [Pa]'}


class _State(Quantity):
    """Values of state columns by their names, numbers or formulas."""

    def parse(self, value: Any) -> Any:
        if not isinstance(value, Mapping):
            raise violation("must be a table", "write { temperature = 400 }", value=value)
        units = _units()
        found, mistakes = {}, []
        for name, given in value.items():
            try:
                if name not in units:
                    raise violation("is no state of a material", nearest(str(name), units))
                found[name] = got = Components(units[name], variables=AT_START).item(given)
                least, most = allowed(name)
                if isinstance(got, float) and not least <= got <= most:
                    rule = "must be between 0 and 1" if most == 1.0 else "must be >= 0"
                    raise violation(rule, value=given)
            except (PydanticCustomError, ValueError) as error:
                mistakes += below(error, (str(name),))
        report(mistakes)
        return found

    def __get_pydantic_json_schema__(self, _schema: Any, _handler: Any) -> dict[str, Any]:
        return {"type": "object"}


_SHARES = ("damage", "burn_fraction")


def allowed(name: str) -> tuple[float, float]:
    """Return the least and the largest value of a state."""
    return (0.0, 1.0) if name in _SHARES else (0.0, math.inf)


def _units() -> dict[str, str]:
    """Return the units of all states of one number, by name."""
    models = (model for kind in KINDS for model in catalogue(kind).values())
    states = (state for model in models for state in model.state)
    return {s.name: "" if s.unit == "1" else s.unit for s in states if s.name not in _TENSORS}


_TENSORS = ("left_cauchy_green", "strain")


AnyFields: Any = any_fields(_units)
StressField = Annotated[str | tuple[float | Expression, ...], _Stress("Pa", variables=AT_START)]


class Initial(CaseModel):
    """`initial` of a body: the stress and the state that it begins with.

    Attributes:
        stress: "geostatic", of the weight of the deformable bodies above, as gravity is at t = 0
            (not of grains, rigid or moved bodies and loads); or its components [Pa], tension
            positive: xx, yy, zz, xy in 2D and xx, yy, zz, yz, xz, xy in 3D, numbers or formulas of
            x, y, z, r; None for none.
        K0: of a geostatic stress, the horizontal over the vertical one; default nu / (1 - nu), as
            in a layer that cannot widen.
        state: states of its material that are one number, by name, such as
            `{ temperature = "500 K" }`: numbers or formulas of x, y, z, r.
        fields: a CSV file of stresses and states at places, `"fields.csv"` or `{ file =
            "fields.csv", unit = "mm" }` with the unit of its lengths: linear between the places,
            beyond them those of the nearest.
    """

    stress: StressField | None = None
    K0: Annotated[float, Quantity("", ">= 0")] | None = None
    state: Annotated[dict[str, float | Expression], _State("")] = Field(default_factory=dict)
    fields: AnyFields = None


def check_initial(case: Case, body: Body, path: Path) -> Iterator[PydanticCustomError]:
    """Find what `initial` of a body has that the body, its material or gravity does not."""
    initial = body.initial
    if initial is None:
        return
    path, D = (*path, "initial"), case.grid.dimension
    if body.motion is not None or case.material[body.material].strength.model == "rigid":
        yield violation("is of a body that does not deform", "remove it", path=path)
        return
    yield from _formulas(initial, D, path)
    material = case.material[body.material]
    known = [name for name in state_columns(material.models) if name not in _TENSORS]
    for name in initial.state:
        if name not in known:
            rule = f'is no state of the material "{body.material}"'
            remedy = f"it has {', '.join(known) or 'none'}"
            yield violation(rule, remedy, path=(*path, "state", name))
    if initial.fields is not None:
        yield from _check_fields(initial, initial.fields, D, known, path)
    if initial.K0 is not None and initial.stress != GEOSTATIC:
        yield violation(
            "is for a geostatic stress", f'give stress = "{GEOSTATIC}"', path=(*path, "K0")
        )
    gives = initial.stress is not None
    if not gives:
        if initial.K0 is None and not initial.state and initial.fields is None:
            yield violation("is empty", "give stress, state or fields, or remove it", path=path)
        if initial.fields is None or not initial.fields.has_stress:
            return
    to_stress = (*path, "stress" if gives else "fields")
    if material.eos is not None:
        rule = f"has its pressure from the equation of state {material.eos.model}"
        yield violation(rule, "remove the stress, or the eos", path=to_stress)
    if "left_cauchy_green" in state_columns(material.models):
        rule = f"has its stress from its strain, as {material.strength.model} is"
        yield violation(rule, "give another strength, such as elastic", path=to_stress)
    if initial.stress is None:
        return
    if initial.stress != GEOSTATIC:
        if len(initial.stress) != len(PARTS[D]):
            rule = f"must have {len(PARTS[D])} numbers in {D}D"
            yield violation(rule, f"the order is {', '.join(PARTS[D])}", path=to_stress)
        return
    if sum(at(g, 0.0) != 0.0 for g in case.run.gravity) != 1:
        rule = "needs gravity along one axis at t = 0"
        example = ", ".join(["0"] * (D - 1) + ['"-9.81 m/s^2"'])
        yield violation(rule, f"give run.gravity = [{example}]", path=to_stress)


def _check_fields(
    initial: Initial, fields: InitialFields, D: int, known: list[str], path: Path
) -> Iterator[PydanticCustomError]:
    """Find columns of a file that the body cannot begin with."""
    path, value = (*path, "fields"), fields.file or None
    if fields.dimension != D:
        rule = f"has {fields.dimension} coordinates, and grid.dimension = {D}"
        yield violation(rule, "give a file of as many", value=value, path=path)
    stresses = [f"{STRESS}{part}" for part in PARTS[D]]
    for name in fields.columns:
        if name.startswith(STRESS):
            if initial.stress is not None:
                rule = "gives the stress, and so does the key stress"
                yield violation(rule, "keep one of the two", value=value, path=path)
                return
            continue
        if name not in known:
            rule = f"has the column {name}, which is no state of this body's material"
            remedy = f"it has {', '.join(known) or 'none'}"
            yield violation(rule, remedy, value=value, path=path)
        if name in initial.state:
            rule = f"gives {name}, and so does the key state"
            yield violation(rule, "keep one of the two", value=value, path=path)
        least, most = allowed(name)
        values = fields.columns[name]
        if not (least <= values.min() and values.max() <= most):
            rule = f"gives {name} from {values.min():g} to {values.max():g}"
            remedy = "it must be between 0 and 1" if most == 1.0 else "it must be >= 0"
            yield violation(rule, remedy, value=value, path=path)
    if fields.has_stress and sorted(n for n in fields.columns if n.startswith(STRESS)) != sorted(
        stresses
    ):
        rule = f"must have all components of the stress in {D}D, or none"
        yield violation(rule, f"they are {', '.join(stresses)}", value=value, path=path)


def _formulas(initial: Initial, D: int, path: Path) -> Iterator[PydanticCustomError]:
    """Find formulas of z in 2D."""
    stress = () if isinstance(initial.stress, str) else initial.stress or ()
    given = [((*path, "stress", k), value) for k, value in enumerate(stress)]
    given += [((*path, "state", name), value) for name, value in initial.state.items()]
    for where, value in given:
        if isinstance(value, Expression) and D == 2 and "z" in value.variables:
            rule = "is a formula of z, and grid.dimension = 2"
            yield violation(rule, "leave z out", value=value.text, path=(*where, "expression"))
