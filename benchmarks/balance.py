# SPDX-License-Identifier: BSD-3-Clause
"""What it is worth to share out the grid anew while a case runs on several ranks.

    python benchmarks/balance.py examples/05_hopper/case.toml --ranks 2 4 --until 1.5 --out out.png

Each number of ranks runs twice, with the tiles where they are at the start and as they are shared
out. Drawn is the largest number of particles of a rank over the mean one; the time is told where
there are cores enough.
"""

from __future__ import annotations

import argparse
import json
import math
import os
import subprocess
import sys
import time
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import mpm3dpp
from mpm3dpp.ranks.launch import command_of
from mpm3dpp.ranks.world import world

SAMPLES = 40
GONE = 3.0  # The column `failed` of a particle that has eroded, or more of one that has left.


def particles_by_rank(simulation: mpm3dpp.Simulation, size: int) -> np.ndarray:
    """Return how many particles that move freely each rank has, shape (size,); by all ranks."""
    core, found = simulation.core, []
    for body, name in enumerate(simulation.parts):
        entry = simulation.case.parts()[name]
        if getattr(entry, "motion", None) is not None:
            continue  # They cost their nodes only.
        owners = core.ranks_of(body)[:, 0].astype(int)
        if "failed" in [column.name for column in core.columns(body)]:
            owners = owners[core.column(body, "failed")[:, 0] < GONE]
        found.append(owners)
    return np.bincount(np.concatenate(found), minlength=size)


def worker(case_file: str, until: float, limit: float) -> None:
    """Make one run, by all ranks; the first prints a line of JSON."""
    ranks = world()
    assert ranks is not None
    case = mpm3dpp.load_case(case_file)
    simulation = mpm3dpp.Simulation(case, threads=1, imbalance_limit=limit, world=ranks)
    times, imbalance, seconds = [], [], 0.0
    for end in np.linspace(0.0, until, SAMPLES + 1):
        begin = time.perf_counter()
        while simulation.time < end:
            simulation.advance(1 << 20, float(end))
        seconds += time.perf_counter() - begin
        counts = particles_by_rank(simulation, ranks.size)
        times.append(float(end))
        if ranks.rank == 0:  # Others are not told.
            imbalance.append(float(counts.max() / counts.mean()))
    if ranks.rank == 0:
        print(json.dumps({"times": times, "imbalance": imbalance, "seconds": seconds}))


def measured(case_file: str, until: float, ranks: int, limit: float) -> dict[str, Any]:
    """Return what the first of so many ranks tells of a run."""
    command, added = command_of(ranks, 1)
    command += [sys.executable, __file__, case_file, "--until", str(until), "--limit", str(limit)]
    done = subprocess.run(command, env=os.environ | added, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    found: dict[str, Any] = json.loads(done.stdout.strip().splitlines()[-1])
    return found


def draw(rows: list[dict[str, Any]], title: str, path: str) -> None:
    """Draw the largest number of particles of a rank over the mean one, by time."""
    figure, axes = plt.subplots(figsize=(7, 4), layout="constrained")
    for row in rows:
        style = "--" if math.isinf(row["limit"]) else "-"
        word = "as at the start" if math.isinf(row["limit"]) else "shared out anew"
        color = f"C{[r['ranks'] for r in rows].index(row['ranks'])}"
        label = f"{row['ranks']} ranks, {word}"
        axes.plot(row["times"], row["imbalance"], style, color=color, label=label)
    axes.set(xlabel="time [s]", ylabel="particles of a rank, most over mean", title=title)
    axes.legend()
    figure.savefig(path, dpi=150)


def main() -> None:
    """Measure and draw."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("case")
    parser.add_argument("--ranks", type=int, nargs="+", default=[2])
    parser.add_argument("--until", type=float, help="time at which it ends [s]")
    parser.add_argument("--out", help="picture to write")
    parser.add_argument("--limit", type=float, help=argparse.SUPPRESS)
    given = parser.parse_args()
    case = mpm3dpp.load_case(given.case)
    until = given.until or case.run.end_time
    if given.limit is not None:
        worker(given.case, until, given.limit)
        return
    rows = []
    for ranks in given.ranks:
        for limit in (math.inf, 1.05):
            row = measured(given.case, until, ranks, limit) | {"ranks": ranks, "limit": limit}
            rows.append(row)
            seconds = f", {row['seconds']:.1f} s" if ranks <= len(os.sched_getaffinity(0)) else ""
            print(
                f"{ranks} ranks, {'as at the start' if math.isinf(limit) else 'shared out anew'}: "
                f"most over mean {np.mean(row['imbalance']):.3f} on average, "
                f"{max(row['imbalance']):.3f} at most{seconds}",
                flush=True,
            )
    if given.out:
        draw(rows, case.title or given.case, given.out)


if __name__ == "__main__":
    main()
