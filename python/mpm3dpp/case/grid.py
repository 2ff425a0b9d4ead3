# SPDX-License-Identifier: BSD-3-Clause
"""The table `[grid]` of a case: cells, what is kept, when cells double."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, ClassVar

from pydantic import model_validator
from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import Path, report, violation
from mpm3dpp.base.model import CaseModel
from mpm3dpp.base.settings import core_table
from mpm3dpp.base.units import Point

from .box import CONTACT, FACES, GridBox

MOST_CELLS = 2**30
"""Of a box along an axis: the core counts cells with 32 bits, and needs some beyond it."""
FARTHEST = 2**19
"""Cells from the grid's origin to the farthest particle along an axis, at the start: the core lists
particles by keys in which tiles have so many bits."""
_WHOLE = 1e-6  # A box that misses a whole number of cells by less, per cell, is taken as whole.

_FEWEST = 3
"""Cells between two walls that touch: at a node there is one spring along an axis."""

_Coarsening: Any = core_table("grid.coarsening")
_Grid: Any = core_table("grid")


class GridCoarsening(_Coarsening):
    """When the cells double, as the moving grid of Ma, Zhang & Huang 2010, section 3.5, ends.

    Mass, momentum and energy of the particles stay as they are. A box must have an even number of
    cells along each axis each time.
    """

    @model_validator(mode="after")
    def _one_of_two(self) -> GridCoarsening:
        if self.tiles is None and self.bytes is None:
            raise violation("needs tiles or bytes", "give one of them, such as tiles = 20000")
        return self


class GridOutflowBox(CaseModel):
    """The region outside which particles take no part any more; the ledger counts them as `left`.

    A rigid body leaves as a whole, with its mass centre.

    Attributes:
        lower, upper: opposite corners [m], D numbers; without one of them there is no limit on
            that side.
    """

    lower: Point = ()
    upper: Point = ()

    @model_validator(mode="after")
    def _one_of_two(self) -> GridOutflowBox:
        if not self.lower and not self.upper:
            raise violation("has no limit", "give lower, upper or both")
        return self


class Grid(_Grid):
    """The background grid.

    Attributes:
        origin: a corner of a cell [m], D numbers; by default the box's lower corner, else zero.
        box: bounds and walls; None for an unbounded grid.
        outflow_box: region outside which particles are taken out of the run; None for none.
        coarsening: when the cells double; None for never.
    """

    formerly: ClassVar[dict[str, str]] = {"keep": "outflow_box", "doubling": "coarsening"}

    origin: Point = ()
    box: GridBox | None = None
    outflow_box: GridOutflowBox | None = None
    coarsening: GridCoarsening | None = None

    @model_validator(mode="after")
    def _consistent(self) -> Grid:
        report(self._numbers_per_vector())
        lower = self.box.lower if self.box is not None else (0.0,) * self.dimension
        self.__dict__["origin"] = self.origin or lower
        of_walls = [*self._friction_mistakes(), *self._narrow_mistakes()]
        report([*self._box_mistakes(), *of_walls, *self._outflow_mistakes()])
        return self

    def _numbers_per_vector(self) -> Iterator[PydanticCustomError]:
        names: dict[tuple[str, ...], tuple[float, ...]] = {("origin",): self.origin}
        if self.box is not None:
            names |= {("box", "lower"): self.box.lower, ("box", "upper"): self.box.upper}
        if self.outflow_box is not None:
            names |= {
                ("outflow_box", "lower"): self.outflow_box.lower,
                ("outflow_box", "upper"): self.outflow_box.upper,
            }
        for path, vector in names.items():
            if vector and len(vector) != self.dimension:
                rule = f"must have {self.dimension} numbers, as grid.dimension = {self.dimension}"
                yield violation(rule, f"it has {len(vector)}", value=list(vector), path=path)

    def _outflow_mistakes(self) -> Iterator[PydanticCustomError]:
        for d, (low, high) in enumerate(zip(*self.kept, strict=True)):
            if low >= high:
                rule, remedy = f"must be > lower = {low:g} m", "swap the two corners"
                yield violation(rule, remedy, value=high, path=("outflow_box", "upper", d))

    def _friction_mistakes(self) -> Iterator[PydanticCustomError]:
        if self.box is None:
            return
        for face in FACES:
            word = getattr(self.box.walls, face)
            if getattr(self.box.friction, face) is None:
                continue
            if face[0] not in "xyz"[: self.dimension]:
                word = f"not there, as grid.dimension = {self.dimension}"
            if word != CONTACT:
                rule = f"is of a face that is {word}"
                remedy = f'give walls.{face} = "contact", or leave it out'
                yield violation(rule, remedy, path=("box", "friction", face))

    def _narrow_mistakes(self) -> Iterator[PydanticCustomError]:
        if self.box is None:
            return
        for axis, cells in zip("xyz", self.box_cells or (), strict=False):
            faces = (f"{axis}_min", f"{axis}_max")
            if cells < 1 or any(getattr(self.box.walls, face) != CONTACT for face in faces):
                continue
            least, times = cells, 0 if self.coarsening is None else self.coarsening.times
            while times > 0 and least % 2 == 0:
                least, times = least // 2, times - 1
            if least < _FEWEST:
                doubled = ", once they have doubled" if least < cells else ""
                rule = f"has contact on both {axis} faces, {least} cells apart{doubled}"
                remedy = f"give at least {_FEWEST} cells, or make one of the two slip"
                yield violation(rule, remedy, path=("box", "walls"))

    def _box_mistakes(self) -> Iterator[PydanticCustomError]:
        box = self.box
        if box is None:
            return
        for d in range(self.dimension):
            path: Path = ("box", "upper", d)
            cells = (box.upper[d] - box.lower[d]) / self.cell_size
            if cells <= 0:
                rule, remedy = f"must be > lower = {box.lower[d]:g} m", "swap the two corners"
                yield violation(rule, remedy, value=box.upper[d], path=path)
            elif cells > MOST_CELLS:
                rule = f"is {cells:.1e} cells from lower, and {MOST_CELLS:.1e} is the most"
                remedy = (
                    "give a smaller box, or larger cells, or no box: the grid has no bounds then"
                )
                yield violation(rule, remedy, value=box.upper[d], path=path)
            elif cells < 1.0 - _WHOLE:
                size = f"{self.cell_size:g} m"
                rule = f"is less than one cell from lower: grid.cell_size = {size}"
                yield violation(
                    rule, 'a plain number is in m: "2 mm"', value=box.upper[d], path=path
                )
            elif abs(cells - round(cells)) > _WHOLE * max(1.0, cells):
                near = box.lower[d] + max(1, round(cells)) * self.cell_size
                rule = f"must be a whole number of cells from lower (it is {cells:.4f} cells away)"
                yield violation(rule, f"for example {near:.6g} m", value=box.upper[d], path=path)
            elif self.coarsening is not None and round(cells) % 2 != 0:
                rule = (
                    f"is {round(cells)} cells from lower, an odd number, so that grid.coarsening "
                    "cannot work"
                )
                yield violation(rule, "make the box one cell larger along this axis", path=path)
            off = (box.lower[d] - self.origin[d]) / self.cell_size
            if abs(off - round(off)) > _WHOLE * max(1.0, abs(off)):
                rule = "must be a whole number of cells from the box's lower corner"
                remedy = "leave it out, then it is that corner"
                yield violation(rule, remedy, value=self.origin[d], path=("origin", d))
        if self.dimension == 2 and (box.walls.z_min, box.walls.z_max) != ("free", "free"):
            uniform = len({getattr(box.walls, face) for face in FACES}) == 1
            if not uniform:
                rule = "has z faces but the grid is 2D"
                yield violation(rule, "remove z_min and z_max", path=("box", "walls"))

    @property
    def kept(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Corners of the region that particles may be in [m], D numbers each; else infinite."""
        box, far = self.outflow_box, (math.inf,) * self.dimension
        lower = box.lower if box is not None else ()
        upper = box.upper if box is not None else ()
        return lower or tuple(-x for x in far), upper or far

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

    def wall_friction(self, default: float) -> tuple[float, ...]:
        """Coefficients of friction of the six faces, in the order of `walls`; 0 without contact."""
        given = [getattr(self.box.friction, face) if self.box else None for face in FACES]
        return tuple(
            0.0 if word != CONTACT else default if mu is None else mu
            for word, mu in zip(self.walls, given, strict=True)
        )
