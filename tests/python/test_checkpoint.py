# SPDX-License-Identifier: BSD-3-Clause
"""Runs that stop and go on, through the command line and from Python."""

from __future__ import annotations

import resource
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import h5py
import numpy as np
import pytest

from commands import CASE, command, mpm3dpp, one_sentence, write
from mpm3dpp import Simulation, load_case, open_results, run_case
from mpm3dpp.errors import CaseError
from mpm3dpp.io import read_manifest

OFTEN = CASE.replace("frames = 4", 'interval = "20 ms"\ncheckpoint_interval = "50 ms"')
LONG = OFTEN.replace('"8 ms"', '"1000 s"')


def stopped(folder: Path, kind: signal.Signals) -> None:
    """Start the long run in `folder`/out, and stop it when it has gone on from a checkpoint."""
    words = command("run", write(folder, LONG), "--out", folder / "out", "--threads", 1, "--quiet")
    run = subprocess.Popen(words, cwd=folder, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 30
    checkpoint, history = folder / "out" / "checkpoint.zip", folder / "out" / "history.csv"
    while not (checkpoint.exists() and history.stat().st_size > 1_000_000):
        assert run.poll() is None and time.monotonic() < deadline, run.communicate()
        time.sleep(0.02)
    run.send_signal(kind)
    run.communicate(timeout=30)


def end_after(folder: Path) -> str:
    """Return the case with an end 50 ms after the checkpoint in `folder`/out."""
    case = load_case(write(folder, LONG))
    simulation = Simulation(case, threads=1)
    simulation.restore(folder / "out" / "checkpoint.zip")
    return LONG.replace('"1000 s"', repr(simulation.time + 0.05))


@pytest.mark.parametrize("kind", [signal.SIGKILL, signal.SIGINT])
def test_a_run_that_goes_on_ends_as_one_that_did_not_stop(
    tmp_path: Path, kind: signal.Signals
) -> None:
    stopped(tmp_path, kind)
    case = write(tmp_path, end_after(tmp_path))
    done = mpm3dpp("run", case, "--out", "out", "--threads", 2, "--resume", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "note: going on from step" in done.stderr
    whole = run_case(load_case(case), tmp_path / "whole", threads=1, pictures=False)
    manifest = read_manifest(tmp_path / "out")
    for key in ("steps", "end_time", "result_hash", "energies", "mass", "status"):
        assert manifest[key] == whole.to_dict()[key], key
    one, other = tmp_path / "out", tmp_path / "whole"
    assert (one / "history.csv").read_bytes() == (other / "history.csv").read_bytes()
    with open_results(one) as results, open_results(other) as straight:
        assert len(results) == len(straight) > 3
        for frame in range(len(straight)):
            arrays, expected = results.arrays(frame), straight.arrays(frame)
            assert list(arrays) == list(expected)
            for name, values in expected.items():
                assert np.array_equal(arrays[name], values), (frame, name)


def test_the_time_before_counts(tmp_path: Path) -> None:
    stopped(tmp_path, signal.SIGINT)
    before = read_manifest(tmp_path / "out")
    case = load_case(write(tmp_path, end_after(tmp_path)))
    after = run_case(case, tmp_path / "out", threads=1, pictures=False, resume=True)
    assert after.wall_time > 0.9 * before["wall_time"]
    for name, seconds in before["stages"].items():  # per step
        assert after.stages[name] * after.steps >= 0.9 * seconds * before["steps"], name


def test_an_unfinished_run_is_not_lost_by_running_it_again(tmp_path: Path) -> None:
    stopped(tmp_path, signal.SIGINT)
    case, out = tmp_path / "case.toml", tmp_path / "out"
    before = (out / "history.csv").read_bytes()
    refused = mpm3dpp("run", case, "--out", "out", cwd=tmp_path)
    assert refused.returncode == 2
    sentence = one_sentence(refused.stderr)
    assert "stopped at 0% of its time" in sentence
    assert "go on with --resume, or begin the run anew with --anew" in sentence
    assert (out / "history.csv").read_bytes() == before
    both = mpm3dpp("run", case, "--out", "out", "--resume", "--anew", cwd=tmp_path)
    assert both.returncode == 2 and "give one of them" in one_sentence(both.stderr)
    short = LONG.replace('"1000 s"', '"2 ms"')  # It has come further than that.
    done = mpm3dpp("run", write(tmp_path, short), "--out", "out", "--quiet", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert read_manifest(out)["end_time"] == 2e-3


def test_a_run_begins_anew(tmp_path: Path) -> None:
    stopped(tmp_path, signal.SIGINT)
    other = LONG.replace('"1000 s"', '"3 ms"').replace("1 MPa", "2 MPa")  # not that of the folder
    done = mpm3dpp("run", write(tmp_path, other), "--out", "out", "--quiet", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    again = LONG.replace('"1000 s"', '"4 ms"').replace("1 MPa", "2 MPa")
    words = ("run", write(tmp_path, again), "--out", "out", "--quiet")
    assert mpm3dpp(*words, cwd=tmp_path).returncode == 2
    assert mpm3dpp(*words, "--anew", cwd=tmp_path).returncode == 0
    assert read_manifest(tmp_path / "out")["end_time"] == 4e-3


def finished(folder: Path, text: str = CASE) -> Path:
    """Run a case to its end; return the checkpoint it leaves."""
    run_case(load_case(write(folder, text)), folder / "out", threads=1, pictures=False)
    return folder / "out" / "checkpoint.zip"


def resumed(folder: Path, text: str) -> str:
    """Try to go on with a case; return what is said against it."""
    with pytest.raises(CaseError) as error:
        run_case(load_case(write(folder, text)), folder / "out", threads=1, resume=True)
    return str(error.value)


def test_a_finished_run_may_get_a_later_end(tmp_path: Path) -> None:
    finished(tmp_path)
    later = load_case(write(tmp_path, CASE.replace('"8 ms"', '"9 ms"')))
    manifest = run_case(later, tmp_path / "out", threads=1, pictures=False, resume=True)
    assert manifest.end_time == 9e-3
    with open_results(tmp_path / "out") as results:
        assert results.times[-1] == pytest.approx(9e-3)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (("1 MPa", "2 MPa"), "material.soft.strength.elastic.E = 2000000.0 was 1000000.0 in the"),
        (("[body.right]", "[body.other]"), "body.right = null was {"),
        (('"5 m/s"', '"6 m/s"'), "body.left.velocity = [6.0, 0.0] was [5.0, 0.0] in the run of"),
        (("frames = 4", 'fields = ["mass"]'), 'output.fields = ["mass"] was []'),
    ],
)
def test_another_case_is_refused(tmp_path: Path, change: tuple[str, str], sentence: str) -> None:
    finished(tmp_path)
    said = resumed(tmp_path, CASE.replace(*change))
    assert sentence in said
    assert said.endswith("give the case as it was, or begin the run anew with --anew")


def test_what_may_change(tmp_path: Path) -> None:
    finished(tmp_path)
    text = CASE.replace("Two blocks", "Others").replace("frames = 4", "frames = 8")
    text = text.replace("[output]", "energy_growth_limit = 2.0\n[output]\nhistory_every = 2")
    case = load_case(write(tmp_path, text.replace('"8 ms"', '"9 ms"')))
    run_case(case, tmp_path / "out", threads=1, pictures=False, resume=True)


def test_no_checkpoint(tmp_path: Path) -> None:
    assert not finished(
        tmp_path, CASE.replace("[output]", "[output]\ncheckpoint_interval = 0")
    ).exists()
    said = resumed(tmp_path, CASE)
    assert "there is no checkpoint" in said and said.endswith("run the case without --resume")


def test_damaged_checkpoints(tmp_path: Path) -> None:
    checkpoint = finished(tmp_path)
    whole = checkpoint.read_bytes()
    with zipfile.ZipFile(checkpoint) as archive:
        about, state = archive.read("about.json"), archive.read("state")
    at = whole.index(state) + len(state) // 2
    checkpoint.write_bytes(whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
    assert "is damaged; begin the run anew with --anew" in resumed(tmp_path, CASE)
    checkpoint.write_bytes(whole[:5000])
    assert "is not a checkpoint of mpm3dpp" in resumed(tmp_path, CASE)
    for changed, sentence in (
        (state[:-1], "it ends too early"),
        (state + b"x", "it is too long"),
        (b"\x63" + state[1:], "it was made by another version of mpm3dpp"),  # the format
    ):
        with zipfile.ZipFile(checkpoint, "w") as archive:
            archive.writestr("about.json", about)
            archive.writestr("state", changed)
        assert f"cannot be used: {sentence}" in resumed(tmp_path, CASE)


@pytest.mark.parametrize(
    ("name", "sentence"),
    [("history.csv", "has lost rows since"), ("results.vtkhdf", "has lost frames since")],
)
def test_files_that_have_changed(tmp_path: Path, name: str, sentence: str) -> None:
    finished(tmp_path)
    file = tmp_path / "out" / name
    if name == "history.csv":
        file.write_text(file.read_text()[:-10])
    else:
        with h5py.File(file, "r+") as results:
            results["VTKHDF/Points"].resize(100, axis=0)
    assert sentence in resumed_late(tmp_path)
    file.unlink()
    assert sentence in resumed_late(tmp_path)


def resumed_late(folder: Path) -> str:
    """As `resumed`, for what is found when the run goes on."""
    case = write(folder, CASE.replace('"8 ms"', '"9 ms"'))
    done = mpm3dpp("run", case, "--out", "out", "--quiet", "--resume", cwd=folder)
    assert done.returncode in (1, 2)
    return one_sentence(done.stderr)


SAVE = """
import sys
from mpm3dpp import Simulation, load_case
from mpm3dpp.errors import CaseError
simulation = Simulation(load_case("case.toml"), threads=1)
simulation.advance(int(sys.argv[1]))
try:
    simulation.save("state.zip")
except CaseError as error:
    sys.exit(f"mpm3dpp: error: {error}")
"""


@pytest.mark.parametrize("room", [0, 1_000, 20_000])
def test_a_full_disk_leaves_the_last_checkpoint(tmp_path: Path, room: int) -> None:
    """A limit on the size of files stands for the full disk."""
    case = load_case(write(tmp_path))
    simulation = Simulation(case, threads=1)
    simulation.save(tmp_path / "state.zip")
    done = subprocess.run(
        [sys.executable, "-c", SAVE, "3"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (room, room)),
    )
    sentence = one_sentence(done.stderr)
    assert done.returncode == 1
    assert "cannot write 'state.zip': file too large" in sentence
    assert sorted(p.name for p in tmp_path.iterdir()) == ["case.toml", "state.zip"]
    simulation.restore(tmp_path / "state.zip")
    assert simulation.step == 0
