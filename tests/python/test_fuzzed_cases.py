# SPDX-License-Identifier: BSD-3-Clause
"""Whatever stands in a case file: a case, or mistakes in sentences; at once, and in little memory.

Values of a rich case are replaced by odd ones, keys are removed, added and renamed, and bytes of
its text are changed; the draws are the same in every run.
"""

from __future__ import annotations

import copy
import resource
import sys
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mpm3dpp import Case, CaseError
from mpm3dpp.case.case import load_case
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import echo

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

RICH = """\
title = "All of it"
[grid]
dimension = 2
cell_size = "2 mm"
origin = [0, 0]
box = { lower = ["0 mm", "0 mm"], upper = ["80 mm", "40 mm"], walls = { x_min = "slip" } }
outflow_box = { lower = ["-1 m", "-1 m"] }
coarsening = { tiles = 1000, times = 1 }
basis = "linear"
[run]
scheme = "usf"
end_time = "1 us"
cfl = 0.5
gravity = ["0 m/s^2", { sine = { amplitude = "1 m/s^2", period = "1 ms" } }]
viscosity = { quadratic = 1.5, linear = 0.06 }
transfer = { flip = 1.0, pic_rate = "1 1/s" }
[output]
interval = "0.5 us"
history_every = 2
fields = ["volume"]
picture = "speed"
compression = 1
checkpoint_interval = 0
[contact]
detection = "gap"
normal = "pair"
friction = 0.1
gap_distance = "0.1 mm"
normal_refresh_distance = 0.1
[[contact.pair]]
bodies = ["left", "right"]
friction = 0.3
[[contact.pair]]
materials = ["rubber", "steel"]
friction = 0.2
[material.rubber]
density = "1010 kg/m^3"
strength = { elastic = { E = "10 MPa", nu = 0.3 } }
failure = { principal_stress = { limit = "9 MPa", action = "erode" } }
artificial_viscosity = { quadratic = 0, linear = 0 }
[material.steel]
library = "steel_4340"
failure = "library"
without = ["eos"]
[material.tnt]
library = "tnt"
[body.left]
material = "rubber"
shape = { difference = [{ disc = { centre = ["10 mm", "10 mm"], radius = "5 mm" } }, \
{ box = { lower = [0, 0], upper = ["8 mm", "8 mm"] } }] }
particles_per_cell = 2
velocity = ["3 m/s", "0 m/s"]
angular_velocity = "1 rad/s"
[body.right]
material = "steel"
shape = { box = { lower = ["20 mm", "4 mm"], upper = ["30 mm", "12 mm"] } }
spacing = "1 mm"
[body.charge]
material = "tnt"
shape = { ring = { centre = ["40 mm", "10 mm"], inner_radius = "3 mm", outer_radius = "6 mm" } }
[body.plate]
material = "rubber"
shape = { translate = { by = [0, 0], shape = { box = { lower = ["60 mm", "2 mm"], \
upper = ["70 mm", "8 mm"] } } } }
motion = { velocity = [{ times = [0, "1 ms"], values = [0, "1 m/s"] }, 0], angular_velocity = 1 }
[grains.sand]
material = "rubber"
lattice = { lower = ["10 mm", "20 mm"], count = [3, 2], radius = "3 mm", spacing = "7 mm" }
align = "particle"
[grains.mud]
material = "rubber"
packing = { lower = ["50 mm", "20 mm"], upper = ["76 mm", "38 mm"], radius = ["2 mm", "3 mm"], \
fraction = 0.3, gap = "0.1 mm", seed = 3 }
[load.press]
body = "right"
side = "x_max"
pressure = { ramp = { from = 0, to = "1 MPa", end = "1 us" } }
[[detonation]]
point = ["40 mm", "10 mm"]
time = "0.1 us"
bodies = ["charge"]
"""
TABLES = tomllib.loads(RICH)


def paths(value: Any, here: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    """Every place of a table, but the whole."""
    pairs = value.items() if isinstance(value, dict) else enumerate(value)
    found = []
    for key, item in pairs:
        found.append((*here, key))
        if isinstance(item, dict | list):
            found += paths(item, (*here, key))
    return found


PLACES = paths(TABLES)
NUMBERS = (0, -1, 1, 2, 3, 7, 0.5, -0.0, 1e-300, 1e300, 1e99, -1e99, 1e-99, 1e9, 10**12, 10**30)
NUMBERS += (10**400, -(10**5000), float("nan"), float("inf"), 2**31, 2**53, 2**63, 5e-324, 1e-9)
UNITS = ("", "m", "mm", "m/s", "kg", "Pa", "m**9**9", "1/s", "furlong", "(", "µm", "°C", "%")
ODD = (True, False, "", " ", "\0", "\ud800", "é", "left", "rubber", "steel", "x" * 5000, "fixed")
ODD += ([], {}, [[]], [{}], {"": 1}, {"a": {"b": []}}, [1, 2], [1, 2, 3], [1] * 5000, [None], None)
ODD += ("../../etc/passwd", "/dev/zero", "/", ".", "a.csv", b"bytes", 1 + 2j)
ODD += ({"disc": {}}, {"union": [{"disc": {"centre": [0, 0], "radius": 1}}]}, {"library": {}})
values = st.one_of(
    st.sampled_from(NUMBERS),
    st.sampled_from(ODD),
    st.builds(lambda n, u: f"{n} {u}", st.sampled_from(NUMBERS[:14]), st.sampled_from(UNITS)),
    st.sampled_from(PLACES).map(lambda path: at(TABLES, path)),
    st.text(max_size=20),
)
changes = st.lists(
    st.tuples(
        st.sampled_from(PLACES),
        st.sampled_from(["replace", "replace", "replace", "remove", "add", "rename"]),
        values,
    ),
    min_size=1,
    max_size=3,
)
MEMORY = 400_000  # KiB that a case of some hundred particles, or the refusal of one, may take.


def at(value: Any, path: tuple[str | int, ...]) -> Any:
    for key in path:
        value = value[key]
    return value


def change(tables: Any, path: tuple[str | int, ...], how: str, value: Any) -> None:
    try:
        parent = at(tables, path[:-1])
        parent[path[-1]]
    except (KeyError, IndexError, TypeError):
        return  # An earlier change has taken the place away.
    if isinstance(parent, str):
        return
    if how == "replace":
        parent[path[-1]] = copy.deepcopy(value)
    elif how == "remove":
        del parent[path[-1]]
    elif how == "add" and isinstance(parent, dict):
        parent[f"{path[-1]}_too"] = copy.deepcopy(value)
    elif how == "rename" and isinstance(parent, dict):
        parent[f"{path[-1]}s"] = parent.pop(path[-1])


def try_case(make: Any) -> None:
    try:
        case = make()
        bodies = build(case)
        if sum(len(body.positions) for body in bodies) < 100_000:
            assert echo(case, bodies)
    except CaseError as error:
        for one in (error, *error.others):
            assert "\n" not in str(one) and str(one).isprintable()
            assert len(str(one)) < 3000


FUZZ = settings(
    deadline=5000,  # Milliseconds.
    derandomize=True,
    database=None,
    suppress_health_check=list(HealthCheck),
)


def test_the_rich_case_is_good() -> None:
    case = Case.from_tables(copy.deepcopy(TABLES), "case.toml", {})
    assert len(build(case)) > 10


def check_tables(drawn: list[tuple[Any, str, Any]]) -> None:
    tables = copy.deepcopy(TABLES)
    for path, how, value in drawn:
        change(tables, path, how, value)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    try_case(lambda: Case.from_tables(tables, "case.toml", {}))
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < MEMORY


def check_bytes(folder: Path, drawn: list[tuple[int, int, bytes]]) -> None:
    data = RICH.encode()
    for place, length, new in drawn:
        data = data[: place % len(data)] + new + data[place % len(data) + length :]
    path = folder / "case.toml"
    path.write_bytes(data)
    try_case(lambda: load_case(path))


edits = st.lists(
    st.tuples(st.integers(0, 10**5), st.integers(0, 30), st.binary(max_size=8)),
    min_size=1,
    max_size=3,
)


@settings(FUZZ, max_examples=150)
@given(changes)
def test_odd_values(drawn: list[tuple[Any, str, Any]]) -> None:
    check_tables(drawn)


@settings(FUZZ, max_examples=100)
@given(edits)
def test_odd_bytes(tmp_path_factory: pytest.TempPathFactory, drawn: Any) -> None:
    check_bytes(tmp_path_factory.getbasetemp(), drawn)


@pytest.mark.slow
@settings(FUZZ, max_examples=5000)
@given(changes)
def test_many_odd_values(drawn: list[tuple[Any, str, Any]]) -> None:
    check_tables(drawn)


@pytest.mark.slow
@settings(FUZZ, max_examples=3000)
@given(edits)
def test_many_odd_bytes(tmp_path_factory: pytest.TempPathFactory, drawn: Any) -> None:
    check_bytes(tmp_path_factory.getbasetemp(), drawn)
