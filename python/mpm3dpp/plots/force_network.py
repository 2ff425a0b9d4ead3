# SPDX-License-Identifier: BSD-3-Clause
"""The forces between grains: a line from centre to centre through each contact."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .case_walls import draw_walls_in_view
from .flat import draw_particles, set_view
from .frames import drawn, sizes_of, view_of
from .labels import at_time, length_unit, prefix
from .paint import ColourBar, draw_bar
from .sheet import paper
from .style import colour_scale, new_figure, save, styled

if TYPE_CHECKING:
    from mpm3dpp.io.results import Results

_THICKEST = 5.0  # Points: a line as wide as that carries the force that 5 % exceed.
_GREY = (0.91, 0.91, 0.91)
_AXES = "xyz"


def save_force_network(results: Results, frame: int, path: Path) -> Path | None:
    """Draw the contacts of a frame and write the picture; None if there are none, or no table.

    The width of a line and its colour are the size of the force. Bodies that are no grains are
    not drawn to their centres, but to the point of contact. In 3D all is seen along y.

    Args:
        results: of `open_results`.
        frame: its number; negative numbers count from the end.
        path: of the picture, a PNG.

    Raises:
        CaseError: a frame is missing or damaged.
    """
    if "contacts" not in results.tables(frame):
        return None
    contacts, grains = results.contacts(frame), results.grains(frame)
    if len(contacts["a"]) == 0:
        return None
    across = (0, results.dimension - 1)
    size = np.sqrt(sum(np.square(np.asarray(contacts[f"force_{a}"])) for a in _AXES))
    lines = _lines(contacts, grains, across)
    view = view_of(results, [frame], "body")
    lower, upper = view.lower[list(across)], view.upper[list(across)]
    length, unit = length_unit(float(max(upper - lower)))
    most = float(np.quantile(size, 0.95)) or float(size.max())
    factor, force_unit = prefix(most, "N" if results.dimension == 3 else "N/m")
    with styled():
        width, height = upper - lower
        figure = new_figure(*paper(width / height))
        axes = figure.add_subplot()
        set_view(axes, length * lower, length * upper, unit)
        axes.set_ylabel(f"{_AXES[across[1]]} [{unit}]")
        if results.dimension == 2:
            arrays = drawn(results, frame, "body")
            colours = np.tile(_GREY, (len(arrays["body"]), 1))
            points = length * arrays["position"][:, :2].astype(float)
            draw_particles(
                axes,
                points,
                length * sizes_of(arrays, results),
                arrays["body"],
                colours,
                grains=arrays.get("grain"),
            )
            if results.box is not None:
                corners = length * np.array([lower, upper])
                draw_walls_in_view(axes, results.walls, length * results.box, *corners)
        from matplotlib.collections import LineCollection

        colour_map, norm = colour_scale("force", 0.0, factor * most)
        order = np.argsort(size)  # The strongest in front.
        drawing = LineCollection(
            list(length * lines[order]),
            linewidths=_THICKEST * np.clip(size[order] / most, 0.02, 1.0),
            array=factor * size[order],
            norm=norm,
            cmap=colour_map,
            capstyle="round",
            joinstyle="round",
        )
        axes.add_collection(drawing)
        draw_bar(axes, ColourBar(drawing, f"contact force [{force_unit}]", "max"))
        end = float(results.times[-1])
        axes.set_title(at_time(float(results.times[frame]), end), loc="left")
        return save(figure, path)


def _lines(contacts: Any, grains: Any, across: tuple[int, int]) -> np.ndarray:
    """Return centre, contact and centre of each pair, shape (pairs, 3, 2) [m]."""
    told, rows = _columns(contacts), _columns(grains)
    _, several = np.unique(rows["name"].astype(str), return_inverse=True)
    is_grain = np.bincount(several)[several] > 1
    point = np.column_stack([told[f"point_{_AXES[a]}"] for a in across])
    centre = np.column_stack([rows[f"centre_{_AXES[a]}"] for a in across])
    ends = [np.where(is_grain[told[k]][:, None], centre[told[k]], point) for k in ("a", "b")]
    return np.stack([ends[0], point, ends[1]], axis=1)


def _columns(table: Any) -> dict[str, np.ndarray]:
    return {name: np.asarray(table[name]) for name in table}
