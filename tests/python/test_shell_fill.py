# SPDX-License-Identifier: BSD-3-Clause
"""Round bodies and grains filled by shells: exact, even, symmetric, and turned from grain to grain.

Tolerances of 1e-12 are those that are promised; sums over some thousand particles round to 1e-15.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from mpm3dpp import Body, Case, CaseError, GrainCentres, Grains, Grid, Simulation
from mpm3dpp.base.neighbours import near_pairs
from mpm3dpp.case.load_pieces import pieces
from mpm3dpp.fill.build import build
from mpm3dpp.fill.parts import FilledBody
from mpm3dpp.grains import GrainPacking
from mpm3dpp.grains.orientation import orientations
from mpm3dpp.run.summary import echo
from mpm3dpp.shapes import Box, Cylinder, Disc, Ring, Rotate, Shape, Sphere, Translate, Tube, fill
from mpm3dpp.shapes.lattice import fill_shape
from mpm3dpp.shapes.shells import ball_count, shell_count, shell_points, takes_shells
from mpm3dpp.shapes.spheres import directions
from mpm3dpp.shapes.turns import cos_sin, cube_root

Array = NDArray[np.float64]
SIZES = (0.6, 0.8, 1.0, 1.49, 1.5, 2.0, 2.5, 3.3, 4.0, 5.0, 7.77, 12.0)
FLAT, SOLID = (0.3, -0.2), (0.3, -0.2, 0.5)


def shapes_of(size: float) -> list[Shape]:
    """Return round shapes of a size [m]; one of them is moved and turned."""
    tube: dict[str, Any] = {
        "centre": SOLID, "inner_radius": size, "outer_radius": 1.9 * size, "height": 1.3 * size
    }  # fmt: skip
    return [
        Disc(centre=FLAT, radius=size),
        Ring(centre=FLAT, inner_radius=size, outer_radius=2.2 * size),
        Sphere(centre=SOLID, radius=size),
        *(Cylinder(centre=SOLID, radius=size, height=1.7 * size, axis=a) for a in "xyz"),
        Tube(**tube, axis="y"),
    ]


def second_moments(shape: Any) -> Array:
    """Return the integral of x x over a shape about its centre [m^(D + 2)], in closed form."""
    volume = shape.volume()
    if isinstance(shape, Sphere):
        return volume * shape.radius**2 / 5 * np.eye(3)
    inner = getattr(shape, "inner_radius", 0.0)
    outer = shape.outer_radius if isinstance(shape, Ring | Tube) else shape.radius
    across = volume * (inner**2 + outer**2) / 4
    if isinstance(shape, Disc | Ring):
        return across * np.eye(2)
    moments = np.full(3, across)
    moments["xyz".index(shape.axis)] = volume * shape.height**2 / 12
    return np.diag(moments)


@pytest.mark.parametrize("size", SIZES)
def test_volume_centre_and_inertia_are_exact(size: float) -> None:
    for shape in shapes_of(size):
        points = shell_points(shape, 1.0)
        centre = np.array(shape.centre)  # type: ignore[attr-defined]
        assert shape.contains(points).all()
        arms, exact = points - centre, second_moments(shape)
        assert np.abs(arms.mean(axis=0)).max() < 1e-12 * size
        found = arms.T @ arms * (shape.volume() / len(points))  # type: ignore[operator]
        assert np.abs(found - exact).max() < 1e-12 * exact.max()


def test_the_inertia_of_what_is_turned_is_turned() -> None:
    rod = Cylinder(centre=SOLID, radius=3.0, height=9.0, axis="x")
    rotated = Rotate(shape=rod, angle=0.7, axis=(1, 2, 3), about=(1, 1, 1))
    shape = Translate(shape=rotated, by=(5, 6, 7))
    points = shell_points(shape, 1.0)
    turn = rotated.matrix()
    middle = turn @ (np.array(SOLID) - 1.0) + 1.0 + (5, 6, 7)
    arms = points - middle
    exact = turn @ second_moments(rod) @ turn.T
    assert np.abs(arms.mean(axis=0)).max() < 1e-12 * 9.0
    found = arms.T @ arms * (rod.volume() / len(points))
    assert np.abs(found - exact).max() < 1e-12 * exact.max()


def test_a_body_has_the_mass_and_the_moments_of_its_shape() -> None:
    """Through a case and the core: all particles of a body have the same volume."""
    shape = Ring(centre=FLAT, inner_radius=0.05, outer_radius=0.08)
    simulation = Simulation(case_of({"ring": body(shape, angular_velocity=3.0)}), threads=1)
    mass, x = simulation.column("ring", "mass"), simulation.column("ring", "position")
    assert mass.max() == mass.min()
    assert abs(mass.sum() / (1000.0 * shape.volume()) - 1.0) < 1e-12
    v, arm = simulation.column("ring", "velocity"), x - np.array(FLAT)
    spin = (mass[:, 0] * (arm[:, 0] * v[:, 1] - arm[:, 1] * v[:, 0])).sum()
    polar = 1000.0 * np.trace(second_moments(shape))
    assert abs(spin / (3.0 * polar) - 1.0) < 1e-12


@pytest.mark.parametrize("size", [4.0, 5.0, 7.77, 12.0])
def test_particles_are_even_and_as_many_as_on_a_lattice(size: float) -> None:
    for shape in shapes_of(size):
        points = shell_points(shape, 1.0)
        cubes = shape.volume()  # Of the spacing; so many has a lattice, on average.
        assert abs(len(points) / cubes - 1.0) < 0.1  # type: ignore[operator]
        if isinstance(shape, Disc | Ring):
            on_lattice = len(fill_shape(shape, shape.centre, 1.0))
            assert abs(len(points) / on_lattice - 1.0) < 0.06
        assert abs(shell_count(shape, 1.0) / len(points) - 1.0) < 0.12
        nearest = cKDTree(points).query(points, k=2)[0][:, 1]
        # Measured: 0.79 at least, at the innermost circles and shells, and 0.88 to 1.00.
        assert nearest.min() > 0.75
        assert 0.85 < nearest.mean() < 1.1


@pytest.mark.parametrize("size", [3.0, 5.0, 12.0])
def test_the_outermost_points_lie_half_a_spacing_inside(size: float) -> None:
    for shape in (Disc(centre=FLAT, radius=size), Sphere(centre=SOLID, radius=size)):
        away = np.linalg.norm(shell_points(shape, 1.0) - shape.centre, axis=1)
        outermost = away[away > away.max() - 1e-9]
        assert 0.4 < size - away.max() < 0.55  # Nearer where the exact inertia of few shells is.
        each = shape.volume() / len(shell_points(shape, 1.0))
        middle = away.max()
        area = 2 * math.pi * middle if len(shape.centre) == 2 else 4 * math.pi * middle**2
        assert 0.8 < each * len(outermost) / area < 1.1  # The thickness of their layer, about.


@pytest.mark.parametrize("count", [6, 8, 12, 14, 24, 30, 54, 72, 78, 126, 264, 1656])
def test_directions_are_as_symmetric_as_a_cube(count: int) -> None:
    points = directions(count)
    assert points.shape == (count, 3)
    assert np.abs(np.linalg.norm(points, axis=1) - 1.0).max() < 1e-14
    for order in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            assert apart(points, points[:, list(order)] * signs) < 1e-14


def test_the_faces_of_the_sphere_have_equal_areas() -> None:
    """Points on a square lattice of each face: as many in each cap of the same size, about."""
    points = directions(6 * 60**2)
    random = np.random.default_rng(1).normal(size=(200, 3))
    poles = random / np.linalg.norm(random, axis=1)[:, None]
    shares = (poles @ points.T > 0.9).mean(axis=1)
    assert np.abs(shares / 0.05 - 1.0).max() < 0.03  # A row of points along the rim of a cap.


def test_series_are_cosines_and_roots() -> None:
    turns = np.linspace(-2.0, 2.0, 10_001)
    cos, sin = cos_sin(turns)
    assert np.abs(cos - np.cos(2 * np.pi * turns)).max() < 2e-15
    assert np.abs(sin - np.sin(2 * np.pi * turns)).max() < 2e-15
    values = np.array([1e-15, 1e-9, 1e-3, 0.3, 1.0])
    assert np.abs(cube_root(values) / np.cbrt(values) - 1.0).max() < 1e-15


def apart(one: Array, other: Array) -> float:
    """Return the largest distance of a point to its partner; infinite if there is none."""
    assert one.shape == other.shape
    away, partner = cKDTree(one).query(other)
    return float(away.max()) if len(np.unique(partner)) == len(one) else math.inf


def case_of(bodies: dict[str, Any], grains: dict[str, Any] | None = None, **more: Any) -> Case:
    [first] = [*bodies.values(), *(grains or {}).values()]
    corner = first.shape.bounds()[0] if isinstance(first, Body) else first.file.centres[0]
    tables: dict[str, Any] = {
        "grid": {"dimension": len(corner), "cell_size": 0.01},
        "run": {"end_time": 1.0},
        "material": {
            "m": {"density": 1000.0, "strength": {"elastic": {"E": 1e6, "nu": 0.3}}},
        },
        "body": bodies,
        "grains": grains or {},
    }
    return Case(**(tables | more))


def body(shape: Shape, **keys: Any) -> Body:
    return Body(material="m", shape=shape, fill="shells", **keys)


def sand(centres: Array, radii: Array) -> Case:
    given = GrainCentres(centres, radii)
    return case_of({}, {"sand": Grains(material="m", file=given, fill="shells")})


WORLDS = {
    2: {
        "mirrored in x": ((0, -1), (1, 1)),
        "mirrored in y": ((0, 1), (1, -1)),
        "x for y": ((1, 1), (0, 1)),
        "a quarter turn": ((1, -1), (0, 1)),
    },
    3: {
        "mirrored in x": ((0, -1), (1, 1), (2, 1)),
        "mirrored in y": ((0, 1), (1, -1), (2, 1)),
        "mirrored in z": ((0, 1), (1, 1), (2, -1)),
        "cyclic axes": ((1, 1), (2, 1), (0, 1)),
        "cyclic axes, the other way": ((2, 1), (0, 1), (1, 1)),
        "x for y": ((1, 1), (0, 1), (2, 1)),
        "a quarter turn about x": ((0, 1), (2, -1), (1, 1)),
    },
}
CASES = [(d, name) for d, worlds in WORLDS.items() for name in worlds]


def matrix(dimension: int, world: str) -> Array:
    q = np.zeros((dimension, dimension))
    for k, (axis, sign) in enumerate(WORLDS[dimension][world]):
        q[k, axis] = sign
    return q


def packing(dimension: int) -> tuple[Array, Array]:
    """Return centres and radii of a packing far from zero; two grains have mirror images."""
    upper = (0.8, 0.5) if dimension == 2 else (0.3, 0.2, 0.25)
    lower = (0.0,) * dimension
    found = GrainPacking(
        lower=lower, upper=upper, radius=(0.02, 0.04), fraction=0.5 if dimension == 2 else 0.35
    )
    centres, radii = found.place(dimension)
    return centres + 1.0, radii


@pytest.mark.parametrize(("dimension", "world"), CASES)
def test_grains_of_another_world_are_those_of_this_one_moved(dimension: int, world: str) -> None:
    """Coordinates of some metres, turned by angles of up to ten turns: a few dozen roundings."""
    centres, radii = packing(dimension)
    q = matrix(dimension, world)
    here, there = build(sand(centres, radii)), build(sand(centres @ q.T, radii))
    assert len(here) > 30
    for one, other in zip(here, there, strict=True):
        assert apart(one.positions @ q.T, other.positions) < 1e-13


@pytest.mark.parametrize(("dimension", "world"), CASES)
def test_bodies_of_another_world_are_those_of_this_one_moved(dimension: int, world: str) -> None:
    q = matrix(dimension, world)
    # A cylinder's or tube's axis goes with the world.
    names = ["xyz"[int(np.abs(q[:, k]).argmax())] for k in range(dimension)]
    for shape in shapes_of(5.0):
        if len(shape.bounds()[0]) != dimension:
            continue
        moved: dict[str, Any] = {"centre": tuple((q @ np.array(shape.centre)).tolist())}  # type: ignore[attr-defined]
        if hasattr(shape, "axis"):
            moved["axis"] = names["xyz".index(shape.axis)]
        other = shape.model_copy(update=moved)
        assert apart(shell_points(shape, 1.0) @ q.T, shell_points(other, 1.0)) < 1e-13


@pytest.mark.parametrize("dimension", [2, 3])
def test_grains_are_the_same_in_whatever_groups_they_are_made(dimension: int) -> None:
    """Ranks make their own, and each some at a time: to the last bit."""
    spinning = Grains(
        material="m",
        file=GrainCentres(*packing(dimension)),
        fill="shells",
        velocity=[{"expression": "sin(50 * r)"}, *(0.0,) * (dimension - 1)],
        angular_velocity=3.0 if dimension == 2 else [1.0, 2.0, 3.0],
    )
    part = build(case_of({}, {"sand": spinning})).parts["sand"]
    whole, shared = part.make(0, len(part.names)), part.share(0, len(part.names))
    single = [part.make(k, k + 1) for k in range(len(part.names))]
    for name in ("positions", "velocities", "volumes"):
        one_by_one = np.concatenate([getattr(one, name) for one in single])
        assert np.array_equal(getattr(whole, name), one_by_one)
        assert np.array_equal(getattr(whole, name), getattr(shared, name))


@pytest.mark.parametrize("dimension", [2, 3])
def test_numbers_of_grains_and_the_place_of_the_whole_do_not_matter(dimension: int) -> None:
    centres, radii = packing(dimension)
    here = build(sand(centres, radii))
    order = np.random.default_rng(2).permutation(len(radii))
    renumbered = build(sand(centres[order], radii[order]))
    for k, one in zip(order, renumbered, strict=True):
        assert np.array_equal(one.positions, here[k].positions)
    shift = 0.01 * np.array([300, -500, 700])[:dimension]  # Whole cells.
    for one, other in zip(here, build(sand(centres + shift, radii)), strict=True):
        assert np.abs(one.positions + shift - other.positions).max() < 1e-13


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_grain_has_exact_moments_however_it_is_turned(dimension: int) -> None:
    centres, radii = packing(dimension)
    for k, grain in enumerate(build(sand(centres, radii))):
        kind = Disc if dimension == 2 else Sphere
        shape = kind(centre=tuple(centres[k]), radius=radii[k])
        assert abs(grain.mass / (1000.0 * shape.volume()) - 1.0) < 1e-12
        arms = grain.positions - centres[k]
        assert np.abs(arms.mean(axis=0)).max() < 1e-12 * radii[k]
        exact = second_moments(shape)
        found = arms.T @ arms * grain.volumes[0]
        assert np.abs(found - exact).max() < 1e-12 * exact.max()


def test_a_packing_has_no_direction() -> None:
    """Angles of 765 discs, and of touching ones to each other, as random numbers would have them.

    A disc is the same after a quarter turn, so the angles times four are looked at.
    """
    found = GrainPacking(lower=(0, 0), upper=(60, 40), radius=(0.5, 1.0), fraction=0.6)
    centres, radii = found.place(2)
    turns = orientations(centres, radii)
    angles = 4.0 * np.arctan2(turns[:, 1, 0], turns[:, 0, 0])
    waves = np.exp(1j * angles)
    assert abs(waves.mean()) < 3.0 / math.sqrt(len(radii))
    a, b = near_pairs(centres, 2.0)
    touch = np.linalg.norm(centres[a] - centres[b], axis=1) < 1.15 * (radii[a] + radii[b])
    pairs = int(touch.sum())
    assert pairs > 1000
    assert abs((waves[a] * waves[b].conj())[touch].mean()) < 3.0 / math.sqrt(pairs)


def test_grains_on_axes_of_symmetry_are_not_turned() -> None:
    row = np.array([[0.05 * k, 0.3, 0.2] for k in range(10)])
    assert np.abs(orientations(row, np.full(10, 0.025)) - np.eye(3)).max() < 1e-12
    assert np.array_equal(orientations(row[:1], np.array([0.025])), np.eye(3)[None])


def test_the_load_on_a_round_side_is_even_and_symmetric() -> None:
    shape = Ring(centre=(0.0, 0.0), inner_radius=0.2, outer_radius=0.3)
    for side, radius in (("outer", 0.3), ("inner", 0.2)):
        load = {"l": {"body": "b", "side": side, "pressure": 1.0}}
        case = case_of({"b": body(shape, spacing=0.02)}, load=load)
        [ring] = build(case)
        found = pieces(case, "l", ring.positions, ring.spacing)
        places = ring.positions[found.particles]
        away = np.linalg.norm(places, axis=1)
        assert np.ptp(away) < 1e-12  # All of one circle ...
        assert len(away) == (np.abs(np.linalg.norm(ring.positions, axis=1) - away[0]) < 1e-9).sum()
        assert found.area == pytest.approx(2 * math.pi * radius, rel=1e-12)
        assert found.sizes.max() / found.sizes.min() < 1.03  # 64 points for each, or one more
        mirror = cKDTree(places).query(places * (-1, 1))[1]
        assert np.abs(found.sizes - found.sizes[mirror]).max() < 1e-12 * found.area


def test_what_check_says() -> None:
    shape = Disc(centre=FLAT, radius=0.05)
    case = case_of({"disc": body(shape)})
    filled = build(case)
    [disc] = filled
    shown = echo(case, filled)
    assert (
        "708 particles 0.003333 m apart in shells, m, mass 7.85398 kg per metre, +0.000%" in shown
    )
    assert (disc.fill, disc.mass_error) == ("shells", pytest.approx(0.0, abs=1e-14))


MISTAKES: list[tuple[dict[str, Any], str]] = [
    (
        {"shape": Box(lower=(0, 0), upper=(1, 1)), "fill": "shells"},
        'fill = "shells" is for a disc, ring, sphere, cylinder or tube, and the shape is a box',
    ),
    (
        {
            "shape": Disc(centre=(0, 0), radius=1) - Disc(centre=(1, 0), radius=1),
            "fill": "shells",
        },
        "the shape is a difference; write",
    ),
    ({"shape": Disc(centre=(0, 0), radius=1), "fill": "shell"}, "is not a known choice"),
]


@pytest.mark.parametrize(("keys", "words"), MISTAKES)
def test_a_mistake_is_a_sentence(keys: dict[str, Any], words: str) -> None:
    with pytest.raises(CaseError) as caught:
        Body(material="m", **keys)
    assert words in str(caught.value)


def test_a_shape_thinner_than_half_a_spacing_is_refused() -> None:
    thin = (
        Disc(centre=(0, 0), radius=0.49),
        Ring(centre=(0, 0), inner_radius=3.0, outer_radius=3.4),
        Sphere(centre=(0, 0, 0), radius=0.49),
        Cylinder(centre=(0, 0, 0), radius=3.0, height=0.49),
    )
    for shape in thin:
        grid = Grid(dimension=len(shape.centre), cell_size=1.0)
        with pytest.raises(CaseError, match="holds no particle"):
            fill(body(shape, spacing=1.0), grid)
    with pytest.raises(CaseError, match=r"grains\.sand\.file has a grain .* holds no particle"):
        build(sand(np.zeros((1, 2)), np.array([0.001])))
    with pytest.raises(CaseError, match="would need some"):
        large = Sphere(centre=(0, 0, 0), radius=1e6)
        fill(body(large, spacing=1.0), Grid(dimension=3, cell_size=1.0))


def test_align_goes_with_a_lattice_only() -> None:
    given = GrainCentres([[0, 0], [0.01, 0]], [2e-3, 2e-3])
    with pytest.raises(CaseError, match=r'align = "grid" goes with fill = "lattice" only'):
        Grains(material="m", file=given, align="grid", fill="shells")
    assert Grains(material="m", file=given, align="grid").filled_by() == "lattice"


def test_counts_that_are_told_before_filling() -> None:
    radii = [1.0, 2.5, 5.0, 10.0]
    for dimension, kind in ((2, Disc), (3, Sphere)):
        zero = (0.0,) * dimension
        filled = sum(len(shell_points(kind(centre=zero, radius=r), 1.0)) for r in radii)
        assert ball_count(radii, dimension, 1.0) == pytest.approx(filled, rel=0.1)
    assert not takes_shells(Box(lower=(0, 0), upper=(1, 1)))


def volumes_of(filled: list[FilledBody]) -> set[float]:
    return {float(x) for grain in filled for x in np.unique(grain.volumes)}


def test_grains_of_one_size_have_one_volume() -> None:
    centres = np.array([[0.0, 0.0], [0.1, 0.03], [0.23, 0.01]])
    assert len(volumes_of(build(sand(centres, np.full(3, 0.04))))) == 1
