# SPDX-License-Identifier: BSD-3-Clause
"""Runs a small case with a fault in one call after another; `shim.c` is preloaded.

    LD_PRELOAD=shim.so python server.py SHIM FOLDER CASE COUNT

makes COUNT of the faults, chosen by a fixed seed, or all if COUNT is 0, and prints a JSON object.
Each run is a fork of this process, which has all modules loaded and has made the whole run once.
"""

from __future__ import annotations

import collections
import ctypes
import errno
import gc
import json
import os
import random
import shutil
import signal
import sys
import traceback
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np

import mpm3dpp.io.background
import mpm3dpp.run.checkpoints
import mpm3dpp.run.resume
import mpm3dpp.run.run
from mpm3dpp import load_case, open_results, run_case
from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.io import read_history, read_manifest

SEED = 2026
MODES = {
    "kill before": (1, 0),
    "kill half way": (2, 0),
    "fail once": (3, errno.EIO),
    "fail from then on": (4, errno.ENOSPC),
}
DONE, STOPPED, REFUSED, TRACEBACK = 0, 1, 2, 3


def main(shim: str, folder: str, case_file: str, count: str) -> None:
    server = Server(ctypes.CDLL(shim), Path(folder), case_file)
    plan = [
        (scenario, mode, call)
        for scenario in ("run", "resume")
        for call in range(1, server.count(scenario) + 1)
        for mode in MODES
    ]
    every = len(plan)
    if int(count):
        plan = random.Random(SEED).sample(plan, int(count))
    outcomes: collections.Counter[str] = collections.Counter()
    wrong = []
    for fault in plan:
        try:
            outcomes[f"{fault[1]}: {server.check(*fault)}"] += 1
        except Exception as error:
            wrong.append([*fault, f"{type(error).__name__}: {error}"])
    print(json.dumps({"points": every, "made": len(plan), "outcomes": outcomes, "wrong": wrong}))


class Server:
    """Makes runs of one case, and knows how they should end."""

    def __init__(self, shim: ctypes.CDLL, folder: Path, case_file: str) -> None:
        shim.faults_last.restype = ctypes.c_char_p
        shim.faults_calls.restype = ctypes.c_long
        shim.faults_arm.argtypes = (ctypes.c_char_p, ctypes.c_long, ctypes.c_int, ctypes.c_int)
        self.shim, self.out = shim, folder / "out"
        self.case = load_case(case_file)
        by_steps()
        one_thread_at_a_time()
        run_case(self.case, folder / "whole", threads=1, pictures=False)
        self.history = (folder / "whole" / "history.csv").read_bytes()
        self.frames = frames_of(folder / "whole")
        self.hash = read_manifest(folder / "whole")["result_hash"]
        self.half = folder / "half"
        code, _ = self.fork(lambda: stopped_after(self.case, self.half, 7))
        assert code == DONE
        gc.collect()
        gc.freeze()  # Forks share these pages then.

    def count(self, scenario: str) -> int:
        """Return at how many calls a fault can be."""
        self.begin(scenario)
        code, calls = self.fork(lambda: self.armed(scenario, 0, "kill before"))
        assert code == DONE, calls
        return int(calls)

    def check(self, scenario: str, mode: str, call: int) -> str:
        """Make a fault, go on, and return how it ended; raise if anything is wrong."""
        self.begin(scenario)
        code, said = self.fork(lambda: self.armed(scenario, call, mode))
        killed = code == -signal.SIGKILL
        if killed != mode.startswith("kill"):
            raise AssertionError(f"ended with {code}: {said}")
        if not killed and code not in (DONE, STOPPED, REFUSED):
            raise AssertionError(f"ended with {code}: {said}")
        if code in (STOPPED, REFUSED):
            assert said and "\n" not in said, said
        self.check_readable()
        if code == DONE:
            self.check_whole()
            return "completed"
        can = mpm3dpp.run.resume.has_checkpoint(self.out)
        if not killed and code == STOPPED:
            assert ("--resume goes on" in said) == can, said
        code, said = self.fork(lambda: self.run(resume=can))
        if code != DONE:
            raise AssertionError(f"afterwards: {code}: {said}")
        self.check_whole()
        return ("killed" if killed else "one sentence") + (", resumed" if can else ", begun anew")

    def begin(self, scenario: str) -> None:
        shutil.rmtree(self.out, ignore_errors=True)
        if scenario == "resume":
            shutil.copytree(self.half, self.out)

    def armed(self, scenario: str, call: int, mode: str) -> str:
        what, error = MODES[mode]
        self.shim.faults_arm(os.fsencode(self.out), call, what, error)
        self.run(resume=scenario == "resume")
        return str(self.shim.faults_calls())

    def run(self, resume: bool) -> None:
        run_case(self.case, self.out, threads=1, pictures=False, resume=resume)

    def fork(self, act: Callable[[], Any]) -> tuple[int, str]:
        """Do something in a fork of this process; return how it ended, and what it said."""
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            code, said = DONE, ""
            try:
                said = act() or ""
            except RunError as error:
                code, said = STOPPED, str(error)
            except CaseError as error:
                code, said = REFUSED, str(error)
            except BaseException:
                code, said = TRACEBACK, traceback.format_exc()
            os.write(writing, said.encode()[:60000])
            ctypes.CDLL(None).exit(code)  # So that HDF5 ends as it does at the end of a program.
        os.close(writing)
        with os.fdopen(reading, encoding="utf-8") as pipe:
            said = pipe.read()
        status = os.waitpid(child, 0)[1]
        return os.waitstatus_to_exitcode(status), said

    def check_readable(self) -> None:
        """Whatever is there after a fault is a part of the whole run."""
        if (self.out / "results.vtkhdf").exists():
            found = frames_of(self.out)
            assert len(found) <= len(self.frames)
            same(found, self.frames[: len(found)])
        table = self.out / "history.csv"
        if table.exists() and b"\n" in table.read_bytes():
            read_history(table)
            whole = table.read_bytes().rpartition(b"\n")[0]
            assert self.history.startswith(whole), "history"

    def check_whole(self) -> None:
        """All results are those of the run without a fault."""
        assert read_manifest(self.out)["status"] == "completed"
        assert read_manifest(self.out)["result_hash"] == self.hash
        assert (self.out / "history.csv").read_bytes() == self.history, "history"
        same(frames_of(self.out), self.frames)
        with h5py.File(self.out / "results.vtkhdf") as file:  # What ParaView sees.
            points = np.concatenate([arrays["position"] for arrays in self.frames])
            assert np.array_equal(file["VTKHDF/Points"][:], points), "results.vtkhdf"
        left = [p.name for p in self.out.rglob(".*")]
        assert not left, left


def frames_of(folder: Path) -> list[dict[str, Any]]:
    with open_results(folder) as results:
        return [
            {**results.arrays(k), "time": results.times[k], "step": results.steps[k]}
            for k in range(len(results))
        ]


def same(found: list[dict[str, Any]], expected: list[dict[str, Any]]) -> None:
    assert len(found) == len(expected), f"{len(found)} of {len(expected)} frames"
    for k, (a, b) in enumerate(zip(found, expected, strict=True)):
        assert a.keys() == b.keys(), k
        for name in a:
            assert np.array_equal(a[name], b[name]), f"frame {k}: {name}"


def by_steps() -> None:
    """Let checkpoints be due at every fifth look, not by the clock."""
    looks = [0]

    def due(_: Any) -> bool:
        looks[0] += 1
        return looks[0] % 5 == 0

    mpm3dpp.run.checkpoints.Checkpoints.due = property(due)  # type: ignore[assignment,method-assign]


def one_thread_at_a_time() -> None:
    """Let a step wait for its frame, so that each run makes the same calls in the same order."""
    thread = mpm3dpp.io.background.FrameThread
    hand_over = thread.hand_over

    def wait(self: Any, simulation: Any) -> None:
        hand_over(self, simulation)
        self.wait()

    thread.hand_over = wait  # type: ignore[method-assign]


def stopped_after(case: Any, folder: Path, looks: int) -> None:
    """Run a case as if it had been killed after so many looks at it."""
    left = iter(range(looks))
    due = mpm3dpp.run.checkpoints.Checkpoints.due.fget  # type: ignore[attr-defined]

    class Killed(BaseException):
        pass

    def end(self: Any) -> bool:
        if next(left, None) is None:
            raise Killed
        return bool(due(self))

    mpm3dpp.run.checkpoints.Checkpoints.due = property(end)  # type: ignore[assignment,method-assign]
    try:
        run_case(case, folder, threads=1, pictures=False)
    except Killed:
        return
    raise AssertionError("the run is too short")


if __name__ == "__main__":
    main(*sys.argv[1:])
