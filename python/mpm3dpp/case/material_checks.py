# SPDX-License-Identifier: BSD-3-Clause
"""Checks of a material: what the core refuses, what has no stiffness, what does not go together."""

from __future__ import annotations

import re
from collections.abc import Iterator

from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import Path, violation

from .material import Material
from .moduli import damping_viscosity


def check_material(material: Material, path: Path) -> Iterator[PydanticCustomError]:
    """Yield what the core finds wrong, and if nothing would resist compression at the start."""
    try:
        material.sound_speed()
        speed = material.eos_sound_speed()
    except ValueError as error:
        yield _refusal(material, str(error), path)
        return
    if material.beta and not material.sound_speed():
        rule = "is of a material that does not deform, and has no stiffness"
        yield violation(rule, "remove it", path=(*path, "damping"))
    if material.beta and material.volume_averaging and not damping_viscosity(material):
        rule = "is of the shape alone with volume_averaging, and a fluid has no stiffness of that"
        yield violation(rule, "remove one of the two", path=(*path, "damping"))
    if material.eos is not None and not speed:
        rule = "has no stiffness at the start: its pressure does not rise when it is compressed"
        model = material.eos.model
        remedy = f"correct its numbers; `mpm3dpp materials {model}` has an example"
        yield violation(rule, remedy, path=(*path, "eos", model))


def _refusal(material: Material, reason: str, path: Path) -> PydanticCustomError:
    """Return the violation for what the core says, `johnson_cook.T_melt must be > T_room`.

    The key is that of the parameter, and the others that are named have their values.
    """
    chosen = [("strength", material.strength), ("eos", material.eos)]
    for kind, model in [*chosen, *(("failure", model) for model in material.failure)]:
        found = re.match(r"(\w+)\.(\w+) (?=must)", reason)
        if model is None or found is None or found[1] != model.model:
            continue
        name, rule, values = found[2], reason[found.end() :], model.parameters
        others = [word for word in re.findall(r"\w+", rule) if word in values and word != name]
        if name in values:
            also = ", ".join(f"{word} = {values[word]:g}" for word in others)
            where = (*path, kind, model.model, name)
            remedy = "change one of the two" if others else "change it"
            rule = f"{rule} ({also})" if also else rule
            return violation(rule, remedy, value=values[name], path=where)
    return violation(f"is refused: {reason}", "see `mpm3dpp materials`", path=path)
