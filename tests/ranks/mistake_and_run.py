# SPDX-License-Identifier: BSD-3-Clause
"""mpiexec -n 2 python mistake_and_run.py CASE OUT: a program that goes on after a mistake."""

from __future__ import annotations

import sys

from mpm3dpp import CaseError, load_case, run_case
from mpm3dpp.ranks.world import world

if __name__ == "__main__":
    ranks = world()
    assert ranks is not None
    case, out = sys.argv[1:]
    wrong = load_case(case).with_({"run.time_step": 1.0})  # longer than the largest stable one
    try:
        run_case(wrong, out, quiet=True, pictures=False)
    except CaseError as error:
        assert "stable" in str(error), error
    else:
        raise AssertionError("that was no mistake")
    manifest = run_case(case, out, quiet=True, pictures=False)
    print(f"rank {ranks.rank}: {manifest.status}", flush=True)
