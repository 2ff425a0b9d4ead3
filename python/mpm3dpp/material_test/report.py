# SPDX-License-Identifier: BSD-3-Clause
"""A material test as text, as CSV and as JSON."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from mpm3dpp.base.disk import replacing
from mpm3dpp.base.ours import refuse_others
from mpm3dpp.plots.labels import prefix

from .curves import Curve
from .failing import STRESS
from .options import Options

if TYPE_CHECKING:
    from . import Result

SHOWN = {
    "stress": (
        *(
            "strain",
            "lateral_strain",
            "volumetric_strain",
            "deviator",
            "stress_xx",
            "stress_yy",
            "stress_xy",
            "pressure",
        ),
        *("von_mises", "plastic_strain", "temperature", "work", "damage", "failed"),
    ),
    "hugoniot": (
        *("particle_velocity", "shock_velocity", "pressure", "density", "volume"),
        "internal_energy",
    ),
}
_MOST_ROWS = 20


def table(options: Options, columns: dict[str, np.ndarray], units: dict[str, str]) -> str:
    """Return about twenty rows of the columns that matter, with units in the head."""
    kind = "hugoniot" if options.test == "hugoniot" else "stress"
    names = [name for name in SHOWN[kind] if name in columns]
    if options.test != "shear":
        names = [name for name in names if name != "stress_xy"]
    count = len(columns[names[0]])
    stride = max(1, (count - 1) // _MOST_ROWS)
    chosen = list(range(0, count, stride))
    if chosen[-1] != count - 1:
        chosen.append(count - 1)
    cells = []
    for name in names:
        values, unit = columns[name], units[name]
        factor, unit = prefix(float(np.nanmax(np.abs(values), initial=0.0)), unit)
        head = [name, f"[{unit or '1'}]"]
        cells.append([*head, *(f"{factor * values[k] + 0.0:.6g}" for k in chosen)])
    wide = [max(len(text) for text in column) for column in cells]
    return "\n".join(
        "  ".join(column[row].rjust(width) for column, width in zip(cells, wide, strict=True))
        for row in range(len(cells[0]))
    )


def write_csv(path: Path, columns: dict[str, np.ndarray], units: dict[str, str]) -> Path:
    """Write all rows and columns; the first line holds the names and units."""
    head = ",".join(f"{name} [{units[name] or '1'}]" for name in columns)
    refuse_others(path, head.encode(), mark="")
    with replacing(path) as file:
        rows = np.column_stack(list(columns.values()))
        np.savetxt(file, rows, "%.12g", ",", header=head, comments="")
    return path


def as_json(result: Result) -> str:
    """Return a test as JSON: what was tested, how, all columns, and where it failed."""
    options = result.options
    asked = {"rate": options.rate, "to": options.to, "steps": options.steps}
    asked |= {"pressure": options.pressure}
    return json.dumps(
        {
            "material": result.name,
            "table": result.material.table(),
            "test": options.test,
            **asked,
            "failed": None if result.failed is None else result.failed.table(),
            "notes": result.notes,
            "units": result.units,
            "columns": {key: values.tolist() for key, values in result.columns.items()},
        },
        indent=1,
    )


def deviation(result: Result, curve: Curve) -> str:
    """Return how far a test is from a known curve, as shares of the curve's largest value.

    Rows that have failed do not count: no curve knows of failure.
    """
    rows = slice(None) if result.failed is None else slice(max(result.failed.row, 1))
    test = result.options.test
    name = {"hugoniot": "shock_velocity", **STRESS}.get(test, "stress_xx")
    order = np.argsort(curve.x)
    x = next(iter(result.columns.values()))[rows]
    known = np.interp(x, curve.x[order], curve.y[order])
    error = np.abs(result.columns[name][rows] - known) / np.abs(curve.y).max()
    end = "at the end" if result.failed is None else "before it fails"
    return f"against {curve.label}: off by {error.max():.1e} at most, {error[-1]:.1e} {end}"
