# SPDX-License-Identifier: BSD-3-Clause
"""The tables of a case about the computation: grid, run, output, contact."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from .errors import violation
from .model import CaseModel, Choice, Count, Exactly, Flag, Text
from .time_functions import TimedAcceleration
from .units import NonNegative, Quantity, Time

STANDARD_FIELDS = ("position", "velocity", "stress", "pressure", "von_mises", "body", "material")


class Viscosity(CaseModel):
    """Artificial bulk viscosity (von Neumann & Richtmyer 1950, Landshoff 1955), dimensionless."""

    quadratic: NonNegative = 1.5
    linear: NonNegative = 0.06


class Run(CaseModel):
    """How time advances.

    Attributes:
        end_time: [s].
        scheme: when the stress is updated: "usf", "usl" or "musl".
        time_step_factor: share f of the largest stable step, 0 < f <= 1.
        gravity: acceleration [m/s^2], D numbers or functions of time; default zero.
        viscosity: artificial bulk viscosity; None for none.
        pic_damping: rate at which particles take over the velocity of the grid [1/s], PIC in place
            of FLIP; takes away noise that the grid does not see, over very long runs.
        energy_growth_limit: the run stops when the numerical error has created this share of
            the largest energy seen.
        outside_limit: the run stops when more than this share of the particles of a body, or of
            all grains of an entry, lies beyond slip or fixed walls of the box; 1 for never.
        volume_limit: the run stops when more than this share of them has less than 0.01 or more
            than 100 times the volume that it began with; gases, products of detonation and
            particles that have failed do not count; 1 for never.
    """

    end_time: Time
    scheme: Annotated[str, Choice(("usf", "usl", "musl"))] = "musl"
    time_step_factor: Annotated[float, Quantity("", "0 < f <= 1")] = 0.25
    gravity: TimedAcceleration = ()
    viscosity: Viscosity | None = None
    pic_damping: Annotated[float, Quantity("1/s", ">= 0")] = 0.0
    energy_growth_limit: Annotated[float, Quantity("", "> 0")] = 1.0
    outside_limit: Annotated[float, Quantity("", "0 < f <= 1")] = 0.05
    volume_limit: Annotated[float, Quantity("", "0 < f <= 1")] = 0.2


class Output(CaseModel):
    """What is written.

    Attributes:
        frames: number of frames after the first one at t = 0; default 50.
        interval: time between frames [s], in place of `frames`.
        history_every: steps between two rows of the history table.
        fields: columns to write beyond position, velocity, stress, pressure, von_mises, body and
            material, for example "volume" or a state column of a material.
        picture: the column that colours the picture and the animation.
        animation: whether a run ends with an animation of its frames, `animation.gif`.
        compression: of the frames: 0 for none, else the level of gzip, 1 to 9. Level 1 makes the
            file a third to a half smaller; it is written at some 50 MB/s then.
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
    checkpoint_interval: Annotated[float, Quantity("s", ">= 0")] = 600.0

    @model_validator(mode="after")
    def _frames_or_interval(self) -> Output:
        if self.frames is not None and self.interval is not None:
            rule = "must not be given together with frames"
            raise violation(rule, "keep one of the two", path=("interval",))
        if self.frames is None and self.interval is None:
            self.__dict__["frames"] = 50
        return self


class ContactPair(CaseModel):
    """A friction coefficient for two bodies, or for all bodies of two materials.

    The name of a `grains` entry stands for all its bodies; twice, for the pairs among them.
    """

    bodies: list[Text] | None = None
    materials: list[Text] | None = None
    friction: NonNegative

    @model_validator(mode="after")
    def _one_kind_of_two(self) -> ContactPair:
        if (self.bodies is None) == (self.materials is None):
            remedy = 'give one of them, for example bodies = ["left", "right"]'
            raise violation("must have either bodies or materials", remedy)
        name = "bodies" if self.bodies is not None else "materials"
        names = getattr(self, name)
        if len(names) != 2:
            raise violation("must have two names", "give two", value=names, path=(name,))
        return self


class Contact(CaseModel):
    """Contact between bodies.

    Attributes:
        enabled: without contact the bodies do not see each other.
        bonded: all bodies have one velocity field, so that they stick together wherever they
            meet, as one body of several materials; nothing else of this table then matters.
        detection: "gap" (touching and approaching) or "velocity" (approaching only).
        normal: direction of contact: "plane" (separates the two bodies' points), or from gradients
            of mass, of both ("pair") or one ("first", "second", "stiffer").
        friction: Coulomb coefficient of all pairs not listed in `pair`.
        gap_distance: bodies closer than this touch [m].
        normal_travel: the direction and gap of a contact are found anew when its two bodies
            together have moved this far [cells]; 0: in every step. 0.1 saves half of the time of
            contact where grains move little, and costs one or two per cent of accuracy.
        pair: coefficients of single pairs; a pair of bodies wins over a pair of materials, and
            a later entry over an earlier one.
    """

    enabled: Flag = True
    bonded: Flag = False
    detection: Annotated[str, Choice(("gap", "velocity"))] = "gap"
    normal: Annotated[str, Choice(("plane", "pair", "first", "second", "stiffer"))] = "plane"
    friction: NonNegative = 0.0
    gap_distance: Annotated[float, Quantity("m", ">= 0")] = 0.0
    normal_travel: Annotated[float, Quantity("", "0 <= f <= 0.25")] = 0.0
    pair: list[ContactPair] = Field(default_factory=list)
