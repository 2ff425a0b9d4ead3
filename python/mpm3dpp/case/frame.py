# SPDX-License-Identifier: BSD-3-Clause
"""Bodies on nodes of their own, `frame = "material"`: what they do not go with."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain, product
from typing import TYPE_CHECKING, Any

from pydantic_core import PydanticCustomError

from mpm3dpp import _core
from mpm3dpp.base.errors import violation
from mpm3dpp.base.frames import MATERIAL, UPDATED

from .box import HOLDING
from .matter import matter_of
from .pairs import is_bonded, presses

if TYPE_CHECKING:
    from .case import Case
    from .material import Material


def in_body(case: Case) -> list[str]:
    """Return the bodies and entries of grains whose nodes lie in them."""
    return [name for name, part in case.parts().items() if part.frame == MATERIAL]


def all_in_bodies(case: Case) -> bool:
    """Return whether all bodies that deform have nodes of their own, and there are any."""

    def deforms(part: Any) -> bool:
        material = case.material.get(part.material)
        rigid = material is not None and material.strength.model == "rigid"
        return getattr(part, "motion", None) is None and not rigid

    frames = [part.frame for part in case.parts().values() if deforms(part)]
    return bool(frames) and all(frame == MATERIAL for frame in frames)


def check_frames(case: Case) -> Iterator[PydanticCustomError]:
    """Refuse what bodies on nodes of their own do not go with, or not yet.

    Yields:
        The violations, with their paths in the case.
    """
    own = in_body(case)
    damped = case.run.short_wave_damping > 0.0
    path = _restitution(case) or (("run", "short_wave_damping") if damped else ())
    if path and not own:
        rule = f'is for bodies with frame = "{MATERIAL}", and there is none'
        why = next(filter(None, case.why_in_space.values()), "")
        remedy = f"leave {path[-1]} out" if why else f"give it to bodies, or leave {path[-1]} out"
        yield violation(f"{rule}, as {why}" if why else rule, remedy, path=path)
    if own and damped and case.grid.basis == "gimp":
        rule = 'does not go with grid.basis = "gimp", which has no affine part of a velocity'
        remedy = 'give grid.basis = "quadratic_bspline", or leave it out'
        yield violation(rule, remedy, path=("run", "short_wave_damping"))
    if not own:
        return
    if case.contact.enabled:
        yield from _at_nodes(case)
    of_case = next(chain(_against_others(case), against_all(case)), None)
    for name in own:
        # One each: the next may follow from it. What is of the case is told of the first.
        found = next(against_body(case, name), of_case if name == own[0] else None)
        if found is not None:
            rule, remedy = found
            yield violation(rule, remedy, value=MATERIAL, path=(*case.part_path(name), "frame"))


def _restitution(case: Case) -> tuple[str | int, ...]:
    """Return the key of a restitution below 1."""
    if case.contact.restitution < 1.0:
        return "contact", "restitution"
    for k, pair in enumerate(case.contact.pair):
        if pair.restitution is not None and pair.restitution < 1.0:
            return "contact", "pair", k, "restitution"
    return ()


def against_body(case: Case, name: str) -> Iterator[tuple[str, str]]:
    """Yield what the table of a body, or entry of grains, has against it, with the remedy."""
    updated = f'give frame = "{UPDATED}"'
    part = case.parts()[name]
    if case.is_rigid(name):
        yield "does not go with a body that does not deform", "remove frame"
    material = case.material[part.material]
    key = f"material.{part.material}"
    if _core.is_loose(**material.for_core()):
        yield _of_what_is_loose(material, key)
    for failure in material.failure:
        if failure.action != "no_tension":
            rule = f'does not go with {key}.failure whose action is "{failure.action}"'
            yield rule, f'{updated}, or give {key}.failure.{failure.model} action = "no_tension"'
    if case.run.settle is not None and _moves(part):
        rule = "does not go with run.settle yet where the body has a velocity at the start"
        yield rule, updated


def _moves(part: Any) -> bool:
    """Return whether the particles of an entry have velocities at the start."""
    given = getattr(getattr(part, "particles", None), "velocities", None)
    one_by_one = given is not None and bool(given.any())
    return one_by_one or any(part.velocity) or any(part.angular_velocity)


def _of_what_is_loose(material: Material, key: str) -> tuple[str, str]:
    """Return rule and remedy of a material that flows or spalls, by the model that makes it so."""
    updated, what, without = f'give frame = "{UPDATED}"', "", ""
    eos = material.eos
    if eos is not None and eos.parameters.get("spall_strength"):
        what = "spalls by the spall_strength of its equation of state"
        without = f"give {key}.eos.{eos.model}.spall_strength = 0 if it does not spall"
    else:
        what = f"flows by its strength {material.strength.model}"
    rule = f"does not go with {key}, which {what}: neighbours stay neighbours"
    return f"{rule} there", f"{updated}, or {without}" if without else updated


def keys_at_nodes(case: Case) -> list[str]:
    """Return the keys of `contact` that are given and for contact at nodes: surfaces do without."""
    given, plain = case.contact, type(case.contact)()
    wrong = [
        key
        for key in ("detection", "normal", "gap_distance", "normal_refresh_distance")
        if getattr(given, key) != getattr(plain, key)
    ]
    if "response" in given.model_fields_set and given.response != "springs":
        wrong.append("response")
    return wrong


def _at_nodes(case: Case) -> Iterator[PydanticCustomError]:
    """Refuse these keys."""
    for key in keys_at_nodes(case):
        rule = f'is for contact at nodes, and bodies with frame = "{MATERIAL}" have none'
        remedy = f'leave it out, or give frame = "{UPDATED}"'
        yield violation(rule, remedy, value=getattr(case.contact, key), path=("contact", key))


def against_all(case: Case) -> Iterator[tuple[str, str]]:
    """Yield what the rest of the case has against the frame, likewise."""
    updated = f'give frame = "{UPDATED}"'
    if case.grid.basis == "linear":
        yield "needs gradients without jumps", 'give grid.basis = "quadratic_bspline"'
    if case.contact.bonded and case.body_count > 1:
        remedy = "give bonded = true in [[contact.pair]], which holds what touches at the start"
        yield "does not go with contact.bonded, of bodies that share nodes", remedy
    if case.contact_enabled and presses(case):
        rule = 'does not go with contact.interference = "pressed" yet'
        yield rule, f"leave it out, or {updated}"
    if "absorbing" in case.grid.walls:
        yield "does not go with walls of grid.box that absorb yet", f"leave them out, or {updated}"
    if HOLDING & set(case.grid.walls) and _restitution(case):
        rule = "does not go with walls of grid.box that are slip or fixed and a restitution, yet"
        yield rule, f"leave one of them out, or {updated}"
    if case.grid.outflow_box is not None:
        yield "does not go with grid.outflow_box", f"leave it out, or {updated}"
    if case.grid.coarsening is not None:
        yield "does not go with grid.coarsening", f"leave it out, or {updated}"


def apart_from_surfaces(case: Case, in_space: Iterable[str]) -> str:
    """Return why no body may have a surface beside entries whose nodes lie in space, or "".

    Particles press surfaces by springs, which hold no gas, nor bonds, and not while a body is held.
    """
    in_space = list(in_space)
    if not case.contact_enabled:
        return ""
    gases = [name for name in in_space if matter_of(case, name) == "gas"]
    if gases:
        return f"it may touch {gases[0]}, a gas, whose nodes lie in space"
    held = [name for name in in_space if case.run.settle is not None and _moves(case.parts()[name])]
    if held:
        return f"run.settle holds {held[0]}, whose nodes lie in space, where it presses no surface"
    for first, other in product(in_space, [name for name in case.parts() if name not in in_space]):
        if is_bonded(case, first, other):
            return f"{other} is bonded to {first}, whose nodes lie in space"
    return ""


def _against_others(case: Case) -> Iterator[tuple[str, str]]:
    """Yield what bodies whose nodes lie in space have against surfaces beside them, likewise."""
    own = in_body(case)
    others = [one for one in case.parts() if not case.is_rigid(one) and one not in own]
    found = apart_from_surfaces(case, others)
    if found:
        yield (
            f"does not go with contact between both frames: {found}",
            f'give all frame = "{UPDATED}"',
        )
