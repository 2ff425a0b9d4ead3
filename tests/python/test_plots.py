# SPDX-License-Identifier: BSD-3-Clause
"""Pictures: they are made, they show what they claim, and they need no graphics driver."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import matplotlib.image as matplotlib_image
import numpy as np
import pytest

from fake_core import COLUMNS, SIZE, FakeSimulation
from mpm3dpp import open_results, plots
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import HistoryWriter, ResultsWriter, build_manifest, read_history
from mpm3dpp.plots import energies, flat, frames, labels, paint, raster, space


def make_run(path: Path, dimension: int = 2, manifest: bool = True) -> Path:
    simulation = FakeSimulation(dimension)
    bodies = ["left", "right"]
    results = ResultsWriter(
        path / "results.vtkhdf",
        bodies=bodies,
        materials=["m", "m"],
        dimension=dimension,
        cell_size=2 * SIZE,
    )
    with results, HistoryWriter(path / "history.csv", columns=COLUMNS, bodies=bodies) as history:
        for _ in range(4):
            results.write(simulation)
            simulation.advance(5)
            history.append(simulation.history(), simulation.contact_pairs())
    if manifest:
        build_manifest(
            simulation,
            version="0",
            case={"output": {"picture": "pressure"}},
            case_text="",
            bodies=bodies,
            cell_size=2 * SIZE,
            threads=1,
            wall_time=1.0,
            status="completed",
        ).write(path)
    return path


def pixels(path: Path) -> np.ndarray:
    image = matplotlib_image.imread(path)
    assert image.shape[0] > 200
    assert image.shape[1] > 300
    assert image[..., :3].std() > 0.01
    return image


@pytest.fixture
def without_pyvista(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(space, "_pyvista_works", lambda: False)


def test_pictures_of_a_run(tmp_path: Path) -> None:
    made = plots.plot_results(make_run(tmp_path), animation=True)
    assert [p.name for p in made] == [
        "frame.png", "energies.png", "animation.gif", "first_contact.png"
    ]  # fmt: skip
    for path in made[:2]:
        pixels(path)
    from PIL import Image

    with Image.open(made[2]) as animation:
        assert animation.n_frames == 4


def test_a_frame_in_another_folder(tmp_path: Path) -> None:
    made = plots.plot_results(make_run(tmp_path), frame=1, colour="speed", out=tmp_path / "new")
    assert made[0] == tmp_path / "new" / "frame_0001.png"
    pixels(made[0])


def test_colours(tmp_path: Path) -> None:
    results = open_results(make_run(tmp_path))
    for colour in ("body", "velocity_y", "stress_xy", "von_mises"):
        frames.draw_frame(results, 1, colour, dpi=50).savefig(tmp_path / "frame.png")
        pixels(tmp_path / "frame.png")


def test_wrong_colour_frame_and_folder(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match="output folder"):
        plots.plot_results(tmp_path)
    make_run(tmp_path)
    with pytest.raises(CaseError, match="von_mises"):
        plots.plot_results(tmp_path, colour="von_misses")
    with pytest.raises(CaseError, match="give 0 to 3"):
        plots.plot_results(tmp_path, frame=9)


def test_a_picture_that_cannot_be_drawn_takes_no_other_with_it(tmp_path: Path) -> None:
    """The frame of the first contact is damaged; another one is wanted."""
    make_run(tmp_path)
    broken = tmp_path / "results.frames" / "000002.h5"
    broken.write_bytes(b"no frame")
    with pytest.raises(CaseError, match="frame 2 is damaged"):
        plots.plot_results(tmp_path, frame=3, animation=False)
    made = {path.name for path in tmp_path.glob("*.png")}
    assert made == {"frame_0003.png", "energies.png"}


@pytest.mark.usefixtures("without_pyvista")
def test_three_dimensions_without_pyvista(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(space, "PIXELS", 400)
    made = plots.plot_results(make_run(tmp_path, dimension=3), colour="body")
    image = pixels(made[0])
    blue = (image[..., 2] > image[..., 0] + 0.3).mean()
    orange = (image[..., 0] > image[..., 2] + 0.3).mean()
    assert min(blue, orange) > 0.02  # both bodies are seen


def test_three_dimensions_with_pyvista(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(space, "_has_graphics_card", lambda: True)
    if not space._pyvista_works():
        pytest.skip("PyVista cannot draw here")
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    lower, upper = np.array([-0.5, -0.5, -0.5]), np.array([1.5, 0.5, 0.5])
    colours = np.array([[1.0, 0, 0], [0, 0, 1.0]])
    image, _ = space.render(points, np.full(2, 0.5), colours, lower, upper)
    red, blue = image[..., 0] > image[..., 2] + 0.2, image[..., 2] > image[..., 0] + 0.2
    assert np.nonzero(red)[1].mean() < np.nonzero(blue)[1].mean()  # x goes to the right


def test_one_look_with_and_without_a_graphics_card(monkeypatch: pytest.MonkeyPatch) -> None:
    """Of some hundred balls the pictures differ in a few pixels at edges."""
    random = np.random.default_rng(3)
    points, sizes = random.uniform(0.0, 1.0, (400, 3)), random.uniform(0.05, 0.12, 400)
    colours = random.uniform(0.2, 1.0, (400, 3))
    lower, upper = -0.1 * np.ones(3), 1.1 * np.ones(3)
    monkeypatch.setattr(space, "_has_graphics_card", lambda: True)
    space._pyvista_works.cache_clear()
    works = space._pyvista_works()
    images = []
    for with_card in (True, False):
        monkeypatch.setattr(space, "_pyvista_works", lambda with_card=with_card: with_card)
        if with_card and not works:
            pytest.skip("PyVista cannot draw here")
        image = space.render(points, sizes, colours, lower, upper, 400, view=(-30.0, 20.0))[0]
        images.append(image.astype(int))
    differs = np.abs(images[0] - images[1]).max(axis=2) > 24
    assert images[0][..., 3].any() and differs.mean() < 0.01


@pytest.mark.parametrize("manifest", [True, False])
@pytest.mark.usefixtures("without_pyvista")
def test_first_contact_picture(tmp_path: Path, manifest: bool) -> None:
    path = plots.first_contact(make_run(tmp_path, manifest=manifest))
    assert path == tmp_path / "first_contact.png"
    pixels(path)


@pytest.mark.usefixtures("without_pyvista")
def test_first_contact_picture_in_space(tmp_path: Path) -> None:
    path = plots.first_contact(make_run(tmp_path, dimension=3), out=tmp_path / "touch.png")
    assert path == tmp_path / "touch.png"
    pixels(path)


def test_grains_are_told_apart_where_they_are_large_enough() -> None:
    bodies, grains = np.array([0, 0, 1, 1, 1]), np.array([0, 1, 0, 1, 1])
    parts = flat._parts(bodies, grains, np.full(5, 12.0))
    assert len(set(parts.tolist())) == 4 and parts[3] == parts[4]
    assert flat._parts(bodies, grains, np.full(5, 2.0)).tolist() == bodies.tolist()


def test_squares_tile_and_slits_close() -> None:
    """A lattice stretched by half its spacing still makes one body, with the gap to the next."""
    x, y = np.meshgrid(np.arange(10), np.arange(10))
    centres = np.column_stack([x.ravel() * 12.0, y.ravel() * 8.0]) + 20.0
    sizes, red = np.full(100, 8.0), np.tile([1.0, 0, 0], (100, 1))
    image = raster.tile(centres, sizes, np.zeros(100, int), red, (120, 160), 0)
    assert (image[20:90, 20:126, 3] == 255).all()  # no slits inside
    assert (image[:, :14, 3] == 0.0).all()  # nothing outside
    two = np.array([[20.0, 20.0], [31.0, 20.0]])
    image = raster.tile(two, np.full(2, 8.0), np.array([0, 1]), red[:2], (40, 60), 0)
    assert (image[20, 25:27, 3] == 0.0).all()  # the gap between two bodies stays open


def test_a_body_in_two_parts_far_apart() -> None:
    """Between them lie bands of rows without a particle."""
    centres = np.array([[5.0, 5.0], [5.0, 395.0]])
    image = raster.tile(
        centres, np.full(2, 4.0), np.zeros(2, dtype=int), np.full((2, 3), 0.5), (400, 10), 1
    )
    rows = (image[..., 3] == 255).any(axis=1).nonzero()[0]
    assert rows.tolist() == [3, 4, 5, 6, 393, 394, 395, 396]


def test_nearer_balls_hide_farther_ones() -> None:
    centres = np.array([[20.0, 20.0], [20.0, 20.0]])
    colours = np.array([[1.0, 0, 0], [0, 0, 1.0]])
    for near in (0, 1):
        depths = np.array([0.0, 0.0])
        depths[near] = 30.0
        image = raster.balls(centres, depths, np.full(2, 8.0), colours, (40, 40))
        assert image[20, 20, :3].argmax() == (0 if near == 0 else 2)


def test_few_balls_are_drawn_as_many_are(monkeypatch: pytest.MonkeyPatch) -> None:
    """Ball by ball or pixel by pixel of all balls, in one band or in many: the same image."""
    random = np.random.default_rng(4)
    centres, depths = random.uniform(0.0, 90.0, (300, 2)), np.sort(random.uniform(0.0, 60.0, 300))
    radii, colours = random.uniform(2.0, 9.0, 300), random.uniform(0.0, 1.0, (300, 3))
    images = []
    for rows in (200, 64, 7):
        monkeypatch.setattr(raster, "_ROWS", rows)
        images.append(raster.balls(centres, depths, radii, colours, (80, 100)).astype(int))
    assert images[0][..., 3].any()
    assert max(np.abs(image - images[0]).max() for image in images) <= 1  # rounding
    few = raster._nearest(centres, depths, radii, (80, 100), 9)
    many = raster._nearest(
        *(np.repeat(a, 8, axis=0) for a in (centres, depths, radii)), (80, 100), 9
    )
    assert np.array_equal(few[0] < 0, many[0] < 0)
    # Where two balls reach a pixel from one side, the many take that whose centre is nearer.
    assert (few[1] >= many[1] - 1e-9).all()
    assert np.isclose(few[1], many[1]).mean() > 0.9


def test_a_run_of_an_older_version_has_pictures(tmp_path: Path) -> None:
    """Its table has fewer terms: what restitution has taken is in `contact`."""
    path = make_run(tmp_path) / "history.csv"
    header, *rows = [line.split(",") for line in path.read_text().splitlines()]
    k = header.index("restitution")
    without = [[*row[:k], *row[k + 1 :]] for row in (header, *rows)]
    path.write_text("\n".join(",".join(row) for row in without) + "\n")
    assert not read_history(path)["restitution"].any()
    assert pixels(energies.save_energies(read_history(path), tmp_path / "energies.png")).size


def test_the_total_misses_what_numerics_took() -> None:
    rng = np.random.default_rng(1)
    history = {name: rng.uniform(1.0, 2.0, 9) for name in COLUMNS}
    gone_to = ("plastic", "viscous", "friction", "contact", "springs", "absorbed", "damped")
    gone_to += ("bounded", "eroded", "fracture", "left", "numerical", "restitution")
    gone = sum(history[name] for name in gone_to)
    history["kinetic"] = 100.0 - gone - history["internal"] + history["external"]
    figure = energies.draw_energies(history)  # Of more curves than there are colours.
    assert len(figure.axes[0].lines) == 16 and len(figure.axes[1].lines) == 17
    [total] = [line for line in figure.axes[0].lines if line.get_label() == "total"]
    expected = 100.0 - history["contact"] - history["numerical"]
    assert np.allclose(total.get_ydata(), expected, rtol=1e-14)


def test_pairs_are_told_by_the_names_of_their_bodies() -> None:
    """The names may have underscores in them, and be many letters long."""
    history = {name: np.linspace(1.0, 2.0, 5) for name in COLUMNS}
    bodies = ["big_block", "small_block", "a_body_with_a_name_of_very_many_letters"]
    for a, b in ((0, 1), (1, 2)):
        for x in "xyz":
            history[f"contact_force_{bodies[a]}_{bodies[b]}_{x}"] = np.linspace(0.0, 1.0, 5)
    figure = energies.draw_energies(history, 2, bodies)
    key = [text.get_text() for text in figure.axes[3].get_legend().get_texts()]
    assert key == [
        "big_block \N{EN DASH} small_block",
        "small_block \N{EN DASH} a_body_\N{HORIZONTAL ELLIPSIS}letters",
    ]


def test_torn_particles_do_not_take_the_colours() -> None:
    """Half a per cent of debris at a thousand times the pressure, or a few particles beyond."""
    bulk = np.linspace(-1.0, 1.0, 2000)
    low, high = paint.colour_range(np.concatenate([bulk, np.full(10, -900.0)]))
    assert -1.01 < low < -0.9 and 0.9 < high <= 1.0
    low, high = paint.colour_range(np.append(bulk, 1.8))
    assert low == -1.0 and 0.9 < high < 1.1
    assert paint.colour_range(bulk) == (-1.0, 1.0)
    wave = np.concatenate([np.zeros(1990), np.linspace(0.0, 1.0, 60)])  # Of few particles, but one.
    assert paint.colour_range(wave) == (0.0, 1.0)


def test_the_legend_of_a_frame_lies_over_nothing(tmp_path: Path) -> None:
    with open_results(make_run(tmp_path)) as results:
        results.bodies[:] = ["a_body_with_a_name_of_very_many_letters", "right"]
        figure = frames.draw_frame(results, -1, "body")
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    key = figure.legends[0].get_window_extent(renderer)
    [axes] = figure.axes
    assert not key.overlaps(axes.get_tightbbox(renderer))


def test_labels() -> None:
    assert labels.scaled(1.25e-3, "s") == "1.25 ms"
    assert labels.scaled(0.0, "s") == "0 s"
    assert labels.prefix(26.1e6, "Pa") == (pytest.approx(1e-6), "MPa")
    assert labels.prefix(1e-3, "s")[1] == "ms"
    assert labels.prefix(5.0, "m/s") == (1.0, "m/s")
    assert labels.length_unit(0.2) == (1e3, "mm")


@pytest.mark.usefixtures("without_pyvista")
@pytest.mark.parametrize("dimension", [2, 3])
def test_preview(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, dimension: int) -> None:
    """The filling is the shapes' business; here a body is the positions it fills."""
    import mpm3dpp.fill.build

    names, blocks = ["left", "right"], FakeSimulation(dimension)._start
    size = np.full(len(blocks[0]), SIZE**dimension)
    counts = [len(blocks[0])]
    some = [SimpleNamespace(positions=block, volumes=size, counts=counts) for block in blocks]
    parts = {
        name: SimpleNamespace(chunks=lambda one=one: [one])
        for name, one in zip(names, some, strict=True)
    }
    filled = SimpleNamespace(parts=parts)
    monkeypatch.setattr(mpm3dpp.fill.build, "fill_all", lambda case: filled)
    box = SimpleNamespace(lower=(0.0,) * dimension, upper=(0.03,) * dimension)
    grid = SimpleNamespace(
        dimension=dimension,
        cell_size=2 * SIZE,
        origin=(0.0,) * dimension,
        box=box,
        walls=("slip", "free", "fixed", "free", "free", "absorbing"),
    )
    case = SimpleNamespace(grid=grid, parts=lambda: names)
    path = plots.preview(case, tmp_path)
    assert path == tmp_path / "preview.png"
    pixels(path)


def test_fewer_pixels_show_the_same(without_pyvista: None) -> None:
    """Half the pixels: the image is half as large, and as much of it is covered by the ball."""
    points, colours = np.zeros((1, 3)), np.array([[1.0, 0.0, 0.0]])
    lower, upper = -np.ones(3), np.ones(3)
    images = [
        space.render(points, np.ones(1), colours, lower, upper, pixels)[0] for pixels in (800, 400)
    ]
    assert max(images[0].shape) == 800
    assert max(images[1].shape) == 400
    shares = [float((image[..., 3] > 0.0).mean()) for image in images]
    assert shares[1] == pytest.approx(shares[0], rel=0.02)  # a pixel along the edge
