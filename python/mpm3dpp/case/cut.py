# SPDX-License-Identifier: BSD-3-Clause
"""Bodies that are cut at the faces of the box, as behind planes of symmetry."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from pydantic_core import PydanticCustomError

from mpm3dpp.base.errors import violation
from mpm3dpp.shapes import Box, Intersection
from mpm3dpp.shapes.shells import LEAVE_OUT, SHELLS, no_shells, takes_shells

if TYPE_CHECKING:
    from .case import Case


def cut_bodies(case: Case) -> Iterator[PydanticCustomError]:
    """Give bodies that are to be cut the shape that is left; yield those that cannot be cut."""
    box = case.grid.box
    for name, body in case.body.items():
        if not body.cut_at_box:
            continue
        path = ("body", name, "cut_at_box")
        if box is None:
            yield violation("needs a box to cut at", "give grid.box, or remove it", path=path)
        elif body.shape is None:
            rule = "is for a shape, and the particles of this body are given"
            yield violation(rule, "remove it, and give those inside the box", path=path)
        else:
            left = Intersection(shapes=[body.shape, Box(lower=box.lower, upper=box.upper)])
            if body.fill == SHELLS and not takes_shells(left):
                yield violation(no_shells(left), LEAVE_OUT, value=SHELLS, path=(*path[:2], "fill"))
                continue
            # A copy: the user's may be of another case too.
            case.body[name] = body.model_copy(update={"shape": left, "cut_at_box": False})
