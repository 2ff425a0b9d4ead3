# SPDX-License-Identifier: BSD-3-Clause
"""The table `[grains.NAME]` of a case: thousands of discs or spheres, each a body of its own."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from mpm3dpp.base.damping import Damping
from mpm3dpp.base.errors import CaseError, Path, violation
from mpm3dpp.base.expression import ForceField, SpinField, TotalForce, VelocityField
from mpm3dpp.base.frames import ALONG, AUTO, FRAMES, UPDATED, particles_along
from mpm3dpp.base.machine import BODY_BYTES, MEMORY, memory_text
from mpm3dpp.base.model import CaseModel, Choice, Count, Text
from mpm3dpp.base.units import Point, PositiveLength
from mpm3dpp.shapes.shells import DEFAULT, LATTICE, SHELLS
from mpm3dpp.shapes.shells import GRAIN_WAYS as FILLS

from .centres import AnyCentres
from .packed import GrainPacking, Lengths, Wrong, needs
from .packing import MOST_GRAINS

Array = NDArray[np.float64]

WAYS = ("lattice", "packing", "file")
"""The keys that say where grains stand; exactly one is given."""

_TOUCH = 1e-9  # Equal grains may touch: the spacing may miss the diameter by this share.


class GrainLattice(CaseModel):
    """Equal grains in rows: one in the middle of each square or cubic cell of a lattice.

    Attributes:
        lower: the lattice's lower corner [m], D numbers.
        count: number of grains along each axis, D whole numbers.
        radius: of the grains [m].
        spacing: distance of neighbouring centres [m], one number or D; default 2 radius, so that
            they touch.
    """

    lower: Point
    count: list[Count]
    radius: PositiveLength
    spacing: Lengths = ()

    @model_validator(mode="after")
    def _no_overlap(self) -> GrainLattice:
        for d, spacing in enumerate(self.spacing):
            if spacing < 2 * self.radius * (1 - _TOUCH):
                rule = f"must be >= 2 radius = {2 * self.radius:g} m, else the grains overlap"
                path: Path = ("spacing",) if len(self.spacing) == 1 else ("spacing", d)
                raise violation(rule, "give a larger spacing", value=spacing, path=path)
        return self

    def wrong_dimension(self, dimension: int) -> Wrong | None:
        """Return (path, rule, remedy) of the first key with too few or too many numbers."""
        for name, given in (("lower", self.lower), ("count", self.count)):
            if len(given) != dimension:
                return needs(name, len(given), dimension)
        if len(self.spacing) not in (0, 1, dimension):
            return needs("spacing", len(self.spacing), dimension)
        return None

    def ends(self) -> tuple[Array, Array]:
        """Return the lowest and the highest centre along each axis [m], shape (D,)."""
        count = np.asarray(self.count, dtype=float)
        spacing = np.asarray(self.spacing or (2 * self.radius,))
        return self.lower + 0.5 * spacing, self.lower + (count - 0.5) * spacing

    def place(self, dimension: int) -> tuple[Array, Array]:
        """Return centres [m], shape (n, D), and radii [m], shape (n,); the last axis is fastest."""
        spacing = np.broadcast_to(np.asarray(self.spacing or (2 * self.radius,)), (dimension,))
        axes = [(np.arange(n) + 0.5) * s for n, s in zip(self.count, spacing, strict=True)]
        mesh = np.meshgrid(*axes, indexing="ij")
        centres = np.asarray(self.lower) + np.stack([x.ravel() for x in mesh], axis=1)
        return centres, np.full(len(centres), self.radius)


class Grains(CaseModel):
    """Many discs (2D) or spheres (3D) of one material, each a body of its own: NAME_0000, ...

    Where they stand is given by exactly one of `lattice`, `packing` and `file`.

    Attributes:
        material: name of their material.
        lattice: equal grains in rows.
        packing: grains at random places, of one size or many.
        file: a CSV file beside the case file with the columns x, y, z (in 2D without z) and
            radius, in SI units, or `{ file = "grains.csv", unit = "mm" }` (in Python:
            `mpm3dpp.GrainCentres`).
        particles_per_cell: particles per cell along each direction; default 2, and 3 of grains of
            less than 8 cells a radius whose frame is "material".
        spacing: distance of the particles of a grain [m], in place of `particles_per_cell`.
        fill: "shells": circles or spheres about the middle of each grain, turned differently from
            grain to grain, the default without `align`; or "lattice".
        align: how a lattice stands in each grain: "between" (its centre is in the middle between
            particles, the default) and "particle" (a particle at its centre) fill equal grains
            alike; "grid" (on the grid's lattice, as bodies) does not.
        velocity: initial velocity of all [m/s], D numbers or formulas of x, y, z, r; default zero.
        angular_velocity: initial spin of each about its own centre [rad/s]: one number or formula
            in 2D, three in 3D; default zero. Stored as a tuple.
        body_force: force per mass of all beside gravity [m/s^2], D numbers or formulas of x, y, z,
            the place at the start X, Y, Z and the time t; None for none.
        force: force on all of them together [N; in 2D N per metre of thickness], shared out by
            mass, D numbers or formulas of the time t; None for none.
        damping: what damps their motion beside their material, in proportion to the mass or
            locally; None for nothing.
        frame: where their nodes lie, "updated" (in space), "material" (in each of them) or "auto"
            (as body.NAME.frame).
    """

    material: Text
    lattice: GrainLattice | None = None
    packing: GrainPacking | None = None
    file: AnyCentres = None
    particles_per_cell: Count | None = None
    spacing: PositiveLength | None = None
    fill: Annotated[str, Choice(FILLS)] | None = None
    align: Annotated[str, Choice(("between", "particle", "grid"))] | None = None
    velocity: VelocityField = ()
    angular_velocity: SpinField = ()
    body_force: ForceField | None = None
    force: TotalForce | None = None
    damping: Damping | None = None
    frame: Annotated[str, Choice(FRAMES)] = AUTO

    @model_validator(mode="after")
    def _one_way(self) -> Grains:
        given = [way for way in WAYS if getattr(self, way) is not None]
        if len(given) != 1:
            found = f"it has {' and '.join(given)}" if given else "it has none"
            rule = "must have exactly one of lattice, packing and file"
            raise violation(rule, f"{found}; add or remove one")
        if self.particles_per_cell is not None and self.spacing is not None:
            rule = "must not be given together with particles_per_cell"
            raise violation(rule, "keep one of the two", path=("spacing",))
        if self.particles_per_cell is None and self.spacing is None and self.frame == UPDATED:
            self.__dict__["particles_per_cell"] = ALONG
        if self.fill == SHELLS and self.align is not None:
            rule = f'goes with fill = "{LATTICE}" only'
            raise violation(rule, "remove one of the two", value=self.align, path=("align",))
        count = self.count if self.packing is None else len(self.packing.drawn())
        need = count * BODY_BYTES
        if count > MOST_GRAINS or need > MEMORY:
            rule = f"would be more than {MOST_GRAINS:,} grains"
            if count <= MOST_GRAINS:
                rule = (
                    f"would be {count:,} grains, which need {memory_text(need)} of memory at "
                    f"least, and there are {memory_text(MEMORY)}"
                )
            remedy = "give fewer, or write lengths with their unit (a plain number is in metres)"
            raise violation(rule, remedy, path=(self.filling,))
        return self

    def filled_by(self, preset: str | None = None) -> str:
        """Return "shells" or "lattice": what fills the grains in a case of a preset."""
        said = LATTICE if preset is not None or self.align is not None else DEFAULT
        return self.fill or said

    @property
    def filling(self) -> str:
        """The key that says where the grains stand: "lattice", "packing" or "file"."""
        return next(way for way in WAYS if getattr(self, way) is not None)

    @property
    def count(self) -> int:
        """Number of grains, known without placing them."""
        if self.lattice is not None:
            return math.prod(self.lattice.count)
        if self.packing is not None:
            return len(self.radii())
        return 0 if self.file is None else len(self.file.radii)

    def radii(self) -> Array:
        """Return the radii [m], shape (n,), known without placing the grains, but in a shape.

        Raises:
            CaseError: a packing cannot be made; its key is below the entry.
        """
        if self.packing is not None:
            try:
                return self.packing.radii()
            except CaseError as error:
                raise CaseError(error.rule, error.remedy, key="packing") from None
        if self.file is not None:
            return self.file.radii
        assert self.lattice is not None
        return np.broadcast_to(self.lattice.radius, (self.count,))

    def names(self, name: str) -> list[str]:
        """Return the names of the bodies, `sand_0000`, ... for the entry `sand`."""
        count = self.count
        digits = max(4, len(str(count - 1)))
        return [f"{name}_{k:0{digits}d}" for k in range(count)]

    def particle_spacing(self, grid: Any) -> float:
        """Return the distance of neighbouring particles [m]."""
        if self.spacing is not None:
            return self.spacing
        along = self.particles_per_cell
        if along is None:
            along = particles_along(self.frame, float(self.radii().max()) / grid.cell_size)
        return float(grid.cell_size / along)

    def place(self, dimension: int) -> tuple[Array, Array]:
        """Return centres [m], shape (n, D), and radii [m], shape (n,).

        Raises:
            CaseError: a packing cannot be made; its key is below the entry.
        """
        if self.file is not None:
            return self.file.centres, self.file.radii
        try:
            return (self.lattice or self.packing).place(dimension)  # type: ignore[union-attr]
        except CaseError as error:
            raise CaseError(error.rule, error.remedy, key="packing") from None

    def wrong_dimension(self, dimension: int) -> Wrong | None:
        """Return (path, rule, remedy) of the first key that does not suit 2D or 3D."""
        if self.file is not None:
            if self.file.dimension == dimension:
                return None
            rule = f"must have {dimension} coordinates, as grid.dimension = {dimension}"
            return ("file",), rule, f"it has {self.file.dimension}"
        wrong = (self.lattice or self.packing).wrong_dimension(dimension)  # type: ignore[union-attr]
        return None if wrong is None else ((self.filling, *wrong[0]), wrong[1], wrong[2])
