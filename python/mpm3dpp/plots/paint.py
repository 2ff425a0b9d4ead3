# SPDX-License-Identifier: BSD-3-Clause
"""The colours of particles: their range without debris, the colour bar, colours of bodies."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np

from .labels import choose, prefix
from .style import body_colours, colour_scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .frames import View

BY_NAME = ("body", "material")
"""Arrays whose colours are those of names, without a scale."""

_BLOCK = 65536  # particles that are coloured at a time

# Of debris and the like [%]: the share of the values that colours leave out at either end if it
# stretches their range by more than a factor; a larger share, as of torn particles, must stretch it
# more than what is a few particles.
_TAILS = ((1.0, 10.0), (0.1, 1.3))
_ALONE = 3.0  # One particle is left out if it stretches the range by more than this factor.
_NEAR = 1.8  # Sizes of a particle: those so near are its neighbours.
_ENOUGH = {
    2: 3,
    3: 6,
}  # Neighbours, by dimension: fewer has debris, a corner of a body has as many.


def colour_range(
    values: np.ndarray,
    points: np.ndarray | None = None,
    sizes: np.ndarray | None = None,
) -> tuple[float, float]:
    """Range for the colours: all values, without a few that lie far outside the others.

    What is but few values is no debris where it lies together in a body, as a wave does: then
    it counts by the median of each particle and its neighbours.

    Args:
        values: finite (n,), at least one.
        points, sizes: of the particles, (n, D) and (n,) [m]; None to go by the values alone.
    """
    low, high = float(values.min()), float(values.max())
    for bottom, top, factor in _inner(values):
        reach = factor * (top - bottom)
        if reach > 0.0 and (top - low > reach or high - bottom > reach):
            inner = bottom if top - low > reach else low, top if high - bottom > reach else high
            if points is None or sizes is None:
                return inner
            outside = np.flatnonzero((values < inner[0]) | (values > inner[1]))
            together = _of_neighbours(values, points, sizes, outside)
            ends = np.append(together, inner)
            return float(ends.min()), float(ends.max())
    return low, high


def _inner(values: np.ndarray) -> list[tuple[float, float, float]]:
    """Return ranges that leave something out, each with the factor that it must win."""
    found = []
    for tail, factor in _TAILS:
        bottom, top = (float(x) for x in np.percentile(values, [tail, 100.0 - tail]))
        found.append((bottom, top, factor))
    if len(values) > 4:
        second = np.partition(values, (1, len(values) - 2))
        found.append((float(second[1]), float(second[-2]), _ALONE))
    return found


def _of_neighbours(
    values: np.ndarray, points: np.ndarray, sizes: np.ndarray, some: np.ndarray
) -> np.ndarray:
    """Return the median of some particles' and their neighbours' values, where these are enough."""
    from scipy.spatial import cKDTree

    tree = cKDTree(points)
    near = tree.query_ball_point(points[some], _NEAR * sizes[some])
    enough = _ENOUGH[points.shape[1]]
    medians = [float(np.median(values[rows])) for rows in near if len(rows) > enough]
    return np.array(medians)


def default_colour(results: Any) -> str:
    """Return the array that colours particles if nobody says: of the stress that there is.

    That is "von_mises"; "pressure" where the last frame has no shear, as of a fluid; "body" where
    it has no stress at all.
    """
    stresses = ("von_mises", "pressure")
    arrays = results.arrays(len(results) - 1, stresses) if len(results) else {}
    for name in stresses:
        if np.nan_to_num(arrays.get(name, np.zeros(0))).any():
            return name
    return "body" if stresses[0] in arrays else stresses[0]


@dataclasses.dataclass
class ColourBar:
    """What a colour bar shows: colours with their range, label with unit, pointed ends."""

    mappable: Any
    label: str
    extend: str


def paint(
    arrays: dict[str, np.ndarray], results: Any, colour: str, view: View
) -> tuple[np.ndarray, ColourBar | None]:
    """Colours of the particles (n, 3), and the colour bar (None: colours of names)."""
    from matplotlib.cm import ScalarMappable

    values, name, unit = choose(arrays, results.units, colour)
    if colour in BY_NAME:
        rgb = body_colours(values)
        for body, table in view.grains.items():
            mine = arrays["body"] == body
            rgb[mine] = table[arrays["grain"][mine]]
        return rgb, None
    colours, norm = colour_scale(colour, view.low, view.high, view.exact)
    factor, unit = prefix(max(abs(norm.vmin), abs(norm.vmax)), unit)
    shown = type(norm)(norm.vmin * factor, norm.vmax * factor)
    rgb = np.empty((len(values), 3), dtype=np.float32)
    for first in range(0, len(values), _BLOCK):
        some = values[first : first + _BLOCK].astype(float)
        part = rgb[first : first + _BLOCK]
        part[:] = colours(norm(np.nan_to_num(some, nan=norm.vmin)))[:, :3]
        part[~np.isfinite(some)] = 0.75  # no such value there: grey
    slack = 0.01 * (norm.vmax - norm.vmin)
    below, above = (values < norm.vmin - slack).any(), (values > norm.vmax + slack).any()
    extend = "both" if below and above else "min" if below else "max" if above else "neither"
    label = f"{name} [{unit}]" if unit else name
    return rgb, ColourBar(ScalarMappable(shown, colours), label, extend)


def draw_bar(axes: Axes, bar: ColourBar) -> None:
    """A colour bar beside axes, as high as they are."""
    place, figure = axes.inset_axes((1.025, 0.0, 0.022, 1.0)), axes.figure
    figure.colorbar(bar.mappable, cax=place, label=bar.label, extend=bar.extend)
    place.yaxis.label.set_fontsize(9)
    place.spines["outline"].set_linewidth(0.6)
