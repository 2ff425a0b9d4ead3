# SPDX-License-Identifier: BSD-3-Clause
"""Basis, transfer, response of contact and time step of a run, named by one string."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mpm3dpp import Case, _core
from mpm3dpp.case import choices

DEFAULT = "default"
MATERIAL = "material"
"""The default, of bodies on nodes of their own."""


@dataclass(frozen=True)
class Numerics:
    """What a basis' name stands for: "gimp", "quadratic_bspline+apic~impulses", "gimp+xpic=4@0.5".

    "default" stands for what a case gets that says nothing, but for the scheme; "material" for the
    same of bodies with `frame = "material"`, as far as they deform.

    Attributes:
        basis: its name in the core.
        transfer: its word in the core.
        number: of the transfer, where the name gives one.
        response: `contact.response` of the core, where the name gives one.
        factor: of the critical time step, where the name gives one: instead of the problem's.
        frame: of bodies that deform, where the name gives one.
    """

    basis: str
    transfer: str = "flip"
    number: float | None = None
    factor: float | None = None
    response: str = ""
    frame: str = ""

    @classmethod
    def named(cls, name: str) -> Numerics:
        """Take a name apart."""
        name, _, factor = name.partition("@")
        name, _, response = name.partition("~")
        if name in (DEFAULT, MATERIAL):
            usual = choices.IN_BODIES if name == MATERIAL else choices.AFFINE
            cfl = float(factor) if factor else usual["cfl"]
            response, frame = response or choices.RESPONSE, name if name == MATERIAL else ""
            return cls(choices.BASIS, choices.TRANSFER, None, cfl, response, frame)
        basis, _, transfer = name.partition("+")
        word, _, number = (transfer or "flip").partition("=")
        return cls(
            basis,
            word,
            float(number) if number else None,
            float(factor) if factor else None,
            response,
        )

    def table(self) -> Any:
        """Return `run.transfer` of a case file."""
        if self.number is None:
            return self.transfer
        return {self.transfer: int(self.number) if self.transfer == "xpic" else self.number}

    def give_case(self, case: Case) -> None:
        """Give a case this basis and transfer, and this factor; without one its own, or 0.25."""
        own = case.run.cfl if "cfl" in case.run.model_fields_set else choices.OTHERS["cfl"]
        case.grid.basis, case.run.transfer = self.basis, self.table()
        case.run.cfl = self.factor or own
        if self.response:
            case.contact.response = self.response
        for body in case.body.values():
            if self.frame and body.motion is None:
                body.frame, body.particles_per_cell = self.frame, None  # By default of the frame.

    def give_core(self, settings: _core.Settings, factor: float) -> None:
        """Give settings of the core this basis and transfer, and this factor or else `factor`."""
        assert not self.frame  # A body has it, which the core's settings do not know.
        settings.grid.basis, settings.run.transfer.word = self.basis, self.transfer
        if self.number is not None:
            table = self.table()
            setattr(settings.run.transfer, self.transfer, table[self.transfer])
        settings.run.cfl = self.factor or factor
        settings.contact.response = self.response or choices.OTHER_RESPONSE
