# SPDX-License-Identifier: BSD-3-Clause
"""A run that begins at rest: bodies settle under their loads until forces balance."""

from __future__ import annotations

import re
import signal
import subprocess
import time
from pathlib import Path

import numpy as np
import pytest

from cases import BASES, SCHEMES
from commands import command
from mpm3dpp import Case, CaseError, Simulation, open_results, run_case
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import echo

HEIGHT, GRAVITY, DENSITY = 0.2, 10.0, 1000.0

COLUMN = """
[grid]
dimension = {dimension}
cell_size = "5 mm"
basis = "{basis}"
box = {{ lower = {low}, upper = {high}, walls = "slip" }}
[run]
scheme = "{scheme}"
end_time = "20 ms"
gravity = {gravity}
{settle}
{run}
[material.soil]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[body.column]
material = "soil"
shape = {{ box = {{ lower = {low}, upper = {top} }} }}
{more}
"""
SETTLE = 'settle = { longest = "1 s" }'


def case(dimension: int = 2, **given: str) -> Case:
    """Return a column between slip walls that stands on one."""
    wide = [0.02] * dimension
    keys = {"basis": "gimp", "scheme": "musl", "settle": SETTLE, "run": "", "more": ""} | given
    gravity, high, top = [0.0] * dimension, [*wide], [*wide]
    gravity[1], high[1], top[1] = -GRAVITY, 1.0, HEIGHT
    lists = {"low": [0] * dimension, "gravity": gravity, "high": high, "top": top}
    return Case.from_text(COLUMN.format(dimension=dimension, **lists, **keys))


def settle(sim: Simulation) -> dict[str, np.ndarray]:
    """Step to the time 0; return the history, which closes."""
    assert sim.time == -1.0
    parts = []
    while sim.time < 0.0:
        sim.advance(1000, end_time=0.0)
        parts.append(sim.core.history())
    rows = dict(zip(sim.core.history_columns, np.concatenate(parts).T, strict=True))
    assert np.abs(rows["residual"]).max() <= 1e-12 * np.abs(rows["external"]).max()
    return rows


@pytest.mark.parametrize(
    ("dimension", "scheme", "basis"),
    [
        *((2, scheme, basis) for scheme in SCHEMES for basis in BASES),
        pytest.param(3, "musl", "gimp", marks=pytest.mark.slow),
    ],
)
def test_a_column_begins_at_rest(scheme: str, basis: str, dimension: int) -> None:
    """sigma_yy = -rho g (H - y) within 1 % of the largest, and nothing moves from there on."""
    sim = Simulation(case(dimension, scheme=scheme, basis=basis), threads=1)
    rows = settle(sim)
    assert sim.time == rows["time"][-1] == 0.0 and rows["kinetic"][-1] == 0.0
    assert rows["unbalanced"][-1] <= 1e-3 < rows["unbalanced"][1:-1].min()
    assert not sim.core.warnings()
    y, stress = sim.column("column", "position")[:, 1], sim.column("column", "stress")[:, 1]
    weight = DENSITY * GRAVITY * HEIGHT
    assert np.abs(stress + DENSITY * GRAVITY * (HEIGHT - y)).max() <= 0.01 * weight
    # What is out of balance, a thousandth of the weight, swings from there on: its energy is a
    # millionth of what the column has fallen by, which is twice its elastic energy. No damping.
    damped = rows["damped"][-1]
    sim.advance(10**6, end_time=0.02)
    later = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
    assert later["time"][-1] == 0.02
    assert np.all(later["damped"] == damped)
    assert np.all(later["unbalanced"] == 0.0)
    assert later["kinetic"].max() <= 1e-5 * rows["kinetic"].max()


def test_without_it_the_column_swings() -> None:
    """The same case begins with all of its weight out of balance."""
    sim = Simulation(case(settle=""), threads=1)
    sim.advance(10**6, end_time=0.02)
    later = dict(zip(sim.core.history_columns, sim.core.history().T, strict=True))
    assert later["kinetic"].max() > 1e-3


def test_loads_are_those_of_the_time_0() -> None:
    """A pressure that rises, and a plate that will move: the one at its start, the other still."""
    more = """
[load.top]
body = "column"
side = "y_max"
pressure = { times = [0, "1 s"], values = ["1 kPa", "5 kPa"] }
[body.plate]
material = "soil"
shape = { box = { lower = [0, "300 mm"], upper = ["20 mm", "320 mm"] } }
motion = { velocity = [0, "-1 m/s"] }
"""
    sim = Simulation(case(more=more), threads=1)
    plate = sim.column("plate", "position").copy()
    settle(sim)
    assert np.array_equal(sim.column("plate", "position"), plate)
    y, stress = sim.column("column", "position")[:, 1], sim.column("column", "stress")[:, 1]
    inside = (y > 0.02) & (y < 0.18)  # away from where the load enters
    exact = -1000.0 - DENSITY * GRAVITY * (HEIGHT - y)
    assert np.abs(stress - exact)[inside].max() <= 0.01 * np.abs(exact).max()
    sim.advance(10**6, end_time=0.01)
    assert sim.column("plate", "position")[:, 1] == pytest.approx(plate[:, 1] - 0.01, abs=1e-12)


def test_goes_on_from_the_middle_of_it(tmp_path: Path) -> None:
    """A checkpoint while it settles: the same bits as in one go."""
    sims = [Simulation(case(), threads=1) for _ in range(2)]
    sims[0].advance(150)
    assert sims[0].time < 0.0
    sims[0].save(tmp_path / "state")
    sims[1].restore(tmp_path / "state")
    for sim in sims:
        sim.advance(10**6, end_time=0.002)
    for column in ("position", "velocity", "stress"):
        one, other = (sim.column("column", column) for sim in sims)
        assert np.array_equal(one, other)


def test_a_run_that_is_stopped_while_it_settles_is_unfinished(tmp_path: Path) -> None:
    """Its checkpoint is of a time before 0, and can be read."""
    text = case(settle='settle = { longest = "1000 s", ratio = 1e-14 }').text
    (tmp_path / "case.toml").write_text(text)
    line = command("run", "case.toml", "--out", "out", "--no-pictures")
    running = subprocess.Popen(line, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    history = tmp_path / "out" / "history.csv"
    for _ in range(600):
        if history.exists() and history.stat().st_size > 100_000:
            break
        time.sleep(0.1)
    running.send_signal(signal.SIGINT)
    running.communicate(timeout=60)
    again = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert again.returncode != 0 and "Traceback" not in again.stderr
    assert "holds an unfinished run, at 0% of its time; go on with --resume" in again.stderr


def test_a_run_tells_of_it(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """The summary, a line when it is over, frames from the time 0, the ratio in the history."""
    text = "settles before t = 0, for 1 s at most, with local damping 0.8 until 0.001 of the forces"
    assert text in echo(case(), build(case()))
    run_case(case(), tmp_path, threads=1, quiet=False, pictures=False)
    assert "settled: forces out of balance are 0.000" in capfd.readouterr().err
    times = open_results(tmp_path).times
    assert times[0] == 0.0 and times[-1] == pytest.approx(0.02)


def test_says_when_the_time_is_over(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """A tenth of a period is not enough: the run begins all the same, and says what is missing."""
    short = case(settle='settle = { longest = "1 ms" }')
    sim = Simulation(short, threads=1)
    sim.advance(10**6, end_time=0.001)
    assert sim.time == 0.001
    [warning] = sim.core.warnings()
    assert "cfl 0.25, end 0.02 s" in echo(short, build(short))
    assert re.search(r"up to [\d,]+ steps to settle, then ", echo(short, build(short)))
    run_case(short, tmp_path, threads=1, quiet=False, pictures=False)
    assert "not settled: forces out of balance are 0." in capfd.readouterr().err
    assert "run.settle.longest was over before forces balanced" in warning.message


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("settle = {}", "longest is missing"),
        ('settle = { longest = "1 s", ratio = 2 }', "ratio"),
        ('settle = { longest = "1 s", local = 1 }', "local"),
        ('settle = { longest = "1 s", mass = 1 }', "not a known key"),
    ],
)
def test_refuses(line: str, message: str) -> None:
    """What makes no sense gets a sentence."""
    with pytest.raises(CaseError, match=message):
        case(settle=line)


def test_needs_a_force() -> None:
    """Nothing settles where nothing acts."""
    given = case().table()
    given["run"]["gravity"] = [0.0, {"ramp": {"to": -9.81, "end": 1.0}}]
    with pytest.raises(CaseError, match="needs a force to settle under"):
        Case(**given)
    given["run"]["gravity"] = [0.0, {"ramp": {"from": -1.0, "to": -9.81, "end": 1.0}}]
    assert Case(**given).run.settle is not None
