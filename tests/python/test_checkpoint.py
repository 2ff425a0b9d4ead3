# SPDX-License-Identifier: BSD-3-Clause
"""Runs that stop and go on, through the command line and from Python."""

from __future__ import annotations

import errno
import io
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from commands import CASE, command, interrupted, mpm3dpp, one_sentence, write
from mpm3dpp import Case, Simulation, load_case, open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import read_history, read_manifest
from mpm3dpp.run.report import speed_line
from mpm3dpp.run.resume import refuse_to_begin_anew

OFTEN = CASE.replace("frames = 4", 'interval = "20 ms"\ncheckpoint_interval = "50 ms"')
LONG = OFTEN.replace('"8 ms"', '"1000 s"')


def stopped(folder: Path, kind: signal.Signals) -> None:
    """Start the long run in `folder`/out, and stop it when it has gone on from a checkpoint."""
    words = command("run", write(folder, LONG), "--out", folder / "out", "--threads", 1, "--quiet")
    run = subprocess.Popen(words, cwd=folder, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 30
    checkpoint, history = folder / "out" / "checkpoint.zip", folder / "out" / "history.csv"
    try:
        while not (checkpoint.exists() and history.stat().st_size > 300_000):
            assert run.poll() is None and time.monotonic() < deadline
            time.sleep(0.02)
        run.send_signal(kind)
        run.communicate(timeout=30)
    finally:
        run.kill()


def end_after(folder: Path) -> str:
    """Return the case with an end 50 ms after the checkpoint in `folder`/out."""
    case = load_case(write(folder, LONG))
    simulation = Simulation(case, threads=1)
    simulation.restore(folder / "out" / "checkpoint.zip")
    return LONG.replace('"1000 s"', repr(simulation.time + 0.05))


@pytest.mark.parametrize(
    "kind", [signal.SIGKILL, pytest.param(signal.SIGINT, marks=pytest.mark.slow)]
)
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
    check_files(tmp_path / "out", tmp_path / "whole")


def check_files(folder: Path, whole: Path) -> None:
    """Check that the files of a run in pieces are those of a run in one piece."""
    for name in ("history.csv", "contact_pairs.csv"):
        if (whole / name).exists():
            assert (folder / name).read_bytes() == (whole / name).read_bytes(), name
    with open_results(folder) as results, open_results(whole) as straight:
        assert len(results) == len(straight) > 3
        assert (results.title, results.case_hash) == (straight.title, straight.case_hash)
        assert np.array_equal(results.times, straight.times)
        for frame in range(len(straight)):
            arrays, expected = results.arrays(frame), straight.arrays(frame)
            assert list(arrays) == list(expected)
            for name, values in expected.items():
                assert np.array_equal(arrays[name], values), (frame, name)


GRAINS = """
[grains.few]
material = "soft"
lattice = { lower = ["0 mm", "70 mm"], count = [3, 2], radius = "12 mm" }
"""
BLOCKS = "".join(
    f"""
[body.b{k}]
material = "soft"
shape = {{ box = {{ lower = ["{30 * k} mm", "-60 mm"], upper = ["{30 * k + 20} mm", "-40 mm"] }} }}
velocity = ["{3 - k} m/s", "20 m/s"]
"""
    for k in range(12)
)
TORN = CASE.replace("[output]", '[output]\nfields = ["volume"]').replace(
    "nu = 0.3 } }",
    'nu = 0.3 } }\nfailure = { principal_stress = { limit = "5 kPa", action = "erode" } }',
)


@pytest.mark.parametrize(
    "text",
    [
        CASE.replace("[output]", "[output]\ncompression = 3\nhistory_every = 7"),
        CASE + GRAINS,
        CASE + BLOCKS,  # More pairs than have columns of their own.
        TORN,
    ],
    ids=["compressed", "grains", "pairs", "torn"],
)
def test_kinds_of_files(text: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    case = load_case(write(tmp_path, text))
    whole = run_case(case, tmp_path / "whole", threads=1, pictures=False)
    for looks in (1, 2):
        out = tmp_path / f"out{looks}"
        interrupted(case, out, looks, monkeypatch)
        again = run_case(case, out, threads=1, pictures=False, resume=True)
        assert again.result_hash == whole.result_hash
        check_files(out, tmp_path / "whole")
    if text is TORN:
        assert whole.eroded["count"] > 0


def test_a_run_that_met_a_full_disk_goes_on_from_its_last_checkpoint(tmp_path: Path) -> None:
    """A limit on the size of files stands for the full disk."""
    limit = (2_000_000, 2_000_000)
    done = subprocess.run(
        command("run", write(tmp_path, LONG), "--out", "out", "--threads", 1, "--quiet"),
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, limit),
    )
    assert done.returncode == 1
    assert "what was written before is in out, and --resume goes on" in one_sentence(done.stderr)
    case = load_case(write(tmp_path, end_after(tmp_path)))
    again = run_case(case, tmp_path / "out", threads=1, pictures=False, resume=True)
    whole = run_case(case, tmp_path / "whole", threads=1, pictures=False)
    assert 0 < again.resumed_step < again.steps and again.result_hash == whole.result_hash
    check_files(tmp_path / "out", tmp_path / "whole")


def test_the_time_before_counts(tmp_path: Path) -> None:
    stopped(tmp_path, signal.SIGINT)
    before = read_manifest(tmp_path / "out")
    case = load_case(write(tmp_path, end_after(tmp_path)))
    after = run_case(case, tmp_path / "out", threads=1, pictures=False, resume=True)
    assert after.wall_time > 0.9 * before["wall_time"]
    assert (before["resumed_step"], after.resumed_step) == (0, before["steps"])
    went_on = f"in all parts of the run (from step {before['steps']:,} on 1 thread), "
    assert f" ns per particle-step {went_on}" in speed_line(after)
    work = after.particles * after.steps * after.ns_per_particle_step / 1e9
    assert 0.0 < work < after.wall_time  # Both are of all steps.
    for name, seconds in before["stages"].items():  # per step
        assert after.stages[name] * after.steps >= 0.9 * seconds * before["steps"], name


def test_an_unfinished_run_is_not_lost_by_running_it_again(tmp_path: Path) -> None:
    stopped(tmp_path, signal.SIGINT)
    case, out = tmp_path / "case.toml", tmp_path / "out"
    before = (out / "history.csv").read_bytes()
    refused = mpm3dpp("run", case, "--out", "out", cwd=tmp_path)
    assert refused.returncode == 2
    sentence = one_sentence(refused.stderr)
    assert "holds an unfinished run, at 0% of its time; go on with --resume, begin" in sentence
    assert "begin the run anew with --anew, or choose another --out" in sentence
    assert (out / "history.csv").read_bytes() == before
    both = mpm3dpp("run", case, "--out", "out", "--resume", "--anew", cwd=tmp_path)
    assert both.returncode == 2 and "give one of them" in one_sentence(both.stderr)
    other = LONG.replace('"1000 s"', '"2 ms"').replace("1 MPa", "2 MPa")  # hours may be lost too
    words = ("run", write(tmp_path, other), "--out", "out", "--quiet")
    assert mpm3dpp(*words, cwd=tmp_path).returncode == 2
    whole = (out / "checkpoint.zip").read_bytes()
    (out / "checkpoint.zip").write_bytes(whole[:2000])
    (out / "checkpoint_previous.zip").unlink(missing_ok=True)
    broken = mpm3dpp(*words, cwd=tmp_path)
    assert broken.returncode == 2 and "or damaged; begin the run anew" in one_sentence(
        broken.stderr
    )
    assert mpm3dpp(*words, "--anew", cwd=tmp_path).returncode == 0
    assert read_manifest(out)["end_time"] == 2e-3
    assert mpm3dpp(*words, cwd=tmp_path).returncode == 0  # That one has come to its end.


def test_a_run_of_another_case_is_not_lost(tmp_path: Path) -> None:
    words = ("--out", "out", "--threads", 1, "--quiet", "--no-pictures")

    def run(name: str, text: str, *more: str) -> subprocess.CompletedProcess[str]:
        (tmp_path / name).write_text(text)
        return mpm3dpp("run", name, *words, *more, cwd=tmp_path)

    softer = CASE.replace("1 MPa", "0.5 MPa")
    assert run("one.toml", CASE).returncode == 0
    assert not list((tmp_path / "out").glob("*.png"))
    assert run("one.toml", softer).returncode == 0  # The same file, edited.
    assert run("two.toml", softer).returncode == 0  # Another file, the same case.
    before = read_manifest(tmp_path / "out")
    assert before["case_file"] == str(tmp_path / "two.toml")
    refused = run("one.toml", CASE)
    assert refused.returncode == 2
    other = f"'out' holds the run of another case, \"Two blocks\" of {tmp_path / 'two.toml'}; "
    remedy = "choose another --out, or begin the run anew with --anew"
    assert other + remedy in one_sentence(refused.stderr)
    assert read_manifest(tmp_path / "out") == before
    assert run("one.toml", CASE, "--anew").returncode == 0
    made_in_python = Case(**load_case(tmp_path / "one.toml").table())
    run_case(made_in_python, tmp_path / "out", pictures=False)
    assert f"{other.split(' of /')[0]}; {remedy}" in one_sentence(run("two.toml", softer).stderr)
    (tmp_path / "out" / "manifest.json").write_text('["not ours"]')
    assert run("two.toml", softer).returncode == 0


def test_results_of_before_manifests_told_the_file_may_be_replaced(tmp_path: Path) -> None:
    run_case(load_case(write(tmp_path)), tmp_path / "out", threads=1, pictures=False)
    manifest = tmp_path / "out" / "manifest.json"
    whole = read_manifest(manifest)
    (tmp_path / "other").mkdir()
    edited = load_case(write(tmp_path / "other", CASE.replace("1 MPa", "0.5 MPa")))
    with pytest.raises(CaseError, match='another case, "Two blocks" of /'):
        refuse_to_begin_anew(tmp_path / "out", edited)
    manifest.write_text(json.dumps(whole | {"case": None}))
    with pytest.raises(CaseError, match="another case, /"):
        refuse_to_begin_anew(tmp_path / "out", edited)
    del whole["case_file"]
    manifest.write_text(json.dumps(whole))
    refuse_to_begin_anew(tmp_path / "out", edited)


def test_two_runs_in_one_folder(tmp_path: Path) -> None:
    words = command("run", write(tmp_path, LONG), "--out", "out", "--threads", 1, "--quiet")
    run = subprocess.Popen(words, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    try:
        history = tmp_path / "out" / "history.csv"
        deadline = time.monotonic() + 30
        while not history.exists():
            assert run.poll() is None and time.monotonic() < deadline
            time.sleep(0.02)
        again = mpm3dpp("run", tmp_path / "case.toml", "--out", "out", "--anew", cwd=tmp_path)
        assert again.returncode == 2
        assert "a run is going on in 'out'; wait for its end" in one_sentence(again.stderr)
    finally:
        run.kill()
        run.communicate()


def finished(folder: Path, text: str = CASE) -> Path:
    """Run a case to its end; return the checkpoint it leaves."""
    run_case(load_case(write(folder, text)), folder / "out", threads=1, pictures=False)
    return folder / "out" / "checkpoint.zip"


def test_a_run_whose_particles_have_all_left_goes_on(tmp_path: Path) -> None:
    """Its next step is infinite."""
    kept = 'outflow_box = { lower = ["-20 mm", "-20 mm"], upper = ["120 mm", "80 mm"] }'
    text = CASE.replace("[run]", kept + "\n[run]").replace("-5 m/s", "5 m/s")
    text = text.replace("8 ms", "40 ms")
    path = finished(tmp_path, text)
    with open_results(tmp_path / "out") as results:
        assert (results.arrays(-1)["failed"] == 4).all()
    later = load_case(write(tmp_path, text.replace("40 ms", "50 ms")))
    assert run_case(later, path.parent, threads=1, pictures=False, resume=True).end_time == 50e-3


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
        (("[body.right]", "[body.other]"), "body.right is missing, and was there in the run"),
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
    assert "there is no checkpoint" in said and said.endswith("has none: leave out --resume")
    nowhere = mpm3dpp("run", tmp_path / "case.toml", "--out", "nowhere", "--resume", cwd=tmp_path)
    assert nowhere.returncode == 2 and "there is no checkpoint" in one_sentence(nowhere.stderr)
    assert not (tmp_path / "nowhere").exists()


def test_damaged_checkpoints(tmp_path: Path) -> None:
    checkpoint = finished(tmp_path)
    whole = checkpoint.read_bytes()
    with zipfile.ZipFile(checkpoint) as archive:
        about, state = archive.read("about.json"), archive.read("state")
    for share in (0.1, 0.5, 0.9):  # Wherever it is, it is found before the core uses it.
        at = whole.index(state) + int(share * len(state))
        checkpoint.write_bytes(whole[:at] + bytes([whole[at] ^ 64]) + whole[at + 1 :])
        assert "is damaged; begin the run anew with --anew" in resumed(tmp_path, CASE)
    checkpoint.write_bytes(whole[:5000])
    assert "is not a checkpoint of mpm3dpp, or damaged" in resumed(tmp_path, CASE)
    for changed, sentence in (
        (state[:-1], "it ends too early"),
        (state + b"x", "it is too long"),
        (b"\x63" + state[1:], "it was made by another version of mpm3dpp"),  # the format
    ):
        with zipfile.ZipFile(checkpoint, "w") as archive:
            archive.writestr("about.json", about)
            archive.writestr("state", changed)
        assert f"cannot be used: {sentence}" in resumed(tmp_path, CASE)


def flipped(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 64]) + data[at + 1 :]


@pytest.mark.parametrize(
    ("name", "change", "sentence"),
    [
        ("history.csv", lambda data: data[:-10], "history.csv' has lost rows since the checkpoint"),
        ("history.csv", lambda data: flipped(data, 8), "history.csv' is damaged: its rows are not"),
        ("history.csv", lambda data: flipped(data, 9000), "history.csv' is damaged: its rows are"),
        ("results.frames/000002.h5", lambda data: data[:1000], "frame 2 is damaged: "),
        ("results.frames/000002.h5", lambda data: flipped(data, 5000), "frame 2 is damaged: "),
        ("results.frames/000000.h5", None, "frame 0 is missing: there is no file "),
    ],
)
def test_files_that_have_changed(
    tmp_path: Path, name: str, change: Callable[[bytes], bytes] | None, sentence: str
) -> None:
    """It is told before anything is touched."""
    finished(tmp_path)
    file = tmp_path / "out" / name
    if change:
        file.write_bytes(change(file.read_bytes()))
    else:
        file.unlink()

    def files() -> dict[Path, bytes]:
        return {p: p.read_bytes() for p in (tmp_path / "out").rglob("*") if p.is_file()}

    before = files()
    said = resumed(tmp_path, CASE.replace('"8 ms"', '"9 ms"'))
    assert sentence in said
    assert "; bring it back, remove '" in said and "to go on with new files, or begin the" in said
    assert files() == before


def test_files_that_are_gone(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """New ones begin where the run goes on."""
    finished(tmp_path)
    out = tmp_path / "out"
    shutil.rmtree(out / "results.frames")
    (out / "results.vtkhdf").unlink()
    (out / "history.csv").unlink()
    later = load_case(write(tmp_path, CASE.replace('"8 ms"', '"9 ms"')))
    done = run_case(later, out, threads=1, quiet=False, pictures=False, resume=True)
    said = capfd.readouterr().err
    for name in ("results.vtkhdf", "history.csv"):
        assert f"note: '{out / name}' was gone: a new one begins at t = 0.008 s" in said
    with open_results(out) as results:
        assert results.times[0] == 8e-3 and results.times[-1] == pytest.approx(9e-3)
        assert "body" in results.arrays(-1)
        size = results.arrays(-1)["size"]  # That of the start, though bodies are pressed by now.
    assert read_history(out)["time"][-1] == 9e-3
    whole = run_case(later, tmp_path / "whole", threads=1, pictures=False)
    with open_results(tmp_path / "whole") as results:
        np.testing.assert_array_equal(size, results.arrays(0)["size"])
    assert done.energies["initial"] == whole.energies["initial"]
    # What tells where frames are can be made again from them.
    (out / "results.vtkhdf").unlink()
    run_case(later, out, threads=1, pictures=False, resume=True)
    with open_results(out) as results:
        assert results.times[0] == 8e-3


def test_the_checkpoint_before_the_last(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    """It is kept until the next is whole, and taken where the last is damaged."""
    case = load_case(write(tmp_path))
    whole = run_case(case, tmp_path / "whole", threads=1, pictures=False)
    out = tmp_path / "out"
    monkeypatch.setattr("mpm3dpp.run.checkpoints.Checkpoints.due", True)
    interrupted(case, out, 3, monkeypatch)
    steps = []
    for name in ("checkpoint.zip", "checkpoint_previous.zip"):
        simulation = Simulation(case, threads=1)
        simulation.restore(out / name)
        steps.append(simulation.step)
    assert 0 < steps[1] < steps[0]
    last = out / "checkpoint.zip"
    last.write_bytes(flipped(last.read_bytes(), 20_000))
    again = run_case(case, out, threads=1, quiet=False, pictures=False, resume=True)
    said = capfd.readouterr().err
    assert f"note: the checkpoint '{last}' is damaged: the run goes on from the one before" in said
    assert again.resumed_step == steps[1] and again.result_hash == whole.result_hash
    check_files(out, tmp_path / "whole")
    last.write_bytes(b"")
    (out / "checkpoint_previous.zip").write_bytes(b"")
    assert f"'{last}' is not a checkpoint of mpm3dpp, or damaged" in resumed(tmp_path, CASE)


def test_going_on_is_recommended_only_where_it_is_possible(tmp_path: Path) -> None:
    stopped(tmp_path, signal.SIGINT)
    other = load_case(write(tmp_path, LONG.replace('"5 m/s"', '"6 m/s"')))
    with pytest.raises(CaseError) as error:
        refuse_to_begin_anew(tmp_path / "out", other)
    assert "--resume cannot go on with it (" in str(error.value)
    assert "was [5.0, 0.0] in the run of" in str(error.value)
    assert str(error.value).endswith("begin the run anew with --anew)")


def test_an_end_that_has_passed(tmp_path: Path) -> None:
    finished(tmp_path)
    said = resumed(tmp_path, CASE.replace('"8 ms"', '"4 ms"'))
    assert "run.end_time = 0.004 is before the 0.008 s that the run of" in said


def test_another_program_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    case = load_case(write(tmp_path))
    monkeypatch.setattr("mpm3dpp.__version__", "0.0.1")
    interrupted(case, tmp_path / "out", 1, monkeypatch)
    monkeypatch.undo()
    run_case(case, tmp_path / "out", threads=1, quiet=False, pictures=False, resume=True)
    said = "the run began with version 0.0.1: it will not end with the same bits"
    assert said in capfd.readouterr().err


def test_a_checkpoint_that_cannot_be_written_does_not_end_the_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def full(handle: int) -> None:
        name = os.readlink(f"/proc/self/fd/{handle}")
        if name.endswith(".checkpoint.zip.new"):
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    out = tmp_path / "out"
    case = load_case(write(tmp_path))
    with monkeypatch.context() as patch:
        patch.setattr("mpm3dpp.base.disk.os.fsync", full)
        done = run_case(case, out, threads=1, quiet=False, pictures=False)
    assert done.status == "completed" and read_manifest(out)["status"] == "completed"
    assert "warning: no checkpoint: cannot write" in capfd.readouterr().err
    assert not list(out.glob("*checkpoint*")) and not list(out.glob(".checkpoint*"))


def test_control_c_leaves_out_the_pictures_of_a_finished_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("mpm3dpp.run.run.draw_apart", stop)
    done = run_case(load_case(write(tmp_path)), tmp_path / "out", threads=1, quiet=False)
    assert done.status == "completed"
    assert "no pictures: `mpm3dpp plot" in capfd.readouterr().err


def test_no_old_checkpoint_stays_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One that goes on without checkpoints brings that which is there to its own end."""
    case = load_case(write(tmp_path))
    interrupted(case, tmp_path / "out", 1, monkeypatch)
    case.output.checkpoint_interval = 0.0
    run_case(case, tmp_path / "out", threads=1, pictures=False, resume=True)
    simulation = Simulation(case, threads=1)
    simulation.restore(tmp_path / "out" / "checkpoint.zip")
    assert simulation.time == 8e-3


def test_restoring_by_hand(tmp_path: Path) -> None:
    # MUSL, as its stages are fused where bodies may meet too.
    text = CASE.replace("[run]", '[run]\nscheme = "musl"')
    case, state = load_case(write(tmp_path, text)), tmp_path / "state.zip"
    simulation = Simulation(case, threads=1)
    simulation.save(state)
    with pytest.raises(CaseError, match=r"E = 2000000.0 was 1000000.0 in the run"):
        other = load_case(write(tmp_path, text.replace("1 MPa", "2 MPa")))
        Simulation(other, threads=1).restore(state)
    with pytest.raises(CaseError, match="made with other stages"):
        Simulation(case, threads=1, fused=False).restore(state)
    with pytest.raises(CaseError, match="there is no checkpoint"):
        Simulation(case, threads=1).restore(tmp_path / "nowhere.zip")
    with zipfile.ZipFile(state, "w") as archive:
        archive.writestr("about.json", "{}")
    with pytest.raises(CaseError, match="give a state that was saved with this case"):
        Simulation(case, threads=1).restore(state)
    simulation.advance(1)
    with pytest.raises(CaseError, match="a simulation that has made steps cannot be restored"):
        simulation.restore(state)


def test_half_a_state_does_not_step(tmp_path: Path) -> None:
    case = load_case(write(tmp_path))
    simulation = Simulation(case, threads=1)
    parts: list[bytes] = []
    simulation.core.save(lambda view: parts.append(bytes(view)) or len(view))
    half = io.BytesIO(b"".join(parts)[: sum(map(len, parts)) // 2])
    with pytest.raises(ValueError, match="it ends too early"):
        simulation.core.restore(half.readinto, len(half.getvalue()))
    velocities = np.zeros((simulation.core.body_particle_count(0), case.grid.dimension))
    for call in (
        lambda: simulation.core.advance(1, 1.0),
        lambda: simulation.core.set_velocity(0, velocities),
        lambda: simulation.core.save(len),
        lambda: simulation.core.restore(half.readinto, 1),
        simulation.core.prepare,
    ):
        with pytest.raises(ValueError, match="make a new one"):
            call()


SAVE = """
import sys
from mpm3dpp import Simulation, load_case
from mpm3dpp.base.errors import CaseError
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
