# SPDX-License-Identifier: BSD-3-Clause
"""A deck as a case, in SI units. What a case cannot do is an error that names the keyword."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any

from mpm3dpp.case import Case
from mpm3dpp.case_grid import FACES

from .deck import Deck
from .lexer import Source, read_source
from .materials import material_name, material_tables
from .output import fields_of
from .particles import body_table, half_cells
from .statements import read_deck
from .units import UnitSystem, choose

_WALLS = ("free", "fixed", "slip")
_NORMALS = ("pair", "first", "second")
Lines = dict[tuple[str | int, ...], int]


@dataclass(frozen=True)
class Imported:
    """A file of MPM3D-F90 as a case.

    Attributes:
        case: the case.
        tables: it as tables in SI units; particles are `mpm3dpp.Particles`.
        lines: line of the file by the key that came from it.
        notes: sentences about what is not the same as in MPM3D-F90.
        name: of the file.
        units: the name of its unit system.
    """

    case: Case
    tables: dict[str, Any]
    lines: Lines
    notes: list[str]
    name: str
    units: str


def import_mpm(path: str | Path, units: str | None = None) -> Imported:
    """Read an input file of MPM3D-F90.

    Args:
        path: the file.
        units: a name of `SYSTEMS`; by default "mm-g-N-ms", and an error if a comment of the file
            (`! Unit: ...`) names another.

    Raises:
        CaseError: a mistake in the file, or a keyword that cannot be honoured; its line is named.
    """
    path = Path(path)
    found = import_source(read_source(path), units)
    found.case.note_file(path)
    return found


def import_source(source: Source, units: str | None = None) -> Imported:
    """Do the same for a text that has been read."""
    system, about = choose(units, source.comments, source.name)
    deck = read_deck(source)
    tables, lines = _tables(deck, system)
    case = Case.from_tables(tables, source.name, lines)
    return Imported(case, tables, lines, [about, *source.notes], source.name, system.name)


def _tables(deck: Deck, units: UnitSystem) -> tuple[dict[str, Any], Lines]:
    """Return the tables of a case, and the line of the file that each key came from."""
    lines: Lines = {}
    grid, lower = _grid(deck, units)
    materials = material_tables(deck, units)
    order = _check_bodies(deck)
    tables: dict[str, Any] = {
        "title": deck.title,
        "grid": grid,
        "run": _run(deck, units),
        "output": {"interval": units.si(deck.interval, "time")},
    }
    contact = _contact(deck)
    if contact:
        tables["contact"] = contact
        lines["contact",] = deck.lines.get("cont", deck.lines.get("nbco", 1))
    fields = fields_of(deck, materials)
    if fields:
        tables["output"]["fields"] = fields
    tables["material"], tables["body"] = materials, {}
    for number in order:
        part, name = deck.parts[number], f"body_{number + 1}"
        body: dict[str, Any] = {"material": material_name(deck, part.material)}
        body |= body_table(deck, part, lower, units)
        if number + 1 in deck.velocity:
            velocity, line = deck.velocity[number + 1]
            body["velocity"] = [units.si(v, "velocity") for v in velocity]
            lines["body", name, "velocity"] = line
        tables["body"][name] = body
        lines["body", name] = part.line
    for number, record in deck.materials.items():
        lines["material", material_name(deck, number)] = record.line
        if "eos" in materials[material_name(deck, number)]:
            lines["material", material_name(deck, number), "eos"] = deck.eos[number].line
    for index, (point, line) in enumerate(deck.detonations):
        place = [units.si(x, "length") for x in point]
        tables.setdefault("detonation", []).append({"point": place})
        lines["detonation", index] = line
    for key, words in _KEYS.items():
        found = [deck.lines[word] for word in words if word in deck.lines]
        lines |= {key: found[-1]} if found else {}
    return tables, lines


_KEYS: dict[tuple[str | int, ...], tuple[str, ...]] = {
    ("title",): ("mpm3",),
    ("grid",): ("dcel",),
    ("grid", "box"): ("grid", "spx"),
    ("run",): ("endt",),
    ("run", "time_step_factor"): ("dtsc",),
    ("run", "scheme"): ("musl", "usl", "usf"),
    ("run", "viscosity"): ("bulk",),
    ("run", "gravity"): ("load",),
    ("output", "interval"): ("endt", "outt"),
    ("output", "fields"): ("outr", "curv"),
}


def _grid(deck: Deck, units: UnitSystem) -> tuple[dict[str, Any], list[Decimal]]:
    """Return the table and the lower corner in units of the file."""
    if deck.cell <= 0:
        raise deck.error("dcel", "is missing", "add dcel, the cell size")
    for axis, word in enumerate(("spx", "spy", "spz")):
        if axis not in deck.bounds:
            raise deck.error(word, "is missing", f"add {word}, the bounds of the grid")
    cell, length = Decimal(repr(deck.cell)), units.factor("length")
    lower, upper = [], []
    for axis, word in enumerate(("spx", "spy", "spz")):
        low, high = (Decimal(repr(x)) for x in deck.bounds[axis])
        cells = int((high - low) / cell + Decimal("0.5"))
        if cells < 1:
            raise deck.error(word, "is less than half a cell", "enlarge it")
        lower.append(low)
        upper.append(low + cells * cell)
        if abs(upper[-1] - high) > Decimal("1e-9") * cell:
            deck.note(
                f"{word}: the upper bound is moved to a whole number of cells, from {high} to "
                f"{upper[-1].normalize():f}, as in MPM3D-F90"
            )
    box: dict[str, Any] = {
        "lower": [float(x * length) for x in lower],
        "upper": [float(x * length) for x in upper],
    }
    if any(deck.faces):
        box["walls"] = {f: _WALLS[c] for f, c in zip(FACES, deck.faces, strict=True) if c}
    return {
        "dimension": 3,
        "cell_size": float(cell * length),
        "box": box,
        "basis": _basis(deck),
    }, lower


def _basis(deck: Deck) -> str:
    if not deck.gimp:
        return "linear"
    if deck.parts and all(p.material in deck.materials for p in deck.parts):
        if half_cells(deck):
            return "gimp"
        rule = "takes every particle as half a cell wide, and here they are not"
        raise deck.error("gimp", rule, "leave it out, or give two particles to a cell's edge")
    return "gimp"


def _run(deck: Deck, units: UnitSystem) -> dict[str, Any]:
    if deck.end <= 0:
        raise deck.error("endt", "is missing or not > 0", "add endt, the end time")
    if not 0 < deck.factor <= 1:
        rule = f"is {deck.factor:g} but a factor here must obey 0 < f <= 1"
        raise deck.error("dtsc", rule, "give a smaller factor")
    table: dict[str, Any] = {
        "end_time": units.si(deck.end, "time"),
        "scheme": _scheme(deck),
        "time_step_factor": deck.factor,
    }
    quadratic, linear = deck.bulk
    if quadratic or linear:
        table["viscosity"] = {"quadratic": quadratic, "linear": linear}
    gravity = _gravity(deck)
    if any(gravity):
        table["gravity"] = [units.si(g, "acceleration") for g in gravity]
    return table


def _scheme(deck: Deck) -> str:
    asked = [name for name, on in deck.schemes.items() if on]
    if not asked:
        return "musl"
    if len(asked) > 1:
        rule = f"has several schemes on: {', '.join(asked)}"
        raise deck.error(asked[-1], rule, "keep one; MPM3D-F90 would mix them")
    return asked[0]


def _gravity(deck: Deck) -> list[float]:
    """Return the acceleration that acts on all bodies."""
    if not deck.gravity:
        return [0.0, 0.0, 0.0]
    values = [deck.gravity.get(k + 1, ([0.0] * 3, 0))[0] for k in range(len(deck.parts))]
    if any(g != values[0] for g in values):
        rule = "gives the bodies different gravity (those not named have none)"
        line = min(line for _, line in deck.gravity.values())
        raise deck.error("load", rule, "give grav the same numbers for every body", line)
    return values[0]


def _check_bodies(deck: Deck) -> list[int]:
    """Check the bodies and return their indices in the order of their components."""
    if not deck.parts:
        raise deck.error("part", "is missing", "add a part statement for each body")
    if deck.bodies != len(deck.parts):
        rule = f"is {deck.bodies} but there are {len(deck.parts)} part statements"
        raise deck.error("nbbo", rule, "correct one of the two")
    total = 0
    for part in deck.parts:
        if part.material not in deck.materials:
            rule = f"names material {part.material}, which is not given"
            raise deck.error("part", rule, "number the materials from 1", part.line)
        if not 1 <= part.component <= deck.components:
            rule = f"is in component {part.component} but nbco is {deck.components}"
            raise deck.error("part", rule, "correct one of the two", part.line)
        n = part.numbers
        if part.masses is not None:
            total += len(part.masses)
        elif part.kind == "block":
            total += int(n["nx"] * n["ny"] * n["nz"])
    if deck.particles and total > deck.particles:
        rule = f"is {deck.particles} but the part statements have at least {total} particles"
        raise deck.error("nbmp", rule, "correct one of the two")
    return sorted(range(len(deck.parts)), key=lambda k: deck.parts[k].component)


def _contact(deck: Deck) -> dict[str, Any]:
    """Return the table of contact; empty for one body without."""
    components = sorted(part.component for part in deck.parts)
    if deck.components > 2:
        raise deck.error("nbco", f"is {deck.components}", "MPM3D-F90 itself knows 1 and 2 only")
    if deck.contact is not None and deck.components == 1:
        rule = "asks for contact but nbco is 1, so that all bodies share one grid"
        raise deck.error("cont", rule, "set nbco 2, or leave cont out")
    if len(set(components)) == 1:
        return {"bonded": True} if len(components) > 1 else {}
    if len(components) > 2:
        rule = "is 2 with several bodies in a component, which cannot be honoured"
        raise deck.error("nbco", rule, "exactly one body to a component")
    if deck.contact is None:
        deck.note("nbco 2 without cont: the bodies do not see each other, as in MPM3D-F90")
        return {"enabled": False}
    friction, whose = deck.contact
    deck.note(
        "cont: the velocity rule of MPM3D-F90; bodies touch more than a cell before they meet, "
        'contact.detection = "gap" would be better'
    )
    return {"detection": "velocity", "normal": _NORMALS[whose], "friction": friction}
