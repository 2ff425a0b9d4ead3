# SPDX-License-Identifier: BSD-3-Clause
"""Rate at which a hopper runs out, beside Beverloo's law: discharge.py CASE TIME [D/d ...].

TIME is how long each run goes on [s]; D/d are outlets in grain diameters, for example 6 9, by
default the case's own.
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

from mpm3dpp import Case, CaseError, Simulation, load_case

GRAVITY = 9.81
C, K = 1.03, 1.4
"""Of a slot: W = C rho_b sqrt(g) (D - k d)^(3/2) for each metre of depth (Myers & Sellers 1977)."""


@dataclass(frozen=True)
class Discharge:
    """What a run has shown.

    Attributes:
        time: [s], shape (n,).
        left: mass that has left [kg per metre], shape (n,).
        total: mass at the start [kg per metre].
        density: of the bed above the funnel when the first grain leaves [kg/m^3].
        outlet, diameter: D and d [m].
    """

    time: np.ndarray
    left: np.ndarray
    total: float
    density: float
    outlet: float
    diameter: float

    def rate(self, first: float = 0.04, last: float = 0.5) -> float:
        """Return the slope of the mass that has left between two shares of all [kg/(m s)]."""
        part = (self.left >= first * self.total) & (self.left <= last * self.total)
        if part.sum() < 3:
            rule = f"has let out {self.left[-1] / self.total:.1%} of its grains, too few for a rate"
            raise CaseError(rule, "give a longer TIME", key="the hopper")
        return float(np.polyfit(self.time[part], self.left[part], 1)[0])

    def beverloo(self, c: float = C, k: float = K) -> float:
        """Return the rate after Beverloo in two dimensions [kg/(m s)]."""
        width = self.outlet - k * self.diameter
        return float(c * self.density * np.sqrt(GRAVITY) * width**1.5)


def with_outlet(case: Case, diameters: float) -> Case:
    """Return the case with an outlet of so many grain diameters; the funnel keeps its height."""
    case = case.model_copy(deep=True)
    case.body["funnel"].shape.outlet_radius = diameters * case.grains["sand"].packing.radius[0]
    return case


def discharge(
    case: Case, until: float, rows: int = 60, threads: int = 1, show: bool = False
) -> Discharge:
    """Run to a time [s] and return what has left, at so many times; `show` prints it on the way."""
    simulation = Simulation(case, threads)
    funnel, radius = case.body["funnel"].shape, case.grains["sand"].packing.radius[0]
    width, low = 2 * funnel.inlet_radius, funnel.height + 2 * radius
    time, left, density = [0.0], [0.0], 0.0
    for end in np.linspace(0.0, until, rows + 1)[1:]:
        simulation.advance(10**9, float(end))
        time.append(simulation.time)
        left.append(simulation.left()["mass"])
        if show:
            print(f"{time[-1]:8.3f} s  {left[-1]:8.2f} kg/m", flush=True)
        if density == 0.0 and left[-1] > 0.0:
            y = simulation.column("sand", "position")[:, 1]
            mass = simulation.column("sand", "mass")[:, 0]
            high = low + 0.7 * (np.percentile(y, 99.0) - low)
            density = mass[(y > low) & (y < high)].sum() / (width * (high - low))
    total = float(simulation.column("sand", "mass").sum())
    numbers = 2 * funnel.outlet_radius, 2 * radius
    return Discharge(np.array(time), np.array(left), total, density, *numbers)


def main() -> None:
    """Print the mass over time, the rate and Beverloo's."""
    parser = argparse.ArgumentParser(description="Rate of a hopper beside Beverloo's law.")
    parser.add_argument("case", help="a case file such as examples/05_hopper/case_small.toml")
    parser.add_argument("time", type=float, help="how long each run goes on [s], 0.3 or more")
    parser.add_argument("outlets", type=float, nargs="*", metavar="D/d",
                        help="outlets in grain diameters; by default the case's own")  # fmt: skip
    given = parser.parse_args()
    try:
        case = load_case(given.case)
        own = case.body["funnel"].shape.outlet_radius / case.grains["sand"].packing.radius[0]
        for diameters in given.outlets or [own]:
            found = discharge(with_outlet(case, diameters), given.time, show=True)
            print(f"D/d = {diameters:g}: {found.rate():.1f} kg/(m s), bed {found.density:.0f} "
                  f"kg/m^3, Beverloo {found.beverloo():.1f} kg/(m s)", flush=True)  # fmt: skip
    except CaseError as error:
        parser.error(str(error))


if __name__ == "__main__":
    main()
