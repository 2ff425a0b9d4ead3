# SPDX-License-Identifier: BSD-3-Clause
"""The example of section 4.3, a short part of it: it holds its grains, and its balances close."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

from mpm3dpp import Case, Simulation, load_case
from mpm3dpp.base.neighbours import near_pairs

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "04_shaking_grains"
SPACING = 0.5e-3
STEPS = 300


def short() -> Case:
    """Return the case with two rows of small grains, all thrown down at 1 m/s."""
    case = load_case(FOLDER / "case_paper.toml")
    case.grains["small"].lattice.count = [23, 2]  # type: ignore[union-attr]
    for grains in case.grains.values():
        grains.velocity = (0.0, -1.0)
    return case


@cache
def run(threads: int, damped: bool = True) -> Simulation:
    case = short()
    if not damped:
        case.run.transfer = "flip"
    simulation = Simulation(case, threads)
    simulation.advance(STEPS)
    return simulation


def of_grains(simulation: Simulation, column: str) -> np.ndarray:
    return np.concatenate([simulation.column(name, column) for name in ("big", "small")])


@cache  # the core gives its rows once
def history(simulation: Simulation) -> dict[str, np.ndarray]:
    rows = simulation.core.history().T
    return dict(zip(simulation.core.history_columns, rows, strict=True))


def test_the_numbers_are_those_of_the_paper() -> None:
    """3 grains of 1,821 particles, 207 of 205, a container of 4,832, and 1,700,000 steps."""
    case = load_case(FOLDER / "case_paper.toml")
    simulation = Simulation(case, threads=1)
    core = simulation.core
    sizes = [len(core.column(b, "mass")) for b in range(core.body_count)]
    assert sorted(sizes) == sorted([1821] * 3 + [205] * 207 + [2412, 1210, 1210])
    simulation.advance(1)
    assert abs(case.run.end_time / simulation.time - 1.7e6) < 0.01 * 1.7e6


def test_the_container_holds_the_grains_and_they_do_not_overlap() -> None:
    """Particles of different grains stay half a spacing, a quarter of a cell, apart.

    Grains that touch have them a spacing apart; an impact at 1 m/s strains material with waves of
    37 m/s by some per cent. The rest is for surfaces that stand in steps.
    """
    simulation = run(1)
    x = of_grains(simulation, "position")
    assert x[:, 0].min() > 0.0 and x[:, 0].max() < 0.196
    assert x[:, 1].min() > 0.0 and x[:, 1].max() < 0.121
    assert simulation.left()["count"] == 0
    assert history(simulation)["friction"][-1] > 0.0  # they have met and slid
    grain = np.repeat(np.arange(49), [1821] * 3 + [205] * 46)
    a, b = near_pairs(x, SPACING)
    a, b = (k[grain[a] != grain[b]] for k in (a, b))
    assert np.linalg.norm(x[a] - x[b], axis=1).min(initial=SPACING) > 0.5 * SPACING


def test_the_energy_closes() -> None:
    rows = history(run(1))
    assert np.abs(rows["residual"]).max() < 1e-11 * rows["kinetic"].max()
    assert np.all(rows["motion_work"] == 0.0)  # nothing that stands still does work


def test_the_momentum_closes() -> None:
    """It is what gravity's integral and the container have given.

    PIC damping feeds particles a share of the correction of eqs. (6)-(7) too, which is not among
    the impulses (decision 0003), so this is without.
    """
    simulation = run(1, damped=False)
    rows = history(simulation)
    mass, omega, t = of_grains(simulation, "mass").sum(), 2 * np.pi * 15.0, rows["time"]
    fall = -9.81 * t + 29.43 / omega * (np.cos(omega * t) - 1.0)
    size = mass * 1.0  # at 1 m/s
    kept_x = rows["momentum_x"] - rows["motion_impulse_x"]
    kept_y = rows["momentum_y"] - rows["motion_impulse_y"] - mass * fall
    assert (
        np.abs(rows["motion_impulse_y"]).max() > 0.05 * size
    )  # the floor has stopped the big ones
    assert np.abs(kept_x).max() < 1e-11 * size
    assert np.abs(kept_y - kept_y[0]).max() < 1e-11 * size


def test_the_same_bits_on_two_threads() -> None:
    one, two = run(1), run(2)
    assert history(one).keys() == history(two).keys()
    assert all(history(one)[k].tobytes() == history(two)[k].tobytes() for k in history(one))
    for column in ("position", "velocity", "stress"):
        assert of_grains(one, column).tobytes() == of_grains(two, column).tobytes()
