# SPDX-License-Identifier: BSD-3-Clause
"""The tables of a case about the computation: grid, run, output, contact."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, model_validator

from .errors import violation
from .model import CaseModel, Choice, Count, Exactly, Flag, Text
from .units import AccelerationVector, NonNegative, Point, PositiveLength, Quantity, Time

FACES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")
STANDARD_FIELDS = ("position", "velocity", "stress", "pressure", "von_mises", "body", "material")
_WHOLE = 1e-6  # A box that misses a whole number of cells by less, per cell, is taken as whole.

Wall = Annotated[str, Choice(("free", "slip", "fixed"), (("symmetry", "slip"),))]


class Walls(CaseModel):
    """What the faces of the box do: `free` (nothing), `slip` (or `symmetry`), `fixed`.

    One word in place of the table holds for all faces. In 2D there are no z faces.
    """

    x_min: Wall = "free"
    x_max: Wall = "free"
    y_min: Wall = "free"
    y_max: Wall = "free"
    z_min: Wall = "free"
    z_max: Wall = "free"

    @model_validator(mode="before")
    @classmethod
    def _one_word(cls, data: Any) -> Any:
        if isinstance(data, str):
            word = Choice(("free", "slip", "fixed"), (("symmetry", "slip"),)).parse(data)
            return dict.fromkeys(FACES, word)
        return data


class GridBox(CaseModel):
    """The region of the computation; without it the grid has no bounds.

    Attributes:
        lower, upper: opposite corners [m], D numbers, a whole number of cells apart.
        walls: what the faces do.
    """

    lower: Point
    upper: Point
    walls: Walls = Field(default_factory=Walls)


class Grid(CaseModel):
    """The background grid.

    Attributes:
        dimension: 2 (plane strain) or 3.
        cell_size: edge of the square or cubic cells [m].
        origin: a corner of a cell [m], D numbers; by default the box's lower corner, else zero.
        box: bounds and walls; None for an unbounded grid.
        basis: shape functions. "gimp" (uniform GIMP, Bardenhagen & Kober 2004) stays accurate
            where stressed particles cross cells; "linear" is the paper's, the fastest.
    """

    dimension: Annotated[int, Exactly(int, 2, 3)]
    cell_size: PositiveLength
    origin: Point = ()
    box: GridBox | None = None
    basis: Annotated[str, Choice(("gimp", "linear"))] = "gimp"

    @model_validator(mode="after")
    def _consistent(self) -> Grid:
        names: dict[tuple[str, ...], tuple[float, ...]] = {("origin",): self.origin}
        if self.box is not None:
            names |= {("box", "lower"): self.box.lower, ("box", "upper"): self.box.upper}
        for path, vector in names.items():
            if vector and len(vector) != self.dimension:
                rule = f"must have {self.dimension} numbers, as grid.dimension = {self.dimension}"
                raise violation(rule, f"it has {len(vector)}", value=list(vector), path=path)
        lower = self.box.lower if self.box is not None else (0.0,) * self.dimension
        self.__dict__["origin"] = self.origin or lower
        if self.box is not None:
            self._check_box(self.box)
        return self

    def _check_box(self, box: GridBox) -> None:
        for d in range(self.dimension):
            cells = (box.upper[d] - box.lower[d]) / self.cell_size
            if cells <= 0:
                rule, remedy = f"must be > lower = {box.lower[d]:g} m", "swap the two corners"
                raise violation(rule, remedy, value=box.upper[d], path=("box", "upper", d))
            if abs(cells - round(cells)) > _WHOLE * max(1.0, cells):
                near = box.lower[d] + max(1, round(cells)) * self.cell_size
                rule = f"must be a whole number of cells from lower (it is {cells:.4f} cells away)"
                remedy = f"for example {near:.6g} m"
                raise violation(rule, remedy, value=box.upper[d], path=("box", "upper", d))
            off = (box.lower[d] - self.origin[d]) / self.cell_size
            if abs(off - round(off)) > _WHOLE * max(1.0, abs(off)):
                rule = "must be a whole number of cells from the box's lower corner"
                remedy = "leave it out, then it is that corner"
                raise violation(rule, remedy, value=self.origin[d], path=("origin", d))
        if self.dimension == 2 and (box.walls.z_min, box.walls.z_max) != ("free", "free"):
            uniform = len({getattr(box.walls, face) for face in FACES}) == 1
            if not uniform:
                rule = "has z faces but the grid is 2D"
                raise violation(rule, "remove z_min and z_max", path=("box", "walls"))

    @property
    def lower(self) -> tuple[float, ...]:
        """Corner from which the core counts cells [m], D numbers: the box's, else the origin."""
        return self.box.lower if self.box is not None else self.origin

    @property
    def box_cells(self) -> tuple[int, ...] | None:
        """Number of cells of the box along each axis, D numbers; None without a box."""
        if self.box is None:
            return None
        pairs = zip(self.box.lower, self.box.upper, strict=True)
        return tuple(round((upper - lower) / self.cell_size) for lower, upper in pairs)

    @property
    def walls(self) -> tuple[str, ...]:
        """Words for the six faces x- x+ y- y+ z- z+; z is `free` in 2D, all are without a box."""
        if self.box is None:
            return ("free",) * 6
        used = FACES[: 2 * self.dimension]
        return tuple(getattr(self.box.walls, f) if f in used else "free" for f in FACES)


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
        gravity: acceleration [m/s^2], D numbers; default zero.
        viscosity: artificial bulk viscosity; None for none.
        energy_growth_limit: the run stops when the numerical error has created this share of
            the largest energy seen.
    """

    end_time: Time
    scheme: Annotated[str, Choice(("usf", "usl", "musl"))] = "musl"
    time_step_factor: Annotated[float, Quantity("", "0 < f <= 1")] = 0.25
    gravity: AccelerationVector = ()
    viscosity: Viscosity | None = None
    energy_growth_limit: Annotated[float, Quantity("", "> 0")] = 1.0


class Output(CaseModel):
    """What is written.

    Attributes:
        frames: number of frames after the first one at t = 0; default 50.
        interval: time between frames [s], in place of `frames`.
        history_every: steps between two rows of the history table.
        fields: columns to write beyond position, velocity, stress, pressure, von_mises, body and
            material, for example "volume" or a state column of a material.
        picture: the column that colours the picture.
    """

    frames: Annotated[int, Exactly(int, 1, 100_000)] | None = None
    interval: Time | None = None
    history_every: Count = 1
    fields: list[Text] = Field(default_factory=list)
    picture: Text = "von_mises"

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
        pair: coefficients of single pairs; a pair of bodies wins over a pair of materials, and
            a later entry over an earlier one.
    """

    enabled: Flag = True
    bonded: Flag = False
    detection: Annotated[str, Choice(("gap", "velocity"))] = "gap"
    normal: Annotated[str, Choice(("plane", "pair", "first", "second", "stiffer"))] = "plane"
    friction: NonNegative = 0.0
    gap_distance: Annotated[float, Quantity("m", ">= 0")] = 0.0
    pair: list[ContactPair] = Field(default_factory=list)
