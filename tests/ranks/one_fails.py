# SPDX-License-Identifier: BSD-3-Clause
"""One of the ranks that mpiexec has started makes a mistake that the others do not make.

mpiexec -n N python one_fails.py CASE RANK
"""

from __future__ import annotations

import sys

from mpm3dpp import Simulation, load_case
from mpm3dpp.ranks.world import world


def main(case: str, who: str) -> None:
    ranks = world()
    assert ranks is not None
    simulation = Simulation(load_case(case), threads=1, world=ranks)
    simulation.core.column(0, "velocity" if ranks.rank != int(who) else "speed")
    simulation.advance(1)


if __name__ == "__main__":
    main(*sys.argv[1:])
