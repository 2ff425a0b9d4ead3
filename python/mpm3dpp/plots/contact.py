# SPDX-License-Identifier: BSD-3-Clause
"""The moment of first contact force: both bodies, the place of contact, and the true gap."""

from __future__ import annotations

import dataclasses
import itertools
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.errors import CaseError
from mpm3dpp.io.history import read_history
from mpm3dpp.io.manifest import read_manifest
from mpm3dpp.io.results import open_results
from mpm3dpp.plots.flat import draw_cells, draw_particles, set_view
from mpm3dpp.plots.frames import drawn, sizes_of, view_of
from mpm3dpp.plots.labels import at_time, length_unit
from mpm3dpp.plots.style import body_colours, legend_of_bodies, new_figure, save, styled

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from mpm3dpp.io.results import Results

_WINDOW = 14.0  # cells across the magnified view


@dataclasses.dataclass
class Gap:
    """The distance of two bodies' surfaces at their nearest place.

    Attributes:
        value: along `normal` [m]; negative when the surfaces overlap.
        place: middle of the gap [m], shape (3,).
        normal: unit vector from the first body to the second, shape (3,).
    """

    value: float
    place: np.ndarray
    normal: np.ndarray


def first_contact(folder: Path, out: Path | None = None) -> Path | None:
    """See `mpm3dpp.plots.first_contact`."""
    with open_results(folder) as results:
        found = _first(folder, results.bodies)
        if found is None or len(results) == 0:
            return None
        time, a, b, recorded = found
        after = np.flatnonzero(results.times >= time * (1.0 - 1e-9))
        frame = int(after[0]) if len(after) else len(results) - 1
        path = out or folder / "first_contact.png"
        with styled():
            return _draw(results, frame, time, a, b, recorded, path)


def measure_gap(
    first: np.ndarray, second: np.ndarray, half_a: np.ndarray, half_b: np.ndarray, reach: float
) -> Gap:
    """The gap between two clouds of particles.

    The normal is the mean direction from the particles of the first body that face the second
    most nearly to their nearest partners; the surface of a body is its foremost particle along
    the normal plus half that particle's size (the paper's distance of a body, with l_p).

    Args:
        first, second: positions (n, 3) and (m, 3) [m].
        half_a, half_b: half sizes of their particles (n,) and (m,) [m].
        reach: radius of what counts as near [m].
    """
    i, j, distance = nearest_pairs(first, second)
    slack = float(half_a.mean())
    nearest = int(distance.argmin())
    facing = distance <= distance[nearest] + slack
    i, j, distance = i[facing], j[facing], distance[facing]
    middles = 0.5 * (first[i] + second[j])
    middle = 0.5 * (first[i] + second[j])[np.flatnonzero(facing) == nearest][0]
    for _ in range(3):  # the middle of this place of contact, not of several
        here = np.linalg.norm(middles - middle, axis=1) <= 5.0 * reach
        middle = middles[here].mean(axis=0)
    ways = [_way(first[k], second, d) for k, d in zip(i[here], distance[here], strict=True)]
    normal = _direction(np.array(ways))
    radius = 0.5 * float(distance.min()) + reach
    near_a = np.linalg.norm(first - middle, axis=1) <= radius
    near_b = np.linalg.norm(second - middle, axis=1) <= radius
    near_a[i[here]] = near_b[j[here]] = True
    end_a = float(((first[near_a] - middle) @ normal + half_a[near_a]).max())
    end_b = float(((second[near_b] - middle) @ normal - half_b[near_b]).min())
    place = middle + 0.5 * (end_a + end_b) * normal
    return Gap(end_b - end_a, place, normal)


def _way(point: np.ndarray, others: np.ndarray, distance: float) -> np.ndarray:
    """From a point to its nearest others: where two are nearly as near, it faces between them."""
    apart = others - point
    as_near = (apart**2).sum(axis=1) <= (1.25 * distance) ** 2
    way: np.ndarray = apart[as_near].mean(axis=0)
    return way


def _direction(vectors: np.ndarray) -> np.ndarray:
    """Mean direction of some vectors; any direction when they cancel."""
    mean = vectors.mean(axis=0)
    size = float(np.linalg.norm(mean))
    return mean / size if size > 0.0 else np.array([1.0, 0.0, 0.0])


def nearest_pairs(
    first: np.ndarray, second: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The points of the first cloud near the second, each with its nearest partner.

    Args:
        first, second: (n, 3) and (m, 3) [m].

    Returns:
        numbers in the first and in the second cloud, distances [m], all (k,); the two nearest
        points of the clouds are always among them.
    """
    i, j = np.arange(len(first)), np.arange(len(second))
    for _ in range(4):  # a bound from a sample throws out what is farther, which betters the next
        some = i[:: max(1, len(i) // 64)]
        bound = min(float(np.linalg.norm(second[j] - point, axis=1).min()) for point in first[some])
        if bound == 0.0:
            break
        i = i[_within_bins(first[i], second[j], 1.5 * bound)]
        j = j[_within_bins(second[j], first[i], 1.5 * bound)]
    partner = np.empty(len(i), dtype=np.int64)
    distance = np.empty(len(i))
    for k, point in enumerate(first[i]):
        squared = ((second[j] - point) ** 2).sum(axis=1)
        m = int(squared.argmin())
        partner[k], distance[k] = j[m], np.sqrt(squared[m])
    return i, partner, distance


def _within_bins(points: np.ndarray, others: np.ndarray, width: float) -> np.ndarray:
    """Which points have one of the others in their own or a neighbouring bin of this width."""
    origin = np.minimum(points.min(axis=0), others.min(axis=0)) - 2 * width
    bins = np.floor((points - origin) / width).astype(np.int64)
    other_bins = np.floor((others - origin) / width).astype(np.int64)
    base = np.maximum(bins.max(axis=0), other_bins.max(axis=0)) + 3

    def key(triples: np.ndarray) -> np.ndarray:
        return (triples[:, 0] * base[1] + triples[:, 1]) * base[2] + triples[:, 2]

    taken = np.unique(key(other_bins))
    near = np.zeros(len(points), dtype=bool)
    for shift in itertools.product((-1, 0, 1), repeat=3):
        near |= np.isin(key(bins + np.array(shift)), taken)
    return near


def _first(folder: Path, bodies: list[str]) -> tuple[float, int, int, float | None] | None:
    """Time of the first contact force, the two bodies and, from the manifest, the gap [m]."""
    folder = folder if folder.is_dir() else folder.parent
    found: list[tuple[float, int, int, float | None]] = []
    try:
        pairs: list[dict[str, Any]] = read_manifest(folder)["contact"]["pairs"]
        for pair in pairs:
            a, b = (bodies.index(name) for name in pair["bodies"])
            if pair["first_time"] is not None and a != b:
                found.append((float(pair["first_time"]), a, b, pair["first_gap"]))
    except CaseError:  # a killed run has no manifest
        history = read_history(folder)
        for a, b in itertools.combinations(range(len(bodies)), 2):
            names = [f"contact_force_{bodies[a]}_{bodies[b]}_{x}" for x in "xyz"]
            if names[0] in history:
                touching = np.any([np.nan_to_num(history[n]) != 0.0 for n in names], axis=0)
                if touching.any():
                    found.append((float(history["time"][touching][0]), a, b, None))
    return min(found, key=lambda f: f[:3], default=None)


def _draw(
    results: Results, frame: int, time: float, a: int, b: int, recorded: float | None, path: Path
) -> Path:
    arrays = drawn(results, frame)
    if not {a, b} <= set(arrays["body"].tolist()):  # One of them has eroded as it touched.
        arrays = results.arrays(frame)
    points = arrays["position"].astype(float)
    sizes = sizes_of(arrays, results)
    of_a, of_b = arrays["body"] == a, arrays["body"] == b
    grains = arrays.get("grain")
    if grains is not None:  # Those two of the entries that are nearest to each other.
        i, j, distance = nearest_pairs(points[of_a], points[of_b])
        k = int(distance.argmin())
        of_a &= grains == grains[of_a][i[k]]
        of_b &= grains == grains[of_b][j[k]]
    cell = results.cell_size
    gap = measure_gap(points[of_a], points[of_b], 0.5 * sizes[of_a], 0.5 * sizes[of_b], 2.0 * cell)
    view = view_of(results, [frame], "body")
    colours = body_colours(arrays["body"])
    aspect = float((view.upper - view.lower)[0] / (view.upper - view.lower)[1])
    wide = min(max(aspect, 0.8), 2.4) if results.dimension == 2 else 1.2
    figure = new_figure(3.3 * (wide + 1.0) + 0.9, 3.7)
    whole, close = figure.subplots(1, 2, width_ratios=[wide, 1.0])
    factor, unit = length_unit(float(np.max(view.upper - view.lower)))
    if results.dimension == 2:
        set_view(whole, factor * view.lower, factor * view.upper, unit)
        draw_particles(
            whole, factor * points[:, :2], factor * sizes, arrays["body"], colours, grains=grains
        )
        half = 0.5 * _WINDOW * cell
        corner = factor * (gap.place[:2] - half)
        whole.add_patch(_frame(corner, 2 * half * factor))
    else:
        from mpm3dpp.plots.space import draw_box_axes, render

        image, camera = render(points, sizes, colours, view.lower, view.upper)
        draw_box_axes(whole, image, camera, view.lower, view.upper)
    end, shown = float(results.times[-1]), float(results.times[frame])
    force, drawn_at = at_time(time, end), at_time(shown, end)
    title = f"{results.bodies[a]} and {results.bodies[b]}\nfirst contact force, {force}"
    whole.set_title(title if force == drawn_at else f"{title}\ndrawn at {drawn_at}", loc="left")
    if results.dimension == 2 and len(results.bodies) <= 3:
        legend_of_bodies(
            whole, results.bodies, loc="lower right", bbox_to_anchor=(1.0, 1.05), ncols=3
        )
    else:
        legend_of_bodies(whole, results.bodies, loc="best")
    _close_up(close, results, arrays, gap, recorded)
    return save(figure, path)


def _close_up(
    axes: Axes,
    results: Results,
    arrays: dict[str, np.ndarray],
    gap: Gap,
    recorded: float | None,
) -> None:
    """The neighbourhood of the contact, with the grid, the two surfaces and their distance."""
    cell = results.cell_size
    plane = [0, 1]
    if results.dimension == 3:  # a slice through the contact that holds the normal
        across = int(np.argmin(np.abs(gap.normal)))
        plane = [k for k in range(3) if k != across]
        depth = arrays["position"][:, across].astype(float)
        nearest = depth[np.abs(depth - gap.place[across]).argmin()]  # Not between two layers.
        layer = np.abs(depth - nearest) <= 0.5 * sizes_of(arrays, results)
        arrays = {name: values[layer] for name, values in arrays.items()}
    half = 0.5 * _WINDOW * cell
    factor, unit = length_unit(2 * half)
    centre = gap.place[plane]
    lower, upper = factor * (centre - half), factor * (centre + half)
    set_view(axes, lower, upper, unit, clean=True)
    axes.set_xlabel(f"{'xyz'[plane[0]]} [{unit}]")
    axes.set_ylabel(f"{'xyz'[plane[1]]} [{unit}]")
    draw_cells(axes, factor * results.origin[plane], factor * cell, lower, upper)
    bodies, points = arrays["body"], factor * arrays["position"][:, plane].astype(float)
    sizes, colours = factor * sizes_of(arrays, results), body_colours(bodies)
    draw_particles(axes, points, sizes, bodies, colours, grains=arrays.get("grain"))
    normal = gap.normal[plane] / np.linalg.norm(gap.normal[plane])
    along = np.array([-normal[1], normal[0]])
    for side in (-0.5, 0.5):
        middle = factor * (centre + side * gap.value * normal)
        ends = middle + np.outer([-1, 1], along) * factor * 0.42 * _WINDOW * cell
        axes.plot(*ends.T, color="black", lw=0.9, ls=(0, (4, 2)), zorder=5)
    if gap.value > 0.3 * cell:
        ends = [factor * (centre + side * gap.value * normal) for side in (-0.5, 0.5)]
        arrow = {"arrowstyle": "<->", "lw": 1.0, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", ends[0], ends[1], arrowprops=arrow, zorder=6)
    said = gap.value if recorded is None else recorded  # What the contact itself has measured.
    size, cells = round(said * factor, 3) + 0.0, round(said / cell, 2) + 0.0
    text = f"gap {size:.3f} {unit} = {cells:.2f} cells"
    axes.set_title(text.replace("-", "\N{MINUS SIGN}"), loc="left")


def _frame(corner: np.ndarray, size: float) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle(tuple(corner), size, size, fill=False, ec="black", lw=0.9, zorder=4)
