# SPDX-License-Identifier: BSD-3-Clause
"""What is asked of pictures: section, view, crop, range, size, arrows, movies; and notebooks."""

from __future__ import annotations

import io
import sys
from pathlib import Path
from types import SimpleNamespace

import matplotlib.image as matplotlib_image
import numpy as np
import pytest

from commands import CASE
from fake_core import SIZE, FakeSimulation
from mpm3dpp import Case, CaseError, Grains, Grid, Material, Run, materials, open_results, plots
from mpm3dpp.base import progress
from mpm3dpp.io import Results, ResultsWriter
from mpm3dpp.plots import arrows, frames, look, movie, paint, space
from mpm3dpp.plots.grain_colours import colours_of_grains
from mpm3dpp.plots.look import Look, look_of
from mpm3dpp.plots.style import body_colours
from mpm3dpp.run.progress import Progress

SPAN = 18 * SIZE
"""Length of both blocks of the stand-in and of the gap between them [m]."""


@pytest.fixture(autouse=True)
def without_pyvista(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(space, "_pyvista_works", lambda: False)
    monkeypatch.setattr(space, "PIXELS", 300)


def make_run(path: Path, dimension: int = 2, count: int = 2) -> Path:
    simulation = FakeSimulation(dimension)
    with ResultsWriter(
        path / "results.vtkhdf",
        bodies=["left", "right"],
        materials=["m", "m"],
        dimension=dimension,
        cell_size=2 * SIZE,
        title="two <blocks>",
    ) as results:
        for _ in range(count):
            results.write(simulation)
            simulation.advance(5)
    return path


@pytest.fixture(scope="module")
def flat(tmp_path_factory: pytest.TempPathFactory) -> Results:
    return open_results(make_run(tmp_path_factory.mktemp("flat")))


@pytest.fixture(scope="module")
def solid(tmp_path_factory: pytest.TempPathFactory) -> Results:
    return open_results(make_run(tmp_path_factory.mktemp("solid"), dimension=3))


MISTAKES = {
    ("size", "10"): "WIDTHxHEIGHT",
    ("size", "20x20"): "100 to 10000",
    ("section", "w=0"): "x, y or z",
    ("section", "y"): "a place",
    ("section", "y=1 s"): "a length",
    ("view", "1"): "two numbers",
    ("view", "0,91"): "elevation",
    ("crop", "0,1,0"): "four or six numbers",
    ("crop", "1,0,0,1"): "X0 < X1",
    ("crop", "0,10 kg,0,1"): "a length",
    ("range", "1,0"): "lowest value first",
    ("range", "0"): "two numbers",
}


@pytest.mark.parametrize(("name", "text"), MISTAKES)
def test_a_mistake_is_one_sentence_that_names_the_option(name: str, text: str) -> None:
    with pytest.raises(CaseError, match=MISTAKES[name, text]) as python:
        look_of(**{name: text})
    assert python.value.key == name
    with pytest.raises(CaseError) as command, look.named_as_options():
        look_of(**{name: text})
    sentence = str(command.value)
    assert sentence.startswith(f'--{name} = "{text}" ') and "\n" not in sentence


def test_text_and_numbers_say_the_same() -> None:
    said = look_of("y = 5 mm", "-30, 20", "0,10 mm,0,0.5 cm", "0,2", "640x480", True)
    given = look_of({"y": 0.005}, (-30, 20), (0, 0.01, 0, 0.005), (0, 2), (640, 480), True)
    assert said == given
    assert said.crop == ((0.0, 0.0), (0.01, 0.005))
    assert look_of() == Look()


def test_what_two_dimensions_do_not_have(flat: Results) -> None:
    for asked in ({"section": "y=0"}, {"view": "0,0"}, {"crop": (0, 1, 0, 1, 0, 1)}):
        with pytest.raises(CaseError, match="2D"):
            flat.plot(**asked)


def test_what_does_not_suit_the_results(flat: Results, solid: Results) -> None:
    with pytest.raises(CaseError, match="leaves no particle"):
        flat.plot(crop=(1.0, 2.0, 0.0, 1.0))
    with pytest.raises(CaseError, match="from its edge"):
        solid.plot(section="y=0", view="0,0")
    with pytest.raises(CaseError, match=r"range .*must be a pressure"):
        flat.plot(colour="pressure", range="0,1 mm")
    with pytest.raises(CaseError, match="lowest value first"):
        flat.plot(colour="pressure", range="1 MPa,2 kPa")
    with pytest.raises(CaseError, match="colours with a scale"):
        flat.plot(colour="body", range="0,1")


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_picture_has_the_pixels_asked_for(
    tmp_path: Path, flat: Results, solid: Results, dimension: int
) -> None:
    results = flat if dimension == 2 else solid
    for size in ((401, 307),) if dimension == 2 else ((200, 330),):
        path = frames.save_frame(results, -1, tmp_path / "a.png", look=look_of(size=size))
        image = matplotlib_image.imread(path)
        assert image.shape[:2] == size[::-1]
        rows, columns = np.nonzero(image[..., :3].min(axis=2) < 0.9)
        assert np.ptp(columns) > 0.6 * size[0] or np.ptp(rows) > 0.6 * size[1]


def test_a_section_shows_what_is_inside(solid: Results) -> None:
    """Half of the particles are gone, and those at the plane have the colours that one sees."""
    middle = 4 * SIZE
    arrays = frames.drawn(solid, -1, "von_mises", look_of(section={"y": middle}))
    assert len(arrays["position"]) == 2 * 8**3 // 2
    assert arrays["position"][:, 1].min() > middle  # One looks along y: what is before is gone.
    behind = frames.drawn(solid, -1, "von_mises", look_of(section={"y": middle}, view=(90, 20)))
    assert behind["position"][:, 1].max() < middle
    shown = {}
    for name, cut in (("inside", {"y": middle}), ("outside", None)):
        figure = solid.plot(
            0, "position_y", section=cut, view=(-90, 0), range="0,8 mm", size=(300, 200)
        )
        image = np.asarray(figure.axes[0].images[0].get_array(), dtype=float)
        shown[name] = image[image[..., 3] == 255.0][:, :3].mean(axis=0)
        assert ("section y = 4 mm" in figure.axes[0].get_title(loc="left")) == (cut is not None)
    green = {name: rgb[1] / rgb.sum() for name, rgb in shown.items()}
    assert green["outside"] < 0.2 and green["inside"] > 0.4  # Of viridis at 0.06 and at 0.56.


def test_a_view_turns_the_bodies(solid: Results) -> None:
    """Along x the first block hides the second; from above both are seen."""
    views = {}
    for view in ((-90, 0), (-180, 0), (0, 90)):
        image = solid.plot(0, "body", view=view, size=(300, 300)).axes[0].images[0].get_array()
        views[view] = np.asarray(image)
    blue, orange = np.array([0, 114, 178]), np.array([230, 159, 0])

    def share(view: tuple[int, int], colour: np.ndarray) -> float:
        rgb = views[view][..., :3].astype(float)
        lengths = np.maximum(np.linalg.norm(rgb, axis=2) * np.linalg.norm(colour), 1e-9)
        return float(((rgb @ colour) / lengths > 0.98).mean())

    assert share((-90, 0), blue) > 0.2 and share((-90, 0), orange) > 0.2
    assert share((-180, 0), blue) > 0.5 and share((-180, 0), orange) < 0.01
    assert share((0, 90), blue) > 0.2


def test_directions_are_those_of_a_right_hand() -> None:
    for view in (None, (-30.0, 20.0), (0.0, 90.0), (77.0, -90.0)):
        axes = np.array(look.directions(view))
        assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-15)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert axes[1, 2] >= -1e-15  # z is not turned upside down


def test_a_crop_is_what_the_axes_show(flat: Results) -> None:
    figure = flat.plot(0, crop="1 mm,6 mm,2 mm,4 mm")
    assert np.allclose([*figure.axes[0].get_xlim(), *figure.axes[0].get_ylim()], [1, 6, 2, 4])
    arrays = frames.drawn(flat, 0, "von_mises", look_of(crop=(0.001, 0.006, 0.002, 0.004)))
    assert set(arrays["body"]) == {0}


def test_a_crop_in_space_takes_away_what_is_outside(solid: Results) -> None:
    arrays = frames.drawn(solid, 0, "von_mises", look_of(crop=(0, 1, 0, 1, 0, 4 * SIZE)))
    assert len(arrays["position"]) == 2 * 8**3 // 2
    four = frames.drawn(solid, 0, "von_mises", look_of(crop=(0, 8 * SIZE, 0, 1)))
    assert len(four["position"]) == 8**3


def test_a_range_is_that_of_the_colour_bar(flat: Results) -> None:
    for given, low, high in (("-1,2 MPa", -1.0, 2e6), ("0 MPa,0.02 GPa", 0.0, 2e7)):
        view = frames.view_of(flat, [0], "pressure", look_of(range=given))
        assert (view.low, view.high, view.exact) == (low, high, True)
        arrays = frames.drawn(flat, 0, "pressure")
        rgb, bar = paint.paint(arrays, flat, "pressure", view)
        assert bar is not None and bar.extend == "min"  # The stand-in's pressures are negative.
        assert len(rgb) == len(arrays["pressure"])
    norm = paint.colour_scale("pressure", -1.0, 3.0, exact=True)
    assert np.allclose(norm[0](norm[1](0.0))[:3], 1.0, atol=0.05)  # White at zero.


def test_a_hot_particle_and_debris_do_not_take_the_colours() -> None:
    """One of a body, or some that fly alone; but a wave of as few particles is seen."""
    x, y = np.meshgrid(np.arange(40.0), np.arange(40.0))
    points, sizes = np.column_stack([x.ravel(), y.ravel()]), np.ones(1600)
    calm = np.linspace(0.0, 1.0, 1600)
    hot = calm.copy()
    hot[820] = 500.0
    assert paint.colour_range(hot, points, sizes)[1] <= 1.0
    few = paint.colour_range(np.append(calm[:60], 9.0), points[:61], sizes[:61])
    assert few[1] < 1.0
    debris = np.column_stack([100.0 + 10.0 * np.arange(12), np.zeros(12)])
    values = np.append(calm, np.full(12, -800.0))
    everything = np.concatenate([points, debris]), np.ones(1612)
    assert paint.colour_range(values, *everything)[0] >= 0.0
    wave = 1e-6 * calm
    wave[(np.hypot(*(points - [20, 20]).T) < 2.1)] = 1.0
    assert (wave == 1.0).sum() < 16  # Less than 1 %, and far above the others.
    assert paint.colour_range(wave, points, sizes)[1] == 1.0


def test_the_ends_of_the_bar_point_to_what_is_beyond(flat: Results) -> None:
    arrays = frames.drawn(flat, 0, "pressure")
    low, high = float(arrays["pressure"].min()), float(arrays["pressure"].max())
    middle = 0.5 * (low + high)
    for ends, extend in (((low, high), "neither"), ((low, middle), "max"), ((middle, high), "min")):
        view = frames.view_of(flat, [0], "pressure", look_of(range=ends))
        bar = paint.paint(arrays, flat, "pressure", view)[1]
        assert bar is not None and bar.extend == extend


def test_neighbouring_grains_have_other_colours() -> None:
    """A hexagonal heap of a name, a body that is none, and then a second name."""
    centres = np.array([(x + 0.5 * (y % 2), 0.87 * y, 0.0) for y in range(9) for x in range(9)])
    ring = 0.45 * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0]])
    points = (centres[:, None] + ring).reshape(-1, 3)
    grains = np.repeat(np.arange(81), 4)
    points = np.concatenate([points, [[50.0, 0.0, 0.0]]])
    bodies, grains = np.append(np.full(324, 1), 0), np.append(grains, 0)
    found = colours_of_grains(bodies, grains, points)
    assert list(found) == [1] and found[1].shape == (81, 3)
    apart = np.linalg.norm(centres[:, None] - centres, axis=2)
    for a, b in np.argwhere((apart > 0.0) & (apart < 1.1)):
        assert not np.allclose(found[1][a], found[1][b])
    blue = body_colours(np.array([0]))[0]
    assert not (np.abs(found[1] - blue).max(axis=1) < 1e-3).any()  # The other body's.
    two = colours_of_grains(np.append(bodies, [2, 2]), np.append(grains, [0, 1]),
                            np.concatenate([points, [[60.0, 0, 0], [61.0, 0, 0]]]))  # fmt: skip
    assert sorted(two) == [1, 2]
    shades = two[1][:, 0] < two[1][:, 2]
    assert not shades.any()  # Of orange, the colour of their name.


def test_arrows_show_the_velocities(flat: Results, solid: Results) -> None:
    for results in (flat, solid):
        figure = results.plot(0, "body", arrows=True, size=(400, 300))
        [quiver] = [one for one in figure.axes[0].collections if hasattr(one, "U")]
        right, left = quiver.U[quiver.U > 0], quiver.U[quiver.U < 0]
        assert len(right) and len(left)  # The blocks meet.
        assert np.abs(quiver.U).max() <= 10.0 + 1e-9
        figure.canvas.draw()
    assert arrows.fastest_of(np.array([[3.0, 4.0, 0.0]])) == 5.0


def test_a_movie_as_gif(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from PIL import Image

    run = make_run(tmp_path, count=3)
    [path] = plots.plot_results(
        run, movie=tmp_path / "all.gif", size="300x201", colour="body", quiet=False
    )
    with Image.open(path) as animation:
        assert animation.n_frames == 3 and animation.size == (300, 201)
    told = capsys.readouterr().err
    assert "100%  all.gif  frame 3 of 3  took" in told
    assert not (run / "frame.png").exists()


def test_a_movie_without_ffmpeg(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "imageio_ffmpeg", None)
    monkeypatch.setattr(movie.shutil, "which", lambda name: None)
    with pytest.raises(CaseError, match="pip install imageio-ffmpeg") as mistake:
        plots.plot_results(make_run(tmp_path), movie=tmp_path / "all.mp4")
    assert mistake.value.key == "movie"
    with pytest.raises(CaseError, match=r"movie\.webm or movie\.gif"):
        plots.plot_results(tmp_path, movie="all.avi")


def test_what_ffmpeg_is_given(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A program that counts its bytes in place of ffmpeg; then one that fails."""
    program = tmp_path / "ffmpeg"
    program.write_text('#!/bin/sh\nfor last; do :; done\nwc -c > "$last"\n')
    program.chmod(0o755)
    monkeypatch.setattr(movie, "_ffmpeg", lambda path: str(program))
    run = make_run(tmp_path / "run")
    [path] = plots.plot_results(run, movie=tmp_path / "all.mp4", size="300x200", colour="body")
    assert int(path.read_text()) == 2 * 300 * 200 * 3
    program.write_text("#!/bin/sh\necho no such codec >&2\nexit 1\n")
    with pytest.raises(CaseError, match="no such codec"):
        plots.plot_results(run, movie=tmp_path / "new.mp4", size="300x200", colour="body")
    assert not list(tmp_path.glob("*new.mp4*"))


def test_results_in_a_notebook(flat: Results) -> None:
    shown = flat._repr_html_()
    assert "two &lt;blocks&gt;" in shown and "left, right" in shown and "pressure [Pa]" in shown
    assert "<script" not in shown and "<blocks>" not in shown
    png = flat.plot(0, "body", size=(200, 150))._repr_png_()
    assert matplotlib_image.imread(io.BytesIO(png)).shape[:2] == (150, 200)


class Notebook(io.StringIO):
    """The stream of a cell's output, as ipykernel has it."""


def test_a_notebook_has_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ipykernel", SimpleNamespace())
    monkeypatch.setattr(Notebook, "__module__", "ipykernel.iostream")
    monkeypatch.setattr(progress, "_REFRESH_IN_NOTEBOOK", 0.0)
    stream = Notebook()
    with Progress(1e-3, stream=stream) as bar:
        for k in range(11):
            bar.update(1e-4 * k, k, 1e-4, 2.0, 1.0, (7, "nodes"))
    text = stream.getvalue()
    assert text.count("\n") == 1 and text.endswith("\n") and text.count("\r") == 11
    last = text.strip().rpartition("\r")[2]
    assert "100%" in last and "contact 7 nodes" in last and "step 10" in last


def test_a_case_and_materials_in_a_notebook() -> None:
    case = Case.from_text(CASE.replace("Two blocks", "a <b>"))
    shown = case._repr_html_()
    assert "a &lt;b&gt;" in shown and "<b>" not in shown and "<script" not in shown
    assert "body.left" in shown and "material.soft" in shown and "cell_size = 0.01 m" in shown
    assert "shape = { box = { lower = [0, 0], upper" in shown
    [material, *_] = case.material.values()
    assert "density" in material._repr_html_() and "kg/m^3" in material._repr_html_()
    assert "Pa" in material.strength._repr_html_()
    copper = materials.named("copper_ofhc")._repr_html_()
    assert "johnson_cook" in copper and "8960" in copper and "<ol>" in copper
    for one in materials.library().values():
        assert one._repr_html_().count("<tr>") > 3


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_preview_shows_walls_and_grains(tmp_path: Path, dimension: int) -> None:
    zeros, ones = ([x] * dimension for x in (0.0, 0.02))
    rubber = Material(density=1000.0, strength={"elastic": {"E": 1e6, "nu": 0.3}})
    case = Case(
        grid=Grid(
            dimension=dimension,
            cell_size=2e-3,
            box={"lower": zeros, "upper": ones, "walls": {"x_min": "symmetry", "y_min": "fixed"}},
        ),
        run=Run(end_time=1e-3),
        material={"rubber": rubber},
        grains={
            "balls": Grains(
                material="rubber",
                lattice={"lower": zeros, "count": [4] * dimension, "radius": 2e-3, "spacing": 5e-3},
            )
        },
    )
    path = plots.preview(case, tmp_path / "preview.svg")
    drawn = path.read_text()
    assert "slip wall (symmetry)" in drawn and "fixed wall" in drawn
    assert "absorbing" not in drawn and "balls (" in drawn
