# SPDX-License-Identifier: BSD-3-Clause
"""The tables of a case about the computation: grid, run, output, contact."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from mpm3dpp.base.errors import violation
from mpm3dpp.base.model import CaseModel, Choice, Count, Exactly, Flag, Text
from mpm3dpp.base.settings import core_table
from mpm3dpp.base.units import NonNegative, Quantity, Time

from . import choices
from .stop import Stop, one_or_more
from .transfer import Transfer, WordOrTable

_Viscosity: Any = core_table("run.viscosity")
_Run: Any = core_table("run")
_Settle: Any = core_table("run.settle")
_Contact: Any = core_table("contact")


class Viscosity(_Viscosity):
    """Artificial bulk viscosity (von Neumann & Richtmyer 1950, Landshoff 1955), dimensionless."""


class Settle(_Settle):
    """The way to rest before the run, under gravity and the loads of the time 0.

    Bodies with a prescribed motion stand still, and those with a velocity at the start are held.
    When forces balance all velocities are set to zero and the run begins, at the time 0, at which
    these get theirs. Equations: docs/theory/damping.md.
    """


class Run(_Run):
    """How time advances.

    With grid.basis = "gimp" or "linear" the default transfer is "flip"; with "flip", "pic" and
    "xpic" the default scheme is "musl", and cfl 0.25. Where a body has nodes of its own
    (`frame = "material"`) the default cfl is 0.4 with the default basis, and where all have there
    is no transfer.

    Attributes:
        end_time: [s].
        transfer: how particles take the velocity of the grid: "flip", the paper's; "apic", which
            smooths and keeps turning; "aflip", which smooths less; "xpic", which takes noise that
            the grid does not see; or "pic", which takes all motion of a cell's size away, turning
            too.
        viscosity: artificial bulk viscosity of all materials; None for that of gases and
            explosives alone, both factors 0 for none.
        settle: how bodies come to rest before the run; None for a run that begins with them as
            they are filled.
        stop: conditions under which the run ends before, a table or a list of them.
    """

    end_time: Time
    transfer: Annotated[Transfer, WordOrTable()] = Field(
        default=choices.TRANSFER, validate_default=True
    )
    viscosity: Viscosity | None = None
    settle: Settle | None = None
    stop: list[Stop] = Field(default_factory=list)

    @classmethod
    def complete(cls, data: Any) -> Any:
        """Refuse keys that are in the table of the transfer now."""
        data = one_or_more(data)
        moved = {
            "pic_damping": 'transfer = { flip = 1.0, pic_rate = "200 1/s" }',
            "flip_share": "transfer = { flip = 0.99 } or { aflip = 0.97 }",
        }
        for key in moved if isinstance(data, dict) else ():
            if key in data:
                rule, remedy = "is a number of run.transfer now", f"write {moved[key]}"
                raise violation(rule, remedy, value=data[key], path=(key,))
        return data

    @model_validator(mode="after")
    def _one_step(self) -> Run:
        if self.time_step is not None and self.largest_time_step is not None:
            rule = "must not be given together with time_step"
            raise violation(rule, "keep one of the two", path=("largest_time_step",))
        return self


class Output(CaseModel):
    """What is written.

    Attributes:
        frames: number of frames after the first one at t = 0; default 50. The first contact has one
            of its own.
        interval: time between frames [s], in place of `frames`.
        history_every: steps between two rows of the history table.
        fields: what to write beyond position, velocity, stress, pressure, von_mises, id, body and
            material: "density", "sound_speed", "displacement" from the start, "volume", or a state
            column of a material.
        picture: the column that colours the picture and the animation; by default "von_mises", or
            "pressure" where all that deform are fluids, which bear no shear.
        animation: whether a run ends with an animation of its frames, `animation.gif`.
        compression: of the frames: 0 for none, else the level of gzip, 1 to 9. Level 1 makes the
            file a third to a half smaller; it is written at some 50 MB/s then.
        files: of several ranks, whether those of a machine write a frame into one file ("machine")
            or each into its own ("rank").
        checkpoint_interval: wall-clock time between two checkpoints [s], from which `--resume` goes
            on; one more is written at the end, also by Ctrl-C. 0 for none at all.
    """

    frames: Annotated[int, Exactly(int, 1, 100_000)] | None = None
    interval: Time | None = None
    history_every: Count = 1
    fields: list[Text] = Field(default_factory=list)
    picture: Text = "von_mises"
    animation: Flag = False
    compression: Annotated[int, Exactly(int, 0, 9)] = 0
    files: Annotated[str, Choice(("machine", "rank"))] = "machine"
    checkpoint_interval: Annotated[float, Quantity("s", ">= 0")] = 600.0

    @model_validator(mode="after")
    def _frames_or_interval(self) -> Output:
        if self.frames is not None and self.interval is not None:
            rule = "must not be given together with frames"
            raise violation(rule, "keep one of the two", path=("interval",))
        if self.frames is None and self.interval is None:
            self.__dict__["frames"] = 50
        return self


SET_BACK, PRESSED = INTERFERENCES = ("set_back", "pressed")
"""What becomes of bodies that are drawn into each other."""


class ContactPair(CaseModel):
    """What holds between two bodies, or between all bodies of two materials.

    The name of a `grains` entry stands for all its bodies; twice, for the pairs among them.

    Attributes:
        friction: Coulomb coefficient; without one that of `contact`.
        restitution: speed of parting over that of approach; without one that of `contact`.
        interference: what becomes of what is drawn into each other, as in `contact`.
        bonded: they stick together wherever they meet, as one body of two materials; then without
            friction. With `frame = "material"` what touches at the start is held by springs.
    """

    bodies: list[Text] | None = None
    materials: list[Text] | None = None
    friction: NonNegative | None = None
    restitution: Annotated[float, Quantity("", "0 <= f <= 1")] | None = None
    interference: Annotated[str, Choice(INTERFERENCES)] | None = None
    bonded: bool = False

    @model_validator(mode="after")
    def _one_kind_of_two(self) -> ContactPair:
        if (self.bodies is None) == (self.materials is None):
            remedy = 'give one of them, for example bodies = ["left", "right"]'
            raise violation("must have either bodies or materials", remedy)
        name = "bodies" if self.bodies is not None else "materials"
        names = getattr(self, name)
        if len(names) != 2:
            raise violation("must have two names", "give two", value=names, path=(name,))
        given = (self.friction, self.restitution, self.interference)
        if self.bonded and any(one is not None for one in given):
            rule = "is bonded, which goes without friction, restitution and interference"
            raise violation(rule, "leave these out, or bonded")
        if not self.bonded and all(one is None for one in given):
            remedy = "give one of them, for example friction = 0.3"
            raise violation("must have friction, restitution or bonded = true", remedy)
        return self


class Contact(_Contact):
    """Contact between bodies.

    Where run.transfer has no affine part, with detection = "velocity", with a normal other than
    "plane" and with normal_refresh_distance the default response is "impulses".

    Attributes:
        interference: what becomes of bodies that are drawn into each other: with "set_back" their
            surfaces are set back until they touch, without stress; with "pressed" they come into
            each other, as in a press fit, in the first half of `run.settle`, and push each other
            apart from then on. For bodies with a shape, and springs.
        pair: friction of single pairs, or that they are bonded; a pair of bodies wins over a pair
            of materials, and a later entry over an earlier one.
    """

    interference: Annotated[str, Choice(INTERFERENCES)] = SET_BACK
    pair: list[ContactPair] = Field(default_factory=list)
