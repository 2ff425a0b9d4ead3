# SPDX-License-Identifier: BSD-3-Clause
"""Draw the collapse of C7: `python -m verification.runout_picture OUT.png` in `tests/`."""

from __future__ import annotations

import argparse
import math
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import EllipseCollection

from . import runout
from .scene import Array

MOMENTS = (0.0, 1.5, 4.0)
"""In units of (H0 / g)^(1/2) after the release."""


def draw(centres: list[Array], radii: Array, width: float, high: float, path: Path) -> None:
    """Draw discs at each moment, coloured by where they stood first; a line where the law ends.

    Args:
        centres: of the discs at each moment [m], (n, 2).
        radii: [m], (n,).
        width, high: of the column [m].
        path: the PNG.
    """
    figure, rows = plt.subplots(len(centres), sharex=True, figsize=(7, 5.6), layout="constrained")
    for axes, x, moment in zip(rows, centres, MOMENTS, strict=True):
        size = 2 * radii
        discs = EllipseCollection(
            size, size, np.zeros_like(size), units="xy", offsets=x, transOffset=axes.transData,
            array=centres[0][:, 0], cmap="viridis", edgecolor="black", linewidth=0.3,
        )  # fmt: skip
        axes.add_collection(discs)
        axes.axvline(width + runout.LAW * high, color="tab:red", linewidth=0.8)
        axes.set(aspect="equal", xlim=(0.0, 1.05), ylim=(-0.01, 1.05 * high), ylabel="y [m]")
        axes.set_title(rf"{moment:g} $\sqrt{{H_0 / g}}$ after the release", loc="left", fontsize=9)
    rows[-1].set_xlabel("x [m]")
    figure.savefig(path, dpi=110)


def main() -> None:
    """Run C7 and draw it."""
    parser = argparse.ArgumentParser(prog="python -m verification.runout_picture")
    parser.add_argument("out", type=Path)
    path = parser.parse_args().out
    column = runout.build("musl", "gimp", 240, 1.0, 4.0)
    high = runout.settle(column)
    centres = []
    for moment in MOMENTS:
        column.scene.run(runout.SETTLE + moment * math.sqrt(high / runout.GRAVITY))
        centres.append(column.centres())
    draw(centres, column.radii, column.width, high, path)


if __name__ == "__main__":
    main()
