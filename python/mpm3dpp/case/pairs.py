# SPDX-License-Identifier: BSD-3-Clause
"""Single pairs of bodies: what `contact.pair` lists of them, and what it has wrong."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations_with_replacement
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import Path, nearest, violation
from mpm3dpp.base.frames import MATERIAL

from .matter import have_springs
from .parts import PRESSED

if TYPE_CHECKING:
    from .case import Case
    from .parts import ContactPair


def listed_pairs(case: Case) -> dict[tuple[int, int], ContactPair]:
    """Return what holds for pairs of bodies, by their numbers, a <= b; see `laws_of`."""
    parts, firsts = case.parts(), case.first_bodies()
    found = {}
    for pair in sorted(case.contact.pair, key=lambda p: p.bodies is not None):
        for (a, first), (b, second) in combinations_with_replacement(firsts.items(), 2):
            ends = [a, b] if pair.bodies else [parts[a].material, parts[b].material]
            among_itself = a != b or a in case.grains
            if among_itself and sorted(ends) == sorted(pair.bodies or pair.materials or []):
                found[first, second] = pair
    return dict(sorted(found.items()))


def laws_of(case: Case) -> list[tuple[int, int, float, float]]:
    """Return (body, body, friction, restitution) of the pairs that have one in `contact.pair`.

    Bodies are numbered, a <= b; an entry of `grains` is given by its first. a == b is for the
    pairs among its own. What a pair does not give is that of `contact`.
    """
    found = []
    for (a, b), pair in listed_pairs(case).items():
        if pair.friction is None and pair.restitution is None:
            continue
        friction, restitution = case.contact.friction, case.contact.restitution
        found.append(
            (
                a,
                b,
                friction if pair.friction is None else pair.friction,
                restitution if pair.restitution is None else pair.restitution,
            )
        )
    return found


def bonds_of(case: Case) -> list[tuple[int, int]]:
    """Return (body, body) of the bonded pairs in `contact.pair`, numbered as in `laws_of`."""
    return [ends for ends, pair in listed_pairs(case).items() if pair.bonded]


def is_bonded(case: Case, first: str, second: str) -> bool:
    """Return whether two bodies are bonded."""
    pair = _pair_of(case, first, second)
    return case.contact.bonded or (pair is not None and pair.bonded)


def is_pressed(case: Case, first: str, second: str) -> bool:
    """Return whether two bodies push each other apart where they are drawn into each other."""
    pair = _pair_of(case, first, second)
    given = pair.interference if pair is not None else None
    pressed = (given or case.contact.interference) == PRESSED
    return pressed and have_springs(case, first, second)


def presses(case: Case) -> bool:
    """Return whether any bodies that are drawn into each other push each other apart."""
    return PRESSED in (case.contact.interference, *(p.interference for p in case.contact.pair))


def _pair_of(case: Case, first: str, second: str) -> ContactPair | None:
    numbers = case.first_bodies()
    a, b = sorted((numbers[first], numbers[second]))
    return listed_pairs(case).get((a, b))


def check_pairs(case: Case) -> Iterator[PydanticCustomError]:
    """Check the names in `contact.pair`.

    Yields:
        The violations, with their paths in the case.
    """
    if not case.parts() or not case.material:
        return  # Then no name is known, which is told already.
    for index, pair in enumerate(case.contact.pair):
        key = "bodies" if pair.bodies is not None else "materials"
        path = ("contact", "pair", index, key)
        known = case.parts() if pair.bodies is not None else case.material
        names = pair.bodies or pair.materials or []
        first, second = pair.bodies or ("", " ")
        if first == second and first in case.body:
            rule, remedy = "must be two different bodies", "a body has no contact with itself"
            yield violation(rule, remedy, value=pair.bodies, path=path)
        for position, word in enumerate(names):
            if word not in known:
                rule = f"is not a {'body' if key == 'bodies' else 'material'} of this case"
                yield violation(rule, nearest(word, known), value=word, path=(*path, position))


def check_pressed(case: Case) -> Iterator[PydanticCustomError]:
    """Refuse bodies that are pressed into each other without springs, or without coming to rest.

    Yields:
        The violations, with their paths in the case.
    """
    in_body = any(part.frame == MATERIAL for part in case.parts().values())
    asked: list[tuple[Path, str | None, list[str]]] = [
        (("contact", "interference"), case.contact.interference, []),
        *(
            (("contact", "pair", k, "interference"), pair.interference, pair.bodies or [])
            for k, pair in enumerate(case.contact.pair)
        ),
    ]
    for path, word, names in asked:
        if word != PRESSED or not case.contact_enabled or in_body:
            continue  # Bodies on nodes of their own refuse it by themselves.
        if not case.has_springs:
            rule = "is for contact by springs, and here contact.response is impulses"
            yield violation(rule, 'give contact.response = "springs"', value=word, path=path)
        elif shapeless := [name for name in names if name in case.body and _is_points(case, name)]:
            rule = f"is for bodies with a shape, and body.{shapeless[0]} has particles one by one"
            remedy = "give a shape, or draw them apart and move one by body.NAME.motion"
            yield violation(rule, remedy, value=word, path=path)
        elif case.run.settle is None:
            rule = "needs a run that settles: bodies go into each other little by little before it"
            remedy = 'give run.settle = { longest = "1 ms" }, of many waves through the bodies'
            yield violation(rule, remedy, value=word, path=path)


def _is_points(case: Case, name: str) -> bool:
    return case.body[name].shape is None


def check_bonds(case: Case) -> Iterator[PydanticCustomError]:
    """Refuse bonds between bodies that do not deform.

    Yields:
        The violations, with their paths in the case.
    """
    parts = case.parts()
    for index, pair in enumerate(case.contact.pair):
        names = pair.bodies or [n for n, p in parts.items() if p.material in (pair.materials or [])]
        if pair.bonded and names and all(case.is_rigid(name) for name in names):
            rule = "are bonded, and neither deforms: nothing could hold them together"
            key = "bodies" if pair.bodies is not None else "materials"
            path: Path = ("contact", "pair", index, key)
            yield violation(rule, "give one another material, and no motion", path=path)
