# SPDX-License-Identifier: BSD-3-Clause
"""Steps of the first examples at quick size, by as many ranks as mpiexec has started.

    mpiexec -n N python digests.py OUT STEPS WHICH [PIECE]

writes a JSON file: of each example what it ends with, as a number that tells bits apart. WHICH is
"all", or "few" for those that start fast. Messages whose length is not known have PIECE bytes at
most.
"""

from __future__ import annotations

import hashlib
import json
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from mpm3dpp import Case, Simulation, load_case
from mpm3dpp.base.shipped import shipped
from mpm3dpp.ranks.world import world
from mpm3dpp.reproduce.examples import EXAMPLES, load


def cases(which: str) -> Iterator[tuple[str, Case]]:
    """Yield the examples 01 to 05 with their names, and cases that have what these do not."""
    folder = shipped("examples")
    for name, example in EXAMPLES.items() if which == "all" else ():
        for label in example.files:
            yield f"{name} {label}", load(example, label, folder, "quick")[0]
    yield "hopper", load_case(folder / "05_hopper" / "case_small.toml")
    for name in ("slices", "slices_in_body"):
        yield name, load_case(Path(__file__).parent / f"{name}.toml")


def digest(simulation: Simulation) -> str:
    """Return a number for all columns, the history and all pairs."""
    core, found = simulation.core, hashlib.sha256()
    for body in range(core.body_count):
        for column in core.columns(body):
            found.update(core.column(body, column.name).tobytes())
    found.update(core.history().tobytes())
    for pair in core.contact_pairs():
        found.update(np.array([*pair.force, *pair.impulse, pair.friction_work]).tobytes())
    return found.hexdigest()


def main(out: str, steps: str, which: str, piece: str = "") -> None:
    ranks, found = world(), {}
    if piece and ranks is not None:
        ranks.piece = int(piece)
    for name, case in cases(which):
        simulation = Simulation(case, threads=1, world=ranks)
        simulation.advance(int(steps))
        found[name] = digest(simulation)
    found["ranks"] = str(ranks.size if ranks else 1)
    if ranks is None or ranks.rank == 0:
        Path(out).write_text(json.dumps(found))


if __name__ == "__main__":
    main(*sys.argv[1:])
