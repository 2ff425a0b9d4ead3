# SPDX-License-Identifier: BSD-3-Clause
"""The command starts fast: `--help` loads nothing heavy."""

import os
import subprocess
import sys

HEAVY = {"numpy", "pydantic", "pint", "matplotlib", "h5py", "rich", "mpi4py"}


def test_help_loads_nothing_heavy() -> None:
    line = [sys.executable, "-X", "importtime", "-m", "mpm3dpp", "--help"]
    done = subprocess.run(line, capture_output=True, text=True, check=True)
    assert "Commands:" in done.stdout
    loaded = {row.rpartition("|")[2].strip().partition(".")[0] for row in done.stderr.splitlines()}
    assert "typer" in loaded and not loaded & HEAVY


def test_a_shell_completes_commands_and_options() -> None:
    """By the instructions of `mpm3dpp --show-completion bash`."""
    program = "import sys; sys.argv = ['mpm3dpp']; from mpm3dpp.cli.command import main; main()"
    for words, found in (("mpm3dpp re", "report\nreproduce"), ("mpm3dpp run --ra", "--ranks")):
        place = {"COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
        done = subprocess.run(
            [sys.executable, "-c", program],
            env=os.environ | place | {"_MPM3DPP_COMPLETE": "complete_bash"},
            capture_output=True,
            text=True,
            check=True,
        )
        assert done.stdout.strip() == found
