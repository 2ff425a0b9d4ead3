# SPDX-License-Identifier: BSD-3-Clause
"""A checkpoint with right check sums may hold anything: one sentence, or a state that steps."""

from __future__ import annotations

import copy
import json
import random
import subprocess
import sys
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from commands import CASE, write
from mpm3dpp import Simulation, load_case, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.run.resume import go_on, refuse_to_begin_anew

FAULTS = Path(__file__).parents[1] / "faults"

PLANE = (
    CASE.replace(
        "nu = 0.3 } }",
        'nu = 0.3 } }\nfailure = { principal_stress = { limit = "5 kPa", action = "erode" } }',
    )
    + """
[material.rigid]
density = "2000 kg/m^3"
strength = { rigid = {} }
[body.stone]
material = "rigid"
shape = { box = { lower = ["20 mm", "-40 mm"], upper = ["60 mm", "-10 mm"] } }
velocity = ["0 m/s", "8 m/s"]
[grains.few]
material = "soft"
lattice = { lower = ["0 mm", "70 mm"], count = [3, 2], radius = "12 mm" }
"""
)
SPACE = """\
title = "Three blocks"
[grid]
dimension = 3
cell_size = "10 mm"
coarsening = { tiles = 4000, times = 1 }
[run]
end_time = "8 ms"
cfl = 0.3
[contact]
friction = 0.2
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.left]
material = "soft"
shape = { box = { lower = ["0 mm", "0 mm", "0 mm"], upper = ["30 mm", "30 mm", "30 mm"] } }
velocity = ["5 m/s", "0 m/s", "0 m/s"]
[body.right]
material = "soft"
shape = { box = { lower = ["30 mm", "10 mm", "0 mm"], upper = ["60 mm", "40 mm", "30 mm"] } }
velocity = ["-5 m/s", "0 m/s", "0 m/s"]
"""
AFFINE = SPACE.replace("[run]", 'basis = "quadratic_bspline"\n[run]\ntransfer = "aflip"')
CASES = pytest.mark.parametrize("text", [PLANE, SPACE, AFFINE], ids=["2D", "3D", "affine"])


def stepped(folder: Path, text: str, steps: int) -> Path:
    """Return the checkpoint of a case after some steps."""
    simulation = Simulation(load_case(write(folder, text)), threads=1)
    simulation.advance(steps)
    simulation.save(folder / "state.zip")
    return folder / "state.zip"


def outcomes(folder: Path, text: str, count: int) -> dict[str, Any]:
    state = stepped(folder, text, 60)
    words = [str(FAULTS / "restore.py"), str(folder / "case.toml"), str(state), str(count)]
    done = subprocess.run([sys.executable, *words], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    print(json.dumps(found, indent=1))
    return found


@CASES
def test_damaged_states(tmp_path: Path, text: str) -> None:
    found = outcomes(tmp_path, text, 150)
    assert found["wrong"] == [] and found["outcomes"]["refused"] > 20


@pytest.mark.slow
@CASES
def test_very_many_damaged_states(tmp_path: Path, text: str) -> None:
    assert outcomes(tmp_path, text, 5000)["wrong"] == []


ODD = [
    *(None, True, "", "x" * 100_000, "\x00", -1, 2**31, 2**63, 2**64, 10**400, 1e308, -1e308),
    *(float("nan"), float("inf"), 0, 0.5, [], {}, [None], {"a": 1}, [[[[]]]], {"": {"": {}}}),
]


def places(value: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where in a tree of dictionaries and lists there is something."""
    if path:
        yield path
    items = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, inner in items:
        yield from places(inner, (*path, key))


def test_damaged_abouts(tmp_path: Path) -> None:
    """`about.json` with values of other types and sizes, keys that are missing, and others."""
    case = load_case(write(tmp_path))
    out = tmp_path / "out"
    run_case(case, out, threads=1, pictures=False)
    checkpoint = out / "checkpoint.zip"
    with zipfile.ZipFile(checkpoint) as archive:
        whole, state = json.loads(archive.read("about.json")), archive.read("state")
    case.run.end_time *= 1.5
    chance, refused, taken = random.Random(2026), 0, 0
    known = list(places(whole))
    texts = []
    for _ in range(300):
        about = copy.deepcopy(whole)
        *inner, key = chance.choice(known)
        table = about
        for step in inner:
            table = table[step]
        if chance.random() < 0.2:
            del table[key]
        elif chance.random() < 0.1 and isinstance(table, dict):
            table["another"] = chance.choice(ODD)
        else:
            table[key] = chance.choice(ODD)
        texts.append(json.dumps(about))
    depth = 100_000
    texts += ["", "[]", "1", "null", "{}", '"x"', "[" * depth + "]" * depth, "1" * 5000, "\ud800"]
    for text in texts:
        with zipfile.ZipFile(checkpoint, "w") as archive:
            archive.writestr("about.json", text.encode("utf-8", "surrogatepass"))
            archive.writestr("state", state)
        for act in (
            lambda: go_on(out, case, lambda: Simulation(case, 1)),
            lambda: refuse_to_begin_anew(out, case),
        ):
            try:
                act()
                taken += 1
            except CaseError as error:
                assert "\n" not in str(error) and len(str(error)) < 1000, error
                refused += 1
    assert refused > 320 and taken + refused == 2 * len(texts)


def test_damaged_abouts_of_saved_states(tmp_path: Path) -> None:
    path = stepped(tmp_path, CASE, 1)
    with zipfile.ZipFile(path) as archive:
        state = archive.read("state")
    simulation = Simulation(load_case(tmp_path / "case.toml"), threads=1)
    for about in [*({"case": odd} for odd in ODD), {}, [], [["case", {"grid": 3}]], 1]:
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("about.json", json.dumps(about))
            archive.writestr("state", state)
        with pytest.raises(CaseError, match="give a state that was saved with this case"):
            simulation.restore(path)


def test_what_unpacks_to_far_more_than_the_file(tmp_path: Path) -> None:
    """Nobody unpacks it: a checkpoint is not compressed."""
    state = stepped(tmp_path, CASE, 1)
    with zipfile.ZipFile(state) as archive:
        about, whole = archive.read("about.json"), archive.read("state")
    case = load_case(tmp_path / "case.toml")
    for name in ("about.json", "state"):
        with zipfile.ZipFile(state, "w", zipfile.ZIP_DEFLATED) as archive:
            for member, content in (("about.json", about), ("state", whole)):
                archive.writestr(member, bytes(50_000_000) if member == name else content)
        assert state.stat().st_size < 200_000
        with pytest.raises(CaseError, match="is not a checkpoint of mpm3dpp, or damaged"):
            Simulation(case, threads=1).restore(state)
