# SPDX-License-Identifier: BSD-3-Clause
"""The other end of `worker.py`: a benchmark that runs in a process of its own."""

from __future__ import annotations

import json
import subprocess
from typing import Any

from mpm3dpp.base import child
from mpm3dpp.base.errors import RunError


class Process:
    """A benchmark running in a process of its own; a context manager that ends it."""

    def __init__(self, name: str, size: int, threads: int, scheme: str, warm_up: int) -> None:
        numbers = [str(size), str(threads), scheme, str(warm_up)]
        self._process = child.start(
            "bench.worker",
            name,
            *numbers,
            stdout=subprocess.PIPE,
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
