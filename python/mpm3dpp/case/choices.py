# SPDX-License-Identifier: BSD-3-Clause
"""Basis, transfer, scheme, step and contact of a case that does not say them: chosen together.

By what was measured on thirteen problems (docs/decisions/0048-the-table.md): a basis with which an
affine transfer goes has AFLIP, and this has USF, steps twice as long as those of the others, and
contact by springs (docs/decisions/0054-a-smooth-surface-for-springs.md), where a body flows by
impulses (docs/decisions/0062-matter-that-flows.md). The core's settings begin so
(`cpp/mpm/run/settings.hpp`); here is what follows where a case says one of them.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, TypeVar

from mpm3dpp import _core
from mpm3dpp.base.model import CaseModel, plain
from mpm3dpp.materials.catalogue import catalogue

from .transfer import Transfer

if TYPE_CHECKING:
    from .case import Case
    from .parts import Contact, Output, Run

_DEFAULTS = _core.Settings()
BASIS, TRANSFER = _DEFAULTS.grid.basis, _DEFAULTS.run.transfer.word
AFFINE: dict[str, Any] = {"scheme": _DEFAULTS.run.scheme, "cfl": _DEFAULTS.run.cfl}
OTHERS: dict[str, Any] = {"scheme": "musl", "cfl": 0.25}
# Quadratic B-splines. What swings on springs of contact, a layer of half a cell, takes four steps a
# period at .5, the resonance of fourth order of leapfrog (Mandziuk & Schlick 1995); decision 0079.
IN_BODIES: dict[str, Any] = {"scheme": _DEFAULTS.run.scheme, "cfl": 0.4}
OTHER_TRANSFER = "flip"
RESPONSE, FLOWING_RESPONSE, OTHER_RESPONSE = _DEFAULTS.contact.response, "by_matter", "impulses"
SHEARED, PRESSED = "von_mises", "pressure"

_Table = TypeVar("_Table", bound=CaseModel)


def with_choices(
    basis: str, run: Run, contact: Contact, flows: bool, in_bodies: bool, in_space: bool
) -> dict[str, Run | Contact]:
    """Return `run` and `contact` of a case with what they leave out, by their names.

    Args:
        basis: a word of `grid.basis`.
        run: stays as it is, as another case may have it too, and is returned if it has all of
            `transfer`, `scheme` and `cfl`.
        contact: likewise, with its `response`.
        flows: whether a body has no shape of its own: a gas, a liquid, an explosive.
        in_bodies: whether any body has nodes of its own, whose contact bears shorter steps.
        in_space: whether any body has nodes in space; else its transfer chooses nothing.
    """
    run = _run(run, basis, in_bodies, in_space)
    return {"run": run, "contact": _contact(contact, run, flows)}


def with_picture(case: Case) -> dict[str, Output]:
    """Return `output` of a case with what colours its picture, where it says nothing of that."""
    output = case.output
    if "picture" in output.model_fields_set:
        return {"output": output}
    picture = PRESSED if has_fluids_alone(case) else SHEARED
    return {"output": _with(output, {"picture": picture})}


def has_fluids_alone(case: Case) -> bool:
    """Return whether all that deforms bears no shear, or next to none."""
    free = [part for part in case.parts().values() if getattr(part, "motion", None) is None]
    used = [case.material[part.material] for part in free if part.material in case.material]
    strengths = {material.strength.model for material in used} - {"rigid"}
    return bool(strengths) and all(catalogue()[name].flows for name in strengths)


def usual_transfer(basis: str) -> str:
    """Return the transfer of a case with a basis that does not say one."""
    return TRANSFER if _core.bases[basis]["second_moment"] > 0.0 else OTHER_TRANSFER


def _run(run: Run, basis: str, in_bodies: bool, in_space: bool) -> Run:
    given, chosen = run.model_fields_set, {}
    if "transfer" not in given:
        chosen["transfer"] = Transfer.model_validate(usual_transfer(basis))
    word = chosen.get("transfer", run.transfer).word
    more = AFFINE if _core.transfers[word]["affine"] else OTHERS
    if in_bodies and usual_transfer(basis) == TRANSFER:
        more = IN_BODIES if not in_space else more | {"cfl": min(more["cfl"], IN_BODIES["cfl"])}
    return _with(run, chosen | {key: value for key, value in more.items() if key not in given})


def _contact(contact: Contact, run: Run, flows: bool) -> Contact:
    if "response" in contact.model_fields_set:
        return contact
    # What springs do not go with has been asked for by name.
    planes = contact.normal == "plane" and contact.normal_refresh_distance == 0.0
    fits = planes and contact.detection == "gap"
    affine = _core.transfers[run.transfer.word]["affine"]
    chosen = FLOWING_RESPONSE if flows else RESPONSE
    return _with(contact, {"response": chosen if fits and affine else OTHER_RESPONSE})


def _with(table: _Table, chosen: dict[str, Any]) -> _Table:
    if all(plain(getattr(table, key)) == plain(value) for key, value in chosen.items()):
        return table
    table = table.model_copy()
    table.__dict__.update(chosen)
    return table
