# SPDX-License-Identifier: BSD-3-Clause
"""The particles of a case before it runs."""

from __future__ import annotations

import dataclasses
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from .case_walls import draw_walls, draw_walls_in_space
from .flat import draw_cells, draw_particles, set_view
from .grain_colours import colours_of_grains
from .labels import length_unit
from .sheet import paper
from .style import body_colours, legend_of_bodies, new_figure, picture_path, save, styled


@dataclasses.dataclass
class Start:
    """All particles of a case.

    Attributes:
        names: of the entries of bodies and grains.
        points: (n, 3) [m].
        sizes: edge of each particle's square or cube (n,) [m].
        bodies: number of its entry (n,).
        grains: its number among the bodies of the entry (n,).
    """

    names: list[str]
    points: np.ndarray
    sizes: np.ndarray
    bodies: np.ndarray
    grains: np.ndarray


def preview(case: Any, out: Path) -> Path:
    """See `mpm3dpp.plots.preview`."""
    path = picture_path(out / "preview.png" if out.is_dir() or not out.suffix else out)
    start = filled(case)
    grid = case.grid
    dimension = int(grid.dimension)
    half = 0.5 * float(start.sizes.max())
    lower, upper = start.points.min(axis=0) - half, start.points.max(axis=0) + half
    box = grid.box
    if box is not None:
        lower[:dimension] = np.minimum(lower[:dimension], np.asarray(box.lower, dtype=float))
        upper[:dimension] = np.maximum(upper[:dimension], np.asarray(box.upper, dtype=float))
    margin = 0.03 * float((upper - lower).max())
    lower, upper = lower - margin, upper + margin
    view = SimpleNamespace(lower=lower, upper=upper)
    own = colours_of_grains(start.bodies, start.grains, start.points)
    colours = body_colours(start.bodies)
    for entry, table in own.items():
        mine = start.bodies == entry
        colours[mine] = table[start.grains[mine]]
    with styled():
        draw = _flat if dimension == 2 else _space
        figure, walls = draw(grid, box, view, start, colours)
        axes = figure.axes[0]
        counts = np.bincount(start.bodies, minlength=len(start.names))
        notes = [f" ({count:,})" for count in counts]
        legend_of_bodies(figure, start.names, notes, own, walls)
        axes.set_title(f"{len(start.points):,} particles", loc="left")
        return save(figure, path)


def filled(case: Any) -> Start:
    """Fill all bodies of a case."""
    from mpm3dpp.fill.build import fill_all

    dimension = int(case.grid.dimension)
    names = list(case.parts())
    points, sizes, bodies, grains = [], [], [], []
    for name, part in fill_all(case).parts.items():
        first = 0
        for some in part.chunks():
            whole = np.zeros((len(some.positions), 3))
            whole[:, :dimension] = some.positions
            points.append(whole)
            sizes.append(some.volumes ** (1.0 / dimension))
            bodies.append(np.full(len(whole), names.index(name)))
            grains.append(first + np.repeat(np.arange(len(some.counts)), some.counts))
            first += len(some.counts)
    columns = (np.concatenate(one) for one in (points, sizes, bodies, grains))
    return Start(names, *columns)


def _flat(
    grid: Any, box: Any, view: Any, start: Start, colours: np.ndarray
) -> tuple[Any, list[Any]]:
    """Return the figure, and what its legend says of walls."""
    width, height = (view.upper - view.lower)[:2]
    factor, unit = length_unit(max(width, height))
    figure = new_figure(*paper(width / height))
    axes = figure.add_subplot()
    set_view(axes, factor * view.lower, factor * view.upper, unit)
    lower, upper = view.lower[:2], view.upper[:2]
    walls: list[Any] = []
    if box is not None:
        lower, upper = (np.asarray(c, dtype=float) for c in (box.lower, box.upper))
        corners = factor * np.array([lower, upper])
        axes.plot(corners[[0, 1, 1, 0, 0], 0], corners[[0, 0, 1, 1, 0], 1], color="black", lw=0.6)
        walls = draw_walls(axes, grid.walls, corners)
    origin = np.asarray(grid.origin, dtype=float)
    cell = factor * float(grid.cell_size)
    draw_cells(axes, factor * origin, cell, factor * lower, factor * upper)
    points, sizes = factor * start.points[:, :2], factor * start.sizes
    draw_particles(axes, points, sizes, start.bodies, colours, grains=start.grains)
    return figure, walls


def _space(
    grid: Any, box: Any, view: Any, start: Start, colours: np.ndarray
) -> tuple[Any, list[Any]]:
    """Return the figure, and what its legend says of walls."""
    from .space import draw_box, draw_box_axes, render

    image, camera = render(start.points, start.sizes, colours, view.lower, view.upper)
    figure = new_figure(*paper(image.shape[1] / image.shape[0]))
    axes = figure.add_subplot()
    draw_box_axes(axes, image, camera, view.lower, view.upper)
    walls: list[Any] = []
    if box is not None:
        factor, _ = length_unit(float((view.upper - view.lower).max()))
        lower, upper = np.asarray(box.lower), np.asarray(box.upper)
        draw_box(axes, camera, lower, upper, factor)
        walls = draw_walls_in_space(axes, camera, grid.walls, lower, upper, factor)
    return figure, walls
