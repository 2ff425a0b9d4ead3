# SPDX-License-Identifier: BSD-3-Clause
"""The preset `asan` compiles, and the unit tests find no error of memory and nothing undefined."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]


@pytest.mark.slow
def test_unit_tests_under_the_sanitizers(tmp_path: Path) -> None:
    folder = tmp_path / "asan"
    unity = ["-D", "CMAKE_UNITY_BUILD=ON", "-D", "CMAKE_UNITY_BUILD_BATCH_SIZE=8"]
    for words in (
        ["cmake", "--preset", "asan", "-B", str(folder), *unity],
        ["cmake", "--build", str(folder), "--target", "unit_tests"],
    ):
        done = subprocess.run(words, cwd=ROOT, capture_output=True, text=True)
        assert done.returncode == 0, (done.stdout + done.stderr)[-4000:]
    options = "halt_on_error=1:print_stacktrace=1"
    environment = {**os.environ, "UBSAN_OPTIONS": options}
    # Every second one by a process of its own: three quarters of an hour of a processor in all.
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    halves = [
        subprocess.Popen([folder / "unit_tests", f"{k}/2"], env=environment, **pipes)
        for k in range(2)
    ]
    told = [half.communicate()[0] for half in halves]
    for half, said in zip(halves, told, strict=True):
        assert half.returncode == 0, said[-4000:]
        assert ", 0 failed" in said
