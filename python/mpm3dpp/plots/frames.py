# SPDX-License-Identifier: BSD-3-Clause
"""Picture of one frame of a run."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.io.rows import takes_part

from .flat import draw_particles, set_view
from .labels import at_time, choose, length_unit, prefix
from .line import draw_line, line_axis
from .style import DPI, body_colours, colour_scale, legend_of_bodies, new_figure, save, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mpm3dpp.io.results import Results


@dataclasses.dataclass
class View:
    """What stays the same from picture to picture of one run (an animation must not jump).

    Attributes:
        lower, upper: corners of the visible region [m], shape (3,).
        low, high: range of the coloured array, SI.
        along: axis over which the values are drawn, for bodies that are a line; None for others.
    """

    lower: np.ndarray
    upper: np.ndarray
    low: float
    high: float
    along: int | None = None


_BLOCK = 65536  # particles that are coloured at a time


PLACED = ("size", "body", "grain", "material", "failed")
"""Arrays that say what is drawn where."""


def drawn(results: Results, frame: int, colour: str | None = None) -> dict[str, np.ndarray]:
    """Return the arrays of a frame without the particles that have eroded or left.

    With a colour (see `labels.choose`) only those that a picture in it needs.
    """
    needed = _needed(results, colour)
    arrays = results.arrays(frame) if needed is None else results.arrays(frame, needed)
    stays = takes_part(arrays)
    return arrays if stays.all() else {name: values[stays] for name, values in arrays.items()}


def _needed(results: Results, colour: str | None) -> list[str] | None:
    """Return the names of the arrays that a colour needs; None, which are all, where none fits."""
    if colour is None:
        return None
    colour = "velocity" if colour == "speed" else colour
    found = [name for name in results.fields if colour == name or colour.startswith(f"{name}_")]
    return [*PLACED, *found] if found else None


def view_of(results: Results, frames: list[int], colour: str) -> View:
    """The view that holds all particles of some frames, with a margin, and all their values."""
    lower, upper = np.full(3, np.inf), np.full(3, -np.inf)
    least, most, low, high = np.inf, -np.inf, np.inf, -np.inf
    for frame in frames:
        arrays = drawn(results, frame, colour)
        position = arrays["position"][np.isfinite(arrays["position"]).all(axis=1)]
        if len(position) == 0:
            continue
        half = 0.5 * sizes_of(arrays, results).max()
        lower = np.minimum(lower, position.min(axis=0) - half)
        upper = np.maximum(upper, position.max(axis=0) + half)
        values = choose(arrays, results.units, colour)[0]
        values = values[np.isfinite(values)]
        if len(values):
            bottom, top = _range(values)
            low, high = min(low, bottom), max(high, top)
            least, most = min(least, float(values.min())), max(most, float(values.max()))
    if not np.isfinite(lower).all():  # All are gone: an empty picture of where they were.
        position = results.arrays(frames[0], ())["position"]
        lower, upper = position.min(axis=0), position.max(axis=0) + results.cell_size
    margin = 0.03 * float(np.max(upper - lower))
    along = line_axis(lower, upper, results.cell_size, results.dimension)
    if along is None or colour in ("body", "material"):
        return View(lower - margin, upper + margin, low, high)
    return View(lower - margin, upper + margin, least, most, along)  # Points hide no others.


def draw_frame(
    results: Results,
    frame: int,
    colour: str = "von_mises",
    view: View | None = None,
    dpi: float = DPI,
) -> Figure:
    """Draw one frame; the caller saves it.

    Args:
        results: of `open_results`.
        frame: its number; negative numbers count from the end.
        colour: array that colours the particles, see `labels.choose`.
        view: region and range of values; default those of this frame.
        dpi: pixels per inch.

    Raises:
        CaseError: the frame has no such array.
    """
    view = view or view_of(results, [frame], colour)
    arrays = drawn(results, frame, colour)
    with styled():
        if view.along is not None:
            figure = draw_line(results, arrays, colour, view, dpi)
        elif results.dimension == 2:
            figure = _draw_flat(results, arrays, colour, view, dpi)
        else:
            figure = _draw_space(results, arrays, colour, view, dpi)
        end = float(results.times[-1])
        figure.axes[0].set_title(at_time(float(results.times[frame]), end), loc="left")
    return figure


def _draw_flat(
    results: Results, arrays: dict[str, np.ndarray], colour: str, view: View, dpi: float
) -> Figure:
    width, height = (view.upper - view.lower)[:2]
    factor, unit = length_unit(max(width, height))
    figure = new_figure(*paper(width / height), dpi)
    axes = figure.add_subplot()
    set_view(axes, factor * view.lower, factor * view.upper, unit)
    colours, mappable = paint(arrays, results, colour, view)
    _key(axes, results, colour, mappable)
    points = factor * arrays["position"][:, :2].astype(float)
    sizes = factor * sizes_of(arrays, results)
    draw_particles(axes, points, sizes, arrays["body"], colours, grains=arrays.get("grain"))
    return figure


def _draw_space(
    results: Results, arrays: dict[str, np.ndarray], colour: str, view: View, dpi: float
) -> Figure:
    from .space import PIXELS, draw_box_axes, render

    colours, mappable = paint(arrays, results, colour, view)
    image, camera = render(
        arrays["position"],
        sizes_of(arrays, results),
        colours,
        view.lower,
        view.upper,
        round(PIXELS * dpi / DPI),
    )
    height, width = image.shape[:2]
    figure = new_figure(*paper(width / height), dpi)
    axes = figure.add_subplot()
    draw_box_axes(axes, image, camera, view.lower, view.upper)
    _key(axes, results, colour, mappable)
    return figure


def _key(axes: Axes, results: Results, colour: str, bar: ColourBar | None) -> None:
    """The colour bar, as high as the axes, or the legend of the bodies or materials."""
    if bar is not None:
        draw_bar(axes, bar)
        return
    names = results.bodies if colour == "body" else results.materials
    figure: Any = axes.figure
    legend_of_bodies(figure, names)


def draw_bar(axes: Axes, bar: ColourBar) -> None:
    """A colour bar beside axes, as high as they are."""
    place, figure = axes.inset_axes((1.025, 0.0, 0.022, 1.0)), axes.figure
    figure.colorbar(bar.mappable, cax=place, label=bar.label, extend=bar.extend)
    place.yaxis.label.set_fontsize(9)
    place.spines["outline"].set_linewidth(0.6)


@dataclasses.dataclass
class ColourBar:
    """What a colour bar shows: colours with their range, label with unit, pointed ends."""

    mappable: Any
    label: str
    extend: str


def paint(
    arrays: dict[str, np.ndarray], results: Any, colour: str, view: View
) -> tuple[np.ndarray, ColourBar | None]:
    """Colours of the particles (n, 3), and the colour bar (None: colours of bodies)."""
    from matplotlib.cm import ScalarMappable

    values, name, unit = choose(arrays, results.units, colour)
    if colour in ("body", "material"):
        return body_colours(values), None
    colours, norm = colour_scale(colour, view.low, view.high)
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


# Of debris and the like [%]: the share of the values that colours leave out at either end if it
# stretches their range by more than a factor; a larger share, as of torn particles, must stretch it
# more than what is a few particles.
_TAILS = ((1.0, 10.0), (0.1, 1.3))


def _range(values: np.ndarray) -> tuple[float, float]:
    """Range for the colours: all values, without a few that lie far outside the others."""
    low, high = float(values.min()), float(values.max())
    for tail, factor in _TAILS:
        bottom, top = (float(x) for x in np.percentile(values, [tail, 100.0 - tail]))
        reach = factor * (top - bottom)
        if reach > 0.0 and (top - low > reach or high - bottom > reach):
            return bottom if top - low > reach else low, top if high - bottom > reach else high
    return low, high


def save_frame(
    results: Results, frame: int, path: Path, colour: str = "von_mises", view: View | None = None
) -> Path:
    """Draw one frame and write it as PNG; arguments of `draw_frame`."""
    figure = draw_frame(results, frame, colour, view)
    with styled():
        return save(figure, path)


def sizes_of(arrays: dict[str, np.ndarray], results: Any) -> np.ndarray:
    """Edge of each particle's square or cube [m]; half a cell where the file does not say."""
    if "size" in arrays:
        return arrays["size"]
    return np.full(len(arrays["position"]), 0.5 * results.cell_size, dtype=np.float32)


def paper(aspect: float) -> tuple[float, float]:
    """Width and height in inches of a picture whose region has this width over height."""
    aspect = min(max(aspect, 0.25), 5.0)
    width = 7.0 if aspect >= 1.2 else 5.2
    height = width / aspect + 0.7
    return (width, height) if height <= 8.0 else (width * 8.0 / height + 1.0, 8.0)
