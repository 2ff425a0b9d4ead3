# SPDX-License-Identifier: BSD-3-Clause
"""The problems of the table: cases as a user writes them, bodies filled as by default."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mpm3dpp import Case, load_case

from .. import bars, column, discs, examples, in_body, in_body_contact
from ..figure import Figure, reference
from ..numerics import AUTO, MATERIAL
from ..scene import Failed, Scene
from . import fields
from .measures import Measured, Watched

RUBBER = {"density": 1010.0, "strength": {"neo_hookean": {"K": 121.7e6, "G": 26.1e6}}}


def case(body: dict[str, Any], cell: float, end: float, material: Any = None, **run: Any) -> Case:
    """Return a case in 2D of one body."""
    return Case.from_tables(
        {
            "grid": {"dimension": 2, "cell_size": cell, "basis": "gimp"},
            "run": {"end_time": end, "energy_growth_limit": 1.0} | run,
            "material": {"solid": material or RUBBER},
            "body": {"body": {"material": "solid"} | body},
        },
        "table",
        {},
    )


def rings(name: str, scheme: str) -> Measured:
    """Example 01 with cells of 1 mm: rebound against finite elements."""
    given = load_case(examples.EXAMPLES / "01_two_rings" / "case_paper.toml")
    given.preset, given.grid.cell_size = None, 1e-3
    for body in given.body.values():
        body.fill = "shells"
    run = Watched(given, name, scheme)
    m, v = (run.simulation.column("left", n) for n in ("mass", "velocity"))
    rebound = -float((m * v).sum(0)[0] / m.sum())
    answer = reference()["E6"]["answers"]["rebound"]["value"]
    return run.measured(rebound / answer - 1, "left")


def breathing(name: str, scheme: str) -> Measured:
    """A ring breathes at 3 m/s in flight at 30 m/s, for 3.5 ms: its amplitude."""
    place = "(x - 0.07) / sqrt((x - 0.07)^2 + (y - 0.06)^2)"
    other = "(y - 0.06) / sqrt((x - 0.07)^2 + (y - 0.06)^2)"
    ring = {"centre": [0.07, 0.06], "inner_radius": 0.03, "outer_radius": 0.04}
    velocity = [{"expression": f"30 + 3 * {place}"}, {"expression": f"3 * {other}"}]
    run = Watched(case({"shape": {"ring": ring}, "velocity": velocity}, 1e-3, 3.5e-3), name, scheme)
    h, flight = run.history, 0.5 * run.simulation.core.total_mass * 900.0
    left = (h["kinetic"] + h["internal"] - flight) / (h["kinetic"] + h["internal"] - flight)[0]
    amplitude = math.sqrt(max(left[-1], 0.0))
    return run.measured(amplitude - 1, "body", energy=float(left[-1]))


def _spinning(body: dict[str, Any], cell: float, omega: float, turns: float, E: float) -> Case:
    material = {"density": 1000.0, "strength": {"elastic": {"E": E, "nu": 0.3}}}
    end = 2 * math.pi * turns / omega
    return case(body | {"angular_velocity": omega}, cell, end, material)


def _spun(run: Watched) -> Measured:
    kinetic = float(run.history["kinetic"][-1] / run.history["kinetic"][0])
    return run.measured(kinetic - 1, "body", spin=run.spin() / run.spin_at_start)


def grain(name: str, scheme: str) -> Measured:
    """A disc of 4 cells a radius, 3.2 turns at 50 rad/s: its kinetic energy."""
    disc = {"disc": {"centre": [0.0, 0.0], "radius": 0.04}}
    return _spun(Watched(_spinning({"shape": disc}, 0.01, 50.0, 3.2, 1e6), name, scheme))


def bar(name: str, scheme: str) -> Measured:
    """A bar of 20 x 4 cells, ten turns at 30 rad/s: its kinetic energy."""
    box = {"box": {"lower": [-0.1, -0.02], "upper": [0.1, 0.02]}}
    return _spun(Watched(_spinning({"shape": box}, 0.01, 30.0, 10.0, 1e7), name, scheme))


def disc(name: str, scheme: str) -> Measured:
    """A disc of 20 cells a radius, 3.2 turns, its rim at 5 % of the speed of sound."""
    shape = {"shape": {"disc": {"centre": [0.0, 0.0], "radius": 1.0}}}
    speed = math.sqrt(1e7 * 0.7 / (1.3 * 0.4) / 1000.0)
    return _spun(Watched(_spinning(shape, 0.05, 0.05 * speed, 3.2, 1e7), name, scheme))


def vortex(name: str, scheme: str, cell: float = 0.025) -> Measured:
    """A ring is turned by a radian and back, less at its edges (Kamojjala et al. 2015)."""
    run = Watched(fields.vortex(cell), name, scheme)
    wrong = run.position("body") - run.start["body"]
    return run.measured(float(np.sqrt((wrong**2).sum(1).mean())) / cell, "body", energy=math.nan)


def manufactured(name: str, scheme: str, cells: int = 32) -> Measured:
    """Waves along both axes with forces made for them: largest error over the amplitude."""
    run = Watched(fields.manufactured(cells, 0.05), name, scheme)
    wrong = run.position("body") - fields.manufactured_place(run.start["body"], 0.05)
    return run.measured(float(np.abs(wrong).max()) / 0.05, "body", energy=math.nan)


def expanding(name: str, scheme: str) -> Measured:
    """A thin ring of a perfectly plastic metal flies apart at 133.33 m/s: how far."""
    run = Watched(fields.expanding(), name, scheme)
    x = run.position("body")
    radius = float(np.hypot(x[:, 0], x[:, 1]).mean() / np.hypot(*run.start["body"].T).mean())
    return run.measured(radius / fields.EXPANDED - 1, "body")


def _figures(
    figures: Callable[..., list[Figure]], judged: str, name: str, scheme: str, **more: Any
) -> Measured:
    """Take the error of one figure of a problem of the verification."""
    before = Scene.steps_made
    found = {f.name: f for f in figures(scheme, 2, name, **more)}
    figure = found[judged]
    assert figure.answer is not None
    size = abs(figure.answer) or 1.0
    return Measured((figure.ours - figure.answer) / size, steps=Scene.steps_made - before)


def vibration(name: str, scheme: str) -> Measured:
    """E1: what is left of the amplitude of a bar after ten periods."""
    figure = "amplitude after 10 periods over the first"
    if name == AUTO:
        return _figures(in_body.vibration, figure, MATERIAL, scheme, cells=26)
    return _figures(column.vibration, figure, name, scheme, cells=26)


def two_bars(name: str, scheme: str) -> Measured:
    """E2: the velocity of the bar that was hit."""
    figure = "second bar's velocity after"
    if name == AUTO:
        return _figures(in_body.two_bars, figure, MATERIAL, scheme, cells=100)
    return _figures(bars.two_bars, figure, name, scheme, cells=100)


def two_discs(name: str, scheme: str) -> Measured:
    """E5: the restitution of Sulsky's discs."""
    if name == AUTO:
        return _figures(in_body_contact.sulsky_discs, "restitution", MATERIAL, scheme, cells=40)
    return _figures(discs.sulsky_discs, "restitution", name, scheme)


def sod(name: str, scheme: str) -> Measured:
    """S3: mean error of the density in Sod's tube."""
    return _figures(examples.sod_tube, "mean error of the density", name, scheme)


def impact(name: str, scheme: str) -> Measured:
    """S1: copper on copper at 2000 m/s: pressure, and the total energy behind the shocks."""
    given = load_case(examples.EXAMPLES / "11_plate_impact" / "case.toml")
    given.body["flyer"].velocity, given.run.end_time = (2000.0, 0.0), 1e-6
    run = Watched(given, name, scheme)
    x, p = run.position("target")[:, 0], run.simulation.column("target", "stress")[:, :3]
    p = -p.mean(1)
    loaded = x[p > 0.5 * p.max()]
    if not len(loaded):
        raise Failed("no shock")
    behind = (x > 0.4 * loaded.max()) & (x < 0.85 * loaded.max())
    answer = 1e9 * reference()["S1 at 2000 m/s"]["answers"]["pressure of the plateau"]["value"]
    return run.measured(float(p[behind].mean()) / answer - 1, "target", noise=math.nan)


PROBLEMS: dict[str, Callable[[str, str], Measured]] = {
    problem.__name__: problem
    for problem in (
        rings, breathing, grain, bar, disc, vortex, manufactured, expanding, vibration, two_bars,
        two_discs, sod, impact,
    )
}  # fmt: skip
