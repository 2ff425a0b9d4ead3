# SPDX-License-Identifier: BSD-3-Clause
"""What bodies on nodes of their own do not go with: a sentence each, that names the body's key."""

from __future__ import annotations

import re

import pytest

from mpm3dpp import Case, CaseError

CASE = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 ms"
gravity = [0, -9.81]
[contact]
enabled = false
[material.m]
density = 1000
strength = { elastic = { E = "10 MPa", nu = 0.3 } }
[body.a]
material = "m"
frame = "material"
shape = { disc = { centre = [0, 0], radius = "4 mm" } }
[body.b]
material = "m"
shape = { disc = { centre = ["20 mm", 0], radius = "4 mm" } }
"""
GRID, RUN, A = 'cell_size = "1 mm"\n', 'end_time = "1 ms"\n', 'frame = "material"\n'
BOX = 'lower = ["-50 mm", "-50 mm"], upper = ["50 mm", "50 mm"]'
MATTER = 'strength = { elastic = { E = "10 MPa", nu = 0.3 } }\n'
WATER = "strength = { fluid = {} }\neos = { tait = { c0 = 10 } }\n"
LOAD = '[load.push]\nbody = "a"\nside = "x_min"\npressure = "1 kPa"\n'


def test_a_case_without_them_is_one() -> None:
    case = Case.from_text(CASE)
    assert [body.frame for body in case.body.values()] == ["material", "updated"]


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        (GRID, f'{GRID}basis = "linear"\n', "needs gradients without jumps"),
        (GRID, f'{GRID}box = {{ {BOX}, walls = "slip" }}\n', "walls of grid.box yet"),
        (GRID, f"{GRID}outflow_box = {{ {BOX} }}\n", "grid.outflow_box"),
        (GRID, f"{GRID}coarsening = {{ tiles = 9, times = 1 }}\n", "grid.coarsening"),
        ("enabled = false", "", "contact yet"),
        ("enabled = false", "bonded = true", "bonded bodies yet"),
        (RUN, f'{RUN}settle = {{ longest = "1 ms" }}\n', "run.settle yet"),
        (MATTER, WATER, "material.m, which flows or breaks"),
        (
            MATTER,
            MATTER + "failure = { hydrostatic_tension = { limit = 1e5 } }\n",
            "flows or breaks",
        ),
        (MATTER, MATTER + "volume_averaging = true\n", "volume_averaging of its material"),
        (A, f'{A}motion = "fixed"\n', "a body that does not deform"),
        ("[contact]", f"{LOAD}[contact]", "loads on its surface yet"),
    ],
)
def test_what_they_do_not_go_with(before: str, after: str, said: str) -> None:
    assert before in CASE
    text = CASE.replace(before, after, 1)
    if "settle" in after:
        text = text.replace(A, f"{A}velocity = [1, 0]\n")
    with pytest.raises(CaseError) as told:
        Case.from_text(text)
    messages = [str(told.value), *map(str, getattr(told.value, "others", []))]
    [about] = [m for m in messages if 'body.a.frame = "material"' in m]
    assert re.search(rf"(does not go with|needs) .*{re.escape(said.removeprefix('needs '))}", about)
    assert ";" in about  # and a remedy


def test_a_word_that_is_none() -> None:
    with pytest.raises(CaseError, match=r'body\.a\.frame = "materiel" .* did you mean "material"'):
        Case.from_text(CASE.replace(A, 'frame = "materiel"\n'))
