# SPDX-License-Identifier: BSD-3-Clause
"""The statements with an inner grammar about materials and bodies: material, seos, part."""

from __future__ import annotations

import numpy as np

from .deck import Deck, Part, Record
from .lexer import Reader

# The values of each type of material, in their order.
MATERIALS = {
    "elas": "rho E nu",
    "pla1": "rho E nu Y",
    "pla2": "rho E nu Y Et",
    "john": "rho E nu A B n C m Troom Tmelt cv eps0",
    "sjc": "rho E nu A B n C eps0",
    "sjcf": "rho E nu A B n C eps0 epf",
    "jcf": "rho E nu A B n C m Troom Tmelt cv eps0 epf",
    "hiex": "rho D",
    "null": "rho K mu",
    "dpm": "rho E nu qphi kphi qpsi tenf",
    "neoh": "rho E nu",
}
EOS = {
    1: "c0 c1 c2 c3 c4 c5 c6 E0",
    2: "c0 s gamma0 E0",
    3: "A B R1 R2 w E0",
    4: "c",
}
PARTS = {
    "bloc": ("block", "density dp ox oy oz nx ny nz"),
    "sphe": ("sphere", "density dp cx cy cz nr"),
    "blod": ("blod", "density dp ox oy oz nx ny nz hx hy hz nr"),
    "cicl": ("cicl", "density dp cx cy cz nr"),
}
_COUNTS = ("nx", "ny", "nz", "nr")
_MOST = 10**9


def material(reader: Reader, deck: Deck) -> None:
    """Read `num type values...` until num = nmat."""
    if deck.material_count < 1:
        raise reader.error("stands before nmat", "put nmat, the number of materials, above it")
    while True:
        number = reader.integer("the number of a material")
        line = reader.line
        if not 1 <= number <= deck.material_count:
            rule = f"has material {number} but nmat is {deck.material_count}"
            raise reader.error(rule, "correct nmat, or number the materials from 1")
        word = reader.word("the type of a material")
        kind = word.text.lower()[:4]
        if kind not in MATERIALS:
            remedy = f"the types are {', '.join(MATERIALS)}"
            raise reader.error(f'has the unknown material type "{word.text}"', remedy)
        names = MATERIALS[kind].split()
        found = reader.numbers(*(f"{name} of {kind}" for name in names))
        if not found[0] > 0:
            rule = f"has rho = {found[0]:g} of {kind}, which must be > 0"
            raise reader.error(rule, "give a density", line)
        deck.materials[number] = Record(kind, dict(zip(names, found, strict=True)), line)
        if number == deck.material_count:
            return


def equation_of_state(reader: Reader, deck: Deck) -> None:
    """Read `seos mat type values...`."""
    line = reader.line
    number = reader.integer("the number of a material")
    kind = reader.integer("the type of an equation of state")
    if kind not in EOS:
        raise reader.error(f"has the unknown type {kind}", "the types are 1, 2, 3, 4")
    names = EOS[kind].split()
    found = reader.numbers(*(f"{name} of type {kind}" for name in names))
    deck.eos[number] = Record(str(kind), dict(zip(names, found, strict=True)), line)


def part(reader: Reader, deck: Deck) -> None:
    """Read a `part` statement: one body."""
    line = reader.line
    word = reader.word("point, block, sphere, blod or cicl")
    if word.key == "poin":
        deck.parts.append(_points(reader, deck, line))
        return
    if word.key not in PARTS:
        remedy = "the kinds are point, block, sphere, blod, cicl"
        raise reader.error(f'has the unknown kind "{word.text}"', remedy)
    kind, names = PARTS[word.key]
    component = reader.integer("the component")
    number = reader.integer("the number of a material")
    values: dict[str, float] = {}
    for name in names.split():
        if name in _COUNTS:
            count = reader.integer(f"{name} of a {kind}")
            if not 1 <= count < _MOST:
                raise reader.error(f"has {name} = {count}", "give a whole number >= 1")
            values[name] = count
        else:
            values[name] = reader.number(f"{name} of a {kind}")
    for name in ("density", "dp"):
        if values[name] <= 0:
            raise reader.error(f"has {name} = {values[name]:g}, which must be > 0", "correct it")
    deck.parts.append(Part(kind, component, number, line, values))


def _points(reader: Reader, deck: Deck, line: int) -> Part:
    """Read `com n` and n records `id mat mass x y z`."""
    component = reader.integer("the component")
    count = reader.integer("the number of particles")
    if not 1 <= count < _MOST:
        raise reader.error(f"has {count} particles", "give a whole number >= 1")
    left = len(reader.source.words) - reader.at
    if 6 * count > left:
        rule = f"has {count} particles but only {left} words follow, and each has 6"
        raise reader.error(rule, "correct the number, or complete the file")
    table = np.empty((count, 6))
    for k in range(count):
        row = table[k]
        for column, what in enumerate(("id", "material", "mass", "x", "y", "z")):
            row[column] = reader.number(f"the {what} of particle {k + 1} of {count}")
        if not row[0] >= 1 or not row[2] > 0:
            raise reader.error("has a particle whose id or mass is not > 0", "correct it")
    materials = table[:, 1]
    if not np.all(materials == materials[-1]):
        deck.note(
            f"line {line}: the particles name several materials; like MPM3D-F90, the body takes "
            f"that of its last particle, {materials[-1]:g}"
        )
    return Part(
        "point", component, int(materials[-1]), line, masses=table[:, 2], points=table[:, 3:]
    )
