# SPDX-License-Identifier: BSD-3-Clause
"""The command line for the tests, and a small case to run with it."""

from __future__ import annotations

import contextlib
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from command_server import run
from mpm3dpp import Case, run_case

CASE = """\
title = "Two blocks"
[grid]
dimension = 2
cell_size = "10 mm"
[run]
end_time = "8 ms"
cfl = 0.3
[output]
frames = 4
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.left]
material = "soft"
shape = { box = { lower = ["0 mm", "0 mm"], upper = ["50 mm", "50 mm"] } }
velocity = ["5 m/s", "0 m/s"]
[body.right]
material = "soft"
shape = { box = { lower = ["60 mm", "10 mm"], upper = ["110 mm", "60 mm"] } }
velocity = ["-5 m/s", "0 m/s"]
"""


def write(folder: Path, text: str = CASE) -> Path:
    path = folder / "case.toml"
    path.write_text(text)
    return path


def command(*arguments: Any, pictures: bool = False) -> list[str]:
    """Return the words of the command; a run draws no pictures, which take seconds, unless told."""
    words = [sys.executable, "-m", "mpm3dpp", *map(str, arguments)]
    if arguments[0] == "run" and not pictures and "--no-pictures" not in words:
        words.append("--no-pictures")
    return words


def mpm3dpp(*arguments: Any, cwd: Path, pictures: bool = False) -> subprocess.CompletedProcess[str]:
    """Run the command to its end, in a fork of a process that has its modules loaded."""
    return run(command(*arguments, pictures=pictures)[3:], cwd, timeout=60)


def one_sentence(text: str) -> str:
    assert "Traceback" not in text
    lines = text.strip().splitlines()
    assert len(lines) == 1, text
    assert lines[0].startswith("mpm3dpp: error: ")
    return lines[0]


def interrupted(case: Case, folder: Path, looks: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Run a case as if Ctrl-C had been pressed after so many looks at it."""
    left = iter(range(looks))

    class Pressed(contextlib.nullcontext[Any]):
        kind = None
        taken = property(lambda _: next(left, None) is None)

        def __enter__(self) -> Pressed:
            return self

    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr("mpm3dpp.run.run.Notice", Pressed)
        run_case(case, folder, threads=1, pictures=False)
