# SPDX-License-Identifier: BSD-3-Clause
"""What is left of round shapes that are bored about their axis, or cut through their middle.

It is round too: a disc with a hole is a ring, and a half, a quarter or an eighth has that part of
the shells of the whole, if no point of these lies on the cuts.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from .base import Bounds, Shape
from .booleans import Difference, Intersection
from .faces import quarter_turn
from .primitives import AXES, Box, Cylinder, Disc, Ring, Sphere, Tube
from .transforms import Rotate, Translate

Round = Disc | Ring | Cylinder | Tube  # A sphere is a disc by its class.
_SAME = 1e-6  # Of the radius: lengths that are to be equal, and places.


class CutRound(NamedTuple):
    """A round shape, or a part of it.

    Attributes:
        whole: before it was cut.
        kept: of each axis 0, or 1 or -1 if only what is above or below the middle is left.
        moves: what has moved and turned that, the last one first.
    """

    whole: Round
    kept: tuple[int, ...]
    moves: tuple[Translate | Rotate, ...] = ()

    @property
    def parts(self) -> int:
        """How many such parts make up the whole."""
        return int(2 ** np.count_nonzero(self.kept))

    def volume(self) -> float:
        """Return its volume [m^3; in 2D m^2]."""
        return self.whole.volume() / self.parts

    def bounds(self) -> Bounds:
        """Return the corners of a box around it before it was moved [m]."""
        lower, upper = self.whole.bounds()
        centre, kept = np.array(self.whole.centre), np.array(self.kept)
        return np.where(kept > 0, centre, lower), np.where(kept < 0, centre, upper)


def round_of(shape: Shape) -> CutRound | None:
    """Return the round shape that a shape is, or is a part of; None for others."""
    if isinstance(shape, Round):
        return CutRound(shape, (0,) * len(shape.centre))
    if isinstance(shape, Translate | Rotate):
        inner = round_of(shape.shape)
        return None if inner is None else inner._replace(moves=(shape, *inner.moves))
    if isinstance(shape, Difference):
        found = _at_rest(round_of(shape.shapes[0]))
        for other in shape.shapes[1:]:
            found = None if found is None else _without(found, other)
        return found
    if isinstance(shape, Intersection):
        rounds = [k for k, one in enumerate(shape.shapes) if round_of(one) is not None]
        if len(rounds) != 1:
            return None
        found = _at_rest(round_of(shape.shapes[rounds[0]]))
        for other in shape.shapes[: rounds[0]] + shape.shapes[rounds[0] + 1 :]:
            found = None if found is None else _within(found, other)
        return found
    return None


def was_round(shape: Shape) -> bool:
    """Return whether a shape is made of a round one by boring and cutting, whatever is left."""
    if isinstance(shape, Translate | Rotate):
        return was_round(shape.shape)
    if isinstance(shape, Difference):
        return was_round(shape.shapes[0])
    if isinstance(shape, Intersection):
        return any(was_round(one) for one in shape.shapes)
    return isinstance(shape, Round)


def _at_rest(found: CutRound | None) -> CutRound | None:
    """Return the same where it is now, without moves; None if its axes are oblique."""
    if found is None:
        return None
    whole, kept = found.whole, found.kept
    for move in reversed(found.moves):
        centre = np.array(whole.centre)
        if isinstance(move, Translate):
            centre = centre + np.array(move.by)
        elif type(whole) in (Disc, Ring, Sphere) and not any(kept):
            centre = move.matrix() @ (centre - move.centre()) + move.centre()
        else:
            return None
        whole = whole.model_copy(update={"centre": tuple(centre.tolist())})
    return CutRound(whole, kept)


def _outer(whole: Round) -> float:
    return whole.outer_radius if isinstance(whole, Ring | Tube) else whole.radius


def _only_box(shape: Shape) -> Bounds | None:
    inner = shape
    while isinstance(inner, Translate | Rotate):
        if isinstance(inner, Rotate) and not quarter_turn(inner):
            return None
        inner = inner.shape
    return shape.bounds() if isinstance(inner, Box) else None


def _within(found: CutRound, other: Shape) -> CutRound | None:
    """Return what is left of a round shape in a box; None if that is no part of one."""
    if isinstance(other, Intersection):
        part: CutRound | None = found
        for one in other.shapes:
            part = None if part is None else _within(part, one)
        return part
    box = _only_box(other)
    if box is None:
        return None
    near = _SAME * _outer(found.whole)
    for axis in range(len(found.kept)):
        for sign, face in ((1, box[0][axis]), (-1, box[1][axis])):
            cut = _cut(found, axis, sign, face, near)
            if cut is None:
                return None
            found = cut
    return found


def _cut(found: CutRound, axis: int, sign: int, face: float, near: float) -> CutRound | None:
    """Return what is left beyond a plane across an axis, on the side of a sign."""
    whole, (lower, upper) = found.whole, found.bounds()
    first, last = (lower[axis], upper[axis]) if sign > 0 else (upper[axis], lower[axis])
    if sign * (face - first) <= near:
        return found  # All of it.
    if sign * (last - face) <= near:
        return None  # Nothing.
    if isinstance(whole, Cylinder | Tube) and axis == AXES[whole.axis]:
        centre = list(whole.centre)
        centre[axis] = 0.5 * (face + last)
        update = {"centre": tuple(centre), "height": abs(last - face)}
        return found._replace(whole=whole.model_copy(update=update))
    if abs(face - whole.centre[axis]) > near:
        return None
    return found._replace(kept=tuple(sign if d == axis else k for d, k in enumerate(found.kept)))


def _without(found: CutRound, other: Shape) -> CutRound | None:
    """Return what a shape leaves of a round one; None if that is no part of one."""
    lower, upper = found.bounds()
    near = _SAME * _outer(found.whole)
    low, high = other.bounds()
    if np.any(high <= lower + near) or np.any(low >= upper - near):
        return found
    box = _only_box(other)
    if box is not None:
        # A box takes one side of a plane if it holds all of that side.
        short = [
            (d, s)
            for d in range(len(lower))
            for s, is_short in ((1, high[d] < upper[d] - near), (-1, low[d] > lower[d] + near))
            if is_short
        ]
        if len(short) != 1:
            return None
        [(axis, sign)] = short
        return _cut(found, axis, sign, float(high[axis] if sign > 0 else low[axis]), near)
    bore = _at_rest(round_of(other))
    return None if bore is None or any(bore.kept) else _bored(found, bore.whole, near)


def _bored(found: CutRound, bore: Round, near: float) -> CutRound | None:
    """Return a round shape with a hole all along its axis."""
    whole = found.whole
    if isinstance(bore, Ring | Tube | Sphere) or isinstance(whole, Sphere):
        return None
    apart = np.abs(np.array(whole.centre) - np.array(bore.centre))
    if isinstance(whole, Cylinder | Tube):
        assert isinstance(bore, Cylinder)
        axis = AXES[whole.axis]
        if bore.axis != whole.axis or apart[axis] + 0.5 * whole.height > 0.5 * bore.height + near:
            return None
        apart[axis] = 0.0
    inner = whole.inner_radius if isinstance(whole, Ring | Tube) else 0.0
    if apart.max() > near or bore.radius >= _outer(whole) - near:
        return None
    if bore.radius <= inner + near:
        return found
    radii = {"centre": whole.centre, "inner_radius": bore.radius, "outer_radius": _outer(whole)}
    if isinstance(whole, Cylinder | Tube):
        return found._replace(whole=Tube(**radii, height=whole.height, axis=whole.axis))
    return found._replace(whole=Ring(**radii))
