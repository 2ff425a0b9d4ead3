# SPDX-License-Identifier: BSD-3-Clause
"""Draw which of four ranks has which grains of the small hopper, into docs/images/ranks.png.

python tools/plot_ranks.py    (mpm3dpp must be installed)
"""

from __future__ import annotations

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from mpm3dpp import Simulation, load_case
from mpm3dpp.plots.style import PALETTE

ROOT = Path(__file__).resolve().parents[1]
IMAGE = ROOT / "docs" / "images" / "ranks.png"
TIMES = (0.0, 0.3)  # s
RANKS = 4


def main() -> None:
    """Draw it."""
    case = load_case(ROOT / "examples" / "05_hopper" / "case_small.toml")
    # Threads that do as processes: who has what is the same.
    simulation = Simulation(case, threads=1, ranks=RANKS)
    figure, row = plt.subplots(1, len(TIMES), figsize=(8.6, 4.6), sharex=True, sharey=True)
    for axes, time in zip(row, TIMES, strict=True):
        simulation.advance(10**9, time)
        for name in ("sand", "funnel"):
            place = 1e3 * simulation.column(name, "position")
            ranks = simulation.ranks_of(name)
            for rank in range(RANKS):
                mine = place[ranks == rank]
                label = f"rank {rank}" if name == "sand" else None
                axes.plot(*mine.T, ".", ms=1.2, color=PALETTE[rank], label=label)
        axes.set_aspect("equal")
        axes.set_title(f"t = {simulation.time:g} s", fontsize=10)
        axes.set_xlabel("x [mm]")
    row[0].set_ylabel("y [mm]")
    figure.subplots_adjust(0.07, 0.16, 0.99, 0.94, wspace=0.04)
    handles = row[0].get_legend_handles_labels()
    figure.legend(*handles, loc="lower center", ncols=RANKS, markerscale=8, frameon=False)
    figure.savefig(IMAGE, dpi=110)


if __name__ == "__main__":
    main()
