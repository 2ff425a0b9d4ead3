# SPDX-License-Identifier: BSD-3-Clause
"""Draw the one-dimensional examples beside their exact solutions, into docs/images.

    PYTHONPATH=tests python tools/plot_examples.py    (mpm3dpp must be installed)

The flows and the bar have `frame.png` of their own results.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mpm3dpp import Case, load_case
from verification.examples import EXAMPLES, Run, curve

IMAGES = Path(__file__).resolve().parents[1] / "docs" / "images"


def draw(name: str, x: Any, y: Any, exact: tuple[Any, Any], labels: tuple[str, str]) -> None:
    """Write one picture: particles as points, the exact solution as a line."""
    figure, axes = plt.subplots(figsize=(6.0, 3.0), layout="constrained")
    axes.plot(x, y, ".", ms=2, color="0.55", label="particles")
    axes.plot(*exact, color="tab:red", lw=1.2, label="exact")
    axes.set_xlabel(labels[0])
    axes.set_ylabel(labels[1])
    axes.legend(frameon=False)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(IMAGES / f"{name}.png", dpi=130)
    plt.close(figure)
    print(IMAGES / f"{name}.png")


def as_written(name: str) -> Case:
    """Return the case of an example."""
    return load_case(EXAMPLES / name / "case.toml")


def main() -> None:
    """Run the four examples and draw them."""
    time = 1e-6
    found = Run(as_written("11_plate_impact")).to(time).along_x()
    up, us = 500.0, 4685.0
    back, front = (1000.0 - us) * time, us * time  # the shock in the flyer, seen from the target
    edges = [-5e-3 + 1000 * time, back, back, front, front, 1e-2]
    levels = [0, 0, 1, 1, 0, 0]
    exact = (1e3 * np.array(edges), 8930 * us * up / 1e9 * np.array(levels))
    draw("plate_impact", 1e3 * found["x"], found["p"] / 1e9, exact, ("x [mm]", "pressure [GPa]"))

    time, c, h = 0.9e-6, 3940.0, 1.0  # acoustic; mm
    found = Run(as_written("12_spall")).to(time).along_x()
    free, half = 1e3 * found["x"].max(), 1e3 * c * (time - 0.75e-6) * h
    edges = [1e3 * found["x"].min(), free - 1 - half, free - 1 - half, free - 1 + half]
    edges += [free - 1 + half, free]
    exact = (edges, -1.76 * np.array([0, 0, 1, 1, 0, 0]))
    draw("spall", 1e3 * found["x"], found["p"] / 1e9, exact, ("x [mm]", "pressure [GPa]"))

    found, table = Run(as_written("13_sod_tube")).to(0.2).along_x(), curve("sod_t0.2")
    draw("sod_tube", found["x"], found["rho"], (table["x"], table["rho"]), ("x", "density"))

    found, table = (
        Run(as_written("14_tnt_slab")).to(1e-5).along_x(),
        curve("tnt_taylor_wave"),
    )
    place = np.append(np.append(69.3, 69.3 * table["x_over_Dt"]), 0.0)
    wave = np.append(np.append(0.0, table["p_GPa"]), table["p_GPa"][-1])
    draw(
        "tnt_slab", 1e3 * found["x"], found["p"] / 1e9, (place, wave), ("x [mm]", "pressure [GPa]")
    )


if __name__ == "__main__":
    main()
