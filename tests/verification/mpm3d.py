# SPDX-License-Identifier: BSD-3-Clause
"""Inputs of MPM3D-F90, run here and beside its own results: python -m verification.mpm3d NAME ...

The inputs and the end states of MPM3D-F90 are in mpm/. A run ends at the time at which MPM3D-F90's
last step ended, which is a part of a step later than the file asks for.
"""

from __future__ import annotations

import argparse
import gzip
import json
import time
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from mpm3dpp import Case, Simulation
from mpm3dpp.importers.mpm3d.lexer import split
from mpm3dpp.importers.mpm3d.to_case import import_source
from mpm3dpp.importers.mpm3d.units import SYSTEMS

FOLDER = Path(__file__).parent / "mpm"
HEAD = (
    "| case | figure | ours | MPM3D-F90 | difference | tolerance | |\n"
    "| --- | --- | --- | --- | --- | --- | --- |"
)


@dataclass(frozen=True)
class Row:
    """A figure of both programs.

    Attributes:
        name: with its unit.
        ours, theirs: the numbers.
        scale: what a difference is relative to.
        tolerance: of the relative difference; None if it is only reported.
    """

    name: str
    ours: float
    theirs: float
    scale: float
    tolerance: float | None = None

    @property
    def difference(self) -> float:
        """Ours less theirs, over the scale."""
        return (self.ours - self.theirs) / self.scale

    @property
    def passed(self) -> bool:
        """Within the tolerance, or finite where there is none."""
        if self.tolerance is None:
            return bool(np.isfinite(self.ours))
        return abs(self.difference) <= self.tolerance

    def cells(self) -> str:
        """Return the row of a table, without the case."""
        limit = "-" if self.tolerance is None else f"± {self.tolerance:.1%}"
        verdict = "reported" if self.tolerance is None else "pass" if self.passed else "**FAIL**"
        numbers = f"{self.ours:.6g} | {self.theirs:.6g} | {self.difference:+.2%}"
        return f"{self.name} | {numbers} | {limit} | {verdict} |"


@cache
def reference() -> dict[str, Any]:
    """Return the results of MPM3D-F90 by case, in the units of the files."""
    return json.loads((FOLDER / "mpm3d.json").read_text())["cases"]


def text_of(name: str) -> str:
    """Return the text of an input file."""
    packed = FOLDER / f"{name}.mpm.gz"
    data = gzip.decompress(packed.read_bytes()) if packed.exists() else None
    data = data if data is not None else (FOLDER / f"{name}.mpm").read_bytes()
    return data.decode("latin-1")


def imported(name: str) -> Case:
    """Return an input file as a case that ends when MPM3D-F90's run ended."""
    given = reference()[name]
    case = import_source(split(text_of(name), f"{name}.mpm"), given["units"]).case
    case.run.end_time = SYSTEMS[given["units"]].si(given["end"], "time")
    return case


def run(case: Case) -> tuple[Simulation, dict[str, np.ndarray]]:
    """Run a case to its end; return it with the columns of its history."""
    simulation = Simulation(case, threads=None)
    rows = []
    while simulation.time < case.run.end_time:
        simulation.advance(256)
        rows.append(simulation.core.history())
    table = np.concatenate(rows)
    names = simulation.core.history_columns
    return simulation, {name: table[:, k] for k, name in enumerate(names)}


def compare(name: str, simulation: Simulation, history: dict[str, np.ndarray]) -> list[Row]:
    """Return the figures of a finished run beside those of MPM3D-F90, in the units of its file."""
    given = reference()[name]
    units, limit = SYSTEMS[given["units"]], given["tolerance"]
    energy = float(units.factor("stress") * units.factor("volume"))
    length = float(units.factor("length"))
    kinetic = history["kinetic"][-1] / energy
    # What MPM3D-F90 counts as internal: all work of the stress, be it lost by plasticity or by
    # artificial viscosity.
    parts = ("internal", "plastic", "viscous")
    internal = sum(history[part][-1] for part in parts) / energy
    rows = [
        _energy("kinetic energy", kinetic, given["kinetic"][1], limit.get("energy")),
        _energy("largest kinetic energy", history["kinetic"].max() / energy,
                given["largest_kinetic"], limit.get("energy")),
        _energy("internal energy", internal, given["internal"][1], limit.get("energy")),
        _energy("total energy", kinetic + internal, given["kinetic"][1] + given["internal"][1],
                limit.get("energy")),
    ]  # fmt: skip
    if "mean_kinetic" in given:
        begin, theirs = given["mean_kinetic"]["from"], given["mean_kinetic"]["mean"]
        late = history["time"] > units.si(begin, "time")
        mean = np.average(history["kinetic"][late], weights=history["dt"][late]) / energy
        name = f"mean kinetic energy from {begin:g}"
        rows.append(_energy(name, mean, theirs, limit.get("energy")))
    x = np.concatenate([simulation.column(b, "position") for b in simulation.bodies]) / length
    for axis, (low, high) in zip("xyz", given["bounds"], strict=True):
        own = x[:, "xyz".index(axis)]
        extent = high - low
        if extent > 0:
            rows.append(Row(f"extent {axis}", float(np.ptp(own)), extent, extent,
                            limit.get("length")))  # fmt: skip
            rows.append(Row(f"largest {axis}", float(own.max()), high, extent,
                            limit.get("length")))  # fmt: skip
    rows += _plastic(simulation, given)
    momentum = float(units.factor("mass") * units.factor("velocity"))
    size = np.sqrt(2 * given["mass"] * max(*given["kinetic"], 1e-300))
    for k, axis in enumerate("xyz"):
        ours = float(history[f"momentum_{axis}"][-1]) / momentum
        rows.append(Row(f"momentum {axis}", ours, given["momentum"][1][k], float(size)))
    return rows


def _energy(name: str, ours: float, theirs: float, tolerance: float | None) -> Row:
    return Row(name, float(ours), theirs, abs(theirs), tolerance)


def _plastic(simulation: Simulation, given: dict[str, Any]) -> list[Row]:
    largest = 0.0
    for number, body in enumerate(simulation.bodies):
        if any(c.name == "plastic_strain" for c in simulation.core.columns(number)):
            largest = max(largest, float(simulation.column(body, "plastic_strain").max()))
    if largest == 0.0:
        return []
    theirs = given["plastic_strain"]
    return [Row("largest plastic strain", largest, theirs, theirs)]


def main() -> None:
    """Run the cases asked for, by default all, and print the table."""
    parser = argparse.ArgumentParser(prog="python -m verification.mpm3d", description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help=", ".join(reference()))
    names = parser.parse_args().names
    unknown = [name for name in names if name not in reference()]
    if unknown:
        parser.error(f"unknown: {', '.join(unknown)}; valid are {', '.join(reference())}")
    print(HEAD)
    judged = passed = 0
    for name in names or reference():
        begin = time.monotonic()
        simulation, history = run(imported(name))
        rows = compare(name, simulation, history)
        steps = reference()[name]["steps"]
        rows.append(Row("steps", simulation.step, steps, steps))
        for row in rows:
            print(f"| {name} | {row.cells()}", flush=True)
        judged += sum(row.tolerance is not None for row in rows)
        passed += sum(row.tolerance is not None and row.passed for row in rows)
        print(f"| {name} | seconds | {time.monotonic() - begin:.1f} | | | | reported |")
    print(f"\n{passed} of {judged} figures with a tolerance are within it")


if __name__ == "__main__":
    main()
