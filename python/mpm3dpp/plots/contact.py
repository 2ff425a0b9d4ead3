# SPDX-License-Identifier: BSD-3-Clause
"""The moment of first contact force: both bodies, and the plane and the gap that acted."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.base.errors import CaseError, show
from mpm3dpp.io.pair_columns import pairs_of
from mpm3dpp.io.read_history import read_history
from mpm3dpp.io.results import open_results
from mpm3dpp.io.stored_manifest import stored_manifest

from .flat import draw_cells, draw_particles, set_view
from .frames import PLACED, drawn, sizes_of, view_of
from .labels import at_time, length_unit, short
from .style import body_colours, legend_of_bodies, new_figure, save, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from mpm3dpp.io.results import Results

_WINDOW = 14.0  # cells across the magnified view
_TITLE = 28  # Letters of both names that fit into a line above the narrowest view.
# Cells from a node, along each axis, to the farthest particles that reach it: with GIMP and two
# particles to a cell's edge. Those of other cases move the drawn plane by a hundredth of a cell.
_REACH = 1.25


@dataclasses.dataclass
class Touch:
    """The first contact of two bodies, as the run has recorded it.

    Attributes:
        time: of the first contact force [s].
        a, b: numbers of the bodies, or of the entries of grains.
        gap: distance of the two surfaces [m], negative when they overlap; None where no manifest
            tells it, as after a kill.
        normal: along which it was measured and acted, from a to b, shape (3,).
        node: at which it acted [m], shape (3,).
    """

    time: float
    a: int
    b: int
    gap: float | None = None
    normal: np.ndarray | None = None
    node: np.ndarray | None = None


@dataclasses.dataclass
class Plane:
    """The plane of contact, midway between the two surfaces.

    Attributes:
        gap: distance of the surfaces [m].
        normal: unit vector from the first body to the second, shape (3,).
        place: a point of the plane [m], shape (3,).
    """

    gap: float
    normal: np.ndarray
    place: np.ndarray


def first_contact(folder: Path, out: Path | None = None) -> Path | None:
    """See `mpm3dpp.plots.first_contact`."""
    with open_results(folder) as results:
        touch = _first(folder, results.bodies)
        if touch is None or len(results) == 0:
            return None
        frame = int(np.abs(results.times - touch.time).argmin())
        path = out or folder / "first_contact.png"
        with styled():
            return save(draw_contact(results, frame, touch), path)


def plane_of(
    touch: Touch, positions: np.ndarray, sizes: np.ndarray, bodies: np.ndarray, cell: float
) -> Plane | None:
    """The plane that acted: its normal and gap are those recorded.

    Where it is along the normal is told by the particles, by the rule of the gap test: a body ends
    at the foremost of its particles around the node, within a cell of the normal through it.

    Args:
        touch: what is recorded.
        positions, sizes, bodies: of the particles, shapes (n, 3) [m], (n,) [m] and (n,).
        cell: edge of the cells [m].

    Returns:
        None if the run has not recorded it.
    """
    if touch.gap is None or touch.normal is None or touch.node is None:
        return None
    near = np.ones(len(positions), dtype=bool)
    for axis, place in enumerate(touch.node):
        near &= np.abs(positions[:, axis] - place) < _REACH * cell
    apart, sizes, bodies = positions[near].astype(float) - touch.node, sizes[near], bodies[near]
    along = apart @ touch.normal
    on_line = (apart**2).sum(axis=1) - along**2 < cell**2
    ends = []
    for body, sign in ((touch.a, 1.0), (touch.b, -1.0)):
        for some in (on_line & (bodies == body), bodies == body):
            if some.any():
                ends.append(sign * float((sign * along[some] + 0.5 * sizes[some]).max()))
                break
    middle = float(np.mean(ends)) if len(ends) == 2 else 0.0  # One of them has eroded.
    return Plane(touch.gap, touch.normal, touch.node + middle * touch.normal)


def _first(folder: Path, bodies: list[str]) -> Touch | None:
    """The contact that came first."""
    folder = folder if folder.is_dir() else folder.parent
    if (folder / "manifest.json").is_file():
        found = _recorded(folder, bodies)
    else:  # A killed run has none.
        found = _of_history(read_history(folder), bodies)
    return min(found, key=lambda f: (f.time, f.a, f.b), default=None)


def _recorded(folder: Path, bodies: list[str]) -> list[Touch]:
    """The first contacts that the manifest has."""
    found = []
    for pair in stored_manifest(folder).contact.pairs:
        for name in pair.bodies:
            if name not in bodies:
                rule = f"'{folder / 'manifest.json'}' tells of {show(name)}, a body that the"
                raise CaseError(f"{rule} frames do not have", "run the case again")
        a, b = (bodies.index(name) for name in pair.bodies)
        if pair.first_time is None or a == b:
            continue
        plane = [np.array(v) for v in (pair.first_normal, pair.first_node) if v is not None]
        if len(plane) < 2:  # Earlier versions recorded none.
            found.append(Touch(pair.first_time, a, b))
        elif plane[0].any():  # Else they are bonded, and touch along no plane.
            found.append(Touch(pair.first_time, a, b, pair.first_gap, *plane))
    return found


def _of_history(history: dict[str, np.ndarray], bodies: list[str]) -> list[Touch]:
    """The first contacts that the columns of pairs have."""
    found, number = [], {name: k for k, name in enumerate(bodies)}
    for a, b, column in pairs_of(history, bodies):
        names = [f"{column}_{x}" for x in "xyz"]
        touching = np.any([np.nan_to_num(history[n]) != 0.0 for n in names], axis=0)
        if touching.any():
            time = float(history["time"][touching][0])
            first, second = sorted((number[a], number[b]))
            found.append(Touch(time, first, second))
    return found


def draw_contact(results: Results, frame: int, touch: Touch) -> Figure:
    """Draw both bodies, and beside them the plane of contact from near, if it is recorded."""
    view = view_of(results, [frame], "body")
    arrays = drawn(results, frame, "body")
    if not np.isin([touch.a, touch.b], arrays["body"]).all():  # One has eroded as it touched.
        arrays = results.arrays(frame, PLACED)
    points, sizes = arrays["position"], sizes_of(arrays, results)
    cell = results.cell_size
    plane = plane_of(touch, points, sizes, arrays["body"], cell)
    colours = body_colours(arrays["body"])
    aspect = float((view.upper - view.lower)[0] / (view.upper - view.lower)[1])
    wide = min(max(aspect, 0.8), 2.4) if results.dimension == 2 else 1.2
    widths = [wide, 1.0] if plane is not None else [wide]
    figure = new_figure(3.3 * sum(widths) + 0.9, 3.9)
    both = figure.subplots(1, len(widths), squeeze=False, width_ratios=widths)[0]
    whole = both[0]
    factor, unit = length_unit(float(np.max(view.upper - view.lower)))
    if results.dimension == 2:
        set_view(whole, factor * view.lower, factor * view.upper, unit)
        grains = arrays.get("grain")
        flat = factor * points[:, :2].astype(float)
        draw_particles(whole, flat, factor * sizes, arrays["body"], colours, grains=grains)
        if plane is not None:
            half = 0.5 * _WINDOW * cell
            low = np.maximum(plane.place - half, view.lower)[:2]
            high = np.minimum(plane.place + half, view.upper)[:2]
            whole.add_patch(_frame(factor * low, factor * (high - low)))
    else:
        from .space import draw_box_axes, render

        image, camera = render(points, sizes, colours, view.lower, view.upper)
        draw_box_axes(whole, image, camera, view.lower, view.upper)
    end, shown = float(results.times[-1]), float(results.times[frame])
    force, drawn_at = at_time(touch.time, end), at_time(shown, end)
    first, second = short(results.bodies[touch.a]), short(results.bodies[touch.b])
    names = f"{first} and{' ' if len(first + second) < _TITLE else chr(10)}{second}"
    title = f"{names}\nfirst contact force, {force}"
    whole.set_title(title if force == drawn_at else f"{title}\ndrawn at {drawn_at}", loc="left")
    legend_of_bodies(figure, results.bodies)
    if plane is not None:
        _close_up(both[1], results, arrays, plane)
    return figure


def _close_up(axes: Axes, results: Results, arrays: dict[str, np.ndarray], contact: Plane) -> None:
    """The neighbourhood of the contact, with the grid, the two surfaces and their normal."""
    cell = results.cell_size
    plane = [0, 1]
    if results.dimension == 3:  # a slice through the contact that nearly holds the normal
        across = int(np.argmin(np.abs(contact.normal)))
        plane = [k for k in range(3) if k != across]
        depth = arrays["position"][:, across].astype(float)
        nearest = depth[np.abs(depth - contact.place[across]).argmin()]  # Not between two layers.
        # Half a particle and some more: bodies whose layers stand beside the plane are seen too.
        layer = np.abs(depth - nearest) <= 0.6 * sizes_of(arrays, results)
        arrays = {name: values[layer] for name, values in arrays.items()}
    half = 0.5 * _WINDOW * cell
    factor, unit = length_unit(2 * half)
    centre = contact.place[plane]
    lower, upper = factor * (centre - half), factor * (centre + half)
    set_view(axes, lower, upper, unit, clean=True)
    axes.set_xlabel(f"{'xyz'[plane[0]]} [{unit}]")
    axes.set_ylabel(f"{'xyz'[plane[1]]} [{unit}]")
    draw_cells(axes, factor * results.origin[plane], factor * cell, lower, upper)
    bodies, points = arrays["body"], factor * arrays["position"][:, plane].astype(float)
    sizes, colours = factor * sizes_of(arrays, results), body_colours(bodies)
    draw_particles(axes, points, sizes, bodies, colours, grains=arrays.get("grain"))
    ends = [factor * line for line in surfaces(contact, plane, 0.42 * _WINDOW * cell)]
    for line in ends:
        axes.plot(*line.T, color="black", lw=0.9, ls=(0, (4, 2)), zorder=5)
    arrow = {"arrowstyle": "-|>", "lw": 1.2, "color": "black", "shrinkA": 0, "shrinkB": 0}
    foot, tip = factor * centre, factor * (centre + 2.0 * cell * contact.normal[plane])
    if contact.gap > 0.3 * cell:  # Room for it between the surfaces.
        arrow["arrowstyle"] = "<|-|>"
        foot, tip = (line.mean(axis=0) for line in ends)
    axes.annotate("", tuple(tip), tuple(foot), arrowprops=arrow, zorder=6)
    size, cells = round(contact.gap * factor, 3) + 0.0, round(contact.gap / cell, 2) + 0.0
    text = f"gap {size:.3f} {unit} = {cells:.2f} cells"
    axes.set_title(text.replace("-", "\N{MINUS SIGN}"), loc="left")


def surfaces(contact: Plane, plane: list[int], half: float) -> list[np.ndarray]:
    """The traces of the two surfaces in a plane through the place of contact.

    Args:
        contact: where they are.
        plane: its two axes.
        half: half their length [m].

    Returns:
        Both ends of the first body's and of the second's [m], each of shape (2, 2).
    """
    normal = contact.normal[plane]
    square = float(normal @ normal)  # Less than 1 where the normal leans out of the plane.
    along = np.array([-normal[1], normal[0]]) / np.sqrt(square)
    found = []
    for side in (-0.5, 0.5):
        middle = contact.place[plane] + side * contact.gap / square * normal
        found.append(middle + np.outer([-half, half], along))
    return found


def _frame(corner: np.ndarray, size: np.ndarray) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle(tuple(corner), *size, fill=False, ec="black", lw=0.9, zorder=4)
