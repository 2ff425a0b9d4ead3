# SPDX-License-Identifier: BSD-3-Clause
"""Unit systems of `.mpm` files, which state none, and their factors to SI units."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.errors import CaseError, nearest

Array = NDArray[np.float64]


@dataclass(frozen=True)
class UnitSystem:
    """A consistent set of units; every factor follows from three.

    Attributes:
        name: as given to `--units`.
        length, mass, time: SI value of the unit of each [m], [kg], [s].
        words: by which a comment of the file may name it.
    """

    name: str
    length: Decimal
    mass: Decimal
    time: Decimal
    words: tuple[str, ...]

    def factor(self, kind: str) -> Decimal:
        """Return the SI value of the unit of a kind of quantity, for example "stress"."""
        m, length, t = self.mass, self.length, self.time
        return {
            "1": Decimal(1),
            "length": length,
            "mass": m,
            "time": t,
            "velocity": length / t,
            "acceleration": length / t**2,
            "density": m / length**3,
            "volume": length**3,
            "stress": m / (length * t**2),
            "viscosity": m / (length * t),
            "rate": 1 / t,
            "force": m * length / t**2,
            "specific heat": length**2 / t**2,
        }[kind]

    def si(self, value: float, kind: str) -> float:
        """Return a quantity in SI units, in decimal arithmetic: 0.38 mm is the float 0.00038."""
        return float(Decimal(repr(value)) * self.factor(kind))

    def array(self, values: Any, kind: str) -> Array:
        """Return quantities in SI units."""
        factor = self.factor(kind)  # A power of ten: dividing rounds once, 0.001 would round twice.
        values = np.asarray(values, dtype=np.float64)
        return values / float(1 / factor) if factor < 1 else values * float(factor)


_MILLI = Decimal("1e-3")
SYSTEMS = {
    system.name: system
    for system in (
        UnitSystem("mm-g-N-ms", _MILLI, _MILLI, _MILLI, ("mm", "g", "ms")),
        UnitSystem("SI", Decimal(1), Decimal(1), Decimal(1), ("m", "kg", "s")),
        UnitSystem("cm-g-us", Decimal("1e-2"), _MILLI, Decimal("1e-6"), ("cm", "g", "us")),
    )
}
DEFAULT = "mm-g-N-ms"


def choose(given: str | None, comments: Iterable[str], name: str) -> tuple[UnitSystem, str]:
    """Return the units of a file and a sentence about them.

    Args:
        given: what the user says; None for the default.
        comments: of the file; one of them may name the units, `! Unit: mm g N ms MPa`.
        name: of the file, for messages.

    Raises:
        CaseError: no such system, or a comment contradicts the default.
    """
    said = next((c for c in comments if re.match(r"units?\b", c, re.I)), "")
    if given is not None:
        if given not in SYSTEMS:
            raise CaseError("is not a known unit system", nearest(given, SYSTEMS), key=given)
        return SYSTEMS[given], f"units {given}, as asked for"
    words = set(re.findall(r"\w+", said))
    named = [s.name for s in SYSTEMS.values() if words.issuperset(s.words)]
    if said and named and DEFAULT not in named:
        rule = f'says "{said}" but --units is not given (default {DEFAULT})'
        raise CaseError(rule, f"give --units {named[0]}", place=name)
    quoted = f'; the file says "{said}"' if said else "; the file does not say"
    return SYSTEMS[DEFAULT], f"units {DEFAULT}, as --units is not given{quoted}"
