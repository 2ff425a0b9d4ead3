# SPDX-License-Identifier: BSD-3-Clause
"""Problems as a user writes them: case files, filled by default, or else by the grid's lattice.

A lattice has steps of half a spacing on the surface of discs and spheres.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from mpm3dpp import Case, RunError, Simulation, load_case

from .figure import Figure, judge, report
from .grains import RADIUS, bounce, hertz_figures
from .numerics import Numerics
from .point import spin_figures
from .scene import Array, Failed, slope

CASES = Path(__file__).parent / "cases"


def _case(
    name: str, scheme: str, dimension: int, basis: str, cells: int, radius: float, fill: str | None
) -> Case:
    """Return a case file with so many cells a radius [m], all else as it is written."""
    case = load_case(CASES / f"{name}.toml")
    assert case.grid.dimension == dimension
    case.run.scheme = scheme
    Numerics.named(basis).give_case(case)
    case.grid.cell_size = radius / cells
    for body in case.body.values():
        body.fill = fill if body.motion is None else None
    return case


def _watched(case: Case, body: str, every: int) -> Array:
    """Run a case; return how a body moves, and the impulse of the first pair on it.

    Returns:
        Rows of time [s], mass centre [m], its velocity [m/s], spin about z [rad/s] and impulse
        along x so far [N s], shape (n, 4 + 2 D).
    """
    simulation, said = Simulation(case), []
    try:
        while simulation.advance(every):
            m, x, v = (simulation.column(body, name) for name in ("mass", "position", "velocity"))
            centre, drift = (m * x).sum(0) / m.sum(), (m * v).sum(0) / m.sum()
            x, v = x - centre, v - drift
            turn = (m[:, 0] * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum()
            turn /= (m * x[:, :2] ** 2).sum()
            pairs = simulation.core.contact_pairs()
            impulse = pairs[0].impulse[0] if pairs else 0.0
            said.append([simulation.time, *centre, *drift, turn, impulse])
    except RunError as error:
        raise Failed(str(error)) from None
    return np.array(said)


def spinning_disc(
    scheme: str, dimension: int, basis: str, cells: int = 10, points: int | None = None,
    fill: str | None = None,
) -> list[Figure]:  # fmt: skip
    """E3: a disc spins 3.2 times; with so many points a cell along each axis, or the default."""
    case = _case("spin", scheme, dimension, basis, cells, 1.0, fill)
    case.body["disc"].particles_per_cell = points
    simulation = Simulation(case)

    def state() -> tuple[float, float]:
        m, x, v = (simulation.column("disc", name) for name in ("mass", "position", "velocity"))
        return float((m[:, 0] * (x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0])).sum()), float(
            0.5 * (m * v * v).sum()
        )

    momentum, kinetic = state()
    simulation.advance(10**9)
    history = dict(zip(simulation.core.history_columns, simulation.core.history().T, strict=True))
    energy = (history["kinetic"] + history["internal"])[-1] / kinetic
    return spin_figures(state()[0] / momentum, energy, cells, judged=True)


def rolling_disc(
    scheme: str, dimension: int, basis: str, cells: int = 8, fill: str | None = None
) -> list[Figure]:
    """E9: a disc rolls down an incline; the first 0.1 s, while it settles, does not count."""
    said = _watched(_case("rolling", scheme, dimension, basis, cells, 0.1, fill), "disc", 20)
    time, drift, turn = said[:, 0], said[:, 3], said[:, 5]
    late = time > 0.1
    acceleration = slope(time[late], drift[late])
    rolls = -0.1 * slope(time[late], turn[late]) / acceleration
    return [
        judge("E9", "disc, 30 degrees, mu 0.3 sticks", acceleration),
        report("disc, 30 degrees: R alpha over a", rolls),
    ]


def hertz_spheres(
    scheme: str, dimension: int, basis: str, cells: int = 20, fill: str | None = None
) -> list[Figure]:
    """C1: a sphere of `cells` a diameter and its mirror image meet at 1 and at 0.5 m/s each."""
    found = {}
    for speed in (1.0, 0.5):
        case = _case("hertz", scheme, dimension, basis, cells, 2 * RADIUS, fill)
        away = RADIUS + 0.1 * case.grid.cell_size
        for body, side in (("left", -1.0), ("right", 1.0)):
            case.body[body].velocity = (-side * speed, 0.0, 0.0)
            case.body[body].shape = case.body[body].shape.model_copy(
                update={"centre": (side * away, 0.0, 0.0)}
            )
        said = _watched(case, "left", 4)
        rows = np.stack([said[:, 0], np.abs(said[:, 8]), -said[:, 1], said[:, 4]], axis=1)
        found[speed] = bounce(rows)
    return hertz_figures(found)
