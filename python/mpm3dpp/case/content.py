# SPDX-License-Identifier: BSD-3-Clause
"""What of a case its results depend on, and presets: choices for where a case says nothing."""

from __future__ import annotations

import hashlib
import json
from typing import TYPE_CHECKING, Any

from mpm3dpp.grains import Grains
from mpm3dpp.shapes.faces import FACES, fits_the_lattice
from mpm3dpp.shapes.shells import SHELLS

from .grid import Grid
from .parts import SET_BACK

if TYPE_CHECKING:
    from .body import Body
    from .case import Case

PRESETS = ("paper",)
_PAPER_BASIS = "linear"


def with_preset(data: Any) -> Any:
    """Return the tables of a case with the basis of its preset, where none is given.

    What fills its shapes is asked of its entries, see `Case.filled_by`.
    """
    if not isinstance(data, dict) or data.get("preset") not in PRESETS:
        return data
    grid = data.get("grid")
    if isinstance(grid, dict) and "basis" not in grid:
        return {**data, "grid": {**grid, "basis": _PAPER_BASIS}}
    if isinstance(grid, Grid) and "basis" not in grid.model_fields_set:
        return {**data, "grid": grid.model_copy(update={"basis": _PAPER_BASIS})}
    return data


def content_of(case: Case) -> dict[str, Any]:
    """Return `Case.content`."""
    table = case.table()
    table.pop("preset", None)
    for name, body in case.body.items():
        _note_fill(table["body"][name], body, case.preset)
        if body.shape is not None and body.filled_by(case.preset) == FACES:
            spacing = body.particle_spacing(case.grid)
            # Where the lattice ends at all faces it is as it was before there was a choice.
            if not fits_the_lattice(body.shape, case.grid.origin, spacing):
                table["body"][name]["fill"] = FACES
        if body.is_weighted(case.preset):
            table["body"][name]["mass"] = "of the shape"
        if body.particles is not None:
            table["body"][name]["particles"] = body.particles.digest
        if body.initial is not None and body.initial.fields is not None:
            table["body"][name]["initial"]["fields"] = body.initial.fields.digest
    for name, grains in case.grains.items():
        _note_fill(table["grains"][name], grains, case.preset)
        if grains.file is not None:
            table["grains"][name]["file"] = grains.file.digest
    del table["output"]["checkpoint_interval"]
    _drop_interference(table["contact"])
    return dict(_rounded(table))


def hash_of(content: dict[str, Any]) -> str:
    """Return the SHA-256 (hexadecimal) of what a case holds."""
    # Without tables that older cases did not know, so that these keep their hash.
    used = {k: v for k, v in content.items() if v or k not in ("grains", "probe")}
    used["run"] = {k: v for k, v in used["run"].items() if v or k != "stop"}
    text = json.dumps(used, sort_keys=True, separators=(",", ":"))
    return hashlib.sha256(text.encode()).hexdigest()


def _note_fill(table: dict[str, Any], part: Body | Grains, preset: str | None) -> None:
    """Note in an entry's table what fills it; a lattice as it was before there was a choice."""
    table.pop("fill", None)
    if part.filled_by(preset) == SHELLS:
        table["fill"] = SHELLS
    elif isinstance(part, Grains):
        table["align"] = part.align or "between"


def _drop_interference(contact: dict[str, Any]) -> None:
    """Leave out what older cases did not know, so that these keep their hash."""
    if contact["interference"] == SET_BACK:
        del contact["interference"]
    for pair in contact.get("pair", []):
        if pair.get("interference") is None:
            pair.pop("interference", None)


def _rounded(value: Any) -> Any:
    """Return plain data with every float rounded to 12 significant digits."""
    if isinstance(value, float):
        return float(f"{value:.12g}")
    if isinstance(value, dict):
        return {key: _rounded(item) for key, item in value.items()}
    return [_rounded(item) for item in value] if isinstance(value, list) else value
