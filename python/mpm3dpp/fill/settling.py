# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that are held while a run settles, as they have a velocity at the start."""

from __future__ import annotations

from mpm3dpp.base.errors import CaseError, key_text
from mpm3dpp.case.body import Body
from mpm3dpp.case.case import Case
from mpm3dpp.case.forces import acts_at_first
from mpm3dpp.case.pairs import presses

from .parts import Filled

_PATH = ("run", "settle")


def settling_mistakes(case: Case, bodies: Filled) -> list[CaseError]:
    """Return why a case cannot settle: bodies that have a velocity do not; no force acts."""
    held, whole = _held(case, bodies)
    if case.run.settle is None:
        return []
    first = key_text(case.part_path(held[0])) if held else ""
    if held and case.contact.bonded:
        rule = (
            f"would hold {first}, which has a velocity at the start, and contact.bonded makes all "
            "bodies move as one"
        )
        return [case.error(_PATH, rule, "bond them by [[contact.pair]], or give no velocity")]
    settling = [name for name in case.parts() if not case.is_rigid(name) and name not in whole]
    if held and not settling:
        rule = (
            f"leaves no body to settle: all that deform have a velocity at the start ({first} is "
            "the first), and are held until t = 0"
        )
        return [case.error(_PATH, rule, "leave it out, or give another body that settles")]
    pressed = any(one.pressed for one in bodies.interferences)
    if settling and not acts_at_first(case, settling) and not pressed:
        rule = (
            f"needs a force on the bodies that settle ({', '.join(settling)}): at the time 0 no "
            "gravity, load or body force acts on them"
            + (f", and {first} is held until then" if held else "")
            + (", and none is drawn into another to be pressed" if presses(case) else "")
        )
        return [case.error(_PATH, rule, "give one, or remove it")]
    return []


def settling_notes(case: Case, bodies: Filled) -> list[str]:
    """Return a sentence on the bodies that are held."""
    if case.run.settle is None:
        return []
    held, _ = _held(case, bodies)
    if not held:
        return []
    names = ", ".join(key_text(case.part_path(name)) for name in held)
    return [
        f"{names} {'has' if len(held) == 1 else 'have'} a velocity at the start: "
        f"{'it is' if len(held) == 1 else 'they are'} held while the case settles "
        "(run.settle), and set going with it at t = 0"
    ]


def _held(case: Case, bodies: Filled) -> tuple[list[str], list[str]]:
    """Return the bodies and entries of grains that are held, and those of them as a whole."""
    speeds = {
        name: part.survey.speeds
        for name, part in bodies.parts.items()
        if not _is_driven(case.parts()[name])
    }
    held = [name for name, of in speeds.items() if (of > 0.0).any()]
    return held, [name for name in held if (speeds[name] > 0.0).all()]


def _is_driven(part: object) -> bool:
    return isinstance(part, Body) and part.motion is not None
