# SPDX-License-Identifier: BSD-3-Clause
"""What a run takes of memory: frames and checkpoints little, pictures nothing of its process."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time as clock
from pathlib import Path

import numpy as np
import pytest

from fake_core import pressure, von_mises
from mpm3dpp import Simulation, load_case
from mpm3dpp.fill.build import build
from mpm3dpp.io import frame_of
from mpm3dpp.run.memory import memory_bytes, process_bytes

MIB = 2**20
LONG = 60.0  # [s] Until a process that hangs is given up.

CASE = """\
[grid]
dimension = {dimension}
cell_size = "1 mm"
[run]
end_time = "{end}"
[output]
frames = 3
checkpoint_interval = "1 us"
[material.rubber]
density = "1000 kg/m^3"
strength = {{ neo_hookean = {{ K = "2 MPa", G = "1 MPa" }} }}
[body.left]
material = "rubber"
shape = {{ box = {{ lower = {low}, upper = {high} }} }}
[body.right]
material = "rubber"
shape = {{ box = {{ lower = {next_low}, upper = {next_high} }} }}
velocity = {velocity}
"""

PROGRAM = """\
import json, sys
import mpm3dpp
case = mpm3dpp.load_case("case.toml")
if sys.argv[1] == "step":
    simulation = mpm3dpp.Simulation(case, threads=1)
    simulation.advance(10_000)
else:
    manifest = mpm3dpp.run_case(case, "out", threads=1, pictures=sys.argv[1] == "draw")
for line in open("/proc/self/status"):
    if line.startswith("VmHWM"):
        print(json.dumps(int(line.split()[1]) * 1024))
"""


def case_file(folder: Path, edge: int, end: str, dimension: int = 3) -> Path:
    """Two blocks with so many cells along their edges, of which the right meets the left."""
    x = np.eye(dimension)[0]
    corners = {"low": 0 * x, "high": 1 + 0 * x, "next_low": x, "next_high": 1 + x}
    places = {name: (1e-3 * edge * place).tolist() for name, place in corners.items()}
    text = CASE.format(end=end, dimension=dimension, velocity=(-x).tolist(), **places)
    (folder / "case.toml").write_text(text)
    return folder / "case.toml"


def peak(folder: Path, what: str) -> int:
    """Most resident memory [bytes] of a process that steps, runs, or runs and draws."""
    words = [sys.executable, "-c", PROGRAM, what]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
    return int(json.loads(done.stdout))


@pytest.mark.parametrize(
    ("edge", "end", "dimension"),
    [(240, "0.02 ms", 2), pytest.param(20, "0.05 ms", 3, marks=pytest.mark.slow)],
)
def test_frames_and_checkpoints_take_a_fourth_of_stepping_at_most(
    tmp_path: Path, edge: int, end: str, dimension: int
) -> None:
    """And `check` says the peak within a fourth.

    Cases so large that the library for frames, some 17 MB, is a small part of that.
    """
    path = case_file(tmp_path, edge, end, dimension)
    stepping, running = peak(tmp_path, "step"), peak(tmp_path, "run")
    assert running <= 1.25 * stepping
    case = load_case(path)
    told = process_bytes(memory_bytes(case, build(case)), surfaces=True)
    assert told == pytest.approx(running, rel=0.25)


@pytest.mark.slow
def test_pictures_do_not_raise_the_peak(tmp_path: Path) -> None:
    case_file(tmp_path, 20, "0.1 ms", 2)
    running, drawing = peak(tmp_path, "run"), peak(tmp_path, "draw")
    assert (tmp_path / "out" / "frame.png").is_file()
    assert drawing <= running + 4 * MIB


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_frame_is_what_the_core_holds_rounded(tmp_path: Path, dimension: int) -> None:
    """To the bit, pressure and von Mises stress by their formulas in double precision."""
    simulation = Simulation(load_case(case_file(tmp_path, 6, "0.2 ms", dimension)), threads=1)
    simulation.advance(40)
    core = simulation.core
    names = ["right", "left"]  # In the order of their numbers, whatever they are called.
    frame = frame_of(core, ["volume", "left_cauchy_green"], names, [0, 0])
    found = {column.name: column.make() for column in frame.columns}
    assert {name: values.nbytes for name, values in found.items()} == {
        column.name: column.bytes for column in frame.columns
    }
    held = {
        name: np.concatenate([core.column(b, name) for b in range(2)])
        for name in ("position", "velocity", "stress", "volume", "left_cauchy_green")
    }
    stress = held["stress"]
    assert np.abs(stress).max() > 0.0
    for name in ("position", "velocity"):
        assert found[name].shape == (len(stress), 3)
        assert np.array_equal(found[name][:, :dimension], held[name].astype(np.float32))
        assert not found[name][:, dimension:].any()
    to_vtk = [0, 1, 2, 5, 3, 4]
    assert np.array_equal(found["stress"], stress[:, to_vtk].astype(np.float32))
    assert np.array_equal(found["pressure"], pressure(stress).astype(np.float32))
    assert np.array_equal(found["von_mises"], von_mises(stress).astype(np.float32))
    assert np.array_equal(found["volume"], held["volume"][:, 0].astype(np.float32))
    green = held["left_cauchy_green"]
    green = green[:, to_vtk] if green.shape[1] == 6 else green
    assert np.array_equal(found["left_cauchy_green"], green.astype(np.float32))


def drawing(folder: Path) -> subprocess.Popen[str]:
    """A run that has come to its pictures."""
    case_file(folder, 4, "0.1 ms")
    words = [sys.executable, "-m", "mpm3dpp", "run", "case.toml", "--out", "out", "--threads", "1"]
    process = subprocess.Popen(
        words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    assert process.stderr is not None
    for line in process.stderr:
        if line.startswith("drawing pictures"):
            return process
    raise AssertionError("it has not come to its pictures")


def children(process: subprocess.Popen[str]) -> list[int]:
    path = Path(f"/proc/{process.pid}/task/{process.pid}/children")
    end = clock.monotonic() + LONG
    while clock.monotonic() < end:
        found = [int(word) for word in path.read_text().split()]
        if found:
            return found
        clock.sleep(0.01)
    raise AssertionError("nothing draws")


def ends(pid: int) -> bool:
    """Whether a process ends."""
    end = clock.monotonic() + LONG
    while clock.monotonic() < end:
        try:
            os.kill(pid, 0)
        except ProcessLookupError:
            return True
        clock.sleep(0.01)
    return False


@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_leaves_out_the_pictures(tmp_path: Path, kind: signal.Signals) -> None:
    process = drawing(tmp_path)
    [child] = children(process)
    process.send_signal(kind)
    _, said = process.communicate(timeout=LONG)
    assert process.returncode == 0
    assert said.startswith("no pictures: `mpm3dpp plot") and said.count("\n") == 1
    assert ends(child)
    assert not [path for path in (tmp_path / "out").iterdir() if ".png" in path.name]


def test_a_death_while_drawing_is_a_sentence(tmp_path: Path) -> None:
    process = drawing(tmp_path)
    os.kill(children(process)[0], signal.SIGKILL)
    _, said = process.communicate(timeout=LONG)
    assert process.returncode == 0
    assert said == "no picture: the process that drew them was ended by SIGKILL\n"


def test_what_draws_ends_with_the_run(tmp_path: Path) -> None:
    process = drawing(tmp_path)
    [child] = children(process)
    process.kill()
    process.communicate(timeout=LONG)
    assert ends(child)
