# SPDX-License-Identifier: BSD-3-Clause
"""The material that is tested: one of the library, or one of a case file."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from mpm3dpp.base.errors import CaseError, nearest
from mpm3dpp.base.readers import PROGRAMS, SUFFIXES
from mpm3dpp.case.case import Material
from mpm3dpp.importers import load_any
from mpm3dpp.materials import library

from .options import Options

REMEDY = 'give a name of "mpm3dpp materials", case.toml:NAME or file.mpm:NAME'


class Subject(NamedTuple):
    """What is tested.

    Attributes:
        name: of the material.
        material: itself.
        notes: what is not the same as in the program whose file it is from.
    """

    name: str
    material: Material
    notes: list[str]


def find(text: str, units: str | None = None) -> Subject:
    """Return a material by its name.

    Args:
        text: `copper_ofhc`, `case.toml:plate`, `slope.mpm:dp_1`, or the file alone if it has one
            material only.
        units: unit system of a file of MPM3D-F90 that states none.

    Raises:
        CaseError: there is no such material or file.
    """
    if text in library():
        if units is not None:
            rule = f"is for files of {PROGRAMS} only"
            raise CaseError(rule, "leave it out", key="--units", value=units)
        return Subject(text, Material(library=text), [])
    path, _, name = text.rpartition(":")
    if not path and not _is_file_name(text):
        closest = nearest(text, library()).partition("?")
        hint = f"{closest[0]}? " if closest[1] else ""
        raise CaseError("is not a material of the library", f"{hint}{REMEDY}", value=text)
    if not path or _is_file_name(text):
        path, name = text, ""
    case, notes = load_any(Path(path), units)
    materials = case.material
    if not name and len(materials) == 1:
        name = next(iter(materials))
    if name in materials:
        return Subject(name, materials[name], notes)
    rule = "is not a material of this case" if name else "has several materials"
    raise CaseError(rule, nearest(name, materials), place=path if name else "", value=name or path)


def _is_file_name(text: str) -> bool:
    return text.lower().endswith((".toml", *SUFFIXES))


def at_temperature(name: str, material: Material, options: Options) -> Material:
    """Return the material at the temperature of the test, where one is given.

    Raises:
        CaseError: the strength model knows no temperature, or the material is molten at it.
    """
    if options.temperature is None:
        return material
    strength = material.strength
    if "T0" not in strength.parameters:
        rule = f"has the strength {strength.model}, which knows no temperature"
        raise CaseError(rule, "leave --temperature out", value=name)
    melting = strength.parameters.get("T_melt")
    if melting is not None and options.temperature >= melting:
        rule = f"is not below the melting temperature of {name}, {melting:g} K: molten metal has no"
        raise CaseError(
            f"{rule} strength", "give less", key="--temperature", value=options.temperature
        )
    table = material.table()
    table["strength"] = {strength.model: {**strength.parameters, "T0": options.temperature}}
    return Material(**table)
