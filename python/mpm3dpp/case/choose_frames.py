# SPDX-License-Identifier: BSD-3-Clause
"""Where the nodes of bodies lie whose case leaves that to us, `frame = "auto"`, and why.

Nodes in the body lose nothing of its motion, so they are taken wherever its material, what it
touches and the rest of the case go with them (docs/decisions/0084-a-frame-by-the-matter.md).
"""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.frames import ALONG, AUTO, MATERIAL, UPDATED

from .body import Body
from .choices import BASIS
from .frame import against_all, against_body, apart_from_surfaces, keys_at_nodes
from .meetings import meets_too_fast

if TYPE_CHECKING:
    from mpm3dpp.grains import Grains

    from .case import Case

LONGEST_STEP = 0.5
"""Of a cell, what waves may pass in a step that is given: contact of surfaces bears .6
(`most_cfl_of_springs` of cpp/mpm/surfaces/law.hpp), and cells may be squeezed."""


def choose_frames(case: Case, of_program: str = "") -> dict[str, str]:
    """Choose where the nodes of each body lie of which the case leaves it to us.

    Args:
        case: its entries that say "auto" are copied, as another case may have them too.
        of_program: why the program that runs it keeps all nodes in space, if it does.

    Returns:
        Why the nodes of an entry, by its name, lie in space; "" where they lie in the body. Of
        those alone that leave it to us and deform.
    """
    asked = [name for name, part in case.parts().items() if leaves_it(part)]
    why: dict[str, str] = {}
    with suppress(CaseError, ValueError):  # A mistake, which is told where it is looked for.
        deform = [name for name in asked if _deforms(case, name)]
        why = dict.fromkeys(deform, of_program) if of_program else _reasons(case, deform)
    tables: list[dict[str, Any]] = [case.body, case.grains]
    for table in tables:
        for name in (one for one in asked if one in table):
            in_space = why.get(name, "it does not deform")
            table[name] = _with_frame(table[name], UPDATED if in_space else MATERIAL)
    return why


def all_in_space(case: Case, why: str) -> Case:
    """Return a case with the nodes of all bodies in space that leave that to us.

    Args:
        case: stays as it is.
        why: of the program that runs it, as `Case.why_in_space` tells it.
    """
    case = _with_own_parts(case)
    case._in_space = why
    case.complete_and_check()
    return case


def in_frames(case: Case, frames: Mapping[str, str]) -> Case:
    """Return a case with frames as if its tables said so, of those alone that leave it to us.

    Args:
        case: stays as it is.
        frames: by the names of entries; others stay as they are.
    """
    case = _with_own_parts(case)
    tables: list[dict[str, Any]] = [case.body, case.grains]
    for table in tables:
        for name in frames.keys() & table.keys():
            if leaves_it(table[name]):
                table[name] = _with_frame(table[name], frames[name])
                table[name].model_fields_set.add("frame")
    case.complete_and_check()
    return case


def _with_own_parts(case: Case) -> Case:
    return case.model_copy(update={"body": dict(case.body), "grains": dict(case.grains)})


def leaves_it(part: Body | Grains) -> bool:
    """Return whether a case leaves it to us where the nodes of an entry lie."""
    return part.frame == AUTO or "frame" not in part.model_fields_set


def _with_frame(part: Any, frame: str) -> Any:
    """Return a copy of an entry in a frame that can be chosen anew."""
    part = part.model_copy()
    part.model_fields_set.discard("frame")
    spaced = {"particles_per_cell", "spacing"} & part.model_fields_set
    part.__dict__["frame"] = frame
    volumes = getattr(getattr(part, "particles", None), "volumes", None)
    if not spaced and volumes is None:
        part.__dict__["particles_per_cell"] = ALONG if frame == UPDATED else None
    return part


def _deforms(case: Case, name: str) -> bool:
    """Return whether an entry deforms, by a material that there is and that can be made."""
    try:
        return case.parts()[name].material in case.material and not case.is_rigid(name)
    except ValueError:  # which is told where materials are checked
        return False


def _reasons(case: Case, names: list[str]) -> dict[str, str]:
    """Return why the nodes of each entry lie in space, "" for nothing."""
    of_all = _of_all(case)
    why = {name: of_all or _against(case, name) for name in names}
    others = [name for name in case.parts() if name not in why and _deforms(case, name)]
    in_space = [name for name, reason in why.items() if reason]
    in_space += [name for name in others if case.parts()[name].frame == UPDATED]
    found = apart_from_surfaces(case, in_space)
    return {name: reason or found for name, reason in why.items()}


def _against(case: Case, name: str) -> str:
    """Return what the table of an entry has against nodes in it, or how fast it meets others, or
    what its waves have against the step."""
    return (
        _sentence(next(against_body(case, name), None))
        or meets_too_fast(case, name)
        or _step_too_long(case, name)
    )


def _step_too_long(case: Case, name: str) -> str:
    """Return how far waves of an entry go in a step that the case gives, if that is too far for
    nodes in it; "" if not, or if none is given."""
    step = case.run.time_step
    if step is None:
        return ""
    waves = case.material[case.parts()[name].material].sound_speed()
    share = step * waves / case.grid.cell_size
    if share <= LONGEST_STEP:
        return ""
    return (
        f"run.time_step lets its waves pass {share:.2g} of a cell, more than the {LONGEST_STEP:g} "
        "for which nodes in it leave room"
    )


def _of_all(case: Case) -> str:
    """Return what of the case keeps all bodies on nodes in space."""
    if case.preset is not None:
        return f'preset = "{case.preset}" is of nodes in space'
    for key in ("transfer", "scheme"):
        if key in case.run.model_fields_set:
            return f"run.{key} is given, which is of nodes in space"
    if case.grid.basis != BASIS:
        return f'grid.basis = "{case.grid.basis}" is given, which is of nodes in space'
    at_nodes = keys_at_nodes(case) if case.contact.enabled else []
    if at_nodes:
        return f"contact.{at_nodes[0]} is given, which is of contact at nodes"
    return _sentence(next(against_all(case), None))


def _sentence(found: tuple[str, str] | None) -> str:
    """Return rule and remedy of what has something against the frame as a reason."""
    return f'frame = "{MATERIAL}" {found[0]}' if found else ""
