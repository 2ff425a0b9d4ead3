# SPDX-License-Identifier: BSD-3-Clause
"""Ranks that are processes: the same bits, one who tells, and what comes of one that dies."""

from __future__ import annotations

import json
import os
import random
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import mpi_jobs
from commands import CASE, command, mpm3dpp, one_sentence, write
from mpi_jobs import PROGRAMS, environment, job, mpiexec, run
from mpm3dpp.io.checkpoint import read_about
from mpm3dpp.ranks import launch

LONG = CASE.replace('"10 mm"', '"2 mm"').replace('"8 ms"', '"100 s"').replace("frames = 4", "")
LONG = LONG.replace("[output]", '[output]\ncheckpoint_interval = 0.2\ninterval = "1 s"')
BOTH = ("out", "straight")
_LONGEST = 240.0  # s
TINY = CASE.replace("50 mm", "1 mm").replace("velocity = [", "angular_velocity = 3.0\nvelocity = [")
way, each_way = mpi_jobs.way, mpi_jobs.each_way
# Grains that a formula gives a velocity; beyond x = 50 mm, where the second of two ranks has them,
# it has none.
GRAINS = """
[grid]
dimension = 2
cell_size = "2 mm"
[run]
end_time = "1 ms"
[material.sand]
density = "2000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[grains.sand]
material = "sand"
lattice = { lower = [0, 0], count = [8, 2], radius = "5 mm" }
velocity = [{ expression = "sqrt(0.05 - x)" }, 0]
"""


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    out = tmp_path_factory.mktemp("alone") / "found.json"
    words = [sys.executable, str(PROGRAMS / "digests.py"), str(out), "10", "all"]
    subprocess.run(words, env=environment("module"), check=True, timeout=600)
    return dict(json.loads(out.read_text()))


@pytest.mark.slow
def test_examples_by_two_ranks(tmp_path: Path, each_way: str, alone: dict[str, str]) -> None:
    check_examples(tmp_path, each_way, alone, "all", 2)


@pytest.mark.slow
def test_examples_by_four_ranks(tmp_path: Path, each_way: str, alone: dict[str, str]) -> None:
    """With letters that go in pieces."""
    check_examples(tmp_path, each_way, alone, "all", 4, 1000)


@pytest.mark.slow
def test_a_hopper_by_four_ranks(tmp_path: Path, way: str, alone: dict[str, str]) -> None:
    check_examples(tmp_path, way, alone, "few", 4, 1000)


def check_examples(
    folder: Path,
    through: str,
    alone: dict[str, str],
    which: str,
    ranks: int,
    piece: int | str = "",
) -> None:
    out = folder / "found.json"
    words = mpiexec(ranks, PROGRAMS / "digests.py", out, 10, which, piece)
    subprocess.run(words, env=environment(through), check=True, timeout=600)
    found = json.loads(out.read_text())
    assert found.pop("ranks") == str(ranks)
    assert len(found) == (8 if which == "all" else 3)
    assert found == {name: alone[name] for name in found}


def test_a_run_writes_and_tells_once(tmp_path: Path, each_way: str) -> None:
    write(tmp_path)
    plain = ("case.toml", "--no-pictures", "--threads", 1)
    assert mpm3dpp("run", *plain, "--out", "one", cwd=tmp_path).returncode == 0
    done = run(each_way, tmp_path, *plain, "--out", "three", "--ranks", 3)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("completed: ") == 1 and "of each of 3 ranks" in done.stdout
    typed = json.loads((tmp_path / "three/manifest.json").read_text())["command"]
    assert typed.endswith("--out three --ranks 3")
    one, three = (
        json.loads((tmp_path / name / "manifest.json").read_text()) for name in ("one", "three")
    )
    assert one["result_hash"] == three["result_hash"]
    assert one["ranks"]["ranks"] == 1 and three["ranks"]["ranks"] == 3
    assert three["ranks"]["mpi"].endswith("mpi4py") == (each_way == "mpi4py")
    for file in ("history.csv", "history_bodies.csv", "history_pairs.csv"):
        a, b = tmp_path / "one" / file, tmp_path / "three" / file
        assert a.exists() == b.exists() and (not a.exists() or a.read_bytes() == b.read_bytes())


@pytest.mark.parametrize(
    ("text", "words", "sentence"),
    [
        (CASE.replace("8 ms", "8 parsec"), (), 'run.end_time = "8 parsec" has the unit'),
        (CASE.replace("cfl = 0.3", "time_step = 1.0"), (), "larger than the largest stable step"),
        pytest.param(GRAINS, (), "which is no finite number", marks=pytest.mark.slow),
        pytest.param(TINY, (), "holds no particle: it measures", marks=pytest.mark.slow),
        pytest.param(CASE, ("--out", "case.toml"), "case.toml", marks=pytest.mark.slow),
        pytest.param(CASE, ("--resume",), "there is no checkpoint", marks=pytest.mark.slow),
    ],
)
def test_a_mistake_is_told_once(
    tmp_path: Path, way: str, text: str, words: tuple[str, ...], sentence: str
) -> None:
    write(tmp_path, text)
    done = run(way, tmp_path, "case.toml", "--ranks", 2, *words)
    assert done.returncode == 2 and sentence in one_sentence(done.stderr)


def test_so_many_ranks_that_they_would_take_all_memory(tmp_path: Path, way: str) -> None:
    write(tmp_path)
    done = run(way, tmp_path, "case.toml", "--ranks", 1000)
    assert done.returncode == 2
    assert "--ranks = 1000: there are" in one_sentence(done.stderr)
    done = run(way, tmp_path, "case.toml", "--ranks", 0)
    assert done.returncode == 2 and "--ranks" in done.stderr


def test_ctrl_c_and_any_number_of_ranks_goes_on(tmp_path: Path, way: str) -> None:
    write(tmp_path, CASE.replace('"10 mm"', '"5 mm"'))
    assert mpm3dpp("run", "case.toml", "--out", "straight", cwd=tmp_path).returncode == 0
    words = command("run", "case.toml", "--out", "out", "--no-pictures", "--ranks", 3)
    with subprocess.Popen(words, cwd=tmp_path, env=environment(way)) as job:
        wait_for((tmp_path / "out" / "history.csv").exists)
        job.send_signal(signal.SIGINT)
        assert job.wait(_LONGEST) == 130
    on = ("case.toml", "--out", "out", "--resume")
    assert run(way, tmp_path, *on, "--ranks", 2).returncode == 0
    assert mpm3dpp("run", *on, cwd=tmp_path).returncode == 0
    found = [json.loads((tmp_path / name / "manifest.json").read_text()) for name in BOTH]
    assert found[0]["result_hash"] == found[1]["result_hash"]


@pytest.mark.parametrize("kind", [signal.SIGUSR1, signal.SIGXCPU, signal.SIGHUP])
def test_a_signal_of_the_batch_system_ends_all_ranks(
    tmp_path: Path, way: str, kind: signal.Signals
) -> None:
    write(tmp_path, LONG)
    words = command("run", "case.toml", "--out", "out", "--ranks", 2)
    with subprocess.Popen(words, cwd=tmp_path, env=environment(way)) as job:
        wait_for((tmp_path / "out" / "checkpoint.zip").exists)
        ranks = ranks_of(job)
        for number in (job.pid, *ranks):  # As when it goes to all processes of a job.
            os.kill(number, kind)
        assert job.wait(_LONGEST) == 130
    check_interrupted(tmp_path / "out", f"stopped by {kind.name} at t = ")
    wait_for(lambda: not any(map(is_there, ranks)))


@pytest.mark.parametrize("killed", ["launcher", "mpiexec"])
def test_ranks_end_with_who_has_started_them(tmp_path: Path, way: str, killed: str) -> None:
    """That nobody could tell them to is no reason to stay, nor to leave without a checkpoint."""
    write(tmp_path, LONG)
    words = command("run", "case.toml", "--out", "out", "--ranks", 2)
    with subprocess.Popen(words, cwd=tmp_path, env=environment(way)) as job:
        wait_for((tmp_path / "out" / "checkpoint.zip").exists)
        ranks = ranks_of(job)
        assert len(ranks) == 2
        (mpiexec,) = {parent_of(rank) for rank in ranks}
        os.kill(job.pid if killed == "launcher" else mpiexec, signal.SIGKILL)
        job.wait(_LONGEST)
    wait_for(lambda: not any(map(is_there, [*ranks, mpiexec])))
    if killed == "launcher":
        check_interrupted(tmp_path / "out", "stopped by the user at t = ")
    reached = read_about(tmp_path / "out" / "checkpoint.zip")["time"]
    more = ("--resume", "--set", f"run.end_time={reached + 1e-4}", "--no-pictures")
    assert run(way, tmp_path, "case.toml", "--out", "out", *more).returncode == 0


def parent_of(process: int) -> int:
    return int(Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[1])


def is_there(process: int) -> bool:
    try:
        return Path(f"/proc/{process}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def check_interrupted(folder: Path, reason: str) -> None:
    manifest = json.loads((folder / "manifest.json").read_text())
    assert manifest["status"] == "interrupted" and manifest["reason"].startswith(reason)
    assert step_of(folder / "checkpoint.zip") == manifest["steps"]


def test_one_that_fails_alone_ends_all(tmp_path: Path, way: str) -> None:
    words = mpiexec(3, PROGRAMS / "one_fails.py", write(tmp_path), 1)
    done = job(way, tmp_path, words)
    assert done.returncode != 0
    assert "rank 1 cannot go on, and with it the run: no column is named speed" in done.stderr


def wait_for(holds: Callable[[], bool], job: subprocess.Popen[str] | None = None) -> None:
    """Wait until it holds, as long as a job lives that is to bring it about.

    More ranks than cores beside other work make some steps a second: a second may take a minute.
    """
    end = time.monotonic() + _LONGEST
    while not holds():
        if job is not None and job.poll() is not None:
            raise AssertionError(f"the job has ended: {job.communicate()[1]}")
        assert time.monotonic() < end
        time.sleep(0.01)


def step_of(checkpoint: Path) -> int:
    return int(read_about(checkpoint)["step"])


def ranks_of(job: subprocess.Popen[Any]) -> list[int]:
    """Return the ranks of a job by their environment: of no other job, that of another test."""
    found = []
    for folder in Path("/proc").iterdir():
        try:
            about = (folder / "environ").read_bytes()
            above = ancestors(int(folder.name))
        except (OSError, ValueError, IndexError):
            continue
        # Below mpiexec, which the launcher has started.
        if f"{launch.TOLD}=".encode() in about and b"RANK" in about and job.pid in above[1:]:
            found.append(int(folder.name))
    return found


def ancestors(process: int) -> list[int]:
    found = [parent_of(process)]
    while found[-1] > 1:
        found.append(parent_of(found[-1]))
    return found


def test_killed_ranks(tmp_path: Path, way: str) -> None:
    check_kills(tmp_path, way, 2, 2)


@pytest.mark.slow
def test_many_killed_ranks(tmp_path: Path, each_way: str) -> None:
    check_kills(tmp_path, each_way, 20, 3)


def check_kills(tmp_path: Path, way: str, kills: int, ranks: int) -> None:
    """The job ends at once, and nothing is lost but the time since the last checkpoint."""
    write(tmp_path, LONG)
    chance, state = random.Random(2026), tmp_path / "out" / "checkpoint.zip"
    reached = []
    for kill in range(kills):
        more = ["--resume"] if kill else []
        words = command(
            "run", "case.toml", "--out", "out", "--no-pictures", "--ranks", ranks, *more
        )
        with subprocess.Popen(
            words, cwd=tmp_path, env=environment(way), stderr=subprocess.PIPE, text=True
        ) as job:
            wait_for(lambda: state.exists() and step_of(state) > max(reached, default=0), job)
            time.sleep(0.3 * chance.random())
            os.kill(chance.choice(ranks_of(job)), signal.SIGKILL)
            begin = time.monotonic()
            _, told = job.communicate(timeout=_LONGEST)
        reached.append(step_of(state))
        assert time.monotonic() - begin < 15 and job.returncode == 1 and "Traceback" not in told
        last = told.strip().splitlines()[-1]
        assert last.startswith("mpm3dpp: error: a process of the run has ended")
    # A run may be given another end when it goes on.
    write(tmp_path, LONG.replace("100 s", f"{1000 * read_about(state)['time'] + 1} ms"))
    plain = ("case.toml", "--no-pictures", "--threads", 1, "--quiet")
    assert run(way, tmp_path, *plain, "--out", "out", "--resume").returncode == 0
    assert run(way, tmp_path, *plain, "--out", "straight").returncode == 0
    found = [json.loads((tmp_path / name / "manifest.json").read_text()) for name in BOTH]
    assert found[0]["result_hash"] == found[1]["result_hash"]
    assert found[0]["resumed_step"] >= reached[-1]


def test_a_program_goes_on_after_a_mistake(tmp_path: Path, way: str) -> None:
    """All ranks meet it, as one process alone would."""
    line = mpiexec(2, PROGRAMS / "mistake_and_run.py", write(tmp_path), tmp_path / "out")
    done = job(way, tmp_path, line)
    assert done.returncode == 0, done.stderr
    assert sorted(done.stdout.split()) == sorted(
        ["rank", "0:", "completed", "rank", "1:", "completed"]
    )


@pytest.mark.parametrize("words", [("sweep", "case.toml"), ("bench", "elastic3d")])
def test_commands_that_start_processes_are_not_for_mpiexec(
    tmp_path: Path, words: tuple[str, str]
) -> None:
    for rank, sentence in ((0, f"{words[0]} starts its runs itself, and mpiexec"), (1, "")):
        about = {**os.environ, "PMI_SIZE": "2", "PMI_RANK": str(rank)}
        done = subprocess.run(
            command(*words), env=about, capture_output=True, text=True, timeout=60, check=False
        )
        assert done.returncode == 2
        assert sentence in done.stderr and bool(done.stderr) == bool(sentence)


def test_processes_that_are_each_alone(tmp_path: Path) -> None:
    """An mpiexec of another MPI than mpi4py's: a sentence by the first, no run of four."""
    pytest.importorskip("mpi4py")
    write(tmp_path)
    for rank in (0, 1):
        about = {**os.environ, "PMI_SIZE": "4", "PMI_RANK": str(rank)}
        done = subprocess.run(
            command("run", "case.toml"),
            cwd=tmp_path,
            env=about,
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 2
        if rank == 0:
            assert "4 processes were started" in one_sentence(done.stderr)
        else:
            assert done.stderr == ""


def test_without_mpi4py(tmp_path: Path) -> None:
    write(tmp_path)
    (tmp_path / "mpi4py.py").write_text("raise ImportError('no mpi4py here')")
    about = {**os.environ, "PYTHONPATH": f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}"}
    for more, extra in ((("--ranks", "2"), {}), ((), {"PMI_SIZE": "2", "PMI_RANK": "0"})):
        done = subprocess.run(
            command("run", "case.toml", *more),
            cwd=tmp_path,
            env={**about, **extra},
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 2
        assert "pip install 'mpm3dpp[mpi]'" in one_sentence(done.stderr)


@pytest.mark.parametrize("name", ["elastic2d", pytest.param("drum", marks=pytest.mark.slow)])
def test_bench_of_ranks(tmp_path: Path, way: str, name: str) -> None:
    words = ("bench", name, "--size", 16, "--steps", 5, "--ranks", 1, "--ranks", 2)
    line = command(*words, "--json", "--plot", tmp_path / "bench.png")
    done = subprocess.run(
        line, env=environment(way), capture_output=True, text=True, timeout=120, check=True
    )
    one, two = json.loads(done.stdout)
    assert (one["ranks"], one["letters"], two["ranks"]) == (1, 0.0, 2)
    assert two["letters"] > 0.0 and two["bytes"] > 0.0 and 0.0 < two["share"] < 1.0
    assert (tmp_path / "bench.png").stat().st_size > 1000


def test_check_tells_the_memory_of_a_rank(tmp_path: Path) -> None:
    write(tmp_path)
    done = mpm3dpp("check", "case.toml", "--ranks", 4, cwd=tmp_path)
    assert "ranks: each of 4 about" in done.stdout
