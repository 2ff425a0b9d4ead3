# SPDX-License-Identifier: BSD-3-Clause
"""Motions and functions of time in a case: what is read, what is refused, shapes of hoppers."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from mpm3dpp import Case, CaseError, Simulation, TimeFunction, load_case
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import echo

GOOD = """\
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 ms"
gravity = [0, { ramp = { from = 0, to = "-9.81 m/s^2", start = "0 ms", end = "1 ms" } }]
[contact]
friction = 0.3
[material.rubber]
density = "1010 kg/m^3"
strength = { elastic = { E = "10 MPa", nu = 0.3 } }
[material.steel]
density = "7800 kg/m^3"
strength = { elastic = { E = "200 GPa", nu = 0.3 } }
[body.hopper]
material = "steel"
motion = "fixed"
shape = { funnel = { centre = [0, 0], outlet_radius = "3 mm", inlet_radius = "8 mm", \
height = "5 mm", thickness = "2 mm" } }
[body.disc]
material = "rubber"
shape = { disc = { centre = [0, "20 mm"], radius = "5 mm" } }
[body.tool]
material = "steel"
shape = { polygon = { points = [["20 mm", 0], ["30 mm", 0], ["25 mm", "8 mm"]] } }
motion = { velocity = [{ sine = { amplitude = "2 m/s", frequency = "50 Hz", phase = "90 deg" } }, \
{ times = [0, "1 ms"], values = [0, "-3 m/s"] }], angular_velocity = "60 rpm" }
"""
TOOL = "body.tool.motion"
TABLE = '{ times = [0, "1 ms"], values = [0, "-3 m/s"] }'
SINE = '{ amplitude = "2 m/s", frequency = "50 Hz", phase = "90 deg" }'

# (text of the good case, what replaces it, key, part of the rule, part of the remedy)
# fmt: off
BAD = [
    ('[0, "1 ms"]', '["1 ms", 0]', f"{TOOL}.velocity[1].times[1]", "must be > the time before",
     "increasing"),
    ('[0, "1 ms"]', '[0, 0]', f"{TOOL}.velocity[1].times[1]", "must be > the time before",
     "increasing"),
    ('[0, "-3 m/s"]', "[0]", f"{TOOL}.velocity[1].values", "as many numbers as times, 2",
     "it has 1"),
    ('[0, "-3 m/s"]', "[]", f"{TOOL}.velocity[1].values", "at least one number", "for example"),
    ('[0, "-3 m/s"]', '[0, "-3 m"]', f"{TOOL}.velocity[1].values[1]", "a velocity", "give"),
    ('[0, "-3 m/s"]', "[0, nan]", f"{TOOL}.velocity[1].values[1]", "must be finite", "give"),
    (TABLE, "{ times = [0] }", f"{TOOL}.velocity[1]", "must have times and values", "for example"),
    (TABLE, "{}", f"{TOOL}.velocity[1]", "must have times and values", "for example"),
    (TABLE, "{ tims = [0], sine = 3 }", f"{TOOL}.velocity[1].tims", "is not a known key",
     '"times"'),
    (TABLE, "{ sine = 3 }", f"{TOOL}.velocity[1].sine", "must be a table", "write sine"),
    (SINE, '{ frequency = "50 Hz" }', f"{TOOL}.velocity[0].sine.amplitude", "is missing", "add"),
    (SINE, '{ amplitude = 1 }', f"{TOOL}.velocity[0].sine", "either frequency or period", "50 Hz"),
    (SINE, '{ amplitude = 1, period = 1, frequency = 1 }', f"{TOOL}.velocity[0].sine",
     "either frequency or period", "50 Hz"),
    (SINE, '{ amplitude = 1, period = 0 }', f"{TOOL}.velocity[0].sine.period", "must be > 0",
     "give"),
    (SINE, '{ amplitude = 1, perod = 1 }', f"{TOOL}.velocity[0].sine.perod", "known key",
     '"period"'),
    ('end = "1 ms" } }', 'end = "0 ms" } }', "run.gravity[1].ramp.end", "must be > start",
     "later"),
    (', end = "1 ms" } }', " } }", "run.gravity[1].ramp.end", "is missing", "add"),
    ('motion = "fixed"', 'motion = "fixd"', "body.hopper.motion", "known motion", '"fixed"'),
    ('motion = "fixed"', "motion = 3", "body.hopper.motion", '"fixed" or a table', "velocity"),
    ('motion = "fixed"', "motion = { velocty = 3 }", "body.hopper.motion.velocty", "known key",
     '"velocity"'),
    ('motion = "fixed"', "motion = { velocity = [0, 0, 0] }", "body.hopper.motion.velocity",
     "must have 2 numbers", "it has 3"),
    ('motion = "fixed"', "motion = { velocity = 3 }", "body.hopper.motion.velocity",
     "list of numbers or functions", "list such as"),
    ('motion = "fixed"', "motion = { angular_velocity = [0, 0, 1] }",
     "body.hopper.motion.angular_velocity", "must have one number", "it has 3"),
    ('motion = "fixed"', "motion = { centre = [0, 0] }", "body.hopper.motion.centre",
     "without angular_velocity", "remove"),
    ('motion = "fixed"', 'motion = "fixed"\nvelocity = [0, 1]', "body.hopper.velocity",
     "together with motion", "write motion"),
    ("friction = 0.3", "bonded = true", "body.hopper.motion", "contact.bonded = true", "remove"),
    ('material = "rubber"', 'material = "rubber"\nmotion = "fixed"', "body", "rigid bodies only",
     "another strength"),
    ('inlet_radius = "8 mm"', 'inlet_radius = "2 mm"', "body.hopper.shape.funnel.inlet_radius",
     "must be > outlet_radius", "swap"),
    ('["25 mm", "8 mm"]', '["25 mm", 0]', "body.tool.shape.polygon.points", "enclose an area",
     "move"),
    ('["25 mm", "8 mm"]', '["25 mm", "8 mm"], ["25 mm", "-8 mm"]',
     "body.tool.shape.polygon.points", "must not cross itself", "in order"),
]
# fmt: on


def read(tmp_path: Path, text: str) -> Case:
    path = tmp_path / "case.toml"
    path.write_text(text)
    return load_case(path)


def test_the_good_case(tmp_path: Path) -> None:
    case = read(tmp_path, GOOD)
    ramp = case.run.gravity[1]
    assert isinstance(ramp, TimeFunction)
    assert [ramp.at(t) for t in (-1.0, 0.0005, 2.0)] == [0.0, -9.81 / 2, -9.81]
    motion = case.body["tool"].motion
    assert motion is not None
    assert motion.angular_velocity == (2 * math.pi,)
    assert motion.velocity[0].at(0.0) == 2.0  # type: ignore[union-attr]
    again = Case(**case.table())
    assert again.case_hash == case.case_hash
    assert json.loads(json.dumps(case.table()))["body"]["hopper"]["motion"] is not None
    sim = Simulation(case, threads=1)
    sim.advance(20)
    assert sim.core.step == 20
    # Rubber alone limits the step: what moves as prescribed has no waves.
    assert sim.core.dt > 0.2 * 1e-3 / 200.0
    x = sim.column("tool", "position")
    v = sim.column("tool", "velocity")
    assert np.ptp(v[:, 0] + 2 * math.pi * (x[:, 1] - x[:, 1].mean())) < 1e-9
    lines = echo(case, build(case)).splitlines()
    assert [line.endswith(", fixed") for line in lines[:3]] == [True, False, False]
    assert lines[2].endswith(
        ", moves as prescribed: velocity (2 m/s sin at 50 Hz and 90 deg, 0 m/s to -3 m/s from 0 s "
        "to 1 ms), spin (6.28319 rad/s)"
    )


def test_the_case_of_the_how_to_page() -> None:
    page = Path(__file__).parents[2] / "docs" / "how-to" / "move-bodies-and-loads.md"
    blocks = page.read_text().split("```toml\n")[1:]
    [text] = [block.partition("```")[0] for block in blocks if "title" in block]
    sim = Simulation(Case.from_text(text), threads=1)
    assert sim.notes == sim.warnings == []
    sim.advance(20)
    assert sim.core.step == 20


@pytest.mark.parametrize("row", BAD, ids=lambda row: row[1][:40])
def test_bad_input(row: tuple[str, str, str, str, str], tmp_path: Path) -> None:
    old, new, key, rule, remedy = row
    assert old in GOOD
    with pytest.raises(CaseError) as caught:
        build(read(tmp_path, GOOD.replace(old, new, 1)))
    sentence = str(caught.value)
    place = f"{tmp_path / 'case.toml'}:"
    assert sentence.startswith(place)
    assert sentence.removeprefix(place).partition(" ")[2].startswith(f"{key} ")
    before, _, after = sentence.partition("; ")
    assert rule in before
    assert remedy in after


def test_the_velocity_of_a_prescribed_body_cannot_be_set(tmp_path: Path) -> None:
    sim = Simulation(read(tmp_path, GOOD), threads=1)
    with pytest.raises(CaseError, match="prescribed motion"):
        sim.set_velocity("tool", sim.column("tool", "velocity"))


def test_python_and_core_agree_on_functions_of_time() -> None:
    from mpm3dpp import _core

    forms = (
        {"times": [0.0, 1.0, 1.5], "values": [2.0, -1.0, 4.0]},
        {"sine": {"amplitude": 3.0, "period": 0.7, "phase": 0.2, "mean": -1.0}},
        {"ramp": {"from": 1.0, "to": 4.0, "start": 0.2, "end": 0.9}},
    )
    for form in forms:
        function = TimeFunction.parse(form, "m/s")
        assert isinstance(function, TimeFunction)
        core = _core.TimeFunction(**function.for_core())
        for t in np.linspace(-0.5, 2.0, 26):
            assert function.at(t) == pytest.approx(core.at(t), abs=1e-14)
            assert abs(function.at(t)) <= function.bound()
        assert TimeFunction.parse(function.table(), "m/s") == function
