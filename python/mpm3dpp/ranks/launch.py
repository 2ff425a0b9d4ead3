# SPDX-License-Identifier: BSD-3-Clause
"""The command on several ranks of this machine, by the mpiexec that goes with mpi4py."""

from __future__ import annotations

import contextlib
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import FrameType

from mpm3dpp.base.errors import CaseError, RunError

from .world import INSTALL

TOLD = "MPM3DPP_LAUNCHED"
"""The folder in which the first process leaves its number for signals, and its exit code."""
AS_ROOT = {
    f"{who}_ALLOW_RUN_AS_ROOT{more}": "1" for who in ("OMPI", "PRTE") for more in ("", "_CONFIRM")
}
_SIGNALS = (signal.SIGINT, signal.SIGTERM)


def launch(count: int, words: list[str], threads: int | None) -> int:
    """Run the command with these words on so many ranks, and return its exit code.

    Ctrl-C and SIGTERM go to the first process, which brings the run to an orderly stop.

    Raises:
        CaseError: there is no MPI, or none that fits.
        RunError: a process has ended that nobody has told to, as one that was killed.
    """
    each = threads if threads is not None else max(1, len(os.sched_getaffinity(0)) // count)
    words = [*words, "--threads", str(each)] if threads is None else words
    command, added = command_of(count, each)
    command += [sys.executable, "-m", "mpm3dpp", *words]
    with tempfile.TemporaryDirectory(prefix="mpm3dpp-") as told:
        environment = os.environ | {TOLD: told} | added
        # In a session of its own, so that Ctrl-C at the terminal comes to this process alone.
        with (
            subprocess.Popen(command, env=environment, start_new_session=True) as job,
            _passing_on(job, Path(told, "pid")),
        ):
            code = job.wait()
        with contextlib.suppress(OSError, ValueError):
            return int(Path(told, "code").read_text())
    how = f"by signal {-code}" if code < 0 else f"with exit code {code}"
    raise RunError(
        f"a process of the run has ended, and mpiexec {how}; what was written before is kept, and "
        "--resume goes on from the last checkpoint"
    )


def command_of(count: int, threads: int) -> tuple[list[str], dict[str, str]]:
    """Return what starts so many ranks here, with so many threads each, and what to add to the
    environment; what they run goes behind it.

    Raises:
        CaseError: there is no MPI, or none that fits.
    """
    program, is_open = find_mpiexec()
    command = [program, "-n", str(count)]
    crowded = count > len(os.sched_getaffinity(0))
    if is_open and crowded:
        command.append("--oversubscribe")
    if is_open and (threads > 1 or crowded):
        command += ["--bind-to", "none"]  # Else all threads of a rank share one core.
    return command, AS_ROOT if is_open and os.geteuid() == 0 else {}


@contextlib.contextmanager
def _passing_on(job: subprocess.Popen[bytes], number: Path) -> Iterator[None]:
    """Pass Ctrl-C and SIGTERM on to the first process; while there is none yet, end the job."""

    def pass_on(kind: int, _: FrameType | None) -> None:
        try:
            os.kill(int(number.read_text()), kind)
        except (OSError, ValueError):
            with contextlib.suppress(OSError):
                job.send_signal(kind)

    before = [signal.signal(kind, pass_on) for kind in _SIGNALS]
    try:
        yield
    finally:
        for kind, handler in zip(_SIGNALS, before, strict=True):
            signal.signal(kind, handler)


def note_begin() -> None:
    """Leave the number of this process, the first one, for who has launched it."""
    if TOLD in os.environ:
        with contextlib.suppress(OSError):
            Path(os.environ[TOLD], "pid").write_text(str(os.getpid()))


def exit_code(code: int) -> int:
    """Leave the exit code for who has launched this process; return the one for mpiexec.

    A process that ends with another code than 0 makes mpiexec print a page.
    """
    if TOLD in os.environ:
        with contextlib.suppress(OSError):
            Path(os.environ[TOLD], "code").write_text(str(code))
            return 0
    return code


def find_mpiexec() -> tuple[str, bool]:
    """Return the mpiexec of the MPI that mpi4py uses, and whether that is Open MPI.

    Raises:
        CaseError: there is no mpi4py, no MPI, or no mpiexec that goes with it.
    """
    ask = "from mpi4py import MPI; print(MPI.Get_library_version())"
    asked = subprocess.run([sys.executable, "-c", ask], capture_output=True, text=True, check=False)
    if asked.returncode != 0:
        reason = (asked.stderr.strip().splitlines() or ["no reason"])[-1]
        raise CaseError(f"--ranks: mpi4py cannot be used: {reason}", INSTALL)
    is_open = "Open MPI" in asked.stdout
    beside = str(Path(sys.executable).parent / "mpiexec")
    for program in dict.fromkeys(filter(None, (shutil.which(beside), shutil.which("mpiexec")))):
        told = subprocess.run([program, "--version"], capture_output=True, text=True, check=False)
        speaks_open = any(
            name in told.stdout + told.stderr for name in ("Open MPI", "OpenRTE", "PRRTE", "prte")
        )
        if speaks_open == is_open:
            return program, is_open
    library = asked.stdout.split(",")[0].strip()
    rule = f"--ranks: there is no mpiexec of the MPI that mpi4py uses, {library}"
    raise CaseError(rule, "put its folder into PATH, or install one that fits")
