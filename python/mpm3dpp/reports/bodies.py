# SPDX-License-Identifier: BSD-3-Clause
"""The sections on bodies and on the loads and walls that act on them."""

from __future__ import annotations

import math
from typing import Any

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.markup import Html, joined, paragraph, table
from mpm3dpp.io.part_cells import of_body

from .document import Section
from .found import Found
from .numbers import NONE, counted, number, vector

_MOST = 100  # rows
_ROUNDING = 1e-12  # share of the largest speed
_ENDS = ("start", "end")

Ends = dict[str, dict[str, float]]
"""What a body had, by PART_COLUMNS: `initial` and `final`."""


def bodies(found: Found) -> Section:
    """Return the section on bodies; grains of an entry are one row."""
    rows = body_rows(found)
    if not rows:
        text = "What became of each body is recorded when the run ends: nothing is there yet."
        return Section("bodies", "Bodies", paragraph(text))
    shown = dict(list(rows.items())[:_MOST])
    per = found.per
    has_eroded = any(row["final"].get("eroded_mass") for row in rows.values())
    head = [
        *("body", "material", "kind", f"mass [kg{per}]", "speed, start [m/s]", "speed, end [m/s]"),
        "velocity, end [m/s]",
        *(f"{name}, {end} [J{per}]" for name in ("kinetic", "internal") for end in _ENDS),
        f"plastic, end [J{per}]",
        *([f"eroded [kg{per}]"] if has_eroded else []),
    ]
    fastest = max(_speed(end) for row in rows.values() for end in row.values())
    lines = [_row(found, name, ends, has_eroded, fastest) for name, ends in shown.items()]
    parts = [
        paragraph(
            "Velocities are those of mass centres; the grains of an entry are taken together."
        )
    ]
    parts.append(table(head, lines, words=3))
    if len(rows) > _MOST:
        parts.append(paragraph(f"The other {len(rows) - _MOST:,} are in manifest.json."))
    return Section("bodies", "Bodies", joined(parts))


def body_rows(found: Found) -> dict[str, Ends]:
    """Return what each body had at the start and has at the end, where it is known."""
    if found.manifest is not None:
        told = found.manifest.bodies
        return {name: ends for name, ends in told.items() if {"initial", "final"} <= set(ends)}
    rows: dict[str, Ends] = {}
    for name in found.bodies if found.history is not None else []:
        assert found.history is not None
        try:
            columns = of_body(found.history, name)
        except CaseError:  # With many bodies they have no columns.
            continue
        if len(columns["time"]):
            ends = (("initial", 0), ("final", -1))
            rows[name] = {w: {k: float(v[i]) for k, v in columns.items()} for w, i in ends}
    return rows


def _row(found: Found, name: str, ends: Ends, has_eroded: bool, fastest: float) -> list[str]:
    """Return the cells of a body; speeds that are rounding beside the fastest are 0."""
    first, last, least = ends["initial"], ends["final"], _ROUNDING * fastest
    cells = [*_kind(found, name), number(last.get("mass"))]
    cells += [number(_or_nil(_speed(end), least)) for end in (first, last)]
    velocity = [_or_nil(v, least) for v in _velocity(last)]
    cells.append(vector(velocity, found.dimension))
    for energy in ("kinetic", "internal"):
        cells += [number(end.get(energy), 5) for end in (first, last)]
    cells.append(number(last.get("plastic"), 5))
    return cells + ([number(last.get("eroded_mass"), 5)] if has_eroded else [])


def _or_nil(value: float, least: float) -> float:
    return 0.0 if abs(value) <= least else value


def _speed(end: dict[str, float]) -> float:
    return math.hypot(*_velocity(end))


def _velocity(end: dict[str, float]) -> list[float]:
    return [end.get(f"velocity_{axis}", math.nan) for axis in "xyz"]


def _kind(found: Found, name: str) -> list[str]:
    """Return name, material and kind of a body, or of an entry of grains."""
    case = found.case
    grains = case.get("grains", {}).get(name)
    entry: dict[str, Any] = grains or case.get("body", {}).get(name) or {}
    material = str(entry.get("material", NONE))
    strength = case.get("material", {}).get(material, {}).get("strength", {})
    kind = "rigid" if "rigid" in strength else "deforms" if strength else NONE
    if entry.get("motion") is not None:
        kind = "moves as prescribed"
    return [name, material, f"grains, {kind}" if grains else kind]


def actions(found: Found) -> Section | None:
    """Return the section on loads and walls; None where there are none."""
    manifest, flat = found.manifest, found.dimension
    if manifest is None or not (manifest.loads or manifest.walls):
        return None
    per, area = found.per, "m^2 per metre" if found.per else "m^2"
    parts: list[Html] = []
    units = f"N{per}", f"N s{per}"
    if manifest.loads:
        rows = [
            [
                name,
                vector(a.impulse, flat),
                vector(a.force, flat),
                number(a.area) if a.area else NONE,
            ]
            for name, a in manifest.loads.items()
        ]
        head = ["load", f"impulse [{units[1]}]", f"force, end [{units[0]}]", f"area [{area}]"]
        parts.append(table(head, rows))
    if manifest.walls:
        lines = [
            [name, vector(w.impulse, flat), vector(w.force, flat), number(w.pressure)]
            for name, w in manifest.walls.items()
        ]
        head = ["wall", f"impulse [{units[1]}]", f"force, end [{units[0]}]", "pressure, end [Pa]"]
        parts.append(table(head, lines))
    about = [
        counted(len(manifest.loads), "load") if manifest.loads else "",
        counted(len(manifest.walls), "face") + " of the box" if manifest.walls else "",
    ]
    sentence = f"{' and '.join(filter(None, about))}."
    if manifest.walls:
        sentence += " A wall has the force of the bodies on it; a pressure is positive outwards."
    return Section("actions", "Loads and walls", joined([paragraph(sentence), *parts]))
