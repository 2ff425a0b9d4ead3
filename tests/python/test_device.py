# SPDX-License-Identifier: BSD-3-Clause
"""Who makes the steps: what is said and written of it. Nothing here needs a GPU.

That a device's steps have the processor's bits is tested where there is one.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import CASE, one_sentence, write
from mpm3dpp import Simulation, _core, bench, load_case, record, run_case
from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.bench import report, worker
from mpm3dpp.cli import command
from mpm3dpp.io import read_history, read_manifest

NONE = "no device can be used: there is no GPU here"
CONTACT = "steps on a device do not know contact between bodies yet: run without one"
CARD = {
    "name": "Card 1",
    "bytes": 80 * 2**30,
    "free_bytes": 79 * 2**30,
    "bandwidth": 3e12,
    "fma_per_second": 1e13,
}

CANNOT = pytest.mark.parametrize(
    "found",
    [{"missing": RuntimeError(NONE)}, {"refusal": ValueError(CONTACT)}],
    ids=["none", "refused"],
)
"""What keeps a device from making the steps."""


def fake(
    patch: pytest.MonkeyPatch, missing: Exception | None = None, refusal: Exception | None = None
) -> list[str]:
    """Give the core a device whose steps the processor makes; return the calls that it gets.

    `missing` is what `device` raises, `refusal` what `use_device` raises.
    """
    calls: list[str] = []

    def device() -> dict[str, Any]:
        if missing is not None:
            raise missing
        return CARD

    def use_device(core: Any) -> None:
        calls.append("use_device")
        for error in (missing, refusal):
            if error is not None:
                raise error

    core = _core.Simulation
    patch.setattr(core, "device", staticmethod(device), raising=False)
    patch.setattr(core, "use_device", use_device, raising=False)
    patch.setattr(core, "device_bytes", 3 * 2**30, raising=False)
    return calls


def run(patch: pytest.MonkeyPatch, *words: Any) -> int:
    """Run the command in this process; return its exit code."""
    patch.setattr(sys, "argv", ["mpm3dpp", *map(str, words)])
    with pytest.raises(SystemExit) as end:
        command._command()
    return int(end.value.code or 0)


@CANNOT
def test_cuda_that_cannot_is_one_sentence(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    found: dict[str, Exception],
) -> None:
    fake(monkeypatch, **found)
    out = tmp_path / "results" / "out"
    assert run(monkeypatch, "run", write(tmp_path), "--out", out, "--device", "cuda") == 2
    [error] = found.values()
    assert one_sentence(capsys.readouterr().err) == f"mpm3dpp: error: {error}"
    assert not out.parent.exists()


def test_without_a_device_no_particle_is_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    fake(monkeypatch, missing=RuntimeError(NONE))
    monkeypatch.setattr("mpm3dpp.run.simulation.build", None)
    with pytest.raises(CaseError, match=NONE):
        Simulation(load_case(write(tmp_path)), device="cuda")


@CANNOT
def test_auto_falls_back_and_says_why(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    found: dict[str, Exception],
) -> None:
    fake(monkeypatch, **found)
    words = ("--out", tmp_path / "out", "--device", "auto", "--no-pictures", "--threads", 1)
    assert run(monkeypatch, "run", write(tmp_path), *words) == 0
    [error] = found.values()
    told = capsys.readouterr().err.splitlines()
    assert told.count(f"note: device auto: {error}; running on the processor") == 1
    manifest = read_manifest(tmp_path / "out")
    assert (manifest["status"], manifest["device"]) == ("completed", "cpu")


def test_the_processor_is_the_default(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    calls = fake(monkeypatch)
    manifest = run_case(write(tmp_path), tmp_path / "out", 1, quiet=False, pictures=False)
    assert manifest.device == read_manifest(tmp_path / "out")["device"] == "cpu"
    assert calls == [] and "device" not in capfd.readouterr().err


def test_a_run_says_which_device_it_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    calls = fake(monkeypatch)
    path = write(tmp_path)
    manifest = run_case(path, tmp_path / "out", 1, False, pictures=False, device="cuda")
    printed = capfd.readouterr()
    assert "note: device: Card 1, 3.00 GiB of its 80.0 GiB of memory taken\n" in printed.err
    assert "ns per particle-step on Card 1, memory" in printed.out
    assert (manifest.device, calls) == ("Card 1", ["use_device"])
    assert manifest.ns_per_particle_step == manifest.stages["steps on the device"] > 0
    run_case(path, tmp_path / "out", 1, pictures=False, device="cuda", resume=True)
    assert calls == ["use_device"] * 3  # Ready, and once more with the state.


def test_a_run_goes_on_in_the_frames_that_it_had(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A device has bodies on nodes in space that the processor would have in the body."""
    fake(monkeypatch)
    short, path = {"run.end_time": 2e-3}, write(tmp_path, CASE.replace("5 m/s", "1 m/s"))
    for first, then, frame in (("cuda", "cpu", "updated"), ("cpu", "cpu", "material")):
        out = tmp_path / f"{first}_{then}"
        run_case(load_case(path).with_(short), out, 1, pictures=False, device=first)
        manifest = run_case(path, out, 1, pictures=False, device=then, resume=True)
        assert manifest.status == "completed"
        assert {body["frame"] for body in manifest.case["body"].values()} == {frame}


def test_a_program_has_it_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    calls = fake(monkeypatch)
    simulation = Simulation(load_case(write(tmp_path)), threads=1, device="auto")
    with record(simulation, tmp_path / "out") as of:
        of.advance(3)
    assert of.manifest is not None and (of.manifest.device, calls) == ("Card 1", ["use_device"])
    with pytest.raises(CaseError, match=r'^device must be cpu, cuda or auto; did you mean "cuda"'):
        Simulation(simulation.case, device="cude")


@pytest.mark.parametrize("doing", ["advance", "column"], ids=["in a step", "when it is read"])
def test_a_device_that_fails_ends_the_run_in_a_sentence(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    doing: str,
) -> None:
    fake(monkeypatch)

    def failing(core: Any, *about: Any, **named: Any) -> Any:
        if core.step > 50:
            raise RuntimeError("the device has no more memory")
        return made_by_core(core, *about, **named)

    owner = Simulation if doing == "advance" else _core.Simulation
    made_by_core = getattr(owner, doing)
    monkeypatch.setattr(owner, doing, failing)
    words = ("run", write(tmp_path), "--out", tmp_path / "out", "--device", "cuda", "--quiet")
    assert run(monkeypatch, *words) == 1
    told = one_sentence(capsys.readouterr().err)
    assert "the device has no more memory; what was written before is in " in told


@pytest.mark.parametrize("stops", [False, True])
def test_sums_of_bodies_are_rare_with_a_device(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stops: bool
) -> None:
    """But for those that may end the run, which ends at the step at which it does without."""
    fake(monkeypatch)
    text = CASE.replace("frames = 4", "frames = 1").replace('"8 ms"', '"100 ms"')
    if stops:
        text = text.replace("cfl = 0.3", 'cfl = 0.3\nstop = { body = "left", moved = "1 km" }')
    run_case(write(tmp_path, text), tmp_path / "out", 1, pictures=False, device="cuda")
    history = read_history(tmp_path / "out")
    steps = history["step"][~np.isnan(history["body_left_mass"])]
    assert len(history["step"]) > 600
    expected = np.arange(0, history["step"][-1] + 1, 16 if stops else 512)
    np.testing.assert_array_equal(steps[: len(expected)], expected)
    assert len(steps) <= len(expected) + 1  # And the last frame.


def test_a_device_is_for_one_process(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fake(monkeypatch)
    sentence = "--device cuda makes the steps of one process: leave --ranks out"
    out = tmp_path / "out"
    words = ("run", write(tmp_path), "--out", out, "--device", "cuda", "--ranks", 2)
    assert run(monkeypatch, *words) == 2
    assert one_sentence(capsys.readouterr().err) == f"mpm3dpp: error: {sentence}"
    assert not out.exists()
    with pytest.raises(CaseError, match=sentence):
        bench.measure("elastic2d", 4, ranks=2, device="cuda")


def test_a_benchmark_without_a_device_ends_in_its_sentence(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for error in (RuntimeError(NONE), ValueError(CONTACT)):
        fake(monkeypatch, refusal=error)
        words = ["elastic2d", "4", "1", "musl", "1", "cuda"]
        with pytest.raises(type(error), match=str(error)):
            worker.main(words)

    def ask(*_: Any) -> None:
        raise RunError(NONE)

    monkeypatch.setattr("mpm3dpp.bench.Process.ask", ask)
    assert run(monkeypatch, "bench", "elastic2d", "--size", 4, "--device", "cuda") == 1
    assert one_sentence(capsys.readouterr().err) == f"mpm3dpp: error: {NONE}"


def test_a_benchmark_shows_what_a_device_does(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In this process, by a fake device that takes 1 ms a step for its only kernel."""
    fake(monkeypatch)
    core = _core.Simulation
    patch = monkeypatch.setattr
    patch(core, "device_times", lambda self: {"everything": 2e-3}, raising=False)

    class Here:
        """What the other process answers, of this one."""

        def __init__(self, part: Any, warm_up: int) -> None:
            self._simulation = bench.cases.make(bench.BENCHES[part.name], part.size)

        def __enter__(self) -> Here:
            return self

        def __exit__(self, *about: object) -> None:
            pass

        def ask(self, order: str = "") -> dict[str, Any]:
            if order.startswith("block"):
                return worker.timed_block(self._simulation, int(order.split()[1]))
            if not order:
                return {"ready": True}
            memory = dict(self._simulation.bytes())
            end = {"growth": 0, "bytes": memory, "isa": "none", **dict.fromkeys(worker.TOUCHING, 0)}
            end["particles"] = self._simulation.particle_count
            return end | worker.measure_device(self._simulation, 2)

    patch(bench, "Process", Here)
    result = bench.measure("elastic2d", 4, steps=5, device="cuda")
    assert (result["device"], result["particles"]) == ("Card 1", 64)
    assert result["device_bytes_per_particle"] == 3 * 2**30 / 64
    assert result["stages"] == {"everything": pytest.approx(2e-3 * 1e9 / 2 / 64)}
    assert result["bandwidth_GBps"] == 3000.0 and result["arithmetic_GFLOPS"] == 20000.0
    share = result["bytes_moved_per_particle_step"] / result["ns_per_particle_step"] / 3000.0
    assert 0 < result["bandwidth_fraction"] == pytest.approx(share)
    report.show(result)
    report.show_series([result, result])
    shown = capsys.readouterr().out
    assert "AFLIP, USF, updated frame; Card 1, 5 steps" in shown and "everything" in shown
    assert "of 3000.0 GB/s" in shown and "the limit is nominal" in shown
