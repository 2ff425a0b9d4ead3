# SPDX-License-Identifier: BSD-3-Clause
"""What ends a run before its time: conditions in the case, a function of the user's."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import interrupted, mpm3dpp, write
from mpm3dpp import Case, Simulation, Stop, load_case, open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import read_history, read_manifest

G = 9.81
BALL = """
[grid]
dimension = 2
cell_size = "10 mm"
[run]
end_time = "1 s"
gravity = [0, "-9.81 m/s^2"]
stop = {stop}
[output]
interval = "50 ms"
[material.soft]
density = "1000 kg/m^3"
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[body.ball]
material = "soft"
shape = {{ disc = {{ centre = [0, 0], radius = "30 mm" }} }}
velocity = [0, "{velocity} m/s"]
"""


@pytest.mark.parametrize(
    ("stop", "velocity", "time"),
    [
        # A ball that falls, or is thrown up: when it has that speed, that way, that energy.
        ('{ body = "ball", speed_above = "2 m/s" }', 0, 2 / G),
        ('{ body = "ball", moved = "20 cm" }', 0, np.sqrt(2 * 0.2 / G)),
        ('{ body = "ball", speed_below = "1 m/s" }', 4, 3 / G),
        ('{ kinetic_below = "1 J" }', 4, (4 - np.sqrt(2 / (1000 * np.pi * 0.03**2))) / G),
        # At rest it is slow at the start: that does not count.
        ('{ body = "ball", speed_below = "1 m/s" }', 0, 1.0),
        (
            '[{ body = "ball", moved = "90 m" }, { body = "ball", speed_above = "3 m/s" }]',
            0,
            3 / G,
        ),
    ],
)
def test_a_ball_in_free_flight(tmp_path: Path, stop: str, velocity: int, time: float) -> None:
    """It stops within the 16 steps between two looks, with all that a run writes."""
    case = Case.from_text(BALL.format(stop=stop, velocity=velocity))
    manifest = run_case(case, tmp_path, threads=1, pictures=False)
    history = read_history(tmp_path)
    looks = 17 * history["dt"].max()
    assert time <= manifest.end_time + 1e-9 <= time + looks + 1e-9
    assert manifest.status == "completed"
    with open_results(tmp_path) as results:
        assert results.times[-1] == manifest.end_time == history["time"][-1]
    if time < 1.0:
        assert manifest.reason is not None and "(run.stop)" in manifest.reason
    else:
        assert manifest.reason is None


def test_the_command_says_why_and_goes_on_without(tmp_path: Path) -> None:
    """With another condition, a later one or none, and another interval of the output."""
    text = BALL.format(stop='{ body = "ball", speed_above = "2 m/s" }', velocity=0)
    write(tmp_path, text)
    done = mpm3dpp("run", "case.toml", "--out", "out", "--no-pictures", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "s: ball is faster than 2 m/s (run.stop)" in done.stdout
    write(tmp_path, text.replace("2 m/s", "3 m/s").replace("50 ms", "20 ms"))
    done = mpm3dpp("run", "case.toml", "--out", "out", "--no-pictures", "--resume", cwd=tmp_path)
    assert done.returncode == 0 and "faster than 3 m/s" in done.stdout
    assert read_manifest(tmp_path / "out")["end_time"] == pytest.approx(3 / G, abs=0.02)


def test_a_condition_that_has_begun_to_count_counts_after_a_break(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = BALL.format(stop='{ body = "ball", speed_below = "1 m/s" }', velocity=4)
    path = write(tmp_path, text)
    whole = run_case(path, tmp_path / "whole", threads=1, pictures=False)
    interrupted(load_case(path), tmp_path / "parts", 3, monkeypatch)
    parts = run_case(path, tmp_path / "parts", threads=1, pictures=False, resume=True)
    assert (parts.end_time, parts.reason) == (whole.end_time, whole.reason)
    assert parts.result_hash == whole.result_hash
    files = [(tmp_path / name / "history.csv").read_bytes() for name in ("whole", "parts")]
    assert files[0] == files[1]


def test_a_function_is_called_at_its_times_and_may_end_the_run(tmp_path: Path) -> None:
    seen: list[float] = []

    def call(simulation: Simulation) -> bool:
        assert simulation.column("left", "velocity").shape[1] == 2
        seen.append(simulation.time)
        return len(seen) < 5

    path = write(tmp_path)
    manifest = run_case(path, tmp_path / "out", pictures=False, every="1 ms", call=call)
    assert [np.floor(time / 1e-3 + 1e-9) for time in seen] == [0, 1, 2, 3, 4]
    assert manifest.end_time == seen[-1] and manifest.status == "completed"
    assert manifest.reason is not None and "the function that was called" in manifest.reason
    assert read_history(tmp_path / "out")["time"][-1] == seen[-1]
    # One that returns nothing changes nothing.
    plain = run_case(path, tmp_path / "plain", pictures=False)
    looked = run_case(path, tmp_path / "looked", pictures=False, every=1e-3, call=lambda _: None)
    assert looked.result_hash == plain.result_hash and looked.reason is None
    ended = run_case(path, tmp_path / "none", pictures=False, every=1e-3, call=lambda _: False)
    assert ended.steps == 0 and ended.end_time == 0.0


@pytest.mark.parametrize(
    ("wrong", "sentence"),
    [
        ({"every": "1 ms"}, "call is missing; every and call go together"),
        ({"call": print}, "every is missing; every and call go together"),
        ({"call": print, "every": 0}, "every = 0 must be > 0"),
        ({"call": print, "every": "1 m"}, "every = "),
    ],
)
def test_mistakes_of_the_call(tmp_path: Path, wrong: dict[str, Any], sentence: str) -> None:
    with pytest.raises(CaseError) as caught:
        run_case(write(tmp_path), tmp_path / "out", **wrong)
    assert sentence in str(caught.value)


@pytest.mark.parametrize(
    ("stop", "sentence"),
    [
        ('{ body = "bal", moved = 1 }', 'is not a body of this case; did you mean "ball"'),
        ('{ body = "ball" }', "has no condition; add one of speed_below, speed_above, moved"),
        ("{ moved = 1 }", "body is missing"),
        ('{ body = "ball", moved = 1, speed_above = 1 }', "must not be given together with"),
        ('{ body = "ball", moved = "1 s" }', "has the unit"),
        ('{ body = "ball", speed_bellow = 1 }', 'did you mean "speed_below"'),
    ],
)
def test_mistakes(tmp_path: Path, stop: str, sentence: str) -> None:
    with pytest.raises(CaseError) as caught:
        load_case(write(tmp_path, BALL.format(stop=stop, velocity=0)))
    assert sentence in str(caught.value) and "case.toml:8: run.stop" in str(caught.value)


def test_from_python(tmp_path: Path) -> None:
    case = Case.from_text(BALL.format(stop="[]", velocity=0))
    run = case.run.model_copy(update={"stop": [Stop(body="ball", moved=0.1)]})
    manifest = run_case(case.model_copy(update={"run": run}), tmp_path, pictures=False)
    assert manifest.reason is not None and "ball has moved by more than 0.1 m" in manifest.reason
