# SPDX-License-Identifier: BSD-3-Clause
"""Sections, lines and grids of a frame: a linear field is seen as it is."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import CASE, write
from mpm3dpp import Case, open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import Results

BLOCK = """
[grid]
dimension = {dimension}
cell_size = "10 mm"
[run]
end_time = "1 us"
[output]
frames = 1
[material.soft]
density = "1000 kg/m^3"
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[body.block]
material = "soft"
frame = "updated"
shape = {{ box = {{ lower = [{zeros}], upper = [{upper}] }} }}
velocity = [{velocity}]
"""
AXES = "xyz"


def block(dimension: int) -> str:
    fields = ("3*x - y", "2 + y", "x + z")[:dimension]
    return BLOCK.format(
        dimension=dimension,
        zeros=", ".join(["0"] * dimension),
        upper=", ".join(["0.05", "0.04", "0.06"][:dimension]),
        velocity=", ".join(f'{{ expression = "{text}" }}' for text in fields),
    )


def expected(places: np.ndarray) -> np.ndarray:
    x, y, z = (*places.T, np.zeros(len(places)))[:3]
    return np.column_stack([3 * x - y, 2 + y, x + z][: places.shape[1]])


@pytest.fixture(scope="module", params=[2, 3])
def results(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = tmp_path_factory.mktemp("run")
    case = Case.from_text(block(request.param))
    run_case(case, folder, threads=1, pictures=False)
    return open_results(folder)


def test_a_line(results: Results) -> None:
    """Inside, a cell from the surface; outside there is nothing. Fields are stored as floats."""
    d = results.dimension
    start, end = np.array([0.011, 0.013, 0.02][:d]), np.array([0.035, 0.027, 0.044][:d])
    found = results.line(start, end, "velocity", frame=0, count=31)
    assert found["distance"][-1] == pytest.approx(np.linalg.norm(end - start))
    assert found["velocity"][:, :d] == pytest.approx(expected(found["position"]), abs=1e-6)
    beyond = results.line(["-1 m"] * d, ["-0.5 m"] * d, "pressure", count=5)
    assert np.isnan(beyond["pressure"]).all() and beyond["position"].shape == (5, d)


def test_a_line_of_a_component_in_one_body(results: Results) -> None:
    ends = np.array([0.011, 0.013, 0.02]), np.array([0.035, 0.027, 0.044])
    start, end = (place[: results.dimension] for place in ends)
    whole = results.line(start, end, "velocity", frame=0, count=9)["velocity"]
    along_y = results.line(start, end, "velocity_y", frame=0, count=9, body="block")
    np.testing.assert_allclose(along_y["velocity_y"], whole[:, 1], rtol=1e-12)
    speed = results.on_grid("speed", 0)["speed"]
    assert np.nanmax(speed) > 2.0 and speed.ndim == results.dimension
    stress = results.line(start, end, "stress_yy", count=9)["stress_yy"]
    tensors = results.line(start, end, "stress", count=9)["stress"]
    np.testing.assert_array_equal(stress, tensors[:, 1])
    with pytest.raises(CaseError, match='did you mean "block"'):
        results.line(start, end, "pressure", body="blok")


def test_a_grid(results: Results) -> None:
    d = results.dimension
    for spacing in (None, "5 mm"):
        found = results.on_grid("velocity", 0, spacing)
        axes = [found[axis] for axis in AXES[:d]]
        assert found["velocity"].shape == (*map(len, axes), 3)
        inside = tuple(slice(2, -2) for _ in range(d))
        places = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)[inside].reshape(-1, d)
        values = found["velocity"][inside].reshape(-1, 3)[:, :d]
        assert len(values) > 0 and values == pytest.approx(expected(places), abs=1e-6)
    assert results.on_grid("pressure").keys() == {*AXES[:d], "pressure"}
    assert np.ndim(results.on_grid("pressure")["pressure"]) == d


def test_a_section(results: Results) -> None:
    arrays = results.arrays(0)
    y = arrays["position"][:, 1]
    found = results.section(0, ["velocity"], y="20 mm")
    inside = np.abs(y - 0.02) <= 0.005
    assert [*found] == ["position", "velocity"] and 0 < inside.sum() < len(y)
    np.testing.assert_array_equal(found["velocity"], arrays["velocity"][inside])
    whole = results.section(0, thickness=1.0, y=0.0)
    assert len(whole["position"]) == len(y)


@pytest.mark.parametrize(
    ("ask", "sentence"),
    [
        (lambda r: r.section(), "write section"),
        (lambda r: r.section(x=0, y=0), "write section"),
        (lambda r: r.section(y="1 s"), "has the unit"),
        (lambda r: r.line((0, 0), (1, 1, 1, 1), "pressure"), "numbers; give a place"),
        (lambda r: r.line([0] * r.dimension, [1] * r.dimension, "presure"), 'mean "pressure"'),
        (lambda r: r.on_grid("stres"), "is not an array of these frames"),
        (lambda r: r.on_grid("stress", spacing=0), "must be > 0"),
        (lambda r: r.on_grid("stress", spacing="1 nm"), "give a larger one"),
    ],
)
def test_mistakes(results: Results, ask: Callable[[Any], Any], sentence: str) -> None:
    with pytest.raises(CaseError) as caught:
        ask(results)
    assert sentence in str(caught.value)


def test_eroded_particles_are_left_out(tmp_path: Path) -> None:
    failure = 'failure = { plastic_strain = { limit = 0.01, action = "erode" } }'
    soft = 'strength = { elastic = { E = "1 MPa", nu = 0.3 } }'
    plastic = 'strength = { j2 = { E = "1 MPa", nu = 0.3, Y0 = "1 kPa" } }'
    path = write(tmp_path, CASE.replace(soft, f"{plastic}\n{failure}"))
    run_case(path, tmp_path / "out", threads=1, pictures=False)
    with open_results(tmp_path / "out") as results:
        last = results.arrays(-1)
        gone = last["failed"] >= 3
        assert gone.any() and not gone.all()
        place = last["position"][gone][:, :2].mean(axis=0).astype(float)
        near = np.abs(last["position"][:, :2] - place).max(axis=1) < results.cell_size
        found = results.line(place, place + 1e-6, "velocity", count=2)["velocity"][0]
        if (near & ~gone).any():
            low, high = last["velocity"][near & ~gone].min(0), last["velocity"][near & ~gone].max(0)
            assert (found >= low - 1e-6).all() and (found <= high + 1e-6).all()
        else:
            assert np.isnan(found).all()
