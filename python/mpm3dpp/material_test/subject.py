# SPDX-License-Identifier: BSD-3-Clause
"""The material that is tested: one of the library, or one of a case file."""

from __future__ import annotations

from pathlib import Path

from mpm3dpp.case import Material, load_case
from mpm3dpp.errors import CaseError, nearest
from mpm3dpp.materials import library

from .options import Options

REMEDY = 'give a name of "mpm3dpp materials", or case.toml:NAME'


def find(text: str) -> tuple[str, Material]:
    """Return the name of a material and the material.

    Args:
        text: `copper_ofhc`, `case.toml:plate`, or `case.toml` if it has one material only.

    Raises:
        CaseError: there is no such material or case file.
    """
    if text in library():
        return text, Material(library=text)
    path, _, name = text.rpartition(":")
    if not path and not text.endswith(".toml"):
        closest = nearest(text, library()).partition("?")
        hint = f"{closest[0]}? " if closest[1] else ""
        raise CaseError("is not a material of the library", f"{hint}{REMEDY}", value=text)
    if not path or text.endswith(".toml"):
        path, name = text, ""
    materials = load_case(Path(path)).material
    if name in materials:
        return name, materials[name]
    if not name and len(materials) == 1:
        return next(iter(materials.items()))
    rule = "is not a material of this case" if name else "has several materials"
    raise CaseError(rule, nearest(name, materials), place=path if name else "", value=name or path)


def at_temperature(name: str, material: Material, options: Options) -> Material:
    """Return the material at the temperature of the test, where one is given.

    Raises:
        CaseError: the strength model knows no temperature.
    """
    if options.temperature is None:
        return material
    strength = material.strength
    if "T0" not in strength.parameters:
        rule = f"has the strength {strength.model}, which knows no temperature"
        raise CaseError(rule, "leave --temperature out", value=name)
    table = material.table()
    table["strength"] = {strength.model: {**strength.parameters, "T0": options.temperature}}
    return Material(**table)
