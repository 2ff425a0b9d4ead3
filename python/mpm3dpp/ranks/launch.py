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
from collections.abc import Callable
from pathlib import Path
from types import FrameType
from typing import Any

from mpm3dpp.base import child, signals
from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.base.machine import TYPED, command_line, thread_count
from mpm3dpp.base.signals import CODE, sentence
from mpm3dpp.base.starter import end_with

from .world import INSTALL

TOLD = "MPM3DPP_LAUNCHED"
"""The folder in which the first process leaves its number for signals, and its exit code; and the
launcher its own number, with which the first process ends."""
_FEW, _OF_A_CORE = 16, 4  # Ranks that may be tried, more than there are cores.
AS_ROOT = {
    f"{who}_ALLOW_RUN_AS_ROOT{more}": "1" for who in ("OMPI", "PRTE") for more in ("", "_CONFIRM")
}


def launch(count: int, words: list[str], threads: int | None, can_go_on: Callable[[], bool]) -> int:
    """Run the command with these words on so many ranks, and return its exit code.

    Ctrl-C, SIGTERM and the others go to the first process, which brings the run to an orderly stop.

    Args:
        count: how many.
        words: of the command.
        threads: of each rank.
        can_go_on: tells whether there is a checkpoint, once the run has ended.

    Raises:
        CaseError: there is no MPI, or none that fits.
        RunError: a process has ended that nobody has told to, as one that was killed.
    """
    each = thread_count(threads, max(1, len(os.sched_getaffinity(0)) // count))
    if threads is None:
        words = [*words[:1], "--threads", str(each), *words[1:]]
    command, added = command_of(count, each)
    command += child.command("__main__", *words, by_us=False)
    cores = len(os.sched_getaffinity(0))
    if count > cores:
        text = (
            f"{count} ranks share {cores} cores, and wait for each other: fewer may be much faster"
        )
        print(f"note: {text}", file=sys.stderr, flush=True)
    with tempfile.TemporaryDirectory(prefix="mpm3dpp-") as told:
        Path(told, "launcher").write_text(str(os.getpid()))
        with _Job(Path(told, "pid")) as job:
            code = job.run(command, os.environ | {TOLD: told, TYPED: command_line()} | added)
        with contextlib.suppress(OSError, ValueError):
            return int(Path(told, "code").read_text())
    if job.stopped is not None:  # before there was a first process that says so
        print(f"mpm3dpp: error: {sentence(job.stopped)}", file=sys.stderr, flush=True)
        return CODE
    how = f"by signal {-code}" if code < 0 else f"with exit code {code}"
    raise RunError(
        f"a process of the run has ended, and mpiexec {how}; what was written before is kept, and "
        + (
            "--resume goes on from the last checkpoint"
            if can_go_on()
            else "there is no checkpoint to go on from: begin anew"
        )
    )


def command_of(count: int, threads: int) -> tuple[list[str], dict[str, str]]:
    """Return what starts so many ranks here, with so many threads each, and what to add to the
    environment; what they run goes behind it.

    Raises:
        CaseError: there is no MPI, or none that fits; or so many ranks would take all memory.
    """
    cores = len(os.sched_getaffinity(0))
    most = max(_FEW, _OF_A_CORE * cores)
    if count > most:
        rule = f"--ranks = {count}: there are {cores} cores here, for {most} ranks at most"
        raise CaseError(rule, "give fewer, or start them on more machines with mpiexec")
    program, is_open = find_mpiexec()
    command = [program, "-n", str(count)]
    if is_open:
        command.append("--oversubscribe")  # It counts cores, of which some run two threads.
    if is_open and (threads > 1 or count > _cores()):
        command += ["--bind-to", "none"]  # Else all threads of a rank share one core.
    return command, AS_ROOT if is_open and os.geteuid() == 0 else {}


def _cores() -> int:
    """Return how many cores this process may use, threads of one core counted once."""
    found = set()
    for number in os.sched_getaffinity(0):
        about = Path(f"/sys/devices/system/cpu/cpu{number}/topology/thread_siblings_list")
        try:
            found.add(about.read_text())
        except OSError:
            found.add(str(number))
    return len(found)


class _Job:
    """While it lives, signals for this process go to the first of the ranks.

    Args:
        number: the file in which that leaves its number; before, the job is ended.

    Attributes:
        stopped: the first signal, if there was one.
    """

    def __init__(self, number: Path) -> None:
        self.stopped: int | None = None
        self._number = number
        self._job: subprocess.Popen[bytes] | None = None
        self._before: dict[signal.Signals, Any] = {}

    def __enter__(self) -> _Job:
        for kind in signals.heeded():
            self._before[kind] = signal.signal(kind, self._pass_on)
        return self

    def __exit__(self, *_about: object) -> None:
        for kind, handler in self._before.items():
            signal.signal(kind, handler)

    def run(self, command: list[str], environment: dict[str, str]) -> int:
        """Run it to its end; return its exit code."""
        # In a session of its own, so that Ctrl-C at the terminal comes to this process alone.
        with subprocess.Popen(command, env=environment, start_new_session=True) as self._job:
            if self.stopped is not None:  # before there was anybody to pass it on to
                self._job.terminate()
            return self._job.wait()

    def _pass_on(self, kind: int, _: FrameType | None) -> None:
        self.stopped = self.stopped or kind
        try:
            os.kill(int(self._number.read_text()), kind)
        except (OSError, ValueError):
            if self._job is not None:  # What mpiexec would make of others is not known.
                with contextlib.suppress(OSError):
                    self._job.send_signal(signal.SIGTERM)


def note_begin() -> None:
    """Leave the number of this process, the first one, for who has launched it."""
    if TOLD in os.environ:
        with contextlib.suppress(OSError):
            Path(os.environ[TOLD], "pid").write_text(str(os.getpid()))
        with contextlib.suppress(OSError, ValueError):
            launcher = int(Path(os.environ[TOLD], "launcher").read_text())
            end_with(launcher, is_parent=False)


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
    ask = child.command("ranks.which_mpi")
    asked = subprocess.run(ask, capture_output=True, text=True, check=False)
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
