# SPDX-License-Identifier: BSD-3-Clause
"""Height of the big grains' centres over that of all grains together: heights.py RESULTS."""

from __future__ import annotations

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import mpm3dpp


def heights(folder: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return of each frame the time [s] and the mean heights of big and of all grains [m]."""
    with mpm3dpp.open_results(folder) as results:
        big, small = (results.bodies.index(name) for name in ("big", "small"))
        means = []
        for frame in range(len(results)):
            arrays = results.arrays(frame)
            y = arrays["position"][:, 1].astype(float)
            grains = np.isin(arrays["body"], (big, small))
            means.append((y[arrays["body"] == big].mean(), y[grains].mean()))
        return results.times, *np.array(means).T


def main() -> None:
    """Print a table and draw `heights.png` beside the results."""
    parser = argparse.ArgumentParser(description="Heights of the big grains.")
    parser.add_argument("results", type=Path, help="folder of results, as of `mpm3dpp run`")
    folder = parser.parse_args().results
    try:
        times, big, mean = heights(folder)
    except mpm3dpp.CaseError as error:
        parser.error(str(error))
    print("time [s]  big [mm]  all [mm]  big over all")
    for row in zip(times, 1e3 * big, 1e3 * mean, big / mean, strict=True):
        print("{:8.3f}  {:8.2f}  {:8.2f}  {:12.3f}".format(*row))
    figure, axes = plt.subplots(figsize=(6, 3), layout="constrained")
    axes.plot(times, 1e3 * big, label="3 big grains")
    axes.plot(times, 1e3 * mean, label="all grains")
    axes.set_xlabel("time [s]")
    axes.set_ylabel("mean height [mm]")
    axes.legend()
    figure.savefig(folder / "heights.png", dpi=120)


if __name__ == "__main__":
    main()
