# SPDX-License-Identifier: BSD-3-Clause
"""A deck as a case, in SI units. What a case cannot do is an error that names the keyword."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from mpm3dpp.case import Case
from mpm3dpp.importers.imported import Imported, Lines

from .box import Bounds, bounds_of, grid_table
from .contact import contact_table, joined
from .deck import Deck, Wave
from .lexer import Source, read_source
from .loads import gravity_vector, load_tables
from .materials import material_name, material_tables
from .output import fields_of
from .particles import body_table, check_counts, one_part
from .statements import read_deck
from .units import UnitSystem, choose


def read(path: str | Path, units: str | None = None) -> Imported:
    """Read an input file of MPM3D-F90.

    Args:
        path: the file.
        units: a name of `SYSTEMS`; by default "mm-g-N-ms", and an error if a comment of the file
            (`! Unit: ...`) names another.

    Raises:
        CaseError: mistakes in the file, and keywords that cannot be honoured: all of them, each
            with its line.
    """
    path = Path(path)
    found = import_source(read_source(path), units)
    found.case.note_file(path)
    return found


def import_source(source: Source, units: str | None = None) -> Imported:
    """Do the same for a text that has been read."""
    problems = source.problems
    chosen = problems.caught(choose, units, source.comments, source.name)
    deck = read_deck(source)
    if chosen is None:
        problems.judge()
    assert chosen is not None
    system, about = chosen
    case = None
    made = _tables(deck, system)
    if made is not None:
        case = problems.caught(Case.from_tables, made[0], source.name, made[1])
    problems.judge()
    assert made is not None and case is not None
    return Imported(case, *made, [about, *source.notes], source.name, "MPM3D-F90", system.name)


def _tables(deck: Deck, units: UnitSystem) -> tuple[dict[str, Any], Lines] | None:
    """Return the tables of a case, and the line of the file that each key came from.

    None if a mistake stands in the way, which is among `deck.source.problems` then.
    """
    caught = deck.source.problems.caught
    materials = caught(material_tables, deck, units)
    good = caught(_check_bodies, deck)
    run = caught(_run, deck, units)
    if not good:
        return None
    contact, groups = caught(contact_table, deck), caught(joined, deck)
    bounds = caught(bounds_of, deck)
    grid = caught(grid_table, deck, bounds, units) if bounds is not None else None
    if materials is None or bounds is None:
        return None
    fields = caught(fields_of, deck, materials)
    bodies = None if groups is None else _bodies(deck, groups, bounds, units)
    loads = None if groups is None else caught(load_tables, deck, groups, bounds, units)
    if grid is None or run is None or contact is None or fields is None or bodies is None:
        return None
    if loads is None:
        return None
    output: dict[str, Any] = {"interval": units.si(deck.interval, "time")}
    tables: dict[str, Any] = {"title": deck.title, "grid": grid, "run": run}
    tables["output"] = output | ({"fields": fields} if fields else {})
    tables |= {"contact": contact} if contact else {}
    tables |= {"material": materials, "body": bodies}
    for point, _ in deck.detonations:
        place = [units.si(x, "length") for x in point]
        tables.setdefault("detonation", []).append({"point": place})
    if loads[0]:
        tables["load"] = loads[0]
    lines = _lines(deck, materials)
    return tables, lines | {("load", name): line for name, line in loads[1].items()}


def _bodies(
    deck: Deck, groups: list[list[int]], bounds: Bounds, units: UnitSystem
) -> dict[str, dict[str, Any]] | None:
    """Return the tables of the bodies; None if one has a mistake."""
    found: dict[str, dict[str, Any]] = {}
    for group in groups:
        number, part = group[0], one_part([deck.parts[k] for k in group])
        table = deck.source.problems.caught(body_table, deck, part, bounds, units)
        if table is None:
            continue
        body = found[f"body_{number + 1}"] = {"material": material_name(deck, part.material)}
        body |= table
        if number + 1 in deck.velocity:
            body["velocity"] = [_speed(v, units) for v in deck.velocity[number + 1][0]]
        if deck.damping:
            body["damping"] = {"mass": units.si(deck.damping, "rate")}
    return found if len(found) == len(groups) else None


def _speed(value: float | Wave, units: UnitSystem) -> Any:
    """Return a component of a velocity in SI units; that of `vsin` as a formula of place."""
    if not isinstance(value, Wave):
        return units.si(value, "velocity")
    v0, half = units.si(value.v0, "velocity"), units.si(6.0, "length")
    return {"expression": f"{v0!r} * sin(pi * y / {half!r})"}


def _lines(deck: Deck, materials: dict[str, dict[str, Any]]) -> Lines:
    lines: Lines = {("contact",): deck.lines.get("cont", deck.lines.get("nbco", 1))}
    for number, part in enumerate(deck.parts, 1):
        lines["body", f"body_{number}"] = part.line
        if number in deck.velocity:
            lines["body", f"body_{number}", "velocity"] = deck.velocity[number][1]
    for number, record in deck.materials.items():
        lines["material", material_name(deck, number)] = record.line
        if "eos" in materials[material_name(deck, number)]:
            lines["material", material_name(deck, number), "eos"] = deck.eos[number].line
    for index, (_, line) in enumerate(deck.detonations):
        lines["detonation", index] = line
    for key, words in _KEYS.items():
        found = [deck.lines[word] for word in words if word in deck.lines]
        lines |= {key: found[-1]} if found else {}
    return lines


_KEYS: dict[tuple[str | int, ...], tuple[str, ...]] = {
    ("title",): ("mpm3",),
    ("grid",): ("dcel",),
    ("grid", "box"): ("grid", "spx"),
    ("run",): ("endt",),
    ("run", "cfl"): ("dtsc",),
    ("run", "scheme"): ("musl", "usl", "usf"),
    ("run", "viscosity"): ("bulk",),
    ("run", "gravity"): ("load",),
    ("output", "interval"): ("endt", "outt"),
    ("output", "fields"): ("outr", "curv"),
}


def _run(deck: Deck, units: UnitSystem) -> dict[str, Any]:
    if deck.end <= 0:
        raise deck.error("endt", "is missing or not > 0", "add endt, the end time")
    if not 0 < deck.factor <= 1:
        rule = f"is {deck.factor:g} but a factor here must obey 0 < f <= 1"
        raise deck.error("dtsc", rule, "give a smaller factor")
    table: dict[str, Any] = {
        "end_time": units.si(deck.end, "time"),
        "scheme": _scheme(deck),
        "cfl": deck.factor,
    }
    quadratic, linear = deck.bulk
    if quadratic or linear:
        table["viscosity"] = {"quadratic": quadratic, "linear": linear}
    if gravity := gravity_vector(deck, units):
        table["gravity"] = gravity
    if deck.rise and not any(deck.force) and not any(deck.particle_force):
        deck.note("QuLo: no force on particles is there to rise, and gravity does not, there too")
    return table


def _scheme(deck: Deck) -> str:
    asked = [name for name, on in deck.schemes.items() if on]
    if not asked:
        return "musl"
    if len(asked) > 1:
        rule = f"has several schemes on: {', '.join(asked)}"
        raise deck.error(asked[-1], rule, "keep one; MPM3D-F90 would mix them")
    return asked[0]


def _check_bodies(deck: Deck) -> bool:
    """Check the bodies: True if there are some, and they have materials."""
    if not deck.parts:
        raise deck.error("part", "is missing", "add a part statement for each body")
    if deck.bodies != len(deck.parts):
        rule = f"is {deck.bodies} but there are {len(deck.parts)} part statements"
        deck.refuse("nbbo", rule, "correct one of the two", deck.lines.get("nbbo", 1))
    for part in deck.parts:
        if part.material not in deck.materials:
            rule = f"names material {part.material}, which is not given"
            raise deck.error("part", rule, "number the materials from 1", part.line)
    check_counts(deck)
    return True
