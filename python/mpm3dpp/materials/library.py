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

from mpm3dpp.base.errors import CaseError, nearest, show, violation

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PARTS = ("density", "strength", "eos", "failure")
"""Keys of a material that the library can give."""
REMOVABLE = ("eos",)
"""Keys that `without` can leave out."""
ON_REQUEST = "failure"
"""The key that the library gives only where the case asks for it."""


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
        parts: the keys of a material of a case file: density, strength, eos, and failure, which
            a case has only where it says `failure = "library"`.
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

    def _repr_html_(self) -> str:
        """What a notebook shows: the numbers with their units, meanings and sources."""
        from .html import named_html

        return named_html(self)


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

    Beside `library`, parameters of the library's own model replace its single numbers, and
    another model replaces the whole part; those named in `without` are left out. Failure is
    taken only where `failure = "library"`, or `failure = { library = { action = "erode" } }`,
    asks for it.

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
        return _with_failure(table, None)
    if not isinstance(name, str) or name not in library():
        remedy = nearest(show(name), library())
        rule = "is not a material of the library"
        raise violation(rule, remedy, value=name, path=("library",))
    left_out = {*without, ON_REQUEST}
    parts = {k: v for k, v in library()[name].parts.items() if k not in left_out}
    both = [key for key in without if key in table]
    if both:
        raise violation(f"is left out by without = {list(without)}", "keep one", path=(both[0],))
    own = _with_failure(table, library()[name])
    merged = {key: _with_numbers(parts[key], own[key]) for key in parts if key in own}
    return {**parts, **own, **merged}


def _with_numbers(of_library: Any, given: Any) -> Any:
    """Return a part as given, with the library's numbers for what it leaves out of its model."""
    if not isinstance(given, dict) or not isinstance(of_library, dict) or len(given) != 1:
        return given
    [(model, numbers)] = given.items()
    if model not in of_library or not isinstance(numbers, dict):
        return given
    return {model: {**of_library[model], **numbers}}


def _with_failure(table: dict[str, Any], material: NamedMaterial | None) -> dict[str, Any]:
    """Return the table with the library's failure models where its key `failure` asks for them."""
    given = table.get("failure")
    given = {"library": {}} if given == "library" else given
    if not isinstance(given, dict) or "library" not in given:
        return table
    if material is None:
        remedy = "name a material with the key library"
        raise violation('is "library" without a library', remedy, path=("failure",))
    models, changes = material.parts.get("failure"), given["library"]
    if models is None:
        able = ", ".join(m.name for m in library().values() if "failure" in m.parts)
        rule = f"is not in the library for {material.name}"
        raise violation(rule, f"give its models; the library has it for {able}", path=("failure",))
    if not isinstance(changes, dict):
        remedy = 'write failure = "library" or { library = { action = "erode" } }'
        raise violation("must be a table", remedy, value=changes, path=("failure", "library"))
    others = {model: values for model, values in given.items() if model != "library"}
    taken = {model: {**values, **changes} for model, values in models.items()}
    return {**table, "failure": {**taken, **others}}


def either_library_or_own(schema: dict[str, Any]) -> None:
    """Say in the JSON schema of a material that it has a library or a density and a strength."""
    schema["properties"]["library"] = {"type": "string", "enum": list(library())}
    schema["properties"]["without"]["items"] = {"type": "string", "enum": list(REMOVABLE)}
    schema.pop("required", None)
    schema["anyOf"] = [{"required": ["library"]}, {"required": ["density", "strength"]}]
