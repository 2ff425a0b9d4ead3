# SPDX-License-Identifier: BSD-3-Clause
"""Shocks, detonation and flows: the examples' own case files against exact and measured answers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp import Case, Eos, RunError, Simulation, load_case

from .figure import Figure, judge, reference, report
from .numerics import Numerics
from .scene import Failed

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CURVES = Path(__file__).parent / "curves"
Array = np.ndarray


def case_of(name: str, scheme: str, basis: str, file: str = "case.toml") -> Case:
    """Return the case of an example with another scheme or basis."""
    case = load_case(EXAMPLES / name / file)
    case.run.scheme = scheme
    Numerics.named(basis).give_case(case)
    return case


def curve(name: str) -> Any:
    """Return a table of `curves/` by column."""
    return np.genfromtxt(CURVES / f"{name}.csv", delimiter=",", names=True)


class Run:
    """An example that runs: its particles along x, all bodies together."""

    def __init__(self, case: Case) -> None:
        self.simulation = Simulation(case, threads=1)

    def to(self, time: float) -> Run:
        """Advance to a time [s].

        Raises:
            Failed: the run has become unstable.
        """
        try:
            self.simulation.advance(10**9, time)
        except RunError as error:
            raise Failed(str(error)) from None
        return self

    def column(self, name: str) -> Array:
        """Return a column of all bodies, shape (n, components)."""
        return np.concatenate([self.simulation.column(b, name) for b in self.simulation.bodies])

    def along_x(self) -> dict[str, Array]:
        """Return x, u, p, rho and the body's number of every particle, in the order of x."""
        x = self.column("position")[:, 0]
        order = np.argsort(x, kind="stable")
        counts = [len(self.simulation.column(b, "mass")) for b in self.simulation.bodies]
        found = {
            "x": x,
            "u": self.column("velocity")[:, 0],
            "p": -self.column("stress")[:, :3].mean(axis=1),
            "rho": (self.column("mass") / self.column("volume"))[:, 0],
            "body": np.repeat(np.arange(len(counts)), counts),
        }
        return {name: values[order] for name, values in found.items()}

    def history(self) -> dict[str, Array]:
        """Return the rows of the history that the core still holds, by column."""
        core = self.simulation.core
        return dict(zip(core.history_columns, core.history().T, strict=True))


def front(profile: dict[str, Array], level: float) -> float:
    """Return the largest x at which the pressure passes a level, by interpolation [m]."""
    x, p = profile["x"], profile["p"]
    last = int(np.flatnonzero(p > level)[-1])
    return float(np.interp(level, [p[last + 1], p[last]], [x[last + 1], x[last]]))


def plate_impact(
    scheme: str, dimension: int, basis: str, flyer: str = "copper", speed: float = 1000.0
) -> list[Figure]:
    """S1 (copper on copper) and S2 (6061-T6 on copper) at 1000 m/s or 2000, without strength."""
    case = case_of("11_plate_impact", scheme, basis)
    case.body["flyer"].velocity = (speed, 0.0)
    problem = "S1" if flyer == "copper" else "S2"
    problem += "" if speed == 1000.0 else f" at {speed:g} m/s"
    pressure = 1e9 * reference()[problem]["answers"]["pressure of the plateau"]["value"]
    if flyer != "copper":
        light = case.material["copper"].model_copy(deep=True)
        light.density = 2703.0
        constants = {"c0": 5350.0, "s": 1.34, "gamma0": 2.0}
        light.eos = Eos(model="mie_gruneisen", parameters=constants)
        case.material["flyer"] = light
        case.body["flyer"].material = "flyer"
    run, times, places = Run(case), np.linspace(0.4e-6, 1.0e-6, 13), []
    for time in times:
        places.append(front(run.to(time).along_x(), pressure / 2))
    profile = run.along_x()
    behind = (profile["x"] > 0.4 * places[-1]) & (profile["x"] < 0.85 * places[-1])
    behind &= profile["body"] == 1
    p, rho, u = (profile[name][behind] for name in ("p", "rho", "u"))
    figures = [judge(problem, "pressure of the plateau", p.mean() / 1e9)]
    if flyer == "copper":
        figures.append(judge(problem, "speed of the shock", np.polyfit(times, places, 1)[0]))
        figures.append(judge(problem, "density of the plateau", rho.mean()))
    else:
        figures.append(judge(problem, "velocity of the interface", u.mean()))
    return [*figures, report("rms of the pressure about its mean", p.std() / p.mean())]


def spall(scheme: str, dimension: int, basis: str) -> list[Figure]:
    """S5: two releases meet at the flyer's thickness from the free surface, without a limit."""
    case = case_of("12_spall", scheme, basis)
    case.material["copper"].failure = []
    run, h, pulls, moves = Run(case), 1e-3, [], []
    for time in np.linspace(0.60e-6, 0.95e-6, 36):
        profile = run.to(time).along_x()
        target = profile["body"] == 1
        depth = profile["x"][target].max() - profile["x"]
        if time < 0.75e-6:
            moves.append(profile["u"][target & (depth < 0.1 * h)].mean())
        if time > 0.80e-6:
            pulls.append(-profile["p"][target & (np.abs(depth - h) < 0.1 * h)].mean())
    return [
        judge("S5", "tension at the plane where the releases meet", np.mean(pulls) / 1e9),
        judge("S5", "velocity of the free surface", np.mean(moves)),
        report("tension, standard deviation in time", np.std(pulls) / 1e9, "GPa"),
    ]


def sod_tube(scheme: str, dimension: int, basis: str) -> list[Figure]:
    """S3 at t = 0.2: the mean error of the density, and the states between contact and waves."""
    case = case_of("13_sod_tube", scheme, basis)
    if Numerics.named(basis).factor is None:
        case.run.cfl = 0.05  # FLIP loses energy in proportion to it where points cross cells.
    run = Run(case).to(0.2)
    profile, exact = run.along_x(), curve("sod_t0.2")
    rho = np.interp(exact["x"], profile["x"], profile["rho"])
    x, p, u = profile["x"], profile["p"], profile["u"]
    star = (x > 0.52) & (x < 0.84) & (np.abs(x - 0.6854) > 0.02)  # the contact is at 0.5 + 0.2 u*
    left, right = star & (x < 0.6854), star & (x > 0.6854)
    return [
        judge("S3", "mean error of the density",
              np.abs(rho - exact["rho"]).mean() / exact["rho"].mean()),
        judge("S3", "pressure between the waves", p[star].mean()),
        judge("S3", "velocity between the waves", u[star].mean()),
        judge("S3", "density left of the contact", profile["rho"][left].mean()),
        judge("S3", "density right of the contact", profile["rho"][right].mean()),
        judge("S3", "speed of the shock", (front(profile, 0.2) - 0.5) / 0.2),
    ]  # fmt: skip


def tnt_slab(scheme: str, dimension: int, basis: str) -> list[Figure]:
    """S4 at 10 us: the Taylor wave behind a detonation that has run 69.3 mm in 2,000 cells."""
    case = case_of("14_tnt_slab", scheme, basis)
    run, cell = Run(case), case.grid.cell_size
    run.to(9.9e-6)
    profile = run.to(10e-6).along_x()
    h = run.history()
    energy = sum(h[name][-1] for name in ("kinetic", "internal", "plastic", "viscous"))
    start = 7e9 * 0.1 * cell  # E0 times the volume
    made = abs(energy / start - 1)
    reached, exact = 6930 * 10e-6, curve("tnt_taylor_wave")
    order = np.argsort(exact["x_over_Dt"])
    place, wave = exact["x_over_Dt"][order] * reached, exact["p_GPa"][order]
    cells = np.floor(profile["x"] / cell).astype(int)
    mean = np.bincount(cells, profile["p"] / 1e9) / np.maximum(np.bincount(cells), 1)
    centre = (np.arange(len(mean)) + 0.5) * cell
    inside = centre < reached
    error = np.abs(mean - np.interp(centre, place, wave, left=wave[0]))[inside].mean()
    still = profile["x"] < 0.3 * reached
    return [
        judge("S4", "front ahead of D t", (front(profile, 5e9) - reached) / cell),
        judge("S4", "largest pressure", profile["p"].max() / 1e9),
        judge("S4", "pressure of the plateau", profile["p"][still].mean() / 1e9),
        judge("S4", "mean error of the pressure over CJ", error / 21.0),
        judge("S4", "change of the total energy", made),
    ]


def dam_break(scheme: str, dimension: int, basis: str) -> list[Figure]:
    """W1: the front of a column of water between the two experiments, 5 % beyond either at most."""
    case, a = case_of("15_dam_break", scheme, basis), 0.05715
    run, unit = Run(case), np.sqrt(a / (2 * 9.81))
    rows = np.genfromtxt(
        CURVES / "dam_break_martin_moyce.csv", delimiter=",", skip_header=1, dtype=None,
        encoding="utf8",
    )  # fmt: skip
    sets: dict[str, list[tuple[float, float]]] = {}
    for name, time, place in rows:
        sets.setdefault(str(name), []).append((float(time), float(place)))
    times = np.array([1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 4.5, 5.0])
    ours, beyond = [], []
    for time in times:
        place = run.to(time * unit).column("position")[:, 0].max() + case.grid.cell_size / 4
        ours.append(place / a)
        measured = [
            np.interp(time, *zip(*points, strict=True))
            for points in sets.values()
            if points[0][0] <= time <= points[-1][0]
        ]
        beyond.append(max(ours[-1] / max(measured) - 1, 1 - ours[-1] / min(measured), 0.0))
    text = ", ".join(f"{t:g}: {z:.2f}" for t, z in zip(times, ours, strict=True))
    return [
        judge("W1", "front beyond the experiments, at most", max(beyond), remark=text),
        report("late slope dZ/dT", np.polyfit(times[-4:], ours[-4:], 1)[0]),
    ]


def sand_column(scheme: str, dimension: int, basis: str) -> list[Figure]:
    """G1: the run-out of a column of dry sand, height over length a = 1, against 1.2 a."""
    case = case_of("16_sand_column", scheme, basis)
    run = Run(case)
    run.to(case.run.end_time)
    place = run.column("position")
    length = case.body["sand"].shape.upper[0]  # type: ignore[attr-defined]
    # The deposit ends where it is first thinner than a cell: that is not resolved, and particles
    # that have jumped ahead of it are no deposit.
    h = case.grid.cell_size
    area = run.column("mass").sum() / case.material["sand"].density / len(place)
    thickness = np.bincount(np.floor(place[:, 0] / h).astype(int)) * area / h
    reach = h * int(np.flatnonzero(np.append(thickness, 0.0) < h)[0])
    at_wall = place[:, 0] < 2 * case.grid.cell_size
    top = place[at_wall, 1].max() + case.grid.cell_size / 4
    return [
        judge("G1", "run-out over the length", reach / length - 1),
        judge("G1", "height left over the length", top / length),
    ]


def taylor_bar(scheme: str, dimension: int, basis: str) -> list[Figure]:
    """A copper bar on a wall: length and diameters of the particles' centres, 80 us."""
    case = case_of("10_taylor_bar", scheme, basis)
    run = Run(case).to(80e-6)
    x = run.column("position")
    radius = np.hypot(x[:, 0], x[:, 1])
    return [
        judge("Taylor", "length", x[:, 2].max() * 1e3),
        judge("Taylor", "diameter of the foot", 2e3 * radius[x[:, 2] < 0.5e-3].max()),
        judge("Taylor", "diameter at 5.08 mm",
              2e3 * radius[np.abs(x[:, 2] - 5.08e-3) < 0.2e-3].max()),
        report("largest plastic strain", run.column("plastic_strain").max()),
    ]  # fmt: skip
