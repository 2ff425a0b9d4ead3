# SPDX-License-Identifier: BSD-3-Clause
"""Result variables of `outr`, `curv` and `curx` as columns of a case's frames."""

from __future__ import annotations

from typing import Any

from mpm3dpp.base.outputs import STANDARD
from mpm3dpp.materials import state_columns

from .deck import Deck
from .materials import material_name

_STANDARD = {
    "seqv": "von_mises",
    "mat": "material",
    "pres": "pressure",
    "velx": "velocity",
    "vely": "velocity",
    "velz": "velocity",
    "stsx": "stress",
}
_COLUMNS = {
    **_STANDARD,
    "epef": "plastic_strain",
    "volu": "volume",
    "engi": "internal_energy",
    "cels": "temperature",
    "fail": "failed",
}
_NONE = {
    "engk": "kinetic energies are in history.csv",
    "sspd": "the speed of sound is not written",
    "damg": "it is always 0 in MPM3D-F90",
    "disx": "displacements follow from the positions of two frames",
    "disy": "displacements follow from the positions of two frames",
    "disz": "displacements follow from the positions of two frames",
}


def fields_of(deck: Deck, materials: dict[str, dict[str, Any]]) -> list[str]:
    """Return `output.fields` for the variables that a deck asks for.

    Args:
        deck: gives the variables; gets notes about those that are not written.
        materials: tables of a case, which decide what is stored.

    Raises:
        CaseError: a variable that MPM3D-F90 does not know.
    """
    used = {material_name(deck, part.material) for part in deck.parts}
    stored = _stored({name: table for name, table in materials.items() if name in used})
    fields: list[str] = []
    for name, line in deck.variables:
        key = name.lower()[:4]
        if key in _NONE:
            deck.note(f"{key}: {_NONE[key]}")
        elif key not in _COLUMNS:
            remedy = f"the variables are {', '.join([*_COLUMNS, *_NONE])}"
            raise deck.error("outr", f'has the unknown variable "{name}"', remedy, line)
        elif _COLUMNS[key] not in (*STANDARD, *stored):
            deck.note(f"{key}: no material of this case stores {_COLUMNS[key]}")
        elif _COLUMNS[key] not in STANDARD and _COLUMNS[key] not in fields:
            fields.append(_COLUMNS[key])
    return fields


def _stored(materials: dict[str, dict[str, Any]]) -> list[str]:
    """Return the columns beyond the standard ones that these materials store."""
    names = {"volume"}
    for table in materials.values():
        parts = [table["strength"], table.get("eos", {}), table.get("failure", {})]
        names |= set(state_columns({model for part in parts for model in part}))
        if "eos" in table:
            names.add("internal_energy")
        if "failure" in table:
            names.add("failed")
    return sorted(names)
