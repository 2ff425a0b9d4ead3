# SPDX-License-Identifier: BSD-3-Clause
"""What bodies are to others that touch them, and which pairs push each other by springs."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .case import Case


def matter_of(case: Case, name: str) -> str:
    """Return what a body or an entry of grains is: a "solid", a "liquid" or a "gas"."""
    return case.material[case.parts()[name].material].matter() if case.flows(name) else "solid"


def parts_by_matter(case: Case) -> dict[str, list[str]]:
    """Return the names of bodies and entries of grains that are a "solid", a "liquid", a "gas"."""
    found: dict[str, list[str]] = {"solid": [], "liquid": [], "gas": []}
    for name in case.parts():
        found[matter_of(case, name)].append(name)
    return found


def liquids_that_meet(case: Case) -> list[str]:
    """Return the liquids of a case if there are several, drops of one entry of grains included."""
    liquids = parts_by_matter(case)["liquid"]
    bodies = sum(case.grains[name].count if name in case.grains else 1 for name in liquids)
    return liquids if bodies > 1 else []


def have_springs(case: Case, first: str, second: str) -> bool:
    """Return whether two bodies push each other by springs, as `stops_approach` of the core says.

    Args:
        case: a checked case.
        first, second: their names.
    """
    if case.contact.response != "by_matter":
        return case.has_springs
    both = {matter_of(case, first), matter_of(case, second)}
    return case.has_springs and "gas" not in both and both != {"liquid"}
