# SPDX-License-Identifier: BSD-3-Clause
"""The particles of a case before it runs."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np

from .flat import draw_cells, draw_particles, set_view
from .frames import paper
from .labels import length_unit
from .style import body_colours, legend_of_bodies, new_figure, picture_path, save, styled


def preview(case: Any, out: Path) -> Path:
    """See `mpm3dpp.plots.preview`."""
    path = picture_path(out / "preview.png" if out.is_dir() or not out.suffix else out)
    names, points, sizes, bodies = filled(case)
    grid = case.grid
    dimension = int(grid.dimension)
    half = 0.5 * float(sizes.max())
    lower, upper = points.min(axis=0) - half, points.max(axis=0) + half
    box = grid.box
    if box is not None:
        lower[:dimension] = np.minimum(lower[:dimension], np.asarray(box.lower, dtype=float))
        upper[:dimension] = np.maximum(upper[:dimension], np.asarray(box.upper, dtype=float))
    margin = 0.03 * float((upper - lower).max())
    lower, upper = lower - margin, upper + margin
    view = SimpleNamespace(lower=lower, upper=upper)
    with styled():
        draw = _flat if dimension == 2 else _space
        figure = draw(grid, box, view, points, sizes, bodies)
        axes = figure.axes[0]
        counts = np.bincount(bodies, minlength=len(names))
        legend_of_bodies(figure, names, [f" ({count:,})" for count in counts])
        axes.set_title(f"{len(points):,} particles", loc="left")
        return save(figure, path)


def filled(case: Any) -> tuple[list[str], np.ndarray, np.ndarray, np.ndarray]:
    """All particles of a case: names of bodies, positions (n, 3) [m], sizes (n,) [m], body (n,)."""
    from mpm3dpp.fill.build import fill_all

    dimension = int(case.grid.dimension)
    names = list(case.parts())
    points, sizes, bodies = [], [], []
    for name, part in fill_all(case).parts.items():
        for some in part.chunks():
            whole = np.zeros((len(some.positions), 3))
            whole[:, :dimension] = some.positions
            points.append(whole)
            sizes.append(some.volumes ** (1.0 / dimension))
            bodies.append(np.full(len(whole), names.index(name)))
    return names, np.concatenate(points), np.concatenate(sizes), np.concatenate(bodies)


def _flat(
    grid: Any, box: Any, view: Any, points: np.ndarray, sizes: np.ndarray, bodies: np.ndarray
) -> Any:
    width, height = (view.upper - view.lower)[:2]
    factor, unit = length_unit(max(width, height))
    figure = new_figure(*paper(width / height))
    axes = figure.add_subplot()
    set_view(axes, factor * view.lower, factor * view.upper, unit)
    lower, upper = view.lower[:2], view.upper[:2]
    if box is not None:
        lower, upper = (np.asarray(c, dtype=float) for c in (box.lower, box.upper))
        corners = factor * np.array([lower, upper])
        axes.plot(corners[[0, 1, 1, 0, 0], 0], corners[[0, 0, 1, 1, 0], 1], color="black", lw=1.0)
    origin = np.asarray(grid.origin, dtype=float)
    cell = factor * float(grid.cell_size)
    draw_cells(axes, factor * origin, cell, factor * lower, factor * upper)
    draw_particles(axes, factor * points[:, :2], factor * sizes, bodies, body_colours(bodies))
    return figure


def _space(
    grid: Any, box: Any, view: Any, points: np.ndarray, sizes: np.ndarray, bodies: np.ndarray
) -> Any:
    from .space import draw_box, draw_box_axes, render

    image, camera = render(points, sizes, body_colours(bodies), view.lower, view.upper)
    figure = new_figure(*paper(image.shape[1] / image.shape[0]))
    axes = figure.add_subplot()
    draw_box_axes(axes, image, camera, view.lower, view.upper)
    if box is not None:
        factor, _ = length_unit(float((view.upper - view.lower).max()))
        draw_box(axes, camera, np.asarray(box.lower), np.asarray(box.upper), factor)
    return figure
