# SPDX-License-Identifier: BSD-3-Clause
"""Keys by their names of the release before: they mean the same, and a note names the new ones."""

from __future__ import annotations

from pathlib import Path

import pytest

import mpm3dpp
from mpm3dpp import CaseError, Grid, Run, Simulation, load_case

CASE = """
[grid]
dimension = 2
cell_size = "10 mm"
{keep} = {{ lower = ["-1 m", "-1 m"] }}
{doubling} = {{ tiles = 1000 }}

[run]
end_time = "1 ms"
{factor} = 0.4

[output]
interval = "1 ms"

[contact]
{travel} = 0.1

[material.rubber]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}

[body.block]
material = "rubber"
shape = {{ box = {{ lower = [0, 0], upper = ["0.1 m", "0.1 m"] }} }}
"""
BEFORE = ("keep", "doubling", "time_step_factor", "normal_travel")
NOW = ("outflow_box", "coarsening", "cfl", "normal_refresh_distance")
HOMES = ("grid", "grid", "run", "contact")


def written(folder: Path, names: tuple[str, ...]) -> Path:
    file = folder / f"{names[0]}.toml"
    keys = dict(zip(("keep", "doubling", "factor", "travel"), names, strict=True))
    file.write_text(CASE.format(**keys))
    return file


def test_they_mean_the_same(tmp_path: Path) -> None:
    before, now = (load_case(written(tmp_path, names)) for names in (BEFORE, NOW))
    assert before.case_hash == now.case_hash
    assert before.run.time_step_factor == before.run.cfl == 0.4
    before.run.time_step_factor = 0.2
    assert before.run.cfl == 0.2
    assert Simulation(now, threads=1).notes == []
    notes = Simulation(load_case(written(tmp_path, BEFORE)), threads=1).notes
    assert len(notes) == 4
    for home, old, new in zip(HOMES, BEFORE, NOW, strict=True):
        assert any(f"{home}.{old} is named {home}.{new} now" in note for note in notes)


def test_not_both() -> None:
    with pytest.raises(CaseError, match="is the former name of the key cfl, which is given too"):
        Run(end_time=1.0, time_step_factor=0.4, cfl=0.4)


def test_python_names() -> None:
    with pytest.warns(DeprecationWarning, match=r"is named mpm3dpp\.GridOutflowBox now"):
        box = mpm3dpp.GridKeep(lower=(0.0, 0.0))
    assert Grid(dimension=2, cell_size=1.0, keep=box).outflow_box == box


def test_a_mistake_is_told_of_the_key_that_was_given(tmp_path: Path) -> None:
    file = written(tmp_path, BEFORE)
    text = file.read_text().replace("time_step_factor = 0.4", "time_step_factor = 3")
    file.write_text(text.replace('lower = ["-1 m", "-1 m"]', 'lower = ["-1 m"]'))
    with pytest.raises(CaseError) as raised:
        load_case(file)
    told = [raised.value, *raised.value.others]
    assert {(e.key, e.place) for e in told} == {
        ("grid.keep.lower", f"{file}:5"),
        ("run.time_step_factor", f"{file}:10"),
    }
