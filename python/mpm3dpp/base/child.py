# SPDX-License-Identifier: BSD-3-Clause
"""Processes of our own: a module of this package that runs beside its caller.

All are started in this way, so that none runs what lies in the user's folder (`start.py`), and
none outlives its starter.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

_START = Path(__file__).absolute().with_name("start.py")


def command(module: str, *arguments: str, by_us: bool = True) -> list[str]:
    """Return the words that run `mpm3dpp.MODULE ARGUMENTS` in a process of its own.

    Args:
        module: of this package.
        arguments: of the command line.
        by_us: whether this process starts it, with whose end it ends; else something between, as
            mpiexec.
    """
    parent = os.getpid() if by_us else 0
    return [sys.executable, str(_START), str(parent), module, *arguments]


def start(
    module: str, *arguments: str, by: Sequence[str] = (), **options: Any
) -> subprocess.Popen[str]:
    """Start `mpm3dpp.MODULE ARGUMENTS`; options are those of `subprocess.Popen`.

    `by`: a program that starts it, with arguments, as mpiexec. Raises OSError.
    """
    words = [*by, *command(module, *arguments, by_us=not by)]
    return subprocess.Popen(words, stdin=subprocess.PIPE, text=True, **options)
