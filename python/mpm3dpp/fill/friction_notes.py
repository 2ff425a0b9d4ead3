# SPDX-License-Identifier: BSD-3-Clause
"""Elastic bodies without any loss that lie on friction, and may tremble on it."""

from __future__ import annotations

from mpm3dpp.base.errors import key_text
from mpm3dpp.case.case import Case
from mpm3dpp.case.frame import in_body
from mpm3dpp.case.pairs import bonds_of, laws_of

_LOSSLESS = ("elastic", "neo_hookean")


def friction_notes(case: Case) -> list[str]:
    """Return a sentence for each material of which bodies lie on friction and lose nothing else.

    Constant friction drives waves along the surfaces of elastic bodies (Adams 1995), and what
    vibrates walks where it should stick. Settling, a restitution or a damping hold it; that of
    short waves alone does not. In the updated frame the nodes take the waves.
    """
    if not any(case.run.gravity) or case.run.settle:
        return []
    trembling: dict[str, list[str]] = {}
    for name in _on_friction(case):
        part = case.parts()[name]
        material = case.material[part.material]
        lossless = material.strength.model in _LOSSLESS and not material.failure
        if lossless and not material.beta and part.damping is None and not case.is_rigid(name):
            trembling.setdefault(part.material, []).append(name)
    return [_sentence(case, names) for names in trembling.values()]


def _on_friction(case: Case) -> list[str]:
    """Return the entries on nodes of their own that others, or walls, rub without restitution."""
    parts, firsts = case.parts(), case.first_bodies()
    usual, bonds = case.contact, set(bonds_of(case))
    laws = {(a, b): law for a, b, *law in laws_of(case)}

    def rubs(first: str, second: str) -> bool:
        a, b = sorted((firsts[first], firsts[second]))
        friction, restitution = laws.get((a, b), (usual.friction, usual.restitution))
        return friction > 0.0 and restitution == 1.0 and (a, b) not in bonds

    walls = any(case.grid.wall_friction(usual.friction)) and usual.restitution == 1.0

    def lies_on(name: str, other: str) -> bool:
        return (other != name or name in case.grains) and rubs(name, other)

    others = parts if case.contact_enabled else {}
    return [name for name in in_body(case) if walls or any(lies_on(name, one) for one in others)]


def _sentence(case: Case, names: list[str]) -> str:
    key = f"material.{case.parts()[names[0]].material}"
    others = f" and {len(names) - 1} more" if len(names) > 1 else ""
    return (
        f"{key_text(case.part_path(names[0]))}{others} of {key}: what is elastic and loses nothing "
        "may tremble on friction and slide where it should stick; give contact.restitution, for "
        f"example 0.9, {key}.damping.stiffness of some per cent of critical, or run.settle"
    )
