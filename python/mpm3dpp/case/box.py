# SPDX-License-Identifier: BSD-3-Clause
"""The table `[grid.box]` of a case: bounds, what its faces do, their friction."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, ValidationError

from mpm3dpp import _core
from mpm3dpp.base.errors import violation
from mpm3dpp.base.model import CaseModel
from mpm3dpp.base.settings import choice
from mpm3dpp.base.units import Point, Quantity

FACES = ("x_min", "x_max", "y_min", "y_max", "z_min", "z_max")

_WALL = choice(_core.walls)
CONTACT = "contact"
"""The word of walls that push back what touches them, with friction."""
HOLDING = {"slip", "fixed"}
"""Of those that hold bodies on nodes of their own that lie on them, and have images of these."""
Wall = Annotated[str, _WALL]


class Walls(CaseModel):
    """What the faces of the box do.

    `free` (nothing), `slip` (or `symmetry`), `fixed`, `absorbing`, `contact`. Nothing parts from a
    `slip` or `fixed` face. A `contact` face pushes back what touches it, with friction
    (`grid.box.friction`), and lets it part: a floor. A rigid body it stops without friction. With
    `frame = "material"` so do `slip` (smooth) and `fixed` (rough) faces what does not lie on them.
    An `absorbing` face lets waves pass, as if the body went on behind it (dashpots, Lysmer &
    Kuhlemeyer 1969); it holds no weight. One word in place of the table holds for all faces. In
    2D there are no z faces.
    """

    x_min: Wall = "free"
    x_max: Wall = "free"
    y_min: Wall = "free"
    y_max: Wall = "free"
    z_min: Wall = "free"
    z_max: Wall = "free"

    @classmethod
    def complete(cls, data: Any) -> Any:
        """Return the table of one word that holds for all faces."""
        if isinstance(data, str):
            word = _WALL.parse(data)
            return dict.fromkeys(FACES, word)
        return data


_Friction = Annotated[float, Quantity("", ">= 0")] | None


class WallFriction(CaseModel):
    """Coulomb's coefficients of faces that are `contact`, where it is not `contact.friction`.

    One number in place of the table holds for all these.
    """

    x_min: _Friction = None
    x_max: _Friction = None
    y_min: _Friction = None
    y_max: _Friction = None
    z_min: _Friction = None
    z_max: _Friction = None


class GridBox(CaseModel):
    """The region of the computation; without it the grid has no bounds.

    Attributes:
        lower, upper: opposite corners [m], D numbers, a whole number of cells apart.
        walls: what the faces do.
        friction: of faces that are `contact`; by default `contact.friction`.
    """

    lower: Point
    upper: Point
    walls: Walls = Field(default_factory=Walls)
    friction: WallFriction = Field(default_factory=WallFriction)

    @classmethod
    def complete(cls, data: Any) -> Any:
        """Return the table with one number for the friction as that of each face that touches."""
        one = data.get("friction") if isinstance(data, dict) else None
        if isinstance(one, bool) or not isinstance(one, int | float | str):
            return data
        try:
            walls = Walls.model_validate(data.get("walls", {}))
        except ValidationError:  # which is told of where the walls are
            return {key: value for key, value in data.items() if key != "friction"}
        lower = data.get("lower")
        axes = "xyz"[: len(lower)] if isinstance(lower, list | tuple) else "xyz"
        faces = [face for face in FACES if face[0] in axes and getattr(walls, face) == CONTACT]
        if not faces:
            rule = "needs a face of grid.box.walls that is contact: it has none"
            raise violation(rule, 'give walls = { y_min = "contact" }', path=("friction",))
        return data | {"friction": dict.fromkeys(faces, one)}
