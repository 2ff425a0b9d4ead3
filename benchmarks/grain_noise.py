# SPDX-License-Identifier: BSD-3-Clause
"""How much grains that come to rest move within themselves, with other settings.

    python benchmarks/grain_noise.py ["8 cells" "flip" ...]

Some 40 soft discs of 16 to 24 mm fall in a box and come to rest. A line for each setting: the share
of their kinetic energy that is motion of particles about that of their rigid grain while they
fall and land (median, to 0.2 s), and at rest (0.48 to 0.6 s) the root mean squares by mass of that
motion and of the grains' velocities, over sqrt(g d). The table is in docs/how-to/many-grains.md.
"""

from __future__ import annotations

import sys

import numpy as np

from mpm3dpp import Case, Simulation

DIAMETER, GRAVITY, END = 0.02, 9.81, 0.6
TEXT = """
[grid]
dimension = 2
cell_size = {cell}
box = {{ lower = [0, 0], upper = [0.12, 0.64], walls = "slip" }}
[run]
end_time = {end}
gravity = [0, -{gravity}]
{run}
[material.glass]
density = 2500
strength = {{ elastic = {{ E = "2 MPa", nu = 0.2 }} }}
[grains.sand]
material = "glass"
packing = {{ lower = [0, 0], upper = [0.12, 0.16], radius = [0.008, 0.012], fraction = 0.7 }}
{grains}
[contact]
friction = 0.5
"""
SETTINGS = {
    "4 cells": (4, "", ""),
    "6 cells": (6, "", ""),
    "8 cells": (8, "", ""),
    "12 cells": (12, "", ""),
    "flip": (8, 'transfer = "flip"', ""),
    "apic": (8, 'transfer = "apic"', ""),
    "local damping": (8, "", "damping = { local = 0.1 }"),
}


class Grains:
    """The grains of a simulation, and what of their motion is not rigid."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation = simulation
        self.mass = simulation.column("sand", "mass")[:, 0]
        counts = [len(simulation.column(name, "mass")) for name in simulation.bodies]
        self._grain = np.repeat(np.arange(len(counts)), counts)

    def _sum(self, values: np.ndarray) -> np.ndarray:
        return np.bincount(self._grain, self.mass * values)

    def energies(self) -> tuple[float, float, float]:
        """Return kinetic energies [J/m]: all, of motion about the rigid one, of grains' centres."""
        x, v = (self._simulation.column("sand", name) for name in ("position", "velocity"))
        masses = self._sum(np.ones(len(x)))
        centre, mean = (np.stack([self._sum(a) / masses for a in of.T], axis=1) for of in (x, v))
        arm, own = x - centre[self._grain], v - mean[self._grain]
        turning = self._sum(arm[:, 0] * own[:, 1] - arm[:, 1] * own[:, 0])
        spin = (turning / self._sum((arm**2).sum(axis=1)))[self._grain]
        own -= spin[:, None] * np.stack([-arm[:, 1], arm[:, 0]], axis=1)
        return tuple(
            0.5 * float(m @ (u**2).sum(axis=1))
            for m, u in ((self.mass, v), (self.mass, own), (masses, mean))
        )


def main(names: list[str]) -> None:
    for name in names or SETTINGS:
        cells, run, grains = SETTINGS[name]
        text = TEXT.format(cell=DIAMETER / cells, end=END, gravity=GRAVITY, run=run, grains=grains)
        simulation = Simulation(Case.from_text(text), threads=1)
        seen, rows = Grains(simulation), []
        times = np.arange(0.02, END + 1e-9, 0.02)
        for time in times:
            simulation.advance(10**7, end_time=float(time))
            rows.append(seen.energies())
        every, own, centres = np.array(rows).T
        landing, rest = times < 0.2, times > 0.48
        speed = np.sqrt(GRAVITY * DIAMETER)
        noise, still = (
            np.sqrt(2 * of[rest].mean() / seen.mass.sum()) / speed for of in (own, centres)
        )
        share = np.median(own[landing] / every[landing])
        print(f"{name:14} share {share:.3f}  noise {noise:.1e}  grains {still:.1e}", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
