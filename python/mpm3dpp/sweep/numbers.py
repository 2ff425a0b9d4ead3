# SPDX-License-Identifier: BSD-3-Clause
"""The numbers of a run that a sweep compares."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from mpm3dpp.base.errors import CaseError, guessed
from mpm3dpp.case.box import CONTACT
from mpm3dpp.case.case import Case
from mpm3dpp.io.history import ENERGIES
from mpm3dpp.io.part_cells import PART_COLUMNS

_OF_THE_RUN = ("end_time", "steps", "wall_time")
_OF_DEPTH = ("J", "N", "kg")  # what a unit has that grows with the depth of a plane body


def numbers_of(manifest: Mapping[str, Any]) -> dict[str, float]:
    """Return the numbers of a manifest by the names that `--number` takes.

    Of each body `ball.speed`, of its mass centre at the end, `ball.velocity_x` and all others of
    `bodies`; `kinetic` and the other energies at the end; `wall.x_min.force_x`, its `impulse_x`
    and `pressure`; `friction_work` of all contacts, of bodies and at walls; `end_time`, `steps`
    and `wall_time`.
    """
    found: dict[str, float] = {}
    for body, told in manifest["bodies"].items():
        final = told.get("final", {})
        if final:
            parts = [_number(final[f"velocity_{axis}"]) for axis in "xyz"]
            found[f"{body}.speed"] = math.hypot(*parts)
        found |= {f"{body}.{name}": _number(value) for name, value in final.items()}
    energies = manifest["energies"].get("final", {})
    found |= {name: _number(value) for name, value in energies.items()}
    for face, wall in (manifest.get("walls") or {}).items():
        for axis, force in zip("xyz", wall["force"], strict=False):
            found[f"wall.{face}.force_{axis}"] = _number(force)
        for axis, impulse in zip("xyz", wall["impulse"], strict=False):
            found[f"wall.{face}.impulse_{axis}"] = _number(impulse)
        found[f"wall.{face}.pressure"] = _number(wall["pressure"])
    pairs = manifest["contact"].get("pairs", [])
    of_pairs = math.fsum(_number(pair["friction_work"]) for pair in pairs)
    found["friction_work"] = found.get("friction", of_pairs)  # at walls, too
    found |= {name: _number(manifest[name]) for name in _OF_THE_RUN}
    return found


def _number(value: float | None) -> float:
    """Return a number of a manifest: NaN where JSON could not hold it."""
    return math.nan if value is None else float(value)


def unit_of(name: str, dimension: int) -> str:
    """Return the unit of a number, as the history has it; in 2D that of a metre of depth."""
    column = name.rpartition(".")[2]
    units = {"speed": "m/s", "end_time": "s", "wall_time": "s", "steps": ""}
    unit = units.get(column, "J")
    if name.startswith("wall."):
        unit = {"force": "N", "impulse": "N s", "pressure": "Pa"}[column.partition("_")[0]]
    if column in PART_COLUMNS and column != name:
        unit = PART_COLUMNS[column][0]
    if dimension == 3 or not any(word in _OF_DEPTH for word in unit.split()):
        return unit
    return f"{unit}/m" if " " not in unit else f"({unit})/m"


def chosen(case: Case, names: Sequence[str]) -> list[str]:
    """Return the numbers that a table shows: those named, else some of each body that moves freely.

    Args:
        case: of the runs.
        names: given by the user; default the speed of each body, and the energies.

    Raises:
        CaseError: runs of this case have no such number.
    """
    bodies = [*case.parts()]
    known = [f"{body}.{column}" for body in bodies for column in ("speed", *PART_COLUMNS)]
    known += [*ENERGIES, "friction_work", *_OF_THE_RUN]
    axes = "xyz"[: case.grid.dimension]
    faces = [f"{axis}_{end}" for axis in axes for end in ("min", "max")]
    walls = case.grid.box.walls if case.grid.box else None
    faces = [face for face in faces if walls and getattr(walls, face) != "free"]
    of_wall = [f"{what}_{axis}" for what in ("force", "impulse") for axis in axes]
    known += [f"wall.{face}.{number}" for face in faces for number in (*of_wall, "pressure")]
    for name in names:
        if name not in known:
            remedy = guessed(name, known) or "write one such as ball.speed or kinetic"
            raise CaseError("is no number of these runs", remedy, key="--number", value=name)
    if names:
        return list(dict.fromkeys(names))
    free = [name for name in bodies if getattr(case.parts()[name], "motion", None) is None]
    shown = [*(f"{name}.speed" for name in free[:6]), "kinetic", "internal"]
    touching = case.contact_enabled and (len(case.body) > 1 or case.grains)
    return [*shown, "friction_work"] if touching or CONTACT in case.grid.walls else shown
