# SPDX-License-Identifier: BSD-3-Clause
"""`first_contact.png` draws the plane, normal and gap that the run has recorded."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from mpm3dpp import open_results, run_case
from mpm3dpp.io import read_history
from mpm3dpp.plots import contact, space

RUBBER = """
[material.rubber]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
"""
DISCS = f"""
[grid]
dimension = 2
cell_size = "2 mm"
[run]
end_time = "3 ms"
[output]
frames = 2
{RUBBER}
[body.left]
material = "rubber"
shape = {{ disc = {{ centre = [0, 0], radius = "12 mm" }} }}
velocity = ["3 m/s", "1 m/s"]
[body.right]
material = "rubber"
shape = {{ disc = {{ centre = ["21 mm", "15 mm"], radius = "12 mm" }} }}
velocity = ["-3 m/s", "-1 m/s"]
"""
BALLS = f"""
[grid]
dimension = 3
cell_size = "2 mm"
[run]
end_time = "2 ms"
[output]
frames = 2
{RUBBER}
[body.first]
material = "rubber"
shape = {{ sphere = {{ centre = [0, 0, 0], radius = "6 mm" }} }}
velocity = ["3 m/s", "2 m/s", "1 m/s"]
[body.second]
material = "rubber"
shape = {{ sphere = {{ centre = ["10 mm", "7 mm", "4 mm"], radius = "6 mm" }} }}
velocity = ["-3 m/s", "-2 m/s", "-1 m/s"]
"""
GRAINS = f"""
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "4 ms"
{RUBBER}
[grains.low]
material = "rubber"
lattice = {{ lower = [0, 0], count = [3, 1], radius = "3 mm", spacing = "8 mm" }}
[grains.high]
material = "rubber"
lattice = {{ lower = [0, "6.5 mm"], count = [3, 1], radius = "3 mm", spacing = "8 mm" }}
velocity = [0, "-1 m/s"]
"""
IMPULSES = '[contact]\nresponse = "impulses"\n'
CASES = {
    "discs": DISCS + IMPULSES,
    "balls": BALLS + IMPULSES,
    "grains": GRAINS + IMPULSES,
    "springs": DISCS,
}


@pytest.fixture(scope="module", params=CASES)
def ran(request: Any, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """The folder of a run, and what its manifest says of the pair."""
    folder = tmp_path_factory.mktemp(request.param)
    (folder / "case.toml").write_text(CASES[request.param])
    run_case(folder / "case.toml", folder, threads=1, pictures=False)
    [pair] = json.loads((folder / "manifest.json").read_text())["contact"]["pairs"]
    return folder, pair


def drawn(folder: Path) -> Any:
    """The figure."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(space, "_pyvista_works", lambda: False)
        kept: list[Any] = []
        patch.setattr(contact, "save", lambda figure, path: kept.append(figure) or path)
        contact.first_contact(folder)
    return kept[0]


def test_what_is_recorded_is_a_plane(ran: tuple[Path, dict[str, Any]]) -> None:
    """Discs and spheres touch on the line between their centres; the gap is that of particles."""
    folder, pair = ran
    normal, node = np.array(pair["first_normal"]), np.array(pair["first_node"])
    assert np.linalg.norm(normal) == pytest.approx(1.0, abs=1e-12)
    with open_results(folder) as results:
        [frame] = np.flatnonzero(np.abs(results.times - pair["first_time"]) < 1e-9)
        arrays = results.arrays(int(frame))
        cell = results.cell_size
    x, body = arrays["position"].astype(float), arrays["body"]
    if "grain" in arrays:  # Those nearest to the node.
        near = [np.abs(x - node).sum(axis=1)[body == b].argmin() for b in (0, 1)]
        grain = [arrays["grain"][body == b][k] for b, k in enumerate(near)]
        keep = np.array([arrays["grain"][k] == grain[body[k]] for k in range(len(body))])
        x, body = x[keep], body[keep]
    line = x[body == 1].mean(axis=0) - x[body == 0].mean(axis=0)
    line /= np.linalg.norm(line)
    radius = max(np.ptp(x[body == 0], axis=0)) / 2
    # From the first body to the second; the node may be a cell beside the line.
    assert float(normal @ line) > np.cos(np.arcsin(cell / radius))
    middle = 0.5 * (x[body == 1].mean(axis=0) + x[body == 0].mean(axis=0))
    assert np.linalg.norm(node - middle) < 2.5 * cell


def test_the_picture_draws_what_is_recorded(ran: tuple[Path, dict[str, Any]]) -> None:
    folder, pair = ran
    close = drawn(folder).axes[1]
    assert len(close.lines) == 2
    ends = [line.get_xydata() for line in close.lines]
    plane = ["xyz".index(label()[0]) for label in (close.get_xlabel, close.get_ylabel)]
    factor = 1e3 if "[mm]" in close.get_xlabel() else 1e6
    normal = np.array(pair["first_normal"])[plane]
    for line in ends:
        along = (line[1] - line[0]) / np.linalg.norm(line[1] - line[0])
        assert abs(along @ normal) < 1e-9
    apart = (ends[1].mean(axis=0) - ends[0].mean(axis=0)) / factor
    # Where the plane leans to the slice, its traces are farther apart than the surfaces.
    assert apart @ normal == pytest.approx(pair["first_gap"], abs=1e-12)
    size = f"{pair['first_gap'] * factor:.3f}".replace("-", "\N{MINUS SIGN}")
    assert f"gap {size} " in close.get_title(loc="left")
    [arrow] = [text for text in close.texts if text.arrow_patch is not None]
    way = np.array(arrow.xy) - arrow.xyann
    assert way @ normal == pytest.approx(np.linalg.norm(way) * np.linalg.norm(normal))


def test_the_surfaces_are_those_of_the_bodies(ran: tuple[Path, dict[str, Any]]) -> None:
    """Particles tell the place along the normal; the gap among them is the one recorded.

    Springs measure it from the smooth surface, which is lower than the foremost particles.
    """
    folder, pair = ran
    with open_results(folder) as results:
        touch = contact._first(folder, results.bodies)
        assert touch is not None and touch.gap == pair["first_gap"]
        frame = int(np.flatnonzero(results.times >= touch.time * (1 - 1e-9))[0])
        arrays, cell = results.arrays(frame), results.cell_size
    x, sizes = arrays["position"].astype(float), contact.sizes_of(arrays, results)
    plane = contact.plane_of(touch, x, sizes, arrays["body"], cell)
    assert plane is not None and plane.gap == pair["first_gap"]
    assert plane.normal.tolist() == pair["first_normal"]
    ends = []
    for body, sign in ((touch.a, 1.0), (touch.b, -1.0)):
        mine = arrays["body"] == body
        apart = x[mine] - touch.node
        along = apart @ plane.normal
        close = (np.abs(apart) < contact._REACH * cell).all(axis=1)
        close &= (apart**2).sum(axis=1) - along**2 < cell**2
        ends.append(sign * (sign * along[close] + 0.5 * sizes[mine][close]).max())
    # The frame is of the end of that step, the gap of its beginning.
    history = read_history(folder)
    step = history["dt"][np.flatnonzero(history["time"] >= touch.time * (1 - 1e-9))[0]]
    speeds = [arrays["velocity"][arrays["body"] == b].mean(axis=0) for b in (touch.a, touch.b)]
    moved = step * float(np.linalg.norm(speeds[1] - speeds[0]))
    smooth = 0.15 * cell if folder.name.startswith("springs") else 0.0
    assert ends[1] - ends[0] == pytest.approx(pair["first_gap"], abs=1.1 * moved + smooth)
    assert moved < 0.1 * cell  # of a step of `cfl` 0.5


@pytest.mark.parametrize("name", ["left", "a_very_long_name_of_a_body_that_nobody_would_type"])
def test_the_legend_lies_over_nothing(tmp_path: Path, name: str) -> None:
    case = DISCS.replace("[body.left]", f"[body.{name}]")
    run_case_text(case, tmp_path)
    figure = drawn(tmp_path)
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    [legend] = figure.legends
    key = legend.get_window_extent(renderer)
    for axes in figure.axes:
        assert not key.overlaps(axes.get_window_extent(renderer))
        title = axes._left_title.get_window_extent(renderer)
        assert not key.overlaps(title)
    first, second = (axes._left_title.get_window_extent(renderer) for axes in figure.axes)
    assert not first.overlaps(second)
    assert key.width < figure.bbox.width


def run_case_text(text: str, folder: Path) -> None:
    (folder / "case.toml").write_text(text)
    run_case(folder / "case.toml", folder, threads=1, pictures=False)


def test_a_frame_is_written_at_the_first_contact(tmp_path: Path) -> None:
    """By velocity bodies act from afar, where one has only just reached a node: not that counts."""
    run_case_text(DISCS + '[contact]\ndetection = "velocity"\n', tmp_path)
    [pair] = json.loads((tmp_path / "manifest.json").read_text())["contact"]["pairs"]
    assert pair["first_gap"] > 5e-4
    with open_results(tmp_path) as results:
        assert np.abs(results.times / pair["first_time"] - 1).min() < 1e-9
    close = drawn(tmp_path).axes[1]
    [arrow] = [text for text in close.texts if text.arrow_patch is not None]
    length = np.linalg.norm(np.array(arrow.xy) - arrow.xyann)
    assert length == pytest.approx(1e3 * pair["first_gap"], rel=1e-9)  # Between the surfaces.


def test_without_a_record_there_is_no_close_up(tmp_path: Path) -> None:
    """A killed run has no manifest: the moment is in its history, the plane nowhere."""
    run_case_text(DISCS, tmp_path)
    (tmp_path / "manifest.json").unlink()
    assert len(drawn(tmp_path).axes) == 1
