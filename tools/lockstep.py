# SPDX-License-Identifier: BSD-3-Clause
"""Find the first step of a case that a device makes otherwise than the processor.

    python tools/lockstep.py examples/02_penetration/case.toml --every 20

Both make the case's steps side by side, and all columns of all bodies are compared to the bit.
Where they differ both go back to the last state that was equal, and go on step by step. With
MPM3DPP_DEVICE_LIBRARY=libmpm_device_emulated.so no card is needed (tests/device/emulated).
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

from mpm3dpp import Case, Simulation, load_case


def differences(here: Simulation, there: Simulation) -> list[str]:
    """Return a line for each column of each body that is not the same to the bit."""
    found = []
    if (here.step, here.time, here.dt) != (there.step, there.time, there.dt):
        found.append(
            f"step {here.step} and {there.step}, time {here.time!r} and {there.time!r}, "
            f"next step {here.dt!r} and {there.dt!r}"
        )
    for number, body in enumerate(here.bodies):
        for column in here.core.columns(number):
            mine, theirs = here.column(body, column.name), there.column(body, column.name)
            apart = (mine != theirs) & ~(np.isnan(mine) & np.isnan(theirs))
            rows = np.flatnonzero(apart.reshape(len(mine), -1).any(axis=1))
            if len(rows):
                first = rows[0]
                found.append(
                    f"{body}, {column.name}: {len(rows)} of {len(mine)} particles, the first "
                    f"{first}: {mine[first].tolist()} and {theirs[first].tolist()}"
                )
    return found


def pair(case: Case, threads: int, state: Path | None) -> tuple[Simulation, Simulation]:
    """Return a simulation by the processor and one by the device, from a state if there is one."""
    both = Simulation(case, threads=threads), Simulation(case, threads=threads, device="cuda")
    if state is not None:
        for one in both:
            one.restore(state)
    return both


def first_look(case: Case, given: argparse.Namespace, folder: Path) -> tuple[Path | None, int]:
    """Return the last state that was equal and the step at which they differ, 0 if they do not."""
    equal: Path | None = given.begin
    here, there = pair(case, given.threads, equal)
    last = here.step + given.steps
    while here.step < last and here.time < case.run.end_time:
        there.advance(here.advance(min(given.every, last - here.step)))
        if found := differences(here, there):
            print(f"not equal at step {here.step}:", *found, sep="\n  ", flush=True)
            return equal, here.step
        print(f"step {here.step}, t {here.time:g} s: equal", flush=True)
        equal = folder / "equal"
        here.save(equal)
    return equal, 0


def main() -> int:
    """Compare, and say where the two part."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("case", type=Path)
    parser.add_argument("--every", type=int, default=20, help="steps from one look to the next")
    parser.add_argument("--steps", type=int, default=10**9, help="at most so many")
    parser.add_argument("--begin", type=Path, help="a state to begin with (Simulation.save)")
    parser.add_argument("--threads", type=int, default=2, help="of the processor, for each")
    given = parser.parse_args()
    case = load_case(given.case)
    with tempfile.TemporaryDirectory() as folder:
        equal, bound = first_look(case, given, Path(folder))
        if bound == 0:
            return 0
        here, there = pair(case, given.threads, equal)
    while here.step < bound:
        there.advance(here.advance(1))
        if found := differences(here, there):
            print(f"step {here.step} is the first that differs:", *found, sep="\n  ")
            return 1
    print("equal where both begin with the last equal state: it is what the device keeps beside it")
    return 1


if __name__ == "__main__":
    sys.exit(main())
