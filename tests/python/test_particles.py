# SPDX-License-Identifier: BSD-3-Clause
"""Bodies given particle by particle: the file, its mistakes, and what becomes of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mpm3dpp import Body, Case, CaseError, Particles, Simulation, load_case
from mpm3dpp.case.particles import read_particles, write_particles
from mpm3dpp.fill.build import build
from mpm3dpp.plots import preview
from mpm3dpp.run.summary import echo

CASE = """\
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 us"
[material.steel]
density = "8000 kg/m^3"
strength = { elastic = { E = "200 GPa", nu = 0.3 } }
[body.rod]
material = "steel"
particles = "rod.csv"
velocity = [1, 0]
"""
ROD = "x [m],y [m],volume [m^2]\n0.0001,0.0001,4e-8\n0.0003,0.0001,4e-8\n0.0006,0.0001,1e-7\n"


def write(folder: Path, points: str, case: str = CASE) -> Path:
    (folder / "rod.csv").write_text(points)
    path = folder / "case.toml"
    path.write_text(case)
    return path


def test_masses_positions_and_check(tmp_path: Path) -> None:
    case = load_case(write(tmp_path, ROD))
    [body] = build(case)
    assert body.mass == pytest.approx(8000 * 1.8e-7, rel=1e-14)
    assert body.shape_volume is None
    assert body.spacing == pytest.approx(np.sqrt(6e-8), rel=1e-14)
    simulation = Simulation(case, threads=1)
    assert np.array_equal(simulation.column("rod", "volume").ravel(), [4e-8, 4e-8, 1e-7])
    assert np.array_equal(simulation.column("rod", "position")[:, 0], [1e-4, 3e-4, 6e-4])
    assert "given one by one" in echo(case, build(case))
    assert preview(case, tmp_path / "rod.png").exists()


def test_the_spin_is_about_the_mass_centre(tmp_path: Path) -> None:
    case = load_case(write(tmp_path, ROD, CASE + "angular_velocity = 100\n"))
    simulation = Simulation(case, threads=1)
    m, v = (simulation.column("rod", name) for name in ("mass", "velocity"))
    assert (m.ravel() @ v / m.sum()).tolist() == pytest.approx([1.0, 0.0], abs=1e-12)


def test_without_volumes_they_are_squares_of_the_spacing(tmp_path: Path) -> None:
    text = CASE + 'spacing = "0.2 mm"\n'
    case = load_case(write(tmp_path, "# made by hand\nx,y\n\n1e-4,1e-4\n3e-4,1e-4\n", text))
    [body] = build(case)
    assert body.volumes.tolist() == pytest.approx([4e-8, 4e-8])


def test_the_hash_is_that_of_the_content(tmp_path: Path) -> None:
    case = load_case(write(tmp_path, ROD))
    other = CASE.replace("rod.csv", "other.csv")
    (tmp_path / "other.csv").write_text(ROD.replace("0.0006", "6e-4"))
    assert load_case(write(tmp_path, ROD, other)).case_hash == case.case_hash
    (tmp_path / "other.csv").write_text(ROD.replace("0.0006", "0.00061"))
    assert load_case(write(tmp_path, ROD, other)).case_hash != case.case_hash
    arrays = read_particles(tmp_path / "rod.csv")
    tables = case.table()
    assert tables["body"]["rod"]["particles"] == "rod.csv"
    tables["body"]["rod"]["particles"] = Particles(arrays.positions, arrays.volumes)
    assert Case(**tables).case_hash == case.case_hash


@pytest.mark.parametrize(
    ("points", "part"),
    [
        ("", "is empty"),
        ("x,y\n", "holds no particle"),
        ("x,z\n1,2\n", "must name its columns"),
        ("0.1,0.2\n0.3,0.4\n", "must name its columns"),
        ("x [mm],y [mm]\n1,2\n", "gives x in [mm] in line 1 but must be in m"),
        ("# note\nx,y\n1,2\n\n1,2,3\n", "has 3 numbers in line 5 but 2 columns"),
        ("x,y\n1,2\n1,two\n", 'has "two" in line 3, which is no number'),
        ("x,y\n1,2\n1,nan\n", "must have finite numbers, in line 3"),
        ("x,y,volume\n1,2,3\n1,2,0\n", "must have a volume > 0, in line 3"),
        ("x,y,z\n1,2,3\n", "must have 2 coordinates"),
        ("x,y,vx\n1,2,3\n", "or with vx,vy,vz behind them (in 2D without z)"),
        ("x,y,vx,vy,volume\n1,2,3,4,5\n", "must name its columns"),
        ("x,y,vx [mm/s],vy\n1,2,3,4\n", "gives vx in [mm/s] in line 1 but must be in m/s"),
        ("x,y,vx,vy\n1,2,3,4\n1,2,inf,4\n", "must have finite numbers, in line 3"),
        (b"\xff\xfe", "cannot be read as a text file"),
        (None, "is not a file"),
    ],
)
def test_a_bad_file_is_one_sentence(tmp_path: Path, points: str | bytes | None, part: str) -> None:
    path = write(tmp_path, "")
    if points is None:
        (tmp_path / "rod.csv").unlink()
    else:
        data = points.encode() if isinstance(points, str) else points
        (tmp_path / "rod.csv").write_bytes(data)
    with pytest.raises(CaseError) as caught:
        load_case(path)
    sentence = str(caught.value)
    assert sentence.startswith(f'{path}:11: body.rod.particles = "rod.csv" ')
    assert part in sentence and "\n" not in sentence


@pytest.mark.parametrize(
    ("extra", "part"),
    [
        ("shape = { disc = { centre = [0, 0], radius = 1 } }\n", "together with shape"),
        ("particles_per_cell = 2\n", "together with particles that have volumes"),
        ("spacing = 1\n", "together with particles that have volumes"),
    ],
)
def test_one_of_two_keys(tmp_path: Path, extra: str, part: str) -> None:
    with pytest.raises(CaseError, match=part):
        load_case(write(tmp_path, ROD, CASE + extra))


def test_neither_key() -> None:
    with pytest.raises(CaseError, match="shape is missing; add this key, or particles"):
        Body(material="steel")


def test_outside_the_box(tmp_path: Path) -> None:
    box = 'box = { lower = [0, 0], upper = ["1 mm", "1 mm"] }\n[run]'
    text = CASE.replace("[run]", box)
    with pytest.raises(CaseError, match="particles reaches out of"):
        build(load_case(write(tmp_path, ROD.replace("0.0006", "0.0016"), text)))


@pytest.mark.parametrize(
    ("positions", "volumes", "part"),
    [
        ([1.0, 2.0], None, "shape"),
        (np.zeros((0, 3)), None, "a particle at least"),
        ([[1.0, np.inf]], None, "finite"),
        ([[1.0, 2.0]], [-1.0], "volume > 0"),
        ([[1.0, 2.0]], [1.0, 2.0], "one number for each"),
    ],
)
def test_bad_arrays(positions: object, volumes: object, part: str) -> None:
    with pytest.raises(CaseError, match=part):
        Particles(positions, volumes)


@pytest.mark.parametrize(
    ("velocities", "part"),
    [([1.0, 2.0], "the shape of the positions, (1, 2)"), ([[1.0, np.nan]], "finite")],
)
def test_bad_velocities(velocities: object, part: str) -> None:
    with pytest.raises(CaseError) as caught:
        Particles([[1.0, 2.0]], None, velocities)
    assert part in str(caught.value)


def test_velocities_of_a_file(tmp_path: Path) -> None:
    """In m/s, whatever the unit of lengths; with volumes or without; they count in the hash."""
    text = CASE.replace("velocity = [1, 0]\n", 'frame = "updated"\n')
    millimetres = text.replace('"rod.csv"', '{ file = "rod.csv", unit = "mm" }')
    cases = [
        ("x,y,volume,vx,vy\n1e-4,1e-4,4e-8,1,2\n3e-4,1e-4,4e-8,3,-4\n", text),
        ("x [mm],y,volume [mm^2],vx [m/s],vy\n0.1,0.1,0.04,1,2\n0.3,0.1,0.04,3,-4\n", millimetres),
        ("x,y,vx,vy\n1e-4,1e-4,1,2\n3e-4,1e-4,3,-4\n", text + 'spacing = "0.2 mm"\n'),
        ("x,y,volume,vx,vy\n1e-4,1e-4,4e-8,1,2\n3e-4,1e-4,4e-8,3,-5\n", text),
    ]
    hashes = []
    for points, given in cases:
        case = load_case(write(tmp_path, points, given))
        simulation = Simulation(case, threads=1)
        last = -5.0 if "-5" in points else -4.0
        assert simulation.column("rod", "velocity").tolist() == [[1.0, 2.0], [3.0, last]]
        assert simulation.column("rod", "position").tolist() == [[1e-4, 1e-4], [3e-4, 1e-4]]
        hashes.append(case.case_hash)
    assert hashes[0] == hashes[1] and len(set(hashes)) == 3


@pytest.mark.parametrize("key", ["velocity = [1, 0]", "angular_velocity = 2", 'motion = "fixed"'])
def test_velocities_take_the_place_of_keys(tmp_path: Path, key: str) -> None:
    text = CASE.replace("velocity = [1, 0]", key)
    with pytest.raises(CaseError, match="together with particles that have velocities") as caught:
        load_case(write(tmp_path, "x,y,vx,vy\n1,2,3,4\n", text))
    assert caught.value.key == f"body.rod.{key.split(' ')[0]}"


def test_numbers_come_back_to_the_last_bit(tmp_path: Path) -> None:
    random = np.random.default_rng(7)
    given = Particles(
        random.normal(size=(50, 3)) * 1e-3,
        random.uniform(1e-12, 1e-9, 50),
        random.normal(size=(50, 3)),
    )
    write_particles(tmp_path / "p.csv", given, "two\nlines")
    found = read_particles(tmp_path / "p.csv")
    assert found.volumes is not None
    assert np.array_equal(found.positions, given.positions)
    assert np.array_equal(found.volumes, given.volumes)
    assert found.velocities is not None
    assert np.array_equal(found.velocities, given.velocities)
    assert found.digest == given.digest


def lattice(count: int, apart: float, start: float = 0.0) -> str:
    axis = [start + (k + 0.5) * apart for k in range(count)]
    return "x,y\n" + "".join(f"{x!r},{y!r}\n" for x in axis for y in axis)


def warnings_of(path: Path) -> list[str]:
    simulation = Simulation(load_case(path), threads=1)
    told = echo(load_case(path), build(load_case(path))).splitlines()
    assert [line.removeprefix("warning: ") for line in told if "warning: " in line] == (
        simulation.warnings
    )
    return simulation.warnings


def test_a_unit_of_length(tmp_path: Path) -> None:
    table = CASE.replace('"rod.csv"', '{ file = "rod.csv", unit = "mm" }')
    text = "x [mm],y [mm],volume [mm^2]\n0.1,0.1,0.04\n0.3,0.1,0.04\n0.6,0.1,0.1\n"
    case, metres = load_case(write(tmp_path, text, table)), load_case(write(tmp_path, ROD))
    assert case.body["rod"].particles is not None
    assert case.table()["body"]["rod"]["particles"] == {"file": "rod.csv", "unit": "mm"}
    again = load_case(write(tmp_path, text.replace(" [mm]", "").replace(" [mm^2]", ""), table))
    assert case.case_hash == again.case_hash == metres.case_hash
    particles = case.body["rod"].particles
    assert particles.positions[:, 0].tolist() == [0.0001, 0.0003, 0.0006]
    assert particles.volumes == pytest.approx([4e-8, 4e-8, 1e-7], rel=1e-15)


@pytest.mark.parametrize(
    ("table", "key", "part"),
    [
        ('{ file = "rod.csv", unit = "kg" }', "particles.unit", "is no unit of length"),
        ('{ file = "rod.csv", unit = 3 }', "particles.unit", "must be text"),
        ('{ file = "rod.csv", units = "mm" }', "particles.units", 'did you mean "unit"?'),
        ('{ unit = "mm" }', "particles.file", "is missing"),
        ('{ file = "rod.csv", unit = "mm" }', "particles", "gives x in [m] in line 1 but must be"),
    ],
)
def test_a_wrong_unit_of_length(tmp_path: Path, table: str, key: str, part: str) -> None:
    with pytest.raises(CaseError) as caught:
        load_case(write(tmp_path, ROD, CASE.replace('"rod.csv"', table)))
    assert f":11: body.rod.{key}" in str(caught.value) and part in str(caught.value)


def test_points_that_fit_are_not_warned_of(tmp_path: Path) -> None:
    path = write(tmp_path, lattice(20, 0.5e-3), CASE + "particles_per_cell = 2\n")
    assert warnings_of(path) == []


@pytest.mark.parametrize(
    ("points", "more", "part"),
    [
        (lattice(20, 2e-3), 'spacing = "2 mm"\n', "0.002 m apart, 2 cells"),
        (lattice(20, 5e-5), 'spacing = "0.05 mm"\n', "5e-05 m apart, 20 in a cell"),
        (lattice(20, 0.5e-3), 'spacing = "0.1 mm"\n', "cubes with edges of 0.0001 m"),
        (lattice(20, 0.5e-3) + "0.00125,0.00075\n", "", "1 stand where another one does, the first "
         "of them number 401 where number 42 is"),
    ],
)  # fmt: skip
def test_points_that_are_hardly_meant(tmp_path: Path, points: str, more: str, part: str) -> None:
    [sentence] = warnings_of(write(tmp_path, points, CASE + more))
    assert sentence.startswith("body.rod: its points") and part in sentence


def test_points_inside_another_body(tmp_path: Path) -> None:
    disc = (
        '[body.disc]\nmaterial = "steel"\n'
        'shape = { disc = { centre = ["14.25 mm", "5.25 mm"], radius = "5 mm" } }\n'
        'fill = "lattice"\nparticles_per_cell = 2\n'
    )
    # Half-way between the disc's particles, which stand at multiples of half a millimetre + 0.25.
    path = write(tmp_path, lattice(20, 0.5e-3, 0.25e-3), CASE + disc)
    [sentence] = warnings_of(path)
    assert "of its points stand inside body.disc" in sentence
    grains = (
        '[grains.sand]\nmaterial = "steel"\nlattice = { lower = ["9.25 mm", "0.25 mm"], '
        'count = [1, 1], radius = "5 mm" }\nparticles_per_cell = 2\n'
    )
    [sentence] = warnings_of(write(tmp_path, lattice(20, 0.5e-3), CASE + grains))
    assert "of its points stand inside grains.sand" in sentence
