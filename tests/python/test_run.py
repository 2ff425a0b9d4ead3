# SPDX-License-Identifier: BSD-3-Clause
"""Whole runs, from a case file to the output folder, through the command line and from Python."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from commands import CASE, command, mpm3dpp, one_sentence, write
from mpm3dpp import RunError, load_case, open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import read_history, read_manifest
from mpm3dpp.io.folders import forget_last_run

LONG = CASE.replace('"8 ms"', '"1000 s"').replace("frames = 4", 'interval = "20 ms"')
# Update stress last with the linear basis makes energy in contact (Bardenhagen 2002).
UNSTABLE = CASE.replace('cell_size = "10 mm"', 'cell_size = "10 mm"\nbasis = "linear"').replace(
    "cfl = 0.3", 'cfl = 0.5\nscheme = "usl"'
)
FIRST = (
    "step,time,dt,kinetic,internal,plastic,viscous,friction,restitution,contact,springs,external,"
    "absorbed,damped,eroded,fracture,left,bounded,numerical,residual,momentum_x,momentum_y,momentum_z"
)
KEYS = (
    *("version", "case_hash", "mass", "cell_size", "particles", "threads", "steps", "wall_time"),
    *("ns_per_particle_step", "stages", "peak_memory_bytes", "bytes", "result_hash", "contact"),
)


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, str]:
    """Return the output folder of a finished run, and what it printed."""
    folder = tmp_path_factory.mktemp("run")
    words = ("run", write(folder), "--out", folder / "out", "--threads", 1)
    done = mpm3dpp(*words, cwd=folder, pictures=True)
    assert done.returncode == 0, done.stderr
    return folder / "out", done.stdout, done.stderr


def test_a_run_leaves_these_files(finished: tuple[Path, str, str]) -> None:
    out, printed, _ = finished
    names = {path.name for path in out.iterdir()}
    assert {"results.vtkhdf", "history.csv", "manifest.json"} <= names
    assert len([name for name in names if name.endswith(".png")]) >= 2
    assert all((out / name).stat().st_size > 0 for name in names)
    assert not [name for name in names if "tmp" in name or name.startswith(".")]
    assert str(out) in printed and "ns per particle-step" in printed
    assert "left - right: first contact at" in printed


def test_the_manifest_has_every_key(finished: tuple[Path, str, str]) -> None:
    out = finished[0]
    manifest = json.loads((out / "manifest.json").read_text())
    assert set(KEYS) <= set(manifest)
    assert set(manifest["bytes"]) == {"particles", "grid", "contact", "other"}
    assert {"overlapped_nodes_max", "bodies_per_node_max", "pairs"} <= set(manifest["contact"])
    assert manifest["contact"]["bodies_per_node_max"] == 2
    [pair] = manifest["contact"]["pairs"]
    assert {"bodies", "first_time", "first_gap", "impulse", "friction_work"} <= set(pair)
    assert pair["bodies"] == ["left", "right"]
    assert 0 < pair["first_time"] < 8e-3
    assert abs(pair["first_gap"]) < 0.5 * manifest["cell_size"]
    assert pair["impulse"][0] < 0 < len(pair["impulse"])  # on the left one, to the left
    assert manifest["mass"] == pytest.approx(2 * 1000.0 * 0.05**2)
    assert (manifest["particles"], manifest["threads"]) == (200, 1)
    assert manifest["cell_size"] == 0.01 and manifest["wall_time"] > 0
    assert manifest["ns_per_particle_step"] == pytest.approx(sum(manifest["stages"].values()))
    assert {"map momentum", "contact forces"} <= set(manifest["stages"])
    assert len(manifest["result_hash"]) == len(manifest["case_hash"]) == 64
    case = load_case(out.parent / "case.toml")
    assert manifest["case_hash"] == case.case_hash and manifest["case_text"] == CASE
    assert manifest["status"] == "completed" and manifest["end_time"] == 8e-3


def test_the_history_is_whole(finished: tuple[Path, str, str]) -> None:
    out = finished[0]
    header = (out / "history.csv").read_text().splitlines()[0]
    assert header.startswith(FIRST + ",")
    pair = [f"contact_{k}_left_right_{x}" for k in ("force", "impulse") for x in "xyz"]
    assert header.split(",")[-6:] == pair
    rows, steps = read_history(out), read_manifest(out)["steps"]
    assert rows["step"].tolist() == list(range(steps + 1))
    assert rows["time"][-1] == 8e-3
    assert np.abs(rows["residual"]).max() <= 1e-12 * rows["kinetic"][0]
    impulse = rows["contact_impulse_left_right_x"][1:]  # the first row is the start
    force = rows["contact_force_left_right_x"][1:]
    assert np.allclose(np.cumsum(force * rows["dt"][1:]), impulse, rtol=1e-9)
    assert impulse[-1] == read_manifest(out)["contact"]["pairs"][0]["impulse"][0]


def test_the_frames_are_readable(finished: tuple[Path, str, str]) -> None:
    with open_results(finished[0]) as results:
        assert results.times[0] == 0.0 and results.times[-1] == 8e-3
        assert len(results) >= 5  # four and the first, and one at the first contact
        assert (np.diff(results.times) > 0).all()
        assert results.bodies == ["left", "right"]
        last = results.arrays(-1)
    for name in ("position", "velocity", "stress", "pressure", "von_mises", "body", "material"):
        assert len(last[name]) == 200 and np.isfinite(last[name]).all(), name
    assert last["von_mises"].max() > 0


def test_quiet_and_json(tmp_path: Path) -> None:
    path = write(tmp_path)
    done = mpm3dpp("run", path, "--out", "quiet", "--threads", 2, "--quiet", cwd=tmp_path)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    done = mpm3dpp("run", path, "--out", "json", "--threads", 1, "--json", cwd=tmp_path)
    assert done.returncode == 0
    printed = json.loads(done.stdout)
    assert printed == read_manifest(tmp_path / "json")
    other = read_manifest(tmp_path / "quiet")
    assert (other["threads"], printed["threads"]) == (2, 1)
    assert (other["result_hash"], other["steps"]) == (printed["result_hash"], printed["steps"])
    assert (tmp_path / "quiet/history.csv").read_text() == (
        tmp_path / "json/history.csv"
    ).read_text()


def test_run_case_from_python(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    file = write(tmp_path)
    case = load_case(file)
    manifest = run_case(case, tmp_path / "out", threads=1)
    assert manifest.to_dict() == read_manifest(tmp_path / "out")
    printed = capfd.readouterr()
    assert (printed.out, printed.err) == ("", "")
    again = run_case(file, tmp_path / "out", threads=1, pictures=False)  # The file, again here.
    assert again.result_hash == manifest.result_hash
    with open_results(tmp_path / "out") as results:
        assert results.case_hash == case.case_hash


def test_what_became_of_each_body(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Also of a run that goes on: before is before its first step."""
    for end in ("4 ms", "8 ms"):
        file, more = write(tmp_path, CASE.replace('"8 ms"', f'"{end}"')), end == "8 ms"
        run_case(file, tmp_path / "out", threads=1, quiet=False, pictures=False, resume=more)
    assert "left: 5 -> " in capfd.readouterr().out
    found = read_manifest(tmp_path / "out")["bodies"]
    assert list(found) == ["left", "right"]
    for name, speed in (("left", 5.0), ("right", -5.0)):
        before, after = found[name]["initial"], found[name]["final"]
        assert before["velocity_x"] == pytest.approx(speed)
        assert before["mass"] == pytest.approx(after["mass"], rel=1e-12)
        assert abs(after["velocity_x"]) < 5.0
    sums = {
        which: sum(found[name][which]["momentum_x"] for name in found)
        for which in ("initial", "final")
    }
    assert abs(sums["final"] - sums["initial"]) < 1e-9 * found["left"]["initial"]["momentum_x"]
    history = read_history(tmp_path / "out")
    assert history["body_left_velocity_x"][-1] == found["left"]["final"]["velocity_x"]


def frames_of(folder: Path) -> int:
    with open_results(folder / "out") as results:
        return len(results)


def start_long_run(folder: Path, pictures: bool = False) -> subprocess.Popen[str]:
    """Start a run without end and return when it has written a few frames."""
    words = ("run", write(folder, LONG), "--out", folder / "out", "--threads", 1, "--quiet")
    run = subprocess.Popen(
        command(*words, pictures=pictures),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONUNBUFFERED": "1"},
    )
    deadline = time.monotonic() + 60
    history = folder / "out" / "history.csv"
    while not history.exists() or history.stat().st_size < 200_000 or frames_of(folder) < 2:
        if run.poll() is not None or time.monotonic() > deadline:
            run.kill()
            pytest.fail(str(run.communicate()))
        time.sleep(0.05)
    return run


@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGTERM])
def test_control_c_ends_cleanly_and_keeps_the_results(tmp_path: Path, kind: signal.Signals) -> None:
    pictures = kind == signal.SIGINT
    run = start_long_run(tmp_path, pictures)
    run.send_signal(kind)
    out, err = run.communicate(timeout=30)
    assert (run.returncode, out) == (130, "")
    assert "Traceback" not in err
    manifest, rows = read_manifest(tmp_path / "out"), read_history(tmp_path / "out")
    assert manifest["status"] == "interrupted" and "user" in manifest["reason"]
    assert manifest["end_time"] == rows["time"][-1] and manifest["steps"] == rows["step"][-1]
    with open_results(tmp_path / "out") as results:
        assert len(results) >= 2
        assert np.isfinite(results.arrays(-1)["velocity"]).all()
    assert bool(list((tmp_path / "out").glob("*.png"))) == pictures


def test_a_killed_run_leaves_readable_frames(tmp_path: Path) -> None:
    run = start_long_run(tmp_path)
    run.kill()
    run.communicate(timeout=30)
    with open_results(tmp_path / "out") as results:
        assert len(results) >= 2
        assert np.isfinite(results.arrays(len(results) - 1)["velocity"]).all()
    rows = read_history(tmp_path / "out")
    assert len(rows["step"]) > 100 and np.isfinite(rows["kinetic"]).all()


def test_an_unstable_run_says_why_and_keeps_the_last_good_frame(tmp_path: Path) -> None:
    path = write(tmp_path, UNSTABLE)
    done = mpm3dpp("run", path, "--out", "out", "--threads", 1, "--quiet", cwd=tmp_path)
    assert (done.returncode, done.stdout) == (1, "")
    sentence = one_sentence(done.stderr)
    for part in ("at step", "t = ", "body ", "particle ", "out"):
        assert part in sentence
    manifest = read_manifest(tmp_path / "out")
    assert manifest["status"] == "failed" and manifest["reason"] in sentence
    with open_results(tmp_path / "out") as results:
        assert len(results) >= 2
        assert results.steps[-1] < manifest["steps"]  # from before the failure
        for name in ("position", "velocity", "stress"):
            assert np.isfinite(results.arrays(-1)[name]).all()
    assert read_history(tmp_path / "out")["step"][-1] == manifest["steps"]
    with pytest.raises(RunError, match="at step"):
        run_case(load_case(path), tmp_path / "again", threads=1)


def test_a_full_disk_ends_the_run_and_keeps_the_frames(tmp_path: Path) -> None:
    """A limit on the size of files stands for the full disk."""
    words = command("run", write(tmp_path, LONG), "--out", "out", "--threads", 1, "--quiet")
    limit = (1_500_000, 1_500_000)
    done = subprocess.run(
        words,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit),
    )
    assert (done.returncode, done.stdout) == (1, "")
    assert "file too large" in one_sentence(done.stderr)
    assert "what was written before is in out" in done.stderr
    with open_results(tmp_path / "out") as results:
        assert len(results) >= 2


def test_an_earlier_run_is_not_taken_for_the_new_one(tmp_path: Path) -> None:
    run_case(load_case(write(tmp_path)), tmp_path / "out", threads=1, pictures=False)
    (tmp_path / "out" / "frame.png").write_text("of before")
    (tmp_path / "out" / "notes.txt").write_text("the user's own")
    forget_last_run(tmp_path / "out")
    left = {file.name for file in (tmp_path / "out").iterdir()}
    assert left == {"results.vtkhdf", "results.frames", "history.csv", "notes.txt"}


@pytest.mark.parametrize("place", ["file", "file/below"])
def test_a_folder_that_cannot_be_made(tmp_path: Path, place: str) -> None:
    (tmp_path / "file").write_text("not a folder")
    path = write(tmp_path)
    done = mpm3dpp("run", path, "--out", place, cwd=tmp_path)
    assert (done.returncode, done.stdout) == (2, "")
    assert "--out" in one_sentence(done.stderr)
    with pytest.raises(CaseError, match="--out"):
        run_case(load_case(path), tmp_path / place)


def test_a_refused_run_leaves_no_folder(tmp_path: Path) -> None:
    """Nor does it take one that was there."""
    (tmp_path / "mine").mkdir()
    write(tmp_path, CASE.replace("cfl = 0.3", "time_step = 1.0"))
    for out in ("mine", "new"):
        done = mpm3dpp("run", "case.toml", "--out", out, cwd=tmp_path)
        assert done.returncode == 2 and "largest stable step" in done.stderr
    assert mpm3dpp("run", "case.toml", cwd=tmp_path).returncode == 2  # results/NAME
    assert [path.name for path in tmp_path.iterdir() if path.is_dir()] == ["mine"]


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write anywhere")
def test_a_folder_without_permission(tmp_path: Path) -> None:
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o500)
    done = mpm3dpp("run", write(tmp_path), "--out", folder, cwd=tmp_path)
    assert done.returncode == 2
    assert "may write to" in one_sentence(done.stderr)


def test_rows_of_the_history_and_contact_forces(tmp_path: Path) -> None:
    """Every seventh step, and those of frames and the end; all with the forces of the step."""
    case = load_case(write(tmp_path, CASE.replace("[output]", "[output]\nhistory_every = 7")))
    manifest = run_case(case, tmp_path / "out", quiet=True, pictures=False)
    history = read_history(tmp_path / "out")
    steps = history["step"].astype(int)
    others = [step for step in steps if step % 7]
    assert set(range(0, manifest.steps + 1, 7)) <= set(steps.tolist())
    assert 0 < len(others) <= len(open_results(tmp_path / "out")) + 1
    for name in history:
        if name.startswith("contact_force"):
            assert np.isfinite(history[name][1:]).all(), name


def test_frames_by_their_times(finished: tuple[Path, str, str]) -> None:
    with open_results(finished[0]) as results:
        last = len(results) - 1
        assert results.nearest(1.0) == last == results.nearest("1 s")
        with pytest.raises(CaseError, match="time"):
            results.nearest("soon")
