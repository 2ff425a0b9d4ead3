# SPDX-License-Identifier: BSD-3-Clause
"""The library of named materials: `library.toml`, whose every number has a source.

>>> named("copper_ofhc").title
'OFHC copper, annealed'
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from functools import lru_cache
from importlib import resources
from typing import Any

from mpm3dpp.errors import CaseError, nearest, violation

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PARTS = ("density", "strength", "eos", "failure")
"""Keys of a material that the library can give."""
REMOVABLE = ("eos", "failure")
"""Keys that `without` can leave out."""


@dataclass(frozen=True)
class Source:
    """Where some numbers of a material come from.

    Attributes:
        text: the publication.
        where: the place in it, or how the numbers follow from it; may be empty.
        gives: what comes from it, for example `("density", "strength.E")`.
        confirmed: with what the numbers were compared; empty if with nothing.
    """

    text: str
    where: str
    gives: tuple[str, ...]
    confirmed: str


@dataclass(frozen=True)
class NamedMaterial:
    """A material of the library.

    Attributes:
        name: `copper_ofhc`.
        title: what it is, one line.
        group: metals, explosives, fluids, soils.
        parts: the keys of a material of a case file: density, strength, eos, failure.
        sources: of every number in `parts`.
        note: what a user should know; may be empty.
    """

    name: str
    title: str
    group: str
    parts: dict[str, Any]
    sources: tuple[Source, ...]
    note: str

    @property
    def unconfirmed(self) -> list[str]:
        """What comes from sources that nothing has confirmed."""
        return [key for source in self.sources if not source.confirmed for key in source.gives]

    def source_of(self, key: str) -> Source | None:
        """Return the source of a number such as `strength.E`; None for a model's default."""
        return next((source for source in self.sources if key in source.gives), None)


@lru_cache(maxsize=1)
def library() -> dict[str, NamedMaterial]:
    """Return all named materials, by name, in the order of the file."""
    data = resources.files(__package__).joinpath("library.toml").read_bytes()
    tables = tomllib.loads(data.decode())
    references = tables["reference"]
    return {name: _entry(name, table, references) for name, table in tables["material"].items()}


def _entry(name: str, table: dict[str, Any], references: dict[str, str]) -> NamedMaterial:
    sources = tuple(
        Source(
            references[item["reference"]],
            item.get("where", ""),
            tuple(item["gives"]),
            item["confirmed"] or "",
        )
        for item in table["source"]
    )
    parts = {key: table[key] for key in PARTS if key in table}
    return NamedMaterial(
        name, table["title"], table["group"], parts, sources, table.get("note", "")
    )


def named(name: str) -> NamedMaterial:
    """Return a material of the library.

    Raises:
        CaseError: there is no such material; the sentence names the nearest one.
    """
    if name not in library():
        rule = "is not a material of the library"
        raise CaseError(rule, nearest(name, library()), value=name)
    return library()[name]


def fill_in(table: dict[str, Any]) -> dict[str, Any]:
    """Return a case's material with the parts that its key `library` gives.

    A part that stands beside `library` replaces the library's whole part; those named in
    `without` are left out.

    Raises:
        PydanticCustomError: a violation, with its path in the material.
    """
    without = table.get("without") or []
    if not isinstance(without, (list, tuple)):
        raise violation('must be a list such as ["failure"]', value=without, path=("without",))
    for index, word in enumerate(without):
        if word not in REMOVABLE:
            rule = "cannot be left out"
            remedy = f"valid here: {', '.join(REMOVABLE)}"
            raise violation(rule, remedy, value=word, path=("without", index))
    name = table.get("library")
    if name is None:
        if without:
            raise violation("has a meaning beside library only", "remove it", path=("without",))
        return table
    if name not in library():
        remedy = nearest(str(name), library())
        rule = "is not a material of the library"
        raise violation(rule, remedy, value=name, path=("library",))
    parts = {k: v for k, v in library()[name].parts.items() if k not in without}
    both = [key for key in without if key in table]
    if both:
        raise violation(f"is left out by without = {list(without)}", "keep one", path=(both[0],))
    return {**parts, **table}


def either_library_or_own(schema: dict[str, Any]) -> None:
    """Say in the JSON schema of a material that it has a library or a density and a strength."""
    schema["properties"]["library"] = {"type": "string", "enum": list(library())}
    schema["properties"]["without"]["items"] = {"type": "string", "enum": list(REMOVABLE)}
    schema.pop("required", None)
    schema["anyOf"] = [{"required": ["library"]}, {"required": ["density", "strength"]}]
