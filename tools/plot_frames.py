# SPDX-License-Identifier: BSD-3-Clause
"""Draw what is left of a soft block's energy in three hits, into docs/images/frames.png.

    python tools/plot_frames.py

Takes half a minute.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from mpm3dpp import Case, Simulation

OUT = Path(__file__).parents[1] / "docs" / "images" / "frames.png"
COLOURS = {"updated": "tab:orange", "material": "tab:blue"}
LINES = {6: "-", 20: "--"}


def block(frame: str, cells: int) -> tuple[Any, Any]:
    """Return times over that of the run, and the energy left of a block of some cells."""
    h, E, density = 1e-3, 1e6, 1000.0
    length, g = cells * h, 400.0 * 6 / cells
    end = 3 * 2.1 / g + 0.5 / g + 6 * length / np.sqrt(E / density)
    shape = {"box": {"lower": [-length / 2, 0.5 * h], "upper": [length / 2, 0.5 * h + length]}}
    corners = {"lower": [-30 * h, 0], "upper": [30 * h, 60 * h]}
    body = {"material": "m", "shape": shape, "velocity": [0.0, -1.0], "frame": frame}
    case = Case.model_validate(
        {
            "grid": {
                "dimension": 2,
                "cell_size": h,
                "box": {**corners, "walls": {"y_min": "contact"}},
            },
            "run": {"end_time": end, "gravity": [0.0, -g]},
            "material": {"m": {"density": density, "strength": {"elastic": {"E": E, "nu": 0.3}}}},
            "body": {"b": body},
        }
    )
    simulation = Simulation(case)
    rows = []
    while simulation.time < end:
        simulation.advance(1000, end)
        rows.append(simulation.core.history())
    columns = dict(zip(simulation.core.history_columns, np.concatenate(rows).T, strict=True))
    energy = columns["kinetic"] + columns["internal"] + columns["springs"] - columns["external"]
    return columns["time"] / end, energy / energy[0]


def main() -> None:
    """Draw both frames, of 6 and 20 cells."""
    figure, axes = plt.subplots(figsize=(7.0, 3.6), layout="constrained")
    for frame, colour in COLOURS.items():
        for cells, line in LINES.items():
            times, energy = block(frame, cells)
            label = f'frame = "{frame}", {cells} cells'
            axes.plot(times, energy, color=colour, linestyle=line, label=label)
    axes.set(xlabel="time over that of three hits", ylabel="energy left", ylim=(0.0, 1.05))
    axes.legend(loc="lower left")
    figure.savefig(OUT, dpi=110)


if __name__ == "__main__":
    main()
