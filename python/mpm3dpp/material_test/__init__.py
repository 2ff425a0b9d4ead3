# SPDX-License-Identifier: BSD-3-Clause
"""A single material point, pulled, sheared, compressed or shocked: what does a material do?

>>> run_test("copper_ofhc", Options(test="hugoniot", to=500.0)).columns["pressure"][-1]
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from mpm3dpp.case.case import Material
from mpm3dpp.plots.labels import scaled

from . import driver, hugoniot, triaxial
from .curves import Curve, known_curves
from .failing import Failed, no_failure
from .options import TESTS, Options
from .subject import at_temperature, find

__all__ = ["TESTS", "Options", "Result", "main", "run_test"]


@dataclass(frozen=True)
class Result:
    """A material test that was done.

    Attributes:
        name: of the material.
        material: as it was tested.
        options: completed.
        columns: name -> values, shape (steps + 1,).
        units: name -> SI unit, "1" or empty for plain numbers.
        known: curves that the test should follow.
        failed: where it failed, or None.
        notes: what is not the same as in the program whose file the material is from.
    """

    name: str
    material: Material
    options: Options
    columns: dict[str, np.ndarray]
    units: dict[str, str]
    known: list[Curve]
    failed: Failed | None
    notes: list[str]


def run_test(subject: str, options: Options, units: str | None = None) -> Result:
    """Do a test.

    Args:
        subject: a material of the library, `case.toml:NAME` or `file.mpm:NAME`.
        options: what is done with it.
        units: unit system of a file of MPM3D-F90 that states none.

    Raises:
        CaseError: there is no such material, or it cannot be tested so.
    """
    chosen = options.completed()
    name, material, notes = find(subject, units)
    material = at_temperature(name, material, chosen)
    if chosen.test == "hugoniot":
        path = driver.Path(hugoniot.shock_test(name, material, chosen), hugoniot.UNITS)
    else:
        path = driver.stress_test(name, material, chosen)
    known = known_curves(material, chosen)
    return Result(name, material, chosen, path.columns, path.units, known, path.failed, notes)


def main(
    subject: str, options: Options, out: Path | None, json: bool, units: str | None = None
) -> str:
    """Do a test, write CSV and PNG, and return what is printed.

    Args:
        subject: as for `run_test`.
        options: as for `run_test`.
        out: folder; None for results/material_test.
        json: whether the text is JSON.
        units: as for `run_test`.
    """
    result = run_test(subject, options, units)
    from mpm3dpp.io.folders import writable_folder

    from . import plot, report

    folder = writable_folder(out if out is not None else Path("results") / "material_test")
    stem = f"{result.name}_{result.options.test.replace('-', '_')}"
    table = report.write_csv(folder / f"{stem}.csv", result.columns, result.units)
    title = headline(result)
    picture = plot.save_picture(folder / f"{stem}.png", title, result)
    if json:
        return report.as_json(result)
    lines = [title, "", report.table(result.options, result.columns, result.units), ""]
    if result.failed is not None:
        lines.append(result.failed.sentence())
    elif result.options.test != "hugoniot" and result.material.failure:
        lines.append(no_failure(result.material, result.columns))
    if result.options.pressure is not None and result.failed is None:
        pressure = result.options.pressure
        lines.append(triaxial.verdict(result.material, pressure, result.columns))
    lines += [report.deviation(result, curve) for curve in result.known]
    lines += [f"note: {note}" for note in result.notes]
    return "\n".join([*lines, str(table), str(picture)])


def headline(result: Result) -> str:
    """Return what was done with what, one line."""
    models = [result.material.strength.model]
    if result.options.test == "hugoniot":
        models = []
    if result.material.eos is not None:
        models.append(result.material.eos.model)
    rate = "" if result.options.rate is None else f" at {result.options.rate:g} 1/s"
    test = result.options.test.replace("-", " ").replace("hugoniot", "Hugoniot")
    pressure = result.options.pressure
    cell = "" if pressure is None else f", cell pressure {scaled(pressure, 'Pa')}"
    return f"{result.name} ({', '.join(models)}): {test}{rate}{cell}"
