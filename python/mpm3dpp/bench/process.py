# SPDX-License-Identifier: BSD-3-Clause
"""The other end of `worker.py`: a benchmark that runs in a process of its own."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

from ..errors import RunError


class Process:
    """A benchmark running in a process of its own; a context manager that ends it."""

    def __init__(self, name: str, size: int, threads: int, scheme: str, warm_up: int) -> None:
        package = Path(__file__).absolute().parents[2]  # -m looks in the current folder first.
        numbers = [str(size), str(threads), scheme, str(warm_up)]
        self._process = subprocess.Popen(
            [sys.executable, "-m", f"{__package__}.worker", name, *numbers],
            cwd=package,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            start_new_session=True,  # Ctrl-C is for this process, whose end ends that one.
        )

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *about: object) -> None:
        self._process.kill()
        self._process.communicate()

    def ask(self, command: str = "") -> dict[str, Any]:
        """Send a command, if any, and return the answer.

        Raises:
            RunError: the run went unstable, or its process has ended.
        """
        assert self._process.stdin is not None and self._process.stdout is not None
        if command:
            self._process.stdin.write(command + "\n")
            self._process.stdin.flush()
        line = self._process.stdout.readline()
        if not line:
            code = self._process.wait()
            raise RunError(f"the process of the benchmark has ended with code {code}")
        content: dict[str, Any] = json.loads(line)
        if "error" in content:
            raise RunError(content["error"])
        return content
