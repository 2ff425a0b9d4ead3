# SPDX-License-Identifier: BSD-3-Clause
"""How particles are drawn: section, view, crop, range of colours, size, arrows; checked here alone.

>>> look_of(section="y=5 mm", view="-30,20").section
(1, 0.005)
"""

from __future__ import annotations

import contextlib
import dataclasses
import re
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from mpm3dpp.base import arguments
from mpm3dpp.base.errors import CaseError

from .labels import length_unit

_AXES = "xyz"
_LEAST, _MOST = 100, 10_000  # Pixels along a side of a picture.
_FROM = (0.55, -1.0, 0.55)  # Where the viewer stands if nothing is said: in front, right, above.
_EDGE_ON = (
    1e-6  # A plane that the viewer sees at a smaller sine of the angle is seen from its edge.
)


@dataclasses.dataclass(frozen=True)
class Look:
    """How particles are drawn; `look_of` makes it.

    Attributes:
        section: axis, 0 to 2, and place [m] of a plane: what lies on its near side is cut away.
        view: azimuth and elevation of the viewer [degrees].
        crop: lower and upper corner of the region that is drawn [m], two or three numbers each.
        range: lowest and highest value of the colours, numbers in SI units or text with a unit.
        size: width and height of the picture [pixels].
        arrows: whether arrows show velocities.
    """

    section: tuple[int, float] | None = None
    view: tuple[float, float] | None = None
    crop: tuple[tuple[float, ...], tuple[float, ...]] | None = None
    range: tuple[Any, Any] | None = None
    size: tuple[int, int] | None = None
    arrows: bool = False

    def check(self, dimension: int) -> None:
        """Raise `CaseError` for what results of a dimension cannot have."""
        for name in ("section", "view") if dimension == 2 else ():
            if getattr(self, name) is not None:
                raise CaseError("is for 3D, and these results are 2D", "leave it out", key=name)
        if self.crop is not None and len(self.crop[0]) > dimension:
            rule = "has six numbers, and these results are 2D"
            raise CaseError(rule, "write X0,X1,Y0,Y1", key="crop")
        if self.section is not None and not self._near_side():
            axis = _AXES[self.section[0]]
            rule = f"is a plane {axis} = constant, which this view sees from its edge"
            raise CaseError(rule, "choose another view", key="section")

    def near(self, positions: np.ndarray, margin: float = 0.0) -> np.ndarray | None:
        """Return which particles are neither cut away nor cropped, shape (n,); None for all.

        Args:
            positions: (n, 3) [m].
            margin: particles so far out of the crop stay [m].
        """
        stays: np.ndarray | None = None
        if self.crop is not None:
            lower, upper = (np.array(corner) for corner in self.crop)
            inside = positions[:, : len(lower)]
            within = (inside >= lower - margin) & (inside <= upper + margin)
            stays = np.all(within, axis=1)
        if self.section is not None:
            axis, place = self.section
            behind = np.asarray((positions[:, axis] - place) * self._near_side() <= 0.0)
            stays = behind if stays is None else stays & behind
        return stays

    def range_in(self, unit: str) -> tuple[float, float] | None:
        """Return the range of the colours in a unit; None if it is not given.

        Raises:
            CaseError: it has another unit, or its first value is not below its second.
        """
        if self.range is None:
            return None
        low, high = (arguments.quantity("range", _plain(value), unit) for value in self.range)
        if low >= high:
            raise _not_rising(self.range)
        return low, high

    @property
    def words(self) -> str:
        """What a title says of it: the section; empty for none."""
        if self.section is None:
            return ""
        axis, place = self.section
        factor, unit = length_unit(abs(place))
        at = f"{place * factor:.4g} {unit}" if place else "0"
        return f"section {_AXES[axis]} = {at}".replace("-", "\N{MINUS SIGN}")

    def _near_side(self) -> int:
        """On which side of the section's plane the viewer is, 1 or -1; 0 on neither."""
        assert self.section is not None
        towards = float(directions(self.view)[2][self.section[0]])
        return 0 if abs(towards) < _EDGE_ON else 1 if towards > 0.0 else -1


PLAIN = Look()


def directions(view: tuple[float, float] | None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unit vectors to the right and up in the picture and to the viewer; z is never turned.

    Args:
        view: azimuth and elevation [degrees]: from the azimuth 0 one looks along -x, from -90
            along y; from the elevation 90 down. None for in front, right and above.
    """
    if view is None:
        towards = np.array(_FROM) / np.linalg.norm(_FROM)
        right = np.array([-towards[1], towards[0], 0.0]) / np.hypot(towards[0], towards[1])
    else:
        azimuth, elevation = np.radians(view)
        across = np.cos(elevation)
        towards = np.array([across * np.cos(azimuth), across * np.sin(azimuth), np.sin(elevation)])
        right = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    return right, np.cross(towards, right), towards


def look_of(
    section: Any = None,
    view: Any = None,
    crop: Any = None,
    range: Any = None,
    size: Any = None,
    arrows: bool = False,
) -> Look:
    """Return how particles are drawn, of text as on the command line or of numbers.

    Args:
        section: `"y=5 mm"` or `{"y": 0.005}`.
        view: `"-30,20"` or `(-30, 20)`.
        crop: `"0,10 mm,0,5 mm"` or `(0, 0.01, 0, 0.005)`; four numbers or, in 3D, four or six.
        range: `"0,1"`, `"0,20 MPa"` or `(0, 20e6)`.
        size: `"1920x1080"` or `(1920, 1080)`.
        arrows: whether arrows show velocities.

    Raises:
        CaseError: one of them is wrong; `key` names it.
    """
    return Look(
        section=None if section is None else _section(section),
        view=None if view is None else _view(view),
        crop=None if crop is None else _crop(crop),
        range=None if range is None else _range(range),
        size=None if size is None else _size(size),
        arrows=bool(arrows),
    )


@contextlib.contextmanager
def named_as_options() -> Iterator[None]:
    """Let mistakes inside the block name options of the command: `--crop` in place of `crop`."""
    names = {field.name for field in dataclasses.fields(Look)} | {"movie"}
    try:
        yield
    except CaseError as error:
        if error.key not in names:
            raise
        option = f"--{error.key}"
        raise CaseError(error.rule, error.remedy, key=option, value=error.value) from None


def _section(value: Any) -> tuple[int, float]:
    given = value
    if isinstance(value, str):
        axis, _, place = (part.strip() for part in value.partition("="))
        value = {axis: place}
    give = "write an axis and a place, such as y=0 or z=5 mm"
    if not isinstance(value, Mapping) or len(value) != 1:
        raise CaseError("must be one plane", give, key="section", value=given)
    ((axis, place),) = value.items()
    if axis not in (*_AXES,) or place == "":
        raise CaseError("must be x, y or z = a place", give, key="section", value=given)
    return _AXES.index(axis), _quantity("section", place, "m", given)


def _view(value: Any) -> tuple[float, float]:
    give = "write azimuth and elevation in degrees, such as -30,20"
    parts = _parts("view", value, (2,), give)
    azimuth, elevation = (_quantity("view", part, "", value) for part in parts)
    if not (abs(azimuth) <= 360.0 and abs(elevation) <= 90.0):
        rule = "must have an azimuth from -360 to 360 and an elevation from -90 to 90"
        raise CaseError(rule, give, key="view", value=value)
    return azimuth, elevation


def _crop(value: Any) -> tuple[tuple[float, ...], tuple[float, ...]]:
    give = "write X0,X1,Y0,Y1 and, in 3D, Z0,Z1 if you like, such as 0,10 mm,0,5 mm"
    parts = _parts("crop", value, (4, 6), give)
    ends = [_quantity("crop", part, "m", value) for part in parts]
    lower, upper = tuple(ends[::2]), tuple(ends[1::2])
    for axis, low, high in zip(_AXES, lower, upper, strict=False):
        if low >= high:
            rule = f"must have {axis.upper()}0 < {axis.upper()}1"
            raise CaseError(rule, give, key="crop", value=value)
    return lower, upper


def _range(value: Any) -> tuple[Any, Any]:
    give = "write the lowest and the highest value, such as 0,20 MPa"
    low, high = (_plain(part) for part in _parts("range", value, (2,), give))
    if not isinstance(low, str) and not isinstance(high, str) and not low < high:
        raise _not_rising(value)
    return low, high


def _not_rising(value: Any) -> CaseError:
    rule = "must have its lowest value first, below the highest"
    return CaseError(rule, "swap them, or give two that differ", key="range", value=value)


def _size(value: Any) -> tuple[int, int]:
    parts = value
    if isinstance(value, str):
        match = re.fullmatch(r"\s*(\d{1,6})\s*[xX\N{MULTIPLICATION SIGN}]\s*(\d{1,6})\s*", value)
        parts = None if match is None else [int(match[1]), int(match[2])]
    rule = f"must be WIDTHxHEIGHT in pixels, each {_LEAST} to {_MOST}"
    refused = CaseError(rule, "write 1920x1080", key="size", value=value)
    if isinstance(parts, str) or not hasattr(parts, "__len__") or len(parts) != 2:
        raise refused
    try:
        width, height = (arguments.whole_number("size", part, _LEAST, _MOST) for part in parts)
    except CaseError:
        raise refused from None
    return width, height


def _parts(name: str, value: Any, counts: tuple[int, ...], give: str) -> list[Any]:
    """Return the parts of text with commas, or the items of a list."""
    parts = value.split(",") if isinstance(value, str) else value
    if not hasattr(parts, "__len__") or len(parts) not in counts:
        many = " or ".join({2: "two", 4: "four", 6: "six"}[count] for count in counts)
        raise CaseError(f"must have {many} numbers", give, key=name, value=value)
    return list(parts)


def _plain(value: Any) -> Any:
    """Return a number that was given as text; other text, which may have a unit, as it is."""
    if not isinstance(value, str):
        return value
    with contextlib.suppress(ValueError):
        return float(value)
    return value.strip()


def _quantity(name: str, part: Any, unit: str, whole: Any) -> float:
    """Return a part as a finite number; a mistake shows the whole that was given."""
    try:
        return arguments.quantity(name, _plain(part), unit)
    except CaseError as error:
        raise CaseError(error.rule, error.remedy, key=name, value=whole) from None
