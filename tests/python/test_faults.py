# SPDX-License-Identifier: BSD-3-Clause
"""A run that is killed at, or told of an error in, any call that changes its files loses nothing.

`tests/faults/shim.c` makes the faults, `tests/faults/server.py` the runs.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import mpm3dpp
from commands import CASE

FAULTS = Path(__file__).parents[1] / "faults"
TINY = (
    CASE.replace('cell_size = "10 mm"', 'cell_size = "20 mm"')
    .replace('"8 ms"', '"2 ms"')
    .replace("frames = 4", "frames = 2")
)


def outcomes(folder: Path, count: int) -> dict[str, Any]:
    """Make `count` faults, or all if 0."""
    compiler = next(
        (c for c in (os.environ.get("CC"), "cc", "gcc", "clang") if c and shutil.which(c)), None
    )
    assert compiler, "there is no C compiler, which building mpm3dpp needs: install one"
    shim = folder / "shim.so"
    build = [compiler, "-O1", "-shared", "-fPIC", str(FAULTS / "shim.c"), "-o", str(shim), "-ldl"]
    subprocess.run(build, check=True)
    (folder / "case.toml").write_text(TINY)
    packages = str(Path(mpm3dpp.__file__).parents[1])
    done = subprocess.run(
        [
            sys.executable,
            str(FAULTS / "server.py"),
            str(shim),
            str(folder),
            str(folder / "case.toml"),
            str(count),
        ],
        env=os.environ | {"LD_PRELOAD": str(shim), "OMP_NUM_THREADS": "1", "PYTHONPATH": packages},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    print(json.dumps(found, indent=1))
    return found


def test_a_sample_of_faults(tmp_path: Path) -> None:
    found = outcomes(tmp_path, 10)
    assert found["made"] == 10 and found["wrong"] == []


@pytest.mark.slow
def test_every_fault(tmp_path: Path) -> None:
    found = outcomes(tmp_path, 0)
    assert found["made"] == found["points"] > 400 and found["wrong"] == []
