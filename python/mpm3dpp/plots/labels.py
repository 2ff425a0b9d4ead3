# SPDX-License-Identifier: BSD-3-Clause
"""Numbers for people: metric prefixes, labels of axes and colour bars."""

from __future__ import annotations

import math

import numpy as np

from mpm3dpp.base.errors import CaseError, nearest
from mpm3dpp.io.rows import component_words, field_of

_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
_PREFIXED = {"m", "s", "Pa", "J", "J/m", "N", "N/m", "N s", "N s/m", "J/kg", "W"}

NAMES = {
    "von_mises": "von Mises stress",
    "pressure": "pressure",
    "speed": "speed",
    "body": "body",
    "material": "material",
    "size": "particle size",
}


def prefix(largest: float, unit: str) -> tuple[float, str]:
    """Factor and unit with the metric prefix that suits a largest value.

    Args:
        largest: largest absolute value, in `unit`.
        unit: SI unit; units that take no prefix (m/s, kg/m^3) come back unchanged.

    Returns:
        (factor, unit): value * factor is in the returned unit.
    """
    if unit not in _PREFIXED or not math.isfinite(largest) or largest <= 0.0:
        return 1.0, unit
    power = 3 * math.floor(math.log10(largest * (1 + 1e-9)) / 3)
    power = max(-12, min(12, power))
    if unit == "m":
        power = min(power, 0)
    return 10.0**-power, _PREFIXES[power] + unit


def length_unit(extent: float) -> tuple[float, str]:
    """Factor and unit for coordinates: m, mm (below 1 m) or µm (below 1 mm)."""
    if extent >= 1.0:
        return 1.0, "m"
    return (1e3, "mm") if extent >= 1e-3 else (1e6, "µm")


def scaled(value: float, unit: str, digits: int = 4) -> str:
    """A value with its prefix, for example `scaled(0.00125, "s")` is `1.25 ms`."""
    factor, text = prefix(abs(value), unit)
    return f"{value * factor:.{digits}g} {text}"


def short(name: str, most: int = 28) -> str:
    """A name for a title or a legend, its middle left out where it has more letters than `most`."""
    if len(name) <= most:
        return name
    half = (most - 1) // 2
    return f"{name[:half]}\N{HORIZONTAL ELLIPSIS}{name[-half:]}"


def at_time(time: float, end: float) -> str:
    """A time for a title, in the unit that suits the whole run, always with the same digits."""
    factor, unit = prefix(end, "s")
    return f"t = {time * factor:.{2 if end * factor >= 10 else 3}f} {unit}"


def choose(
    arrays: dict[str, np.ndarray], units: dict[str, str], colour: str
) -> tuple[np.ndarray, str, str]:
    """The values that colour the particles.

    Args:
        arrays: of a frame.
        units: name -> unit.
        colour: an array, a vector's or tensor's component ("velocity_x", "stress_xy"),
            or "speed". A whole vector means its length.

    Returns:
        values (n,), name for the colour bar, unit.

    Raises:
        CaseError: the frame has no such array.
    """
    if colour == "speed":
        colour = "velocity"
    if colour in arrays:
        values, unit = arrays[colour], units.get(colour, "")
        if values.ndim == 1:
            return values, NAMES.get(colour, colour.replace("_", " ")), unit
        name = "speed" if colour == "velocity" else f"length of {colour.replace('_', ' ')}"
        return np.linalg.norm(values, axis=1), name, unit
    component = field_of(arrays, colour)
    if component is not None:
        name, _, axis = colour.rpartition("_")
        return component, f"{name.replace('_', ' ')} {axis}", units.get(name, "")
    parts = [
        f"{name}_{word}"
        for name, array in arrays.items()
        if array.ndim == 2 and name != "position"
        for word in component_words(array.shape[1])
    ]
    known = [*(name for name in arrays if name != "position"), "speed", *parts]
    remedy = (
        f"{nearest(colour, known)}; others are written where output.fields of the case names them"
    )
    raise CaseError(f"'{colour}' is not an array of these results", remedy)
