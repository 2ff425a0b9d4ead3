# SPDX-License-Identifier: BSD-3-Clause
"""The picture of a material test: the curve, and what is known of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mpm3dpp.plots.labels import prefix
from mpm3dpp.plots.style import PALETTE, new_figure, save, styled

from .failing import STRESS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from . import Result

_KNOWN: dict[str, Any] = {"color": "black", "linestyle": (0, (4, 3)), "linewidth": 1.0}
_MARK: dict[str, Any] = {"marker": "X", "markersize": 7, "linestyle": "none", "zorder": 5}


def save_picture(path: Path, title: str, result: Result) -> Path:
    """Draw a test and write it as PNG.

    Args:
        path: of the picture.
        title: name of the material and what is done with it.
        result: of the test.
    """
    draw = _shocks if result.options.test == "hugoniot" else _path
    with styled():
        figure = new_figure(8.6, 3.5)
        left, right = figure.subplots(1, 2)
        draw(left, right, result)
        for axes in (left, right):
            axes.grid(True)
        figure.suptitle(title, fontsize=10)
        return save(figure, path)


def _path(left: Axes, right: Axes, result: Result) -> None:
    shear, columns = result.options.test == "shear", result.columns
    squeezed, name = result.options.test == "triaxial", STRESS.get(result.options.test, "stress_xx")
    strain, stress = columns["strain"], columns[name]
    factor, unit = prefix(float(np.abs(stress).max()), "Pa")
    left.plot(strain, factor * stress, color=PALETTE[0], label=name.replace("_", " "))
    if squeezed:
        left.invert_xaxis()
        right.invert_xaxis()
    if "lateral_strain" not in columns:  # else von Mises' stress is the same line
        mises = factor * columns["von_mises"]
        left.plot(strain, mises, color=PALETTE[1], label="von Mises stress")
    for curve in result.known:
        left.plot(curve.x, factor * curve.y, label=curve.label, **_KNOWN)
    failed = result.failed
    if failed is not None:
        label = f"fails: {' and '.join(model.model for model in failed.models)}"
        point = (failed.before, factor * failed.stress)
        left.plot(*point, color=PALETTE[4], label=label, **_MARK)
    left.set_xlabel("shear [1]" if shear else "logarithmic strain [1]")
    left.set_ylabel(f"stress [{unit}]")
    left.legend()
    if "temperature" in columns and np.ptp(columns["temperature"]) > 0.01:
        right.plot(strain, columns["temperature"], color=PALETTE[4])
        right.set_xlabel(left.get_xlabel())
        right.set_ylabel("temperature [K]")
        return
    if squeezed:
        right.plot(strain, columns["volumetric_strain"], color=PALETTE[2])
        right.set_xlabel(left.get_xlabel())
        right.set_ylabel("volumetric strain [1]")
        return
    pressure = columns["pressure"]
    factor, unit = prefix(float(np.abs(pressure).max()), "Pa")
    right.plot(columns["volume"], factor * pressure, color=PALETTE[2])
    right.set_xlabel("volume / initial volume [1]")
    right.set_ylabel(f"pressure [{unit}]")


def _shocks(left: Axes, right: Axes, result: Result) -> None:
    columns = result.columns
    up, us = columns["particle_velocity"], columns["shock_velocity"]
    dots: dict[str, Any] = {"color": PALETTE[0], "marker": "o", "markersize": 3.5, "linewidth": 0.8}
    left.plot(up / 1e3, us / 1e3, label="equation of state", **dots)
    for curve in result.known:
        left.plot(curve.x / 1e3, curve.y / 1e3, label=curve.label, **_KNOWN)
    left.set_xlabel("particle velocity [km/s]")
    left.set_ylabel("shock velocity [km/s]")
    left.legend()
    factor, unit = prefix(float(np.abs(columns["pressure"]).max()), "Pa")
    right.plot(columns["volume"], factor * columns["pressure"], **dots)
    right.set_xlabel("volume / initial volume [1]")
    right.set_ylabel(f"pressure [{unit}]")
