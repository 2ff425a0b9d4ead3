# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C and SIGTERM end a command whenever they come, and a simulation's steps with the next."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from commands import CASE, command, write
from mpm3dpp import Case, Simulation
from mpm3dpp.base import signals

LONG = CASE.replace("8 ms", "1000 s")
KINDS = (signal.SIGINT, signal.SIGTERM)
# A simulation with steps of some milliseconds, of which many thousands are asked for.
STEPPING = """
import signal, sys, time
from mpm3dpp import Case, Simulation
signal.signal(signal.SIGINT, signal.default_int_handler)  # A shell's background job ignores it.
text = open(sys.argv[1]).read().replace('cell_size = "10 mm"', 'cell_size = "0.2 mm"')
case = Case.from_text(text)
simulation = Simulation(case, threads=1)
begin = time.monotonic()
simulation.advance(10)
print((time.monotonic() - begin) / 10, flush=True)
try:
    simulation.advance(10**6, 1e9)
except KeyboardInterrupt:
    print(simulation.step, time.monotonic(), flush=True)
"""


def caught(process: subprocess.Popen[str]) -> bool:
    """Whether the process has a handler of its own for SIGTERM: ours is the first."""
    lines = Path(f"/proc/{process.pid}/status").read_text().splitlines()
    mask = next(int(line.split()[1], 16) for line in lines if line.startswith("SigCgt"))
    return bool(mask >> (signal.SIGTERM - 1) & 1)


def end(arguments: list[str], kind: signal.Signals, after: float) -> tuple[int, str, str]:
    """Send a signal so many seconds after the program has begun; return code, output, errors."""
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        while process.poll() is None and not caught(process):
            time.sleep(0.0005)
        time.sleep(after)
        process.send_signal(kind)
        out, err = process.communicate(timeout=20)
    finally:
        process.kill()
    return process.returncode, out, err


def check_ends(folder: Path, count: int, seed: int) -> None:
    case, draw = write(folder, LONG), random.Random(seed)
    for k in range(count):
        kind, after = KINDS[k % 2], draw.uniform(0.0, 1.0) ** 2
        arguments = command("run", case, "--out", folder / f"{k}", "--threads", 1, "--no-pictures")
        code, _, err = end(arguments, kind, after)
        told = f"{kind.name} after {after:.3f} s: {code}\n{err}"
        assert code == 130, told
        assert "Traceback" not in err and "ignored" not in err, told
        assert "stopped by the user" in err, told


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs /proc")
def test_at_any_moment_of_the_first_second(tmp_path: Path) -> None:
    check_ends(tmp_path, 10, seed=9)


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="needs /proc")
def test_at_250_moments_of_the_first_second(tmp_path: Path) -> None:
    check_ends(tmp_path, 250, seed=10)


# What swallows exceptions: a finaliser, a hook of the garbage collector, a key that is compared.
SWALLOWING = """
import os, runpy, signal, sys, time
sys.argv = ["mpm3dpp", "check", sys.argv[1]]
class Finaliser:
    def __del__(self):
        os.kill(os.getpid(), signal.SIG{kind})
        for _ in range(1000):
            pass
def load(*_):
    Finaliser()
    time.sleep(2)
    print("went on")
import mpm3dpp.importers
mpm3dpp.importers.load_any = load
runpy.run_module("mpm3dpp", run_name="__main__")
"""


@pytest.mark.parametrize("kind", ["INT", "TERM"])
def test_in_a_callback_in_which_exceptions_are_lost(tmp_path: Path, kind: str) -> None:
    line = [sys.executable, "-c", SWALLOWING.replace("{kind}", kind), str(write(tmp_path))]
    done = subprocess.run(line, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "mpm3dpp: error: stopped by the user\n"


def test_many_steps_from_python_end_with_the_present_one(tmp_path: Path) -> None:
    line = [sys.executable, "-c", STEPPING, str(write(tmp_path))]
    with subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as run:
        assert run.stdout is not None
        step = float(run.stdout.readline())
        assert 4096 * step > 20.0, "steps so short that this test shows nothing"
        time.sleep(0.3)
        sent = time.monotonic()
        run.send_signal(signal.SIGINT)
        try:
            out, err = run.communicate(timeout=30)
        finally:
            run.kill()
    assert (run.returncode, err) == (0, "")
    steps, ended = out.split()
    # A step and the way of the signal; on a busy machine a step may take many times as long.
    assert float(ended) - sent < 20 * step + 1.0
    assert 10 < int(steps) < 4096


def test_a_handler_that_only_takes_notice_gets_the_program_back() -> None:
    simulation = Simulation(Case.from_text(LONG), threads=1)
    old = signal.signal(signal.SIGTERM, lambda *_: None)
    try:
        threading.Timer(0.2, os.kill, [os.getpid(), signal.SIGTERM]).start()
        made = simulation.advance(10**7)
        assert 0 < made < 10**7
        assert simulation.step == made
    finally:
        signal.signal(signal.SIGTERM, old)


def test_a_simulation_in_another_thread_takes_no_signal_away() -> None:
    small, big = (Simulation(Case.from_text(LONG), threads=1) for _ in range(2))
    ended = threading.Event()

    def many_short_ones() -> None:
        while not ended.is_set():
            small.core.advance(1, 1e9)
            small.core.history()

    worker = threading.Thread(target=many_short_ones)
    old = signal.signal(signal.SIGTERM, lambda *_: None)
    worker.start()
    try:
        threading.Timer(0.2, os.kill, [os.getpid(), signal.SIGTERM]).start()
        assert 0 < big.advance(10**6) < 10**6
    finally:
        ended.set()
        worker.join()
        signal.signal(signal.SIGTERM, old)


def test_a_handler_of_another_language_is_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Python tells None of it, and cannot set it again."""
    real = signal.signal
    before = {kind: signal.getsignal(kind) for kind in KINDS}

    def told_none(kind: signal.Signals, new: signal.Handlers) -> None:
        real(kind, new)

    monkeypatch.setattr(signal, "signal", told_none)
    try:
        with signals.Notice():
            pass
    finally:
        for kind, handler in before.items():
            real(kind, handler)


def test_a_second_thread_is_refused() -> None:
    simulation = Simulation(Case.from_text(LONG), threads=1)
    made: list[int] = []
    worker = threading.Thread(target=lambda: made.append(simulation.core.advance(4000, 1e9)))
    worker.start()
    refused = 0
    uses = (
        lambda: simulation.advance(1),
        lambda: simulation.column("left", "position"),
        lambda: simulation.time,
        lambda: simulation.core.history(),
    )
    while worker.is_alive():
        for use in uses:
            try:
                use()
            except RuntimeError as error:
                assert "another thread is at work in this simulation" in str(error)
                refused += 1
    worker.join()
    assert made == [4000]
    assert refused > 0
    assert simulation.step >= 4000
    assert simulation.advance(1) == 1
