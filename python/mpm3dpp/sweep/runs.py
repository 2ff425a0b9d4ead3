# SPDX-License-Identifier: BSD-3-Clause
"""The runs of a sweep, some at a time, each a process of its own."""

from __future__ import annotations

import shlex
import subprocess
import threading
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass, field
from pathlib import Path

from mpm3dpp.base import child
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import thread_count
from mpm3dpp.base.signals import as_exceptions
from mpm3dpp.io.foreign import refuse_foreign
from mpm3dpp.io.stored_manifest import manifest_data, read_manifest
from mpm3dpp.run.resume import refuse_another_case

from .numbers import numbers_of
from .plan import Planned

Say = Callable[[str], None]

_WAS_THERE, _COMPLETED = "was there", "completed"


@dataclass(frozen=True)
class Outcome:
    """What has come of a run.

    Attributes:
        said: "completed", "was there", or why it came to no end.
        numbers: of its manifest, see `numbers_of`; empty if it came to no end.
    """

    said: str
    numbers: dict[str, float] = field(default_factory=dict)


class _Processes:
    """Those that run; none is started once they have been stopped."""

    def __init__(self) -> None:
        self._lock, self._running = threading.Lock(), set[subprocess.Popen[str]]()
        self._stopped = False

    def run(self, words: Sequence[str]) -> tuple[int, str]:
        """Return the exit code, and what was said on the error output."""
        with self._lock:
            if self._stopped:
                return -1, ""
            process = child.start("__main__", *words, stderr=subprocess.PIPE, errors="replace")
            self._running.add(process)
        with process:
            _, told = process.communicate()
        with self._lock:
            self._running.discard(process)
        return process.returncode, told

    def stop(self) -> None:
        with self._lock:
            self._stopped = True
            for process in self._running:
                process.terminate()


def refuse_other_cases(plan: Sequence[Planned], file: Path) -> None:
    """Raise `CaseError` if a run would take the place of one of another case, or of other files.

    That of the same file is made anew, if the file has been edited.
    """
    for planned in plan:
        refuse_foreign(planned.folder, planned.case.probe)
        if str(file.absolute()) not in _command(planned.folder):
            refuse_another_case(planned.folder, planned.case)


def _command(folder: Path) -> list[str]:
    """Return the words that have made the run in a folder; none where there is no such run."""
    try:
        return shlex.split(str(manifest_data(folder).get("command", "")))
    except (CaseError, ValueError):
        return []


def run_all(
    plan: Sequence[Planned],
    file: Path,
    jobs: int,
    threads: int | None,
    pictures: bool,
    say: Say,
) -> list[Outcome]:
    """Run what is planned and has not been run; return what has come of each.

    Args:
        plan: the runs.
        file: the case file.
        jobs: how many runs at a time.
        threads: of each; by default the cores shared out.
        pictures: whether each draws its pictures.
        say: what tells the user.

    Raises:
        KeyboardInterrupt: the user stopped it; what has ended stays, and a new sweep goes on.
    """
    share = threads or max(1, thread_count(None) // jobs)
    found = [Outcome("")] * len(plan)
    processes, begun, made = _Processes(), time.monotonic(), 0
    with as_exceptions(), ThreadPoolExecutor(jobs) as pool:
        waiting = {
            pool.submit(_run, planned, file, share, pictures, processes): number
            for number, planned in enumerate(plan)
        }
        try:
            for ended, future in enumerate(as_completed(waiting), 1):
                number = waiting[future]
                found[number] = outcome = future.result()
                made += outcome.said != _WAS_THERE
                left = (time.monotonic() - begun) / max(made, 1) * (len(plan) - ended)
                rest = f"  left {left:.0f} s" if ended < len(plan) and made else ""
                say(f"[{ended}/{len(plan)}] {plan[number].words()}: {outcome.said}{rest}")
        except BaseException:
            processes.stop()
            for future in waiting:
                future.cancel()
            raise
    return found


def _run(
    planned: Planned, file: Path, threads: int, pictures: bool, processes: _Processes
) -> Outcome:
    numbers = _numbers(planned)
    if numbers is not None:
        return Outcome(_WAS_THERE, numbers)
    words = ["run", str(file.absolute()), "--out", str(planned.folder.absolute())]
    words += ["--threads", str(threads), "--quiet", "--anew"]
    words += [] if pictures else ["--no-pictures"]
    for key, value in planned.values.items():
        words += ["--set", f"{key}={value}"]
    code, told = processes.run(words)
    if code != 0:
        return Outcome(_why(told) or f"it ended with exit code {code}")
    numbers = _numbers(planned)
    if numbers is None:
        return Outcome("the case file has changed since the sweep began")
    return Outcome(_COMPLETED, numbers)


def _why(told: str) -> str:
    """Return what was said last; of several mistakes the first, and how many more there are."""
    lines = told.strip().splitlines() or [""]
    first = next((k for k, line in enumerate(lines) if line.startswith("mpm3dpp: error: ")), -1)
    mistakes = len(lines) - 1 - first if lines[-1].endswith(" mistakes") and first >= 0 else 1
    more = f" (and {mistakes - 1} more)" if mistakes > 1 else ""
    return lines[first].removeprefix("mpm3dpp: ") + more


def _numbers(planned: Planned) -> dict[str, float] | None:
    """Return the numbers of a run that has been completed with this very case."""
    try:
        manifest = read_manifest(planned.folder)
    except CaseError:
        return None
    same = manifest.get("case_hash") == planned.case.case_hash
    return numbers_of(manifest) if same and manifest.get("status") == "completed" else None
