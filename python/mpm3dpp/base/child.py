# SPDX-License-Identifier: BSD-3-Clause
"""Processes of our own: a module of this package that runs beside its caller."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any


def start(
    module: str, *arguments: str, by: Sequence[str] = (), **options: Any
) -> subprocess.Popen[str]:
    """Start `python -m mpm3dpp.MODULE ARGUMENTS`; options are those of `subprocess.Popen`.

    `by`: a program that starts it, with arguments, as mpiexec.

    Paths among the arguments must be whole: the process starts in another folder. Raises OSError.
    """
    package = Path(__file__).absolute().parents[2]  # -m looks in the current folder first.
    command = [*by, sys.executable, "-m", f"mpm3dpp.{module}", *arguments]
    return subprocess.Popen(command, cwd=package, stdin=subprocess.PIPE, text=True, **options)
