# SPDX-License-Identifier: BSD-3-Clause
"""How far ranks may go: what they tell each other, counted here, and what that costs elsewhere.

    python benchmarks/projection.py --out docs/images/projection.png

Left: bytes that a rank sends in a step, counted with threads as ranks, against its particles, and
the surface of a cube through the last. Right: the efficiency of a run whose ranks have a million
particles each, by a model of a large machine. That is a projection: nothing of it was measured
beyond this machine. Not in it are noise of the operating system, a crowded network, slow nodes, and
what a run's first process orders between steps (half a dozen broadcasts of a step with contact).
"""

from __future__ import annotations

import argparse
import math
import sys
from dataclasses import dataclass
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from record import measured

from mpm3dpp.bench.cases import BENCHES, make
from mpm3dpp.bench.worker import advance

RANKS = 64  # Threads as ranks: 4 x 4 x 4, of which 8 have others on all sides.
FACES = 4.5  # Of 6 that one of them has on average.
PARTICLES = 1e6  # Of a rank, in the projection.
WARM_UP, STEPS = 3, 4


@dataclass(frozen=True)
class Machine:
    """A cluster of today.

    Attributes:
        latency: of a message [s].           overhead: of a core for one [s].
        network: of a node [byte/s].         memory: of a node [byte/s].
        copy: of a core [byte/s].            cores: of a node, a rank each.
        imbalance: the longest time of work over the mean one, less 1.
    """

    latency: float = 2e-6
    overhead: float = 0.7e-6
    network: float = 50e9
    memory: float = 200e9
    copy: float = 8e9
    cores: int = 128
    imbalance: float = 0.03


@dataclass(frozen=True)
class Counted:
    """What a rank of a benchmark sends in a step.

    Attributes:
        particles: of a rank.                bytes, letters: to others.
        exchanges: with a barrier each.      reductions: over all.
    """

    particles: float
    bytes: float
    letters: float
    exchanges: float
    reductions: float


def counted(name: str, edge: int) -> Counted:
    """Count a few steps of a benchmark, of which each rank has a cube of so many cells an edge.

    For grains `edge`^3 of them.
    """
    bench = BENCHES[name]
    size = RANKS * edge**3 if bench.bodies == 0 else round(RANKS ** (1 / 3)) * edge
    simulation = make(bench, size, ranks=RANKS)
    keys = ("bytes", "letters", "exchanges", "reductions")
    # Means since the start; in the first steps tiles may be shared out anew.
    told = []
    for steps in (WARM_UP, STEPS):
        advance(simulation, steps)
        means = simulation.ranks()
        told.append(np.array([means[key] for key in keys]) * simulation.step)
    return Counted(simulation.particle_count / RANKS, *((told[1] - told[0]) / STEPS).tolist())


def step_time(of: Counted, work: float, ranks: int, machine: Machine) -> float:
    """Return the time of a step [s] of a rank that has others on all sides.

    Args:
        of: what was counted; its bytes grow as the surface of a cube.
        work: of the step on one rank alone [s].
        ranks: how many.
        machine: on which.
    """
    if ranks == 1:
        return work
    sent = of.bytes * (6 / FACES) * (PARTICLES / of.particles) ** (2 / 3)
    letters = of.letters * 6 / FACES
    # Ranks of a node are a cube too: its surface leaves the node, the rest passes by memory.
    leaves = min(1.0, machine.cores ** (-1 / 3))
    wire = machine.cores * sent * (leaves / machine.network + 2 * (1 - leaves) / machine.memory)
    # Nodes travel while patches without neighbours on other ranks are worked on.
    tiles = (PARTICLES / 512) ** (1 / 3)
    hidden = min(wire, 0.4 * work * max(0.0, 1 - 2 / tiles) ** 3)
    depth = math.log2(ranks)
    waits = (of.reductions + of.exchanges) * 2 * depth * machine.latency
    return (
        work * (1 + machine.imbalance)
        + 2 * sent / machine.copy
        + letters * 2 * machine.overhead
        + wire
        - hidden
        + waits
    )


def main() -> None:
    """Count, project and draw."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--out", required=True, help="picture to write")
    given = parser.parse_args()
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    ranks = np.array([1, 2, 8, 64, 512, 1024, 4096, 10_000])
    cases = (("elastic3d", (8, 12, 16, 20)), ("spheres", (2, 3, 4)))
    for color, (name, edges) in enumerate(cases):
        found = [counted(name, edge) for edge in edges]
        alone: dict[str, Any] = measured(sys.executable, name, ["--threads", "1", "--steps", "50"])
        work = PARTICLES * alone["ns_per_particle_step"] * 1e-9
        times = [step_time(found[-1], work, int(n), Machine()) for n in ranks]
        efficiency = times[0] / np.array(times)
        particles = np.array([one.particles for one in found])
        style = {"color": f"C{color}", "label": name}
        left.loglog(particles, [one.bytes for one in found], "o", **style)
        along = np.array([particles[0], PARTICLES])
        surface = found[-1].bytes * (along / particles[-1]) ** (2 / 3)
        left.loglog(along, surface, color=f"C{color}", linewidth=1)
        right.semilogx(ranks, efficiency, "o-", **style)
        last = found[-1]
        print(
            f"{name}: {last.bytes / 1e3:.0f} kB in {last.letters:.1f} letters, "
            f"{last.exchanges:.0f} exchanges, {last.reductions:.0f} reductions a step of a rank of "
            f"{last.particles:,.0f} particles; {alone['ns_per_particle_step']:.1f} ns; efficiency "
            f"{efficiency[-1]:.3f} at {ranks[-1]:,} ranks of {PARTICLES:,.0f} (projection)",
            flush=True,
        )
    left.set(xlabel="particles of a rank", ylabel="bytes that it sends in a step")
    left.set_title(f"points: counted, {RANKS} ranks; lines: as the surface of a cube", fontsize=9)
    right.set(xlabel="ranks", ylabel="time of one rank / time of a rank", ylim=(0.8, 1.01))
    right.set_title(f"a projection: {PARTICLES:,.0f} particles a rank", fontsize=9)
    right.legend(loc="lower right")
    right.grid(alpha=0.3)
    figure.savefig(given.out, dpi=150)


if __name__ == "__main__":
    main()
