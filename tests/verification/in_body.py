# SPDX-License-Identifier: BSD-3-Clause
"""Problems as cases of bodies on nodes of their own: bars, columns, flights, and shear.

All else is what a case gets that says nothing. Those with discs, spheres and friction are in
in_body_contact.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from mpm3dpp import Case, Simulation

from . import bars, column, point
from .figure import Figure, judge
from .numerics import MATERIAL
from .scene import Scene

Table = dict[str, Any]


class InBody(Scene):
    """A simulation of a case, for what looks at a `Scene`.

    Args:
        dimension: 2 or 3.
        cell_size: [m].
        end: of the run [s].
        bodies: their tables by name, in the order of their numbers; without a material, "m".
        material: the table of "m".
        grid, run: more keys of these tables.
        more: other tables.
    """

    def __init__(
        self, dimension: int, cell_size: float, end: float, bodies: dict[str, Table],
        material: Table, grid: Table | None = None, run: Table | None = None, **more: Any,
    ) -> None:  # fmt: skip
        tables = {
            "grid": {"dimension": dimension, "cell_size": cell_size, **(grid or {})},
            "run": {"end_time": end, **(run or {})},
            "material": {"m": material},
            "body": {name: {"material": "m", **body} for name, body in bodies.items()},
            **more,
        }
        self.simulation = Simulation(Case.model_validate(tables), threads=1)
        self.scheme, self.dimension = self.simulation.case.run.scheme, dimension
        self.cell_size, self.core, self.rows = cell_size, self.simulation.core, []

    def energy_made(self) -> float:
        """Largest rise of the mechanical energy, with that of springs, over the start."""
        h = self.history()
        inside = h["kinetic"] + h["internal"] + h["springs"] - h["external"]
        return float((inside - inside[0]).max() / (h["kinetic"] + h["internal"])[0])

    def impulse(self, pair: int = 0) -> np.ndarray:
        """Impulse so far [N s], (3,), of the wall that stops bodies, or else of a pair."""
        walls = self.core.walls()
        return np.array(walls[0].impulse) if walls else super().impulse(pair)

    def rest(self) -> None:
        """Come to rest, with `run.settle`, until the time 0."""
        while self.time < 0.0:
            self.step(4000, 0.0)


def soft(shape: str, about: Table, velocity: Sequence[Any] | None = None) -> Table:
    """Return a body that deforms, on nodes of its own."""
    moves = {} if velocity is None else {"velocity": list(velocity)}
    return {"frame": MATERIAL, "shape": {shape: about}, **moves}


def box(lower: Sequence[float], upper: Sequence[float], velocity: Any = None) -> Table:
    """Return a rectangle (2D) or box (3D) that deforms."""
    return soft("box", {"lower": list(lower), "upper": list(upper)}, velocity)


def matter(density: float, model: str, **parameters: float) -> Table:
    """Return a material."""
    return {"density": density, "strength": {model: parameters}}


def vibration(scheme: str, dimension: int, basis: str, cells: int = 13) -> list[Figure]:
    """E1: bar fixed at its left end in its first mode, v(x) = 0.1 sin(pi x / 50); ten periods."""
    length, across = column.LENGTH, dimension - 1
    h = length / cells
    wide, still = [2 * h] * across, [0.0] * across
    mode = {"expression": f"{column.SPEED} * sin({math.pi / (2 * length)} * x)"}
    bar = box([0.0, *still], [length, *wide], [mode, *still])
    walls = {"x_min": "fixed", **dict.fromkeys(_sides("yz"[:across]), "slip")}
    room = {"lower": [0.0, *still], "upper": [length + 2 * h, *wide], "walls": walls}
    rubber = matter(column.RHO, "elastic", E=column.E, nu=0.0)
    scene = InBody(dimension, h, 101.0, {"bar": bar}, rubber, {"box": room})
    return column.vibration_figures(scene, math.prod(wide))


def _sides(axes: str) -> list[str]:
    return [f"{axis}_{end}" for axis in axes for end in ("min", "max")]


def under_gravity(scheme: str, dimension: int, basis: str, cells: int = 25) -> list[Figure]:
    """E11: column of height 1 on a fixed floor when gravity is suddenly on; one period."""
    h, across, up = 1.0 / cells, dimension - 1, "xyz"[dimension - 1]
    wide, still = [2 * h] * across, [0.0] * across
    walls = {f"{up}_min": "fixed", **dict.fromkeys(_sides("xy"[:across]), "slip")}
    room = {"lower": [*still, 0.0], "upper": [*wide, 1.0 + 2 * h], "walls": walls}
    scene = InBody(
        dimension, h, 1.0, {"column": box([*still, 0.0], [*wide, 1.0])},
        matter(column.SOFT, "elastic", E=1e6, nu=0.0), {"box": room},
        {"gravity": [*still, -column.G]},
    )  # fmt: skip
    return column.column_figures(scene, cells)


def line_of_bars(
    dimension: int, cells: int, lengths: Sequence[float], speeds: Sequence[float],
    offset: float = 0.0,
) -> InBody:  # fmt: skip
    """Touching bars in a row along x, two cells wide and free; `offset` of the row in cells."""
    h, start, row = bars.LENGTH / cells, 0.0, {}
    wide, still = [2 * h] * (dimension - 1), [0.0] * (dimension - 1)
    for length, speed in zip(lengths, speeds, strict=True):
        ends = [start, *still], [start + length, *wide]
        row[f"bar{len(row)}"] = box(*ends, [speed, *still])
        start += length
    grid = {"origin": [-offset * h, *still]}
    return InBody(dimension, h, 1.0, row, matter(bars.RHO, "elastic", E=bars.E, nu=0.0), grid)


def two_bars(
    scheme: str, dimension: int, basis: str, cells: int = 50, speed: float = 1.0
) -> list[Figure]:
    """E2: two equal bars, the first at speed v against rest; stress and velocities over v."""
    row = line_of_bars(dimension, cells, [bars.LENGTH] * 2, [speed, 0.0])
    return bars.two_bars_figures(row, cells, speed)


def unequal_bars(scheme: str, dimension: int, basis: str, cells: int = 25) -> list[Figure]:
    """E2b: the second bar twice as long; the worst over offsets of the contact within a cell."""
    about = dimension, cells, [bars.LENGTH, 2 * bars.LENGTH], [1.0, 0.0]
    rows = {offset: line_of_bars(*about, offset) for offset in (0.0, 0.25, 0.5, 0.75)}
    return bars.unequal_bars_figures(rows, 1.0)


def rod_energy(scheme: str, dimension: int, basis: str, cells: int = 50) -> list[Figure]:
    """Two equal rods head-on at v/2 each: they part with all their kinetic energy."""
    return bars.rod_figures(line_of_bars(dimension, cells, [bars.LENGTH] * 2, [0.5, -0.5]))


def five_bars(scheme: str, dimension: int, basis: str, cells: int = 25) -> list[Figure]:
    """E9b: five equal touching bars, the first at v: the last leaves with v, the others rest."""
    speeds = [1.0, 0.0, 0.0, 0.0, 0.0]
    return bars.five_bars_figures(line_of_bars(dimension, cells, [bars.LENGTH] * 5, speeds), 1.0)


def rigid_translation(scheme: str, dimension: int, basis: str, cells: int = 4) -> list[Figure]:
    """E3: a block flies across cells in an oblique direction; then the same, whole cells away."""
    h = 0.125  # A power of two, so that whole cells shift places without rounding.

    def fly(shift: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        ends = [[10.0 + shift + far] * dimension for far in (0.0, cells * h)]
        block = box(*ends, [3.0, 2.0, -1.0][:dimension])
        scene = InBody(dimension, h, 0.4, {"a": block}, matter(1e3, "elastic", E=point.E, nu=0.3))
        scene.run(0.4)
        return scene.x(0) - shift, scene.v(0), scene.stress(0)

    return point.translation_figures(fly, h)


def free_fall(scheme: str, dimension: int, basis: str, cells: int = 4) -> list[Figure]:
    """E3: a block falls in an oblique direction.

    Velocities in a step are those of its middle, so that their sum is g t^2 / 2.
    """
    h, g, stiff = 0.1, np.array([3.0, -9.0, 2.0][:dimension]), 1e6
    block = box([0.03] * dimension, [0.03 + cells * h] * dimension)
    scene = InBody(
        dimension, h, 0.5, {"a": block}, matter(1e3, "elastic", E=stiff, nu=0.3),
        run={"gravity": g.tolist()},
    )  # fmt: skip
    x0 = scene.x(0)
    scene.run(0.5)
    t, fall = scene.time, 0.5 * scene.time**2
    return [
        judge("E3", "fall: velocity against g t, over g t",
              np.abs(scene.v(0) - g * t).max() / (np.abs(g).max() * t)),
        judge("E3", "fall: displacement against the sum of v dt, over g t^2/2",
              np.abs(scene.x(0) - x0 - g * fall).max() / (np.abs(g).max() * fall)),
        judge("E3", "fall: largest stress over E", np.abs(scene.stress(0)).max() / stiff),
    ]  # fmt: skip


def simple_shear(scheme: str, dimension: int, basis: str, steps: int = 10_000) -> list[Figure]:
    """E4: a block too heavy for its stress to slow it is sheared to gamma = 2 pi.

    The particle nearest to its middle is looked at: waves go .002 of a cell meanwhile. What the
    velocities that nodes begin with lack at the surface reaches it in smaller blocks, by 1e-6.
    """
    models = {
        "Jaumann": (matter(1e6, "elastic", E=2.6, nu=0.3), lambda g: (np.sin(g), 1 - np.cos(g))),
        "neo-Hookean": (matter(1e6, "neo_hookean", K=2.0, G=1.0), lambda g: (g, g**2)),
    }
    figures = []
    for name, (material, exact) in models.items():
        wide = [22.0] * dimension
        shear = [{"expression": f"{2 * math.pi} * y"}, *[0.0] * (dimension - 1)]
        block = box([-one for one in wide], wide, shear)
        run = {"time_step": 1.0 / steps}
        scene = InBody(dimension, 1.0, 1.0, {"a": block}, material, run=run)
        middle = int(np.linalg.norm(scene.x(0), axis=1).argmin())
        said = scene.run(1.0, lambda s, p=middle: [s.time, *s.stress(0)[p, [5, 0]]], 1)
        tau, s11 = exact(2 * math.pi * said[:, 0])
        for of, got, want in (("tau", said[:, 1], tau), ("s11", said[:, 2], s11)):
            error = np.abs(got - want).max()
            figures.append(judge("E4", f"{name}: largest error of {of} over G", error))
    return figures
