# SPDX-License-Identifier: BSD-3-Clause
"""Ctrl-C, SIGTERM and their like end a command whenever they come, and a simulation's steps with
the next; and no process of ours outlives its starter."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from commands import CASE, command, write
from mpm3dpp import Case, Simulation
from mpm3dpp.base import signals
from mpm3dpp.io import read_manifest
from mpm3dpp.io.checkpoint import read_about

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


OTHERS = ["HUP", "QUIT", "USR1", "USR2", "XCPU"]


def started(folder: Path, *words: object) -> subprocess.Popen[str]:
    """Start a run without end, and return when it has written some rows."""
    line = command("run", write(folder, LONG), "--out", folder / "out", "--threads", 1, *words)
    run = subprocess.Popen(line, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wait_for(lambda: size(folder / "out" / "history.csv") > 50_000, run)
    return run


def size(path: Path) -> int:
    return path.stat().st_size if path.exists() else 0


def wait_for(holds: Callable[[], bool], *alive: subprocess.Popen[str]) -> None:
    end = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < end
        assert all(process.poll() is None for process in alive)
        time.sleep(0.01)


@pytest.mark.parametrize("name", OTHERS)
def test_what_batch_systems_and_terminals_send_ends_a_run_as_sigterm_does(
    tmp_path: Path, name: str
) -> None:
    run = started(tmp_path)
    run.send_signal(signal.Signals[f"SIG{name}"])
    _, err = run.communicate(timeout=30)
    assert run.returncode == 130
    last = err.splitlines()[-1]
    assert last.startswith(f"mpm3dpp: stopped by SIG{name} at t = ") and "--resume goes on" in last
    manifest = read_manifest(tmp_path / "out")
    assert manifest["status"] == "interrupted"
    assert manifest["reason"].startswith(f"stopped by SIG{name} at t = ")
    assert read_about(tmp_path / "out" / "checkpoint.zip")["step"] == manifest["steps"]


@pytest.mark.parametrize("name", OTHERS)
def test_they_end_other_commands_at_once(tmp_path: Path, name: str) -> None:
    line = [sys.executable, "-c", SWALLOWING.replace("{kind}", name), str(write(tmp_path))]
    done = subprocess.run(line, capture_output=True, text=True, timeout=60)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == f"mpm3dpp: error: stopped by SIG{name}\n"


@pytest.mark.parametrize("name", OTHERS)
def test_steps_from_python_end_with_the_present_one(name: str) -> None:
    simulation = Simulation(Case.from_text(LONG), threads=1)
    kind = signal.Signals[f"SIG{name}"]
    old = signal.signal(kind, lambda *_: None)
    try:
        threading.Timer(0.2, os.kill, [os.getpid(), kind]).start()
        made = simulation.advance(10**7)
        assert 0 < made < 10**7
    finally:
        signal.signal(kind, old)


def test_what_the_starter_ignores_is_ignored(tmp_path: Path) -> None:
    """`nohup mpm3dpp run` goes on when the terminal closes."""
    old = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        run = started(tmp_path)
    finally:
        signal.signal(signal.SIGHUP, old)
    before = size(tmp_path / "out" / "history.csv")
    run.send_signal(signal.SIGHUP)
    wait_for(lambda: size(tmp_path / "out" / "history.csv") > before + 50_000, run)
    run.terminate()
    assert run.wait(30) == 130
    run.communicate()


def test_a_handler_of_the_program_is_left_to_it() -> None:
    """A program may have a use of its own for SIGUSR1; SIGTERM is ours during a run."""

    def own(*_: object) -> None: ...

    old = {kind: signal.signal(kind, own) for kind in (signal.SIGUSR1, signal.SIGTERM)}
    try:
        with signals.Notice() as notice:
            os.kill(os.getpid(), signal.SIGUSR1)
            assert not notice.taken and signal.getsignal(signal.SIGUSR1) is own
            os.kill(os.getpid(), signal.SIGTERM)
            assert notice.taken
        assert signal.getsignal(signal.SIGTERM) is own
    finally:
        for kind, handler in old.items():
            signal.signal(kind, handler)


SWEEP = ("--set", "contact.friction=0,0.1", "--jobs", 2, "--out", "out")


def swept(folder: Path) -> tuple[subprocess.Popen[str], list[int]]:
    """Start a sweep of runs without end; return it, and its runs, which are at work."""
    line = command("sweep", write(folder, LONG).name, *SWEEP)
    sweep = subprocess.Popen(
        line, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    tables = [folder / "out" / f"contact.friction={x}" / "history.csv" for x in ("0", "0.1")]
    wait_for(lambda: all(size(table) > 50_000 for table in tables), sweep)
    own = Path(f"/proc/{sweep.pid}/task").iterdir()
    found = [(task / "children").read_text().split() for task in own]
    return sweep, [int(number) for numbers in found for number in numbers]


def gone(process: int) -> bool:
    """Whether a process has ended; one that nobody has waited for counts."""
    try:
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] == "Z"
    except OSError:
        return True


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
@pytest.mark.parametrize("name", ["TERM", "USR1", "XCPU", "HUP", "KILL"])
def test_a_sweep_ends_with_its_runs(tmp_path: Path, name: str) -> None:
    """Each with its checkpoint, also where nobody could tell them: their starter was killed."""
    sweep, runs = swept(tmp_path)
    assert len(runs) == 2
    sweep.send_signal(signal.Signals[f"SIG{name}"])
    sweep.communicate(timeout=30)
    assert sweep.returncode == (-signal.SIGKILL if name == "KILL" else 130)
    wait_for(lambda: all(map(gone, runs)))
    for value in ("0", "0.1"):
        folder = tmp_path / "out" / f"contact.friction={value}"
        assert read_manifest(folder)["status"] == "interrupted"
        assert (folder / "checkpoint.zip").is_file()


ASLEEP = """
import os, subprocess, sys
from mpm3dpp.base import child
line = child.command("__main__", "run", "case.toml", "--out", "out", "--threads", "1")
process = subprocess.Popen(line, stdin=subprocess.DEVNULL)
print(process.pid, flush=True)
process.wait()
"""


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
@pytest.mark.parametrize("tells", [True, False], ids=["told by the system", "looked for"])
def test_a_process_of_ours_does_not_outlive_its_starter(tmp_path: Path, tells: bool) -> None:
    write(tmp_path, LONG)
    about = dict(os.environ)
    if not tells:  # As on an old Linux.
        (tmp_path / "lib").mkdir()
        (tmp_path / "lib" / "sitecustomize.py").write_text("import os\ndel os.pidfd_open\n")
        about["PYTHONPATH"] = f"{tmp_path / 'lib'}:{os.environ.get('PYTHONPATH', '')}"
    line = [sys.executable, "-c", ASLEEP]
    starter = subprocess.Popen(line, cwd=tmp_path, env=about, stdout=subprocess.PIPE, text=True)
    assert starter.stdout is not None
    run = int(starter.stdout.readline())
    wait_for(lambda: size(tmp_path / "out" / "history.csv") > 20_000)
    assert not gone(run)
    starter.kill()
    starter.communicate()
    wait_for(lambda: gone(run))
    assert read_manifest(tmp_path / "out")["status"] == "interrupted"
