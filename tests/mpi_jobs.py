# SPDX-License-Identifier: BSD-3-Clause
"""Runs of several processes, for tests."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from commands import command
from mpm3dpp.base.errors import CaseError
from mpm3dpp.ranks import launch, world

PROGRAMS = Path(__file__).parent / "ranks"


def mpiexec(count: int, *words: Any) -> list[str]:
    return [*launch.command_of(count, 1)[0], sys.executable, *map(str, words)]


def environment(way: str) -> dict[str, str]:
    found = {**os.environ, **launch.AS_ROOT, "OMP_NUM_THREADS": "1"}
    return {**found, world.THROUGH: "1"} if way == "mpi4py" else found


def has_module() -> bool:
    """Return whether the core can speak to MPI itself. Skips the test where there is none."""
    try:
        launch.find_mpiexec()
    except CaseError as error:
        pytest.skip(f"no MPI: {error}")
    ask = (
        "from mpi4py import MPI; from mpm3dpp.ranks.world import module_for; print(module_for(MPI))"
    )
    told = subprocess.run([sys.executable, "-c", ask], capture_output=True, text=True, check=True)
    return told.stdout.strip() != "None"


@pytest.fixture(scope="module", params=["module", "mpi4py"])
def each_way(request: pytest.FixtureRequest) -> str:
    """How the core speaks to MPI; skipped where it cannot."""
    if not has_module() and request.param == "module":
        pytest.skip("mpm3dpp was built without a module for the MPI that mpi4py uses")
    return str(request.param)


@pytest.fixture(scope="module")
def way() -> str:
    """As `each_way`, for tests of what is the same in both: the way that users get."""
    return "module" if has_module() else "mpi4py"


def job(way: str, folder: Path, line: list[str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        line,
        cwd=folder,
        env=environment(way),
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )


def run(way: str, folder: Path, *words: Any) -> subprocess.CompletedProcess[str]:
    return job(way, folder, command("run", *words))
