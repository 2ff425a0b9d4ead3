# SPDX-License-Identifier: BSD-3-Clause
"""The tests that there are, their options, and what is wrong with options."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from mpm3dpp.base.errors import CaseError, nearest

from .triaxial import CELL_PRESSURE


@dataclass(frozen=True)
class Kind:
    """A kind of test.

    Attributes:
        about: one line.
        to: how far it goes unless the user says: a logarithmic strain (negative in compression),
            a shear, or a particle velocity [m/s].
        steps: into how many steps it is divided unless the user says.
    """

    about: str
    to: float
    steps: int


LEAST, MOST = 1e-9, 1e12
"""Sizes that no test needs, in the units of the options."""

TESTS = {
    "uniaxial-strain": Kind("stretch or compression along x, sides held", -0.05, 500),
    "uniaxial-stress": Kind("stretch or compression along x, sides free of stress", 0.2, 400),
    "triaxial": Kind("compression along x after one on all sides, that pressure kept", -0.1, 400),
    "shear": Kind("simple shear in x along y", 0.5, 500),
    "compression-release": Kind("uniaxial strain there and back", -0.05, 1000),
    "hugoniot": Kind("states behind shocks of growing particle velocity", 2000.0, 20),
}


@dataclass(frozen=True)
class Options:
    """What a user can choose.

    Attributes:
        test: a key of TESTS.
        rate: rate of the strain [1/s]; None for the default of 1/s.
        to: the last strain, shear or particle velocity; None for the test's own.
        steps: number of steps; None for the test's own.
        temperature: at the start [K]; None for the material's.
        pressure: in the cell of the test triaxial [Pa]; None for 100 kPa.
    """

    test: str = "uniaxial-strain"
    rate: float | None = None
    to: float | None = None
    steps: int | None = None
    temperature: float | None = None
    pressure: float | None = None

    def completed(self) -> Options:
        """Return the options with all defaults filled in.

        Raises:
            CaseError: an option makes no sense.
        """
        if self.test not in TESTS:
            raise CaseError(
                "is not a known test", nearest(self.test, TESTS), key="--test", value=self.test
            )
        shock = self.test == "hugoniot"
        for name in ("rate", "temperature"):
            value = getattr(self, name)
            if value is None:
                continue
            if shock:
                rule = "has no meaning for the test hugoniot"
                raise CaseError(rule, "remove it", key=f"--{name}")
            unit = "1/s" if name == "rate" else "K"
            if not (value > 0 and math.isfinite(value)):
                rule = "must be > 0 and finite"
                raise CaseError(rule, f"it is in {unit}", key=f"--{name}", value=value)
            if not LEAST <= value <= MOST:
                rule = f"must lie between {LEAST:g} and {MOST:g}"
                raise CaseError(rule, f"it is in {unit}", key=f"--{name}", value=value)
        test = TESTS[self.test]
        to = test.to if self.to is None else self.to
        self._check_end(to)
        steps = test.steps if self.steps is None else self.steps
        if isinstance(steps, float) or not 2 <= steps <= 100_000:
            raise CaseError(
                "must be from 2 to 100000", "give a whole number", key="--steps", value=steps
            )
        rate = None if shock else self.rate or 1.0
        pressure = self._cell_pressure()
        return replace(self, rate=rate, to=to, steps=steps, pressure=pressure)

    def _cell_pressure(self) -> float | None:
        given = self.pressure
        if self.test != "triaxial":
            if given is None:
                return None
            rule = f"has no meaning for the test {self.test}"
            raise CaseError(rule, "remove it, or choose --test triaxial", key="--pressure")
        pressure = CELL_PRESSURE if given is None else given
        if not 0.0 <= pressure <= MOST:
            remedy = "it is in Pa, such as 100e3 for 100 kPa"
            rule = f"must lie between 0 and {MOST:g}"
            raise CaseError(rule, remedy, key="--pressure", value=pressure)
        return pressure

    def _check_end(self, to: float) -> None:
        shock = self.test == "hugoniot"
        what = "a particle velocity in m/s" if shock else "a strain such as -0.1 (compression)"
        if not math.isfinite(to):
            rule = "must be finite"
        elif shock and to <= 0:
            rule = "must be > 0"
        elif self.test == "triaxial" and to >= 0:
            rule, what = "must be < 0 in the test triaxial, which compresses", "a strain like -0.1"
        elif to == 0:
            rule = "must not be zero"
        elif abs(to) < LEAST:
            rule = f"must be at least {LEAST:g} in size"  # below it there is rounding only
        elif not shock and abs(to) > 5:
            rule, what = "must lie between -5 and 5", "a strain, no percentage"
        else:
            return
        raise CaseError(rule, f"give {what}", key="--to", value=to)
