# SPDX-License-Identifier: BSD-3-Clause
"""Runs that a program steps leave the files that `run_case` leaves."""

from __future__ import annotations

import os
import signal
import threading
from pathlib import Path

import numpy as np
import pytest

from commands import CASE, write
from mpm3dpp import Case, Simulation, load_case, open_results, record, run_case
from mpm3dpp.base.errors import CaseError, RunError
from mpm3dpp.io import read_history, read_manifest

PROBED = CASE.replace("frames = 4", "frames = 4\nhistory_every = 3") + (
    '[probe.nose]\nbody = "left"\nevery = "0.3 ms"\n'
)


def same_files(one: Path, other: Path) -> None:
    for name in ("history.csv", "probes/nose.csv"):
        assert (one / name).read_bytes() == (other / name).read_bytes(), name
    with open_results(one) as results, open_results(other) as others:
        np.testing.assert_array_equal(results.steps, others.steps)
        for k in range(len(results)):
            for name, values in results.arrays(k).items():
                np.testing.assert_array_equal(values, others.arrays(k)[name])
    found = [read_manifest(folder) for folder in (one, other)]
    for key in ("steps", "end_time", "result_hash", "energies", "bodies", "status", "contact"):
        assert found[0][key] == found[1][key], key


@pytest.mark.parametrize("steps", [1, 7, 100_000])
def test_the_files_are_those_of_a_run_however_steps_are_made(tmp_path: Path, steps: int) -> None:
    path = write(tmp_path, PROBED)
    run_case(path, tmp_path / "whole", threads=1, pictures=False)
    simulation, seen = Simulation(load_case(path), threads=1), []
    with record(simulation, tmp_path / "out") as run:
        assert run.simulation is simulation and run.manifest is None
        while run.advance(steps):
            seen.append(simulation.step)
    assert seen == list(range(steps, simulation.step, steps))
    same_files(tmp_path / "whole", tmp_path / "out")
    assert run.manifest is not None and run.manifest.status == "completed"


def test_one_that_is_left_early_goes_on(tmp_path: Path) -> None:
    path, out = write(tmp_path, PROBED), tmp_path / "out"
    run_case(path, tmp_path / "whole", threads=1, pictures=False)
    with record(Simulation(load_case(path), threads=1), out) as run:
        run.advance(11)
    manifest = read_manifest(out)
    assert (manifest["steps"], manifest["status"]) == (11, "completed")
    assert "ended by the program at t = " in manifest["reason"]
    with record(Simulation(load_case(path), threads=1), out, resume=True) as run:
        assert run.simulation.step == 11
        run.advance(4)
    run_case(path, out, threads=1, pictures=False, resume=True)
    found = [read_manifest(folder)["result_hash"] for folder in (out, tmp_path / "whole")]
    assert found[0] == found[1]
    steps = [read_history(folder)["step"] for folder in (out, tmp_path / "whole")]
    assert set(steps[0]) == {*steps[1], 11.0, 15.0}  # With rows of where it was left.


def test_an_error_of_the_program_loses_nothing(tmp_path: Path) -> None:
    out = tmp_path / "out"
    with (
        pytest.raises(ZeroDivisionError),
        record(Simulation(Case.from_text(PROBED), threads=1), out) as run,
    ):
        run.advance(20)
        run.write_frame()
        _ = 1 / 0
    manifest = read_manifest(out)
    assert (manifest["steps"], manifest["status"]) == (20, "interrupted")
    assert manifest["reason"] == "by ZeroDivisionError: division by zero"
    with open_results(out) as results:
        assert results.steps[-1] == 20
    run_case(Case.from_text(PROBED), out, threads=1, pictures=False, resume=True)
    assert read_manifest(out)["status"] == "completed"


def test_an_unstable_run_says_why(tmp_path: Path) -> None:
    text = PROBED.replace('velocity = ["5 m/s"', 'velocity = ["500 m/s"')
    case = Case.from_text(text.replace("[run]", "[run]\nenergy_growth_limit = 1e-9"))
    with (
        pytest.raises(RunError, match="frames and history up to then are in"),
        record(Simulation(case, threads=1), tmp_path / "out") as run,
    ):
        while run.advance(10):
            pass
    assert read_manifest(tmp_path / "out")["status"] == "failed"


def test_ctrl_c_is_taken_at_the_end_of_a_step(tmp_path: Path) -> None:
    out = tmp_path / "out"
    simulation = Simulation(Case.from_text(PROBED.replace('"8 ms"', '"100 s"')), threads=1)
    with (
        pytest.raises(KeyboardInterrupt),
        record(simulation, out) as run,
    ):
        threading.Timer(0.3, os.kill, (os.getpid(), signal.SIGINT)).start()
        run.advance(10_000_000)
    manifest = read_manifest(out)
    assert manifest["status"] == "interrupted" and "stopped by the user" in manifest["reason"]
    steps = read_history(out)["step"]
    assert steps[-1] == manifest["steps"]
    assert set(range(0, int(steps[-1]), 3)) <= set(steps.tolist())  # None is lost.
    run_case(
        Case.from_text(PROBED.replace('"8 ms"', f'"{simulation.time + 1e-3} s"')),
        out,
        threads=1,
        pictures=False,
        resume=True,
    )


def test_steps_that_grow_end_as_in_a_run(tmp_path: Path) -> None:
    """Without contact, where a look is 64 steps away: a body that rings, in steps of one."""
    text = PROBED.partition("[body.right]")[0].replace("5 m/s", "0.1 m/s")
    text += '[probe.nose]\nbody = "left"\nevery = "0.3 ms"\n'
    text = text.replace("0 m/s", "expression", 0).replace(
        'velocity = ["0.1 m/s", "0 m/s"]',
        'velocity = [{ expression = "100 * (X - 0.025)" }, 0.0]',
    )
    case = Case.from_text(text.replace("X", "x"))
    run_case(case, tmp_path / "whole", threads=1, pictures=False)
    with record(Simulation(case, threads=1), tmp_path / "out") as run:
        while run.advance(1):
            pass
    same_files(tmp_path / "whole", tmp_path / "out")


def test_the_history_belongs_to_the_run(tmp_path: Path) -> None:
    simulation = Simulation(Case.from_text(CASE), threads=1)
    with record(simulation, tmp_path / "out") as run:
        run.advance(3)
        with pytest.raises(CaseError, match="has no history while the run is written"):
            simulation.history()
    assert len(simulation.history()["step"]) == 0


def test_mistakes(tmp_path: Path) -> None:
    simulation = Simulation(Case.from_text(CASE))
    with (
        pytest.raises(CaseError, match="there is no checkpoint"),
        record(simulation, tmp_path / "none", resume=True),
    ):
        pass
    with (
        pytest.raises(CaseError, match=r"simulation must be a Simulation; write Simulation\(case"),
        record(Case.from_text(CASE), tmp_path / "none"),  # type: ignore[arg-type]
    ):
        pass
    simulation.advance(1)
    with (
        pytest.raises(CaseError, match=r"has made steps cannot be recorded; make a new one"),
        record(simulation, tmp_path / "out"),
    ):
        pass
    assert not (tmp_path / "out").exists()
    with (
        record(Simulation(Case.from_text(CASE)), tmp_path / "out") as run,
        pytest.raises(CaseError, match="steps = 0 must be >= 1"),
    ):
        run.advance(0)
