# SPDX-License-Identifier: BSD-3-Clause
"""Cases with keys changed, and sweeps over values of keys."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import Any

import pytest

from commands import CASE, mpm3dpp, one_sentence, write
from mpm3dpp import Case, load_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.changes import value_of, values_of
from mpm3dpp.case.pairs import laws_of
from mpm3dpp.io import read_manifest
from mpm3dpp.sweep import runs
from mpm3dpp.sweep.numbers import unit_of

CONTACT = (
    CASE
    + "\n[contact]\nfriction = 0.5\n[[contact.pair]]\nbodies = ['left', 'right']\n"
    + ("friction = 0.4\n")
)


@pytest.mark.parametrize(
    ("key", "value", "old", "new"),
    [
        ("contact.friction", 0.25, "friction = 0.5", "friction = 0.25"),
        ("run.end_time", "7 ms", '"8 ms"', '"7 ms"'),
        ("contact.pair.0.friction", 0.1, "friction = 0.4", "friction = 0.1"),
        ("material.soft.strength.elastic.E", "2 MPa", "1 MPa", "2 MPa"),
        ("body.left.velocity", [1.0, 2.0], '["5 m/s", "0 m/s"]', "[1.0, 2.0]"),
        ("output.history_every", 5, "frames = 4", "frames = 4\nhistory_every = 5"),
        ("output.frames", None, "frames = 4", ""),
    ],
)
def test_a_changed_case_is_the_case_with_that_value(
    key: str, value: Any, old: str, new: str
) -> None:
    case = Case.from_text(CONTACT)
    changed = case.with_({key: value})
    assert changed.case_hash == Case.from_text(CONTACT.replace(old, new, 1)).case_hash
    assert changed.case_hash != case.case_hash and changed.text == ""
    again = changed.with_({"title": "Another", "grid.cell_size": "8 mm"})
    text = CONTACT.replace(old, new, 1).replace("Two blocks", "Another").replace("10 mm", "8 mm", 1)
    assert again.case_hash == Case.from_text(text).case_hash


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"contact.frictoin": 0.1}, 'did you mean "friction"'),
        ({"contact.friction": -0.1}, "contact.friction = -0.1 must be >= 0"),
        ({"contact.friction.more": 1}, "cannot be changed: friction is no table"),
        ({"contact.pair.3.friction": 1}, "cannot be changed: 3 is no number of a list of 1"),
        ({"contact.pair.friction": 1}, "from 0: contact.pair.0; or take all out with"),
        ({"contact..friction": 1}, 'is no key; write one such as "contact.friction"'),
        ({("contact", "friction"): 1}, 'is no key; write one such as "contact.friction"'),
        ({"run.settle.ratio": None}, "cannot be changed: settle is no table of the case"),
        (
            {"body.lef.velocity": [1.0, 0.0]},
            'body.lef.velocity cannot be changed: there is no body.lef; did you mean "left"?',
        ),
    ],
)
def test_mistakes_in_changes(changes: Any, sentence: str) -> None:
    with pytest.raises(CaseError) as error:
        Case.from_text(CONTACT).with_(changes)
    assert sentence in str(error.value)


def test_a_case_built_in_python_has_no_keys() -> None:
    case = Case.from_text(CASE)
    built = Case(grid=case.grid, run=case.run, material=case.material, body=case.body)
    with pytest.raises(CaseError, match="the case is of no case file, and only those have keys"):
        built.with_({"run.end_time": 1.0})


def test_what_was_changed_otherwise_is_not_lost_without_a_word() -> None:
    case = Case.from_text(CASE)
    case.run.end_time = 1.0
    with pytest.raises(CaseError, match="objects of this case were changed"):
        case.with_({"title": "x"})


def test_the_last_change_counts_and_values_are_copied() -> None:
    table = {"friction": 0.2}
    case = Case.from_text(CASE).with_({"contact.friction": 0.1}).with_({"contact": table})
    case = case.with_({"contact.friction": 0.3})
    assert case.contact.friction == 0.3 and table == {"friction": 0.2}
    changed = Case.from_text(CONTACT).with_({"contact.pair[0].friction": 0.0})
    assert laws_of(changed)[-1][2] == 0


def test_values_of_the_command_line() -> None:
    assert values_of("0, 0.1,10 mm") == ["0", "0.1", "10 mm"]
    assert values_of("[0, 1], ['a,b', 2]") == ["[0, 1]", "['a,b', 2]"]
    assert values_of('{ a = 1, b = "x,y" }') == ['{ a = 1, b = "x,y" }']
    assert value_of("0.1") == 0.1 and value_of("10 mm") == "10 mm" and value_of("true") is True
    assert value_of("[1, 2]") == [1, 2] and value_of('"usf"') == "usf" and value_of("usf") == "usf"


def test_a_key_is_out_of_a_table_that_is_not_there() -> None:
    changed = Case.from_text(CASE.replace("[output]\nframes = 4\n", "")).with_(
        {"output.frames": None}
    )
    assert changed.output.frames == 50
    with pytest.raises(CaseError, match="outptu is no table of the case"):
        Case.from_text(CASE).with_({"outptu.frames": None})


def test_run_and_check_take_changes(tmp_path: Path) -> None:
    write(tmp_path)
    words = ("--set", "run.end_time=2 ms", "--set", "title=Short")
    done = mpm3dpp("run", "case.toml", "--out", "out", "--no-pictures", *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    manifest = read_manifest(tmp_path / "out")
    assert manifest["end_time"] == 2e-3 and manifest["case"]["title"] == "Short"
    checked = mpm3dpp("check", "case.toml", "--set", "grid.cell_size=5 mm", cwd=tmp_path)
    assert checked.returncode == 0 and "0.005 m" in checked.stdout
    words = ("--set", "output.frames=", "--set", "output.interval=1 ms")
    checked = mpm3dpp("check", "case.toml", *words, cwd=tmp_path)
    assert checked.returncode == 0 and "9 frames" in checked.stdout
    for word, sentence in (
        ("run.end_tim=1", "did you mean"),
        ("run.end_time", "write KEY=VALUE"),
        ("contact.friction=0,0.1", "takes one value; run several with `mpm3dpp sweep`"),
    ):
        done = mpm3dpp("check", "case.toml", "--set", word, cwd=tmp_path)
        assert done.returncode == 2 and sentence in one_sentence(done.stderr)


BOX = 'box = { lower = ["0 mm", 0], upper = ["20 cm", "20 cm"], walls = "slip" }'


def test_a_sweep(tmp_path: Path) -> None:
    """Every combination, as single runs; a table, a picture; and nothing is run twice."""
    write(tmp_path, CASE.replace("[grid]", f"[grid]\n{BOX}"))
    words = ("--set", "contact.friction=0,0.3", "--set", "body.left.velocity=[5,0],[3,1]")
    words = ("sweep", "case.toml", "--out", "out", *words, "--jobs", 2, "--number", "left.speed")
    done = mpm3dpp(*words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "[4/4]" in done.stderr and "completed" in done.stderr
    lines = done.stdout.splitlines()
    assert lines[0].split() == ["contact.friction", "body.left.velocity", "left.speed"]
    assert len(lines) == 7 and lines[-2:] == ["out/sweep.csv", "out/sweep.png"]
    with open(tmp_path / "out" / "sweep.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert rows[1]["folder"] == "contact.friction=0,body.left.velocity=_3,1_4d1409"
    case = load_case(tmp_path / "case.toml")
    for row in rows:
        velocity = [5, 0] if row["body.left.velocity"] == "[5,0]" else [3, 1]
        friction = float(row["contact.friction"])
        single = case.with_({"contact.friction": friction, "body.left.velocity": velocity})
        manifest = read_manifest(tmp_path / "out" / row["folder"])
        assert manifest["case_hash"] == single.case_hash
        assert float(row["left.velocity_x"]) == manifest["bodies"]["left"]["final"]["velocity_x"]
        assert row["status"] == "completed"
    again = mpm3dpp(*words, cwd=tmp_path)
    assert again.returncode == 0 and again.stderr.count("was there") == 4
    assert again.stdout == done.stdout
    more = tuple(word.replace("=0,0.3", "=0,0.1,0.3") for word in map(str, words))
    assert mpm3dpp(*more, "--number", "wall.x_min.force_x", cwd=tmp_path).stderr.count("there") == 4
    tables = [(tmp_path / "out" / f"{stem}.csv").read_text() for stem in ("sweep_1", "sweep")]
    assert [text.count("\n") for text in tables] == [5, 7]  # That of the other runs is kept.
    assert (tmp_path / "out" / "sweep_1.png").is_file()


@pytest.mark.parametrize(
    ("name", "units"),
    [
        ("kinetic", ("J/m", "J")),
        ("wall.x_min.force_x", ("N/m", "N")),
        ("left.mass", ("kg/m", "kg")),
        ("left.momentum_x", ("(N s)/m", "N s")),
        ("left.speed", ("m/s", "m/s")),
        ("left.velocity_x", ("m/s", "m/s")),
        ("steps", ("", "")),
    ],
)
def test_units_in_2d_are_those_of_a_metre_of_depth(name: str, units: tuple[str, str]) -> None:
    assert (unit_of(name, 2), unit_of(name, 3)) == units


def test_runs_that_fail_are_told_and_the_others_go_on(tmp_path: Path) -> None:
    write(tmp_path, CASE.replace("cfl = 0.3", 'time_step = "50 us"'))
    words = ("sweep", "case.toml", "--out", "out", "--set", "run.time_step=50 us,5 s")
    done = mpm3dpp(*words, cwd=tmp_path)
    assert done.returncode == 1
    lines = done.stdout.splitlines()
    assert lines[1].startswith("        50 us") and "larger than the largest stable" in lines[2]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        ((), "there is nothing to change; give --set"),
        (("--set", "contact.friction=0,0"), "must have different values"),
        (("--set", "contact.friction=0,"), "must have different values"),
        (("--set", "contact.friction=0", "--set", "contact.friction=1"), "is given twice"),
        (("--set", "contact.friction=0,-1"), "contact.friction = -1 must be >= 0"),
        (("--set", "contact.friction=0", "--number", "left.sped"), 'did you mean "left.speed"'),
    ],
)
def test_mistakes_in_sweeps(tmp_path: Path, words: tuple[str, ...], sentence: str) -> None:
    write(tmp_path, CASE.replace('"8 ms"', '"0.1 ms"'))
    done = mpm3dpp("sweep", "case.toml", "--out", "out", *words, cwd=tmp_path)
    assert done.returncode == 2 and sentence in one_sentence(done.stderr)


def test_of_several_mistakes_of_a_run_the_first_is_told() -> None:
    told = (
        "note: x\nmpm3dpp: error: a must be b\nmpm3dpp: error: c must be d\nmpm3dpp: 2 mistakes\n"
    )
    assert runs._why(told) == "error: a must be b (and 1 more)"
    assert runs._why("mpm3dpp: error: a must be b\n") == "error: a must be b"
    assert runs._why("") == ""


def test_a_mistake_in_a_changed_key_names_no_line_of_the_file(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE)
    done = mpm3dpp("check", "case.toml", "--set", "run.cfl=7", cwd=tmp_path)
    assert done.returncode == 2
    assert "case.toml as changed: run.cfl = 7 must obey 0 < f <= 1" in done.stderr
    done = mpm3dpp("check", "case.toml", "--set", "foo.bar=3", cwd=tmp_path)  # No table of it.
    assert done.returncode == 2
    assert "case.toml as changed: foo is not a known key" in done.stderr
