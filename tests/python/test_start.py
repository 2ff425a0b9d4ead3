# SPDX-License-Identifier: BSD-3-Clause
"""The command starts fast: `--help` loads nothing heavy."""

import subprocess
import sys

HEAVY = {"numpy", "pydantic", "pint", "matplotlib", "h5py", "rich", "mpi4py"}


def test_help_loads_nothing_heavy() -> None:
    line = [sys.executable, "-X", "importtime", "-m", "mpm3dpp", "--help"]
    done = subprocess.run(line, capture_output=True, text=True, check=True)
    assert "Commands:" in done.stdout
    loaded = {row.rpartition("|")[2].strip().partition(".")[0] for row in done.stderr.splitlines()}
    assert "typer" in loaded and not loaded & HEAVY
