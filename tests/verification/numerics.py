# SPDX-License-Identifier: BSD-3-Clause
"""Basis, transfer, response of contact and time step of a run, named by one string."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from mpm3dpp import Case, _core
from mpm3dpp.case import choices

UPDATED = "updated"
"""What a case gets that says nothing but `frame = "updated"`."""
MATERIAL = "material"
"""What a case gets that says nothing, of solids: nodes in the body."""
AUTO = "auto"
"""What a case gets that says nothing, whatever it is."""


@dataclass(frozen=True)
class Numerics:
    """What a basis' name stands for: "gimp", "quadratic_bspline+apic~impulses", "gimp+xpic=4@0.5".

    "auto" stands for what a case gets that says nothing, "material" and "updated" for the same with
    the frame said of all bodies that deform, "updated" but for the scheme.

    Attributes:
        basis: its name in the core.
        transfer: its word in the core.
        number: of the transfer, where the name gives one.
        response: `contact.response` of the core, where the name gives one.
        factor: of the critical time step, where the name gives one: instead of the problem's.
        frame: of bodies that deform, where the name gives one; else "updated".
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
        if name in (UPDATED, MATERIAL, AUTO):
            usual = choices.IN_BODIES if name == MATERIAL else choices.AFFINE
            cfl = float(factor) if factor else usual["cfl"]
            return cls(
                choices.BASIS, choices.TRANSFER, None, cfl, response or choices.RESPONSE, name
            )
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
        for body in case.body.values():
            if body.motion is None:
                body.frame = self.frame or UPDATED
                if self.frame in (MATERIAL, AUTO):
                    body.particles_per_cell = None  # By default of the frame.
        case.grid.basis = self.basis
        if self.frame == AUTO:
            for table, key in ((case.run, "transfer"), (case.run, "scheme"), (case.run, "cfl")):
                table.model_fields_set.discard(key)
            case.complete_and_check()
            return
        case.run.transfer = self.table()
        case.run.cfl = self.factor or own
        if self.response:
            case.contact.response = self.response

    def give_core(self, settings: _core.Settings, factor: float) -> None:
        """Give settings of the core this basis and transfer, and this factor or else `factor`."""
        assert self.frame in ("", UPDATED)  # A body has it, which the core's settings do not know.
        settings.grid.basis, settings.run.transfer.word = self.basis, self.transfer
        if self.number is not None:
            table = self.table()
            setattr(settings.run.transfer, self.transfer, table[self.transfer])
        settings.run.cfl = self.factor or factor
        settings.contact.response = self.response or choices.OTHER_RESPONSE
