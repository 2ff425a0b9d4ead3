# SPDX-License-Identifier: BSD-3-Clause
"""The other end of `worker.py`: a benchmark that runs in a process of its own."""

from __future__ import annotations

import contextlib
import json
import os
import subprocess
from typing import Any, NamedTuple

from mpm3dpp.base import child
from mpm3dpp.base.errors import RunError
from mpm3dpp.ranks.launch import command_of
from mpm3dpp.run.device import CPU

from .numerics import DEFAULT, Numerics

NO_WORD = "-"
"""In the place of the scheme where none is given."""


class Part(NamedTuple):
    """What is measured: a benchmark in a size, with threads of each of some ranks, or a device.

    Attributes:
        numerics: what is said of them.
    """

    name: str
    size: int
    threads: int
    ranks: int
    device: str = CPU
    numerics: Numerics = DEFAULT

    @property
    def on_device(self) -> bool:
        """Whether a device makes the steps."""
        return self.device != CPU


class Process:
    """A benchmark in a process of its own, or in several; a context manager that ends it."""

    def __init__(self, part: Part, warm_up: int) -> None:
        scheme = part.numerics.scheme or NO_WORD
        numbers = [str(part.size), str(part.threads), scheme, str(warm_up)]
        by, added = command_of(part.ranks, part.threads) if part.ranks > 1 else ([], {})
        self._process = child.start(
            "bench.worker",
            part.name,
            *numbers,
            part.device,
            *part.numerics.words(),
            by=by,
            env=os.environ | added,
            stdout=subprocess.PIPE,
            start_new_session=True,  # Ctrl-C is for this process, whose end ends that one.
        )

    def __enter__(self) -> Process:
        return self

    def __exit__(self, *about: object) -> None:
        self._process.terminate()  # That mpiexec ends its own.
        with contextlib.suppress(subprocess.TimeoutExpired):
            self._process.wait(5)
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
