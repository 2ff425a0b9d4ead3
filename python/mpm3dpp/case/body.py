# SPDX-License-Identifier: BSD-3-Clause
"""A table `[body.NAME]` of a case."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import model_validator

from mpm3dpp.base.damping import Damping
from mpm3dpp.base.errors import violation
from mpm3dpp.base.expression import ForceField, SpinField, TotalForce, VelocityField
from mpm3dpp.base.frames import ALONG, AUTO, FRAMES, UPDATED, particles_along
from mpm3dpp.base.model import CaseModel, Choice, Count, Flag, Text
from mpm3dpp.base.units import PositiveLength
from mpm3dpp.shapes.base import MaybeShape
from mpm3dpp.shapes.cut_round import round_of, was_round
from mpm3dpp.shapes.faces import FACES, has_faces
from mpm3dpp.shapes.primitives import Disc
from mpm3dpp.shapes.shells import (
    LATTICE,
    LEAVE_OUT,
    SHELLS,
    WAYS,
    default_way,
    no_shells,
    takes_shells,
)

from .grid import Grid
from .initial import Initial
from .motion import MaybeMotion
from .particles import AnyParticles


class Body(CaseModel):
    """A body: a shape filled with particles of one material, or the particles one by one.

    Attributes:
        material: name of its material.
        shape: any shape of `mpm3dpp.shapes`; in place of `particles`.
        particles: a CSV file beside the case file with the columns x, y, z and, if it likes,
            volume and vx, vy, vz, in SI units, or `{ file = "points.csv", unit = "mm" }`, the unit
            of its lengths (in Python: `mpm3dpp.Particles`); in place of `shape`.
        particles_per_cell: particles per cell along each direction; default 2, and 3 of a disc or a
            ball of less than 8 cells a radius whose frame is "material", as cut cells vibrate.
        spacing: distance of the particles [m], in place of `particles_per_cell`.
        fill: how particles fill the shape: "shells", circles and spheres about the middle, the
            default for a disc, ring, sphere, cylinder or tube, also moved, turned, bored or cut
            through its middle; "faces", a lattice whose cells end at flat faces, the default for
            boxes and what else has some across its axes, also turned; or "lattice", a lattice that
            is aligned with the grid's origin, for all others.
        cut_at_box: leave out what of the shape lies beyond the faces of `grid.box`, as of a ball
            behind planes of symmetry.
        velocity: initial velocity [m/s], D numbers or formulas of x, y, z, r; default zero.
        angular_velocity: initial spin about the mass centre [rad/s]: one number or formula in 2D,
            three in 3D; default zero. Stored as a tuple.
        initial: the stress and the state that it begins with; None for none.
        body_force: force per mass beside gravity [m/s^2], D numbers or formulas of the present
            place x, y, z, the place at the start X, Y, Z and the time t; None for none.
        force: force on all of it [N; in 2D N per metre of thickness], shared out by mass, D numbers
            or formulas of the time t; None for none.
        damping: what damps its motion beside its material, in proportion to the mass or locally;
            None for nothing.
        frame: where its nodes lie: in space, "updated", where any flow is possible; in the body,
            "material", where they keep its motion and nothing of it is lost (no fluids, nothing
            that erodes); or, "auto", in the body where its material, what it may touch and how
            fast, and the rest of the case allow that.
        motion: "fixed", or a motion that the body has whatever acts on it; it does not deform
            then; None for a body that is free to move.
    """

    material: Text
    shape: MaybeShape = None
    particles: AnyParticles = None
    particles_per_cell: Count | None = None
    spacing: PositiveLength | None = None
    fill: Annotated[str, Choice(WAYS)] | None = None
    cut_at_box: Flag = False
    velocity: VelocityField = ()
    angular_velocity: SpinField = ()
    initial: Initial | None = None
    body_force: ForceField | None = None
    force: TotalForce | None = None
    damping: Damping | None = None
    frame: Annotated[str, Choice(FRAMES)] = AUTO
    motion: MaybeMotion = None

    @model_validator(mode="after")
    def _one_spacing(self) -> Body:
        if self.particles_per_cell is not None and self.spacing is not None:
            rule = "must not be given together with particles_per_cell"
            raise violation(rule, "keep one of the two", path=("spacing",))
        given = "spacing" if self.spacing is not None else "particles_per_cell"
        if self.particles is not None and self.particles.volumes is not None:
            if getattr(self, given) is not None:
                rule = "must not be given together with particles that have volumes"
                raise violation(rule, "remove it", path=(given,))
        elif getattr(self, given) is None and self.frame == UPDATED:
            self.__dict__["particles_per_cell"] = ALONG
        return self

    @model_validator(mode="after")
    def _shape_or_particles(self) -> Body:
        if self.shape is not None and self.particles is not None:
            rule = "must not be given together with shape"
            raise violation(rule, "keep one of the two", path=("particles",))
        if self.shape is None and self.particles is None:
            remedy = "add this key, or particles, the name of a file"
            raise violation("is missing", remedy, path=("shape",))
        return self

    @model_validator(mode="after")
    def _fill_suits_shape(self) -> Body:
        if self.fill is not None and self.shape is None:
            rule = "must not be given together with particles"
            raise violation(rule, "remove it", value=self.fill, path=("fill",))
        if self.fill == SHELLS and self.shape is not None and not takes_shells(self.shape):
            raise violation(no_shells(self.shape), LEAVE_OUT, value=self.fill, path=("fill",))
        if self.fill == FACES and self.shape is not None and not has_faces(self.shape):
            rule = "is for what has flat faces along the axes, and the shape has none"
            raise violation(rule, LEAVE_OUT, value=self.fill, path=("fill",))
        return self

    def filled_by(self, preset: str | None = None) -> str:
        """Return "shells", "faces" or "lattice": what fills the shape in a case of a preset."""
        if self.fill is not None or self.shape is None:
            return self.fill or LATTICE
        return LATTICE if preset is not None else default_way(self.shape)

    def is_weighted(self, preset: str | None = None) -> bool:
        """Return whether the volumes of its particles are made such that the mass is the shape's.

        That is so for what was round before it was cut so that shells cannot fill it.
        """
        if self.shape is None or self.fill is not None or preset is not None:
            return False
        return self.filled_by() != SHELLS and was_round(self.shape)

    @property
    def filling(self) -> str:
        """The key that gives its particles: "shape" or "particles"."""
        return "shape" if self.shape is not None else "particles"

    def particle_spacing(self, grid: Grid) -> float:
        """Return the distance of neighbouring particles [m]."""
        edge = self.particles.edge() if self.particles is not None else None
        if edge is not None:
            return edge
        if self.spacing is not None:
            return self.spacing
        along = self.particles_per_cell
        return grid.cell_size / (
            along or particles_along(self.frame, self._radius() / grid.cell_size)
        )

    def _radius(self) -> float:
        """Return the radius of a disc or ball, or of a part of one [m]; infinity of others."""
        found = None if self.shape is None else round_of(self.shape)
        whole = None if found is None else found.whole
        return whole.radius if isinstance(whole, Disc) else math.inf  # of which spheres are kinds
