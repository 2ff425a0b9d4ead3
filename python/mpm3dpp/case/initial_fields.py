# SPDX-License-Identifier: BSD-3-Clause
"""Stresses and states at places, in a CSV file beside a case file: what a body begins with.

The file's first line names the columns: `x,y,z` (in 2D `x,y`) and behind these any states of one
number, such as `temperature`, and components of the stress, `stress_xx` and so on; units may follow
in brackets, those of the reference. Every other line is a place.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from mpm3dpp.base.csv_points import Layout, digest_of, read_points, short
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.from_file import FromFile, file_entry

Array = NDArray[np.float64]
_LARGEST = 1e100
_GIVE = 'see "Begin under stress" in docs/how-to/run-a-case.md for its columns'
STRESS = "stress_"
_STRESSES = {f"{STRESS}{part}": "Pa" for part in ("xx", "yy", "zz", "yz", "xz", "xy")}


@dataclass(frozen=True)
class _Columns(Layout):
    """Coordinates, and at least one field of any that are known."""

    units: Mapping[str, str] = field(default_factory=dict)

    def dimension_of(self, names: list[str]) -> int | None:
        for dimension in (3, 2):
            rest = names[dimension:]
            if names[:dimension] == list("xyz"[:dimension]) and rest:
                known = all(name in self.units for name in rest)
                return dimension if known and len(set(rest)) == len(rest) else None
        return None

    def unit_of(self, name: str, dimension: int, length: str) -> str:
        return self.units.get(name, length)

    def power_of(self, name: str, dimension: int) -> int:
        return 0 if name in self.units else 1

    def in_words(self) -> str:
        return f"x,y,z and then some of {', '.join(self.units)}, each once"


class InitialFields:
    """Fields at places, linear between them; beyond them those of the nearest place.

    Places that fill a grid of axes, in any order, are interpolated along these one by one, others
    over the triangles or tetrahedra of Delaunay. Along an axis on which all are equal, a field is
    constant: a profile over the depth is a column of places. Coordinates that differ by a millionth
    of the extent are equal.

    Attributes:
        positions: [m], shape (n, D).
        columns: of numbers in SI units by the fields' names, shape (n,) each.
        file: the name by which a case file knows them.
        unit: of the lengths in that file.
    """

    def __init__(
        self, positions: Array, columns: dict[str, Array], file: str = "", unit: str = "m"
    ) -> None:
        self.positions = np.ascontiguousarray(positions, dtype=np.float64)
        self.columns = {
            name: np.asarray(values, dtype=np.float64) for name, values in columns.items()
        }
        self.file, self.unit = file, unit
        self._axes, self._places = _numbered(self.positions)

    @property
    def dimension(self) -> int:
        """Number of coordinates of a place."""
        return int(self.positions.shape[1])

    @property
    def has_stress(self) -> bool:
        """Whether a column is a component of the stress."""
        return any(name.startswith(STRESS) for name in self.columns)

    @cached_property
    def digest(self) -> str:
        """SHA-256 (hexadecimal) of places and fields, numbers to 12 digits, and their names."""
        numbers = np.column_stack([self.positions, *self.columns.values()])
        return f"{','.join(self.columns)}:{digest_of(numbers)}"

    def table(self) -> str | dict[str, str]:
        """Return the value of the key `fields` of a case file."""
        return file_entry(self.file, self.unit)

    def repeated(self) -> tuple[int, int] | None:
        """Return the numbers of the first two places that are one; None if there are none."""
        _, first, number = np.unique(self._places, axis=0, return_index=True, return_inverse=True)
        again = np.flatnonzero(first[number.ravel()] != np.arange(len(self._places)))
        return (int(first[number.ravel()[again[0]]]), int(again[0])) if len(again) else None

    def at(self, positions: Array) -> dict[str, Array]:
        """Return all fields at places (m, D) [m], shape (m,) each.

        Raises:
            ValueError: places that fill no grid of axes lie on a line or in a plane.
        """
        values = np.column_stack(list(self.columns.values()))
        return dict(zip(self.columns, self._at(values, positions).T, strict=True))

    def _at(self, values: Array, positions: Array) -> Array:
        varies = [k for k, axis in enumerate(self._axes) if len(axis) > 1]
        if not varies or not len(positions):
            return np.broadcast_to(values[0], (len(positions), values.shape[1]))
        axes, there = [self._axes[k] for k in varies], positions[:, varies]
        shape = [len(axis) for axis in axes]
        if math.prod(shape) == len(values):
            flat = np.ravel_multi_index(tuple(self._places[:, varies].T), shape)
            if len(np.unique(flat)) == len(values):
                return _on_grid(axes, values[np.argsort(flat)], there)
        return _scattered(self.positions[:, varies], values, there)


_SAME = 1e-6  # of the extent along an axis


def _numbered(positions: Array) -> tuple[list[Array], NDArray[np.int64]]:
    """Return the coordinates along each axis [m], and which of them a place has, shape (n, D)."""
    axes, places = [], np.zeros(positions.shape, dtype=np.int64)
    for k, x in enumerate(positions.T):
        order = np.argsort(x, kind="stable")
        apart = np.diff(x[order]) > _SAME * np.ptp(positions, axis=0).max()
        places[order, k] = np.concatenate([[0], np.cumsum(apart)])
        axes.append(x[order][np.concatenate([[True], apart])])
    return axes, places


def _on_grid(axes: list[Array], values: Array, places: Array) -> Array:
    from scipy.interpolate import RegularGridInterpolator

    inside = np.clip(places, [axis[0] for axis in axes], [axis[-1] for axis in axes])
    table = values.reshape([*(len(axis) for axis in axes), values.shape[1]])
    return np.asarray(RegularGridInterpolator(axes, table)(inside), dtype=np.float64)


def _scattered(points: Array, values: Array, places: Array) -> Array:
    from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator
    from scipy.spatial import QhullError

    flat = "has places on a line or in a plane that is along no axis"
    if points.shape[1] == 1 or len(points) <= points.shape[1]:
        raise ValueError(flat)
    try:
        found = LinearNDInterpolator(points, values)(places)
    except QhullError:
        raise ValueError(flat) from None
    beyond = np.isnan(found).any(axis=1)
    if beyond.any():
        found[beyond] = NearestNDInterpolator(points, values)(places[beyond])
    return np.asarray(found, dtype=np.float64)


def read_fields(path: Path, name: str, unit: str, states: Mapping[str, str]) -> InitialFields:
    """Read a file of fields.

    Args:
        path: the file.
        name: its name in messages and in the case.
        unit: of the lengths in it.
        states: units of the states that a material may have, by name.

    Raises:
        CaseError: the file is missing or malformed; the rule names the line.
    """
    layout = _Columns("", (0, 0), True, False, "place", _GIVE, 100.0, {**states, **_STRESSES})
    points = read_points(path, name, layout, unit)
    columns = {k: v.copy() for k, v in points.columns.items() if k not in "xyz"}
    good = np.all(np.abs(np.stack(list(points.columns.values()))) < _LARGEST, axis=0)
    if not good.all():
        number, line = points.line(int(np.argmin(good)))
        rule = f"must have finite numbers, in line {number} ({short(line)})"
        raise CaseError(rule, _GIVE, value=name)
    found = InitialFields(points.positions, columns, name, unit)
    if (pair := found.repeated()) is not None:
        numbers = [points.line(row)[0] for row in pair]
        rule = f"has one place twice, in lines {numbers[0]} and {numbers[1]}"
        remedy = "leave one out; for a jump move one of them by a thousandth of the extent"
        raise CaseError(rule, remedy, value=name)
    return found


def any_fields(states: Callable[[], Mapping[str, str]]) -> Any:
    """Return the annotation of a key that is a file of fields; `states` gives `read_fields` its."""

    def read(path: Path, name: str, unit: str) -> InitialFields:
        return read_fields(path, name, unit, states())

    from_file = FromFile(InitialFields, read, "places with stresses and states", "fields.csv")
    return Annotated[InitialFields | None, from_file]
