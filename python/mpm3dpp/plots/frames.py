# SPDX-License-Identifier: BSD-3-Clause
"""Picture of one frame of a run."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base.errors import CaseError
from mpm3dpp.io.rows import takes_part

from .arrows import draw_arrows, fastest_of
from .case_walls import draw_walls_in_view
from .flat import draw_particles, set_view
from .grain_colours import colours_of_grains
from .labels import at_time, choose, length_unit
from .line import draw_line, line_axis
from .look import PLAIN, Look
from .paint import BY_NAME, ColourBar, colour_range, draw_bar, paint
from .sheet import paper, sheet
from .style import DPI, legend_of_bodies, save, styled

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
        exact: whether the range was asked for, and is not to be rounded.
        fastest: speed of the longest arrow [m/s].
        grains: colours of the grains, by the number of their body, shape (grains, 3).
    """

    lower: np.ndarray
    upper: np.ndarray
    low: float
    high: float
    along: int | None = None
    exact: bool = False
    fastest: float = 0.0
    grains: Mapping[int, np.ndarray] = dataclasses.field(default_factory=dict)


PLACED = ("size", "body", "grain", "material", "failed")
"""Arrays that say what is drawn where."""

_FILLED = (0.8, 0.8)  # Share of a picture of a given size that the image of particles fills.


def drawn(
    results: Results, frame: int, colour: str | None = None, look: Look = PLAIN
) -> dict[str, np.ndarray]:
    """Return the arrays of a frame without the particles that have eroded or left, or are cut away.

    With a colour (see `labels.choose`) only those that a picture in it needs.
    """
    needed = _needed(results, colour)
    if needed is not None and look.arrows:
        needed.append("velocity")
    arrays = results.arrays(frame) if needed is None else results.arrays(frame, needed)
    stays = takes_part(arrays)
    # In 2D particles at the edge of the picture are drawn in part.
    margin = float(sizes_of(arrays, results).max(initial=0.0)) if results.dimension == 2 else 0.0
    near = look.near(arrays["position"], 0.5 * margin)
    stays = stays if near is None else stays & near
    return arrays if stays.all() else {name: values[stays] for name, values in arrays.items()}


def _needed(results: Results, colour: str | None) -> list[str] | None:
    """Return the names of the arrays that a colour needs; None, which are all, where none fits."""
    if colour is None:
        return None
    colour = "velocity" if colour == "speed" else colour
    found = [name for name in results.fields if colour == name or colour.startswith(f"{name}_")]
    return [*PLACED, *found] if found else None


def view_of(results: Results, frames: list[int], colour: str, look: Look = PLAIN) -> View:
    """The view that holds all particles of some frames, with a margin, and all their values.

    Raises:
        CaseError: there is no such array, or `look` does not suit the results.
    """
    look.check(results.dimension)
    lower, upper = np.full(3, np.inf), np.full(3, -np.inf)
    least, most, low, high, fastest = np.inf, -np.inf, np.inf, -np.inf, 0.0
    unit = ""
    for frame in frames:
        arrays = drawn(results, frame, colour, look)
        values, _, unit = choose(arrays, results.units, colour)
        finite = np.isfinite(arrays["position"]).all(axis=1)
        position, sizes = arrays["position"][finite], sizes_of(arrays, results)[finite]
        if len(position) == 0:
            continue
        half = 0.5 * sizes.max()
        lower = np.minimum(lower, position.min(axis=0) - half)
        upper = np.maximum(upper, position.max(axis=0) + half)
        if look.arrows:
            fastest = max(fastest, fastest_of(arrays["velocity"]))
        known = np.isfinite(values[finite])
        if known.any() and look.range is None:
            values, places = values[finite][known], position[known][:, : results.dimension]
            bottom, top = colour_range(values, places, sizes[known])
            low, high = min(low, bottom), max(high, top)
            least, most = min(least, float(values.min())), max(most, float(values.max()))
    if not np.isfinite(lower).all():  # All are gone: an empty picture of where they were.
        lower, upper = _empty(results, frames[0], look)
    margin = 0.03 * float(np.max(upper - lower))
    along = line_axis(lower, upper, results.cell_size, results.dimension)
    lower, upper = lower - margin, upper + margin
    if look.crop is not None and results.dimension == 2:  # In 3D what is left fills the picture.
        lower[:2], upper[:2] = look.crop
    view = View(lower, upper, low, high, fastest=fastest)
    if colour == "body" and "grain" in results.fields:
        view.grains = _grains(results, frames[0])
    if along is not None and colour not in BY_NAME:
        view.low, view.high, view.along = least, most, along  # Points hide no others.
    if look.range is not None:
        if colour in BY_NAME:
            rule = f"is for colours with a scale, and those of {colour} have none"
            raise CaseError(rule, "leave it out, or choose another colour", key="range")
        (view.low, view.high), view.exact = look.range_in(unit) or (low, high), True
    return view


def _empty(results: Results, frame: int, look: Look) -> tuple[np.ndarray, np.ndarray]:
    """Return the region in which nothing is. Raises `CaseError` where that was asked for."""
    position = results.arrays(frame, ())["position"].astype(float)
    position = position[np.isfinite(position).all(axis=1)]
    if len(position) == 0:
        return np.zeros(3), np.full(3, results.cell_size)
    for name in ("crop", "section"):
        if getattr(look, name) is not None and takes_part(results.arrays(frame, PLACED)).any():
            low, high = position.min(axis=0), position.max(axis=0)
            places = zip("xyz"[: results.dimension], low, high, strict=False)
            where = ", ".join(f"{a} {b:.3g} to {c:.3g} m" for a, b, c in places)
            raise CaseError("leaves no particle", f"they are at {where}", key=name)
    return position.min(axis=0), position.max(axis=0) + results.cell_size


def _grains(results: Results, frame: int) -> dict[int, np.ndarray]:
    arrays = results.arrays(frame, ("body", "grain"))
    return colours_of_grains(arrays["body"], arrays["grain"], arrays["position"].astype(float))


def draw_frame(
    results: Results,
    frame: int,
    colour: str = "von_mises",
    view: View | None = None,
    dpi: float = DPI,
    look: Look = PLAIN,
) -> Figure:
    """Draw one frame; the caller saves it.

    Args:
        results: of `open_results`.
        frame: its number; negative numbers count from the end.
        colour: array that colours the particles, see `labels.choose`.
        view: region and range of values; default those of this frame.
        dpi: pixels per inch.
        look: what else was asked for.

    Raises:
        CaseError: the frame has no such array, or `look` does not suit the results.
    """
    view = view or view_of(results, [frame], colour, look)
    arrays = drawn(results, frame, colour, look)
    with styled():
        if view.along is not None:
            figure = draw_line(results, arrays, colour, view, sheet((7.0, 3.4), dpi, look))
        elif results.dimension == 2:
            figure = _draw_flat(results, arrays, colour, view, dpi, look)
        else:
            figure = _draw_space(results, arrays, colour, view, dpi, look)
        end = float(results.times[-1])
        title = ", ".join(filter(None, [at_time(float(results.times[frame]), end), look.words]))
        figure.axes[0].set_title(title, loc="left")
    return figure


def _draw_flat(
    results: Results,
    arrays: dict[str, np.ndarray],
    colour: str,
    view: View,
    dpi: float,
    look: Look,
) -> Figure:
    width, height = (view.upper - view.lower)[:2]
    factor, unit = length_unit(max(width, height))
    figure = sheet(paper(width / height), dpi, look)
    axes = figure.add_subplot()
    set_view(axes, factor * view.lower, factor * view.upper, unit)
    colours, mappable = paint(arrays, results, colour, view)
    _key(axes, results, colour, mappable, view)
    points = factor * arrays["position"][:, :2].astype(float)
    sizes = factor * sizes_of(arrays, results)
    draw_particles(axes, points, sizes, arrays["body"], colours, grains=arrays.get("grain"))
    if results.box is not None:
        corners = factor * np.array([view.lower, view.upper])[:, :2]
        draw_walls_in_view(axes, results.walls, factor * results.box, *corners)
    if look.arrows:
        draw_arrows(axes, points, arrays["velocity"][:, :2], arrays["body"], view.fastest)
    return figure


def _draw_space(
    results: Results,
    arrays: dict[str, np.ndarray],
    colour: str,
    view: View,
    dpi: float,
    look: Look,
) -> Figure:
    from .space import PIXELS, camera_for, draw_box_axes, render

    colours, mappable = paint(arrays, results, colour, view)
    camera = camera_for(view.lower, view.upper, look.view)
    pixels = float(PIXELS * dpi / DPI)
    if look.size is not None:
        room = np.multiply(_FILLED, look.size) / [camera.width, camera.height]
        pixels = float(room.min()) * max(camera.width, camera.height)
    sizes = sizes_of(arrays, results)
    image, camera = render(
        *(arrays["position"], sizes, colours, view.lower, view.upper, round(pixels), look.view)
    )
    figure = sheet(paper(image.shape[1] / image.shape[0]), dpi, look)
    axes = figure.add_subplot()
    draw_box_axes(axes, image, camera, view.lower, view.upper)
    _key(axes, results, colour, mappable, view)
    if look.arrows:
        factor, _ = length_unit(float((view.upper - view.lower).max()))
        across = np.column_stack([camera.right, camera.up, camera.towards])
        places = factor * (arrays["position"].astype(float) - camera.centre) @ across
        flat = arrays["velocity"].astype(float) @ across[:, :2]
        draw_arrows(axes, places[:, :2], flat, arrays["body"], view.fastest, places[:, 2])
    return figure


def _key(axes: Axes, results: Results, colour: str, bar: ColourBar | None, view: View) -> None:
    """The colour bar, as high as the axes, or the legend of the bodies or materials."""
    if bar is not None:
        draw_bar(axes, bar)
        return
    names = results.bodies if colour == "body" else results.materials
    figure: Any = axes.figure
    legend_of_bodies(figure, names, grains=view.grains)


def save_frame(
    results: Results,
    frame: int,
    path: Path,
    colour: str = "von_mises",
    view: View | None = None,
    look: Look = PLAIN,
) -> Path:
    """Draw one frame and write it as PNG; arguments of `draw_frame`."""
    figure = draw_frame(results, frame, colour, view, look=look)
    with styled():
        return save(figure, path, whole=look.size is not None)


def sizes_of(arrays: dict[str, np.ndarray], results: Any) -> np.ndarray:
    """Edge of each particle's square or cube [m]; half a cell where the file does not say."""
    if "size" in arrays:
        return arrays["size"]
    return np.full(len(arrays["position"]), 0.5 * results.cell_size, dtype=np.float32)
