# SPDX-License-Identifier: BSD-3-Clause
"""What `check` tells that is perhaps not meant, and what it says of what other programs have."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from commands import CASE, mpm3dpp, one_sentence, write
from mpm3dpp import CaseError, load_case, open_results
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build
from mpm3dpp.importers import import_file, load_any
from mpm3dpp.plots.paint import default_colour

STL = b"solid cube\nfacet normal 0 0 1\n outer loop\n"
OTHERS = {
    "cube.stl": (STL, "is an STL surface"),
    "binary.stl": (b"\0" * 80 + struct.pack("<I", 2) + b"\1" * 100, "is an STL surface, in binary"),
    "crash.k": (b"$# made by a program\n*KEYWORD\n*NODE\n", 'LS-DYNA, as its line "*KEYWORD"'),
    "part.k": (b"*NODE\n$   nid    x\n       1  0.0\n", "LS-DYNA"),
    "beam.inp": (b"** a beam\n*Heading\n*Node\n1, 0., 0.\n", "Abaqus"),
    "tube_0000.rad": (b"#RADIOSS STARTER\n/BEGIN\ntube\n", "Radioss"),
    "part.msh": (b"$MeshFormat\n4.1 0 8\n", "a mesh of Gmsh"),
    "disks.fmcmd": (b'Title "Disks"\nName "D"\nHeader\nAnalysis "2D MPM"\n', "NairnMPM"),
    "disks.mpm": (b"<?xml version='1.0'?>\n<JANFEAInput version='3'>\n", "NairnMPM"),
    "discs.mpm": (b"E = 211\n# impact\nmethod(tlmpm, FLIP)\n", "Karamelo"),
    "mpm.json": (b'{\n "title": "column",\n "mesh": { "mesh": "mesh.txt" }\n}\n', "CB-Geo"),
    "points.ply": (b"ply\nformat ascii 1.0\n", "a PLY surface"),
    "old.vtk": (b"# vtk DataFile Version 3.0\nx\nASCII\n", "a VTK file"),
}


@pytest.mark.parametrize("name", OTHERS)
def test_a_file_of_another_program_is_named(tmp_path: Path, name: str) -> None:
    """Given to run, import, or as the points of a body."""
    content, words = OTHERS[name]
    (tmp_path / name).write_bytes(content)
    for read in (load_any, import_file):
        with pytest.raises(CaseError) as caught:
            read(tmp_path / name)
        assert words in caught.value.rule and caught.value.place == str(tmp_path / name)
        assert "points.csv" in caught.value.remedy
    shape = 'shape = { box = { lower = ["0 mm", "0 mm"], upper = ["50 mm", "50 mm"] } }'
    case = write(tmp_path, CASE.replace(shape, f'particles = "{name}"', 1))
    with pytest.raises(
        CaseError, match=r"case.toml:15: body.left.particles = .* is an? .* of particles"
    ):
        load_case(case)


def test_the_command_names_it_in_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "crash.k").write_bytes(OTHERS["crash.k"][0])
    for command in ("run", "check", "import"):
        done = mpm3dpp(command, "crash.k", cwd=tmp_path)
        assert done.returncode == 2
        assert "is an input file of LS-DYNA" in one_sentence(done.stderr)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        (
            "dimension = 2",
            'dimension = 2\nunits = "mm"',
            "grid.units is not in this version; write",
        ),
        ("dimension = 2", "dimension = 2\nperiodic = true", "grid.periodic is not in this version"),
        ("dimension = 2", "dimension = 2\naxisymmetric = true", "compute a quarter in 3D"),
        ("cfl = 0.3", "cfl = 0.3\nplane_stress = true", "2D is plane strain"),
        ('velocity = ["5 m/s"', 'rotation = 30\nvelocity = ["5 m/s"', "turn the shape"),
        ("[grid]", 'include = "other.toml"\n[grid]', "include is not in this version"),
        ("cfl = 0.3", "cfl = 0.3\nthreads = 4", "an option of the command"),
        ("cfl = 0.3", "cfl = 0.3\ngravty = [0, 0]", 'is not a known key; did you mean "gravity"?'),
    ],
)
def test_keys_that_others_have_tell_what_to_do(
    tmp_path: Path, old: str, new: str, words: str
) -> None:
    with pytest.raises(CaseError) as caught:
        load_case(write(tmp_path, CASE.replace(old, new, 1)))
    assert words in str(caught.value)


BALL = """\
[grid]
dimension = 2
cell_size = "10 mm"
box = { lower = [0, 0], upper = [1, 1], walls = { x_min = "symmetry" } }
[run]
end_time = "1 ms"
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.ball]
material = "soft"
shape = { disc = { centre = [0, 0.5], radius = "100 mm" } }
"""


def test_a_ball_across_a_plane_of_symmetry_may_be_cut(tmp_path: Path) -> None:
    cut = "leave out what lies beyond with cut_at_box = true"
    with pytest.raises(CaseError, match=f"move the shape, {cut}, or enlarge the box"):
        build(load_case(write(tmp_path, BALL)))
    build(load_case(write(tmp_path, BALL + "cut_at_box = true\n")))
    shells = BALL + 'fill = "shells"\n'
    with pytest.raises(CaseError, match=f'{cut} and fill = "lattice", or enlarge'):
        build(load_case(write(tmp_path, shells)))
    build(load_case(write(tmp_path, BALL + 'fill = "lattice"\ncut_at_box = true\n')))
    outside = BALL.replace("centre = [0, 0.5]", "centre = [-0.5, 0.5]")
    with pytest.raises(CaseError, match="move the shape, or enlarge the box"):
        build(load_case(write(tmp_path, outside)))


def told(folder: Path, text: str) -> list[str]:
    case = load_case(write(folder, text))
    return notes(case, build(case))


PLASTIC = CASE.replace("elastic = { E", 'j2 = { Y0 = "5 kPa", E')
GAS = """\
strength = { fluid = {} }
eos = { ideal_gas = { gamma = 1.4, E0 = "200 MJ/m^3" } }
"""
FLUID = CASE.replace('strength = { elastic = { E = "1 MPa", nu = 0.3 } }\n', GAS)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (PLASTIC.replace("5 kPa", "0.001 Pa"), "j2.Y0 is 1e-09 of E = 1e.06 Pa, less than in any"),
        (PLASTIC.replace("5 kPa", "5 GPa"), "j2.Y0 is 5e.03 of E = 1e.06 Pa, more than in any"),
        (CASE + "[probe.a]\npoint = [30, 0]\n", "probe.a.point is 29.89 m from the particles"),
        (CASE + "[probe.a]\nparticle = [0, 20]\n", "probe.a.particle is 19.94 m from .* follows"),
        (
            CASE + "[probe.a]\nregion = { lower = [9, 9], upper = [10, 10] }\n",
            "probe.a.region is 12.61 m from .* may see nothing",
        ),
        (CASE.replace("frames = 4", "frames = 100000"), "asks for 100,000 frames in about"),
        (CASE.replace("frames = 4", 'interval = "1 us"'), "output.interval asks for 8,000 frames"),
        (FLUID.replace("frames = 4", 'picture = "von_mises"'), "do not bear: the picture has one"),
    ],
)
def test_notes(tmp_path: Path, text: str, words: str) -> None:
    import re

    found = told(tmp_path, text)
    assert [note for note in found if re.search(words, note)], found


def test_what_is_meant_is_not_noted(tmp_path: Path) -> None:
    near = '[probe.a]\npoint = ["80 mm", "140 mm"]\n[probe.b]\nparticle = [0, 0]\n'
    assert told(tmp_path, PLASTIC + near) == told(tmp_path, CASE) == []
    assert not [note for note in told(tmp_path, FLUID) if "picture" in note]


def test_the_picture_of_a_fluid_is_of_its_pressure(tmp_path: Path) -> None:
    """By the case, by the frames alone, and not where a solid is there too."""
    path = write(tmp_path, FLUID.replace("8 ms", "0.5 ms"))
    case = load_case(path)
    assert case.output.picture == "pressure"
    assert load_case(write(tmp_path)).output.picture == "von_mises"
    both = (
        FLUID + "[material.hard]\ndensity = 2000\nstrength = { elastic = { E = 1e6, nu = 0.3 } }\n"
    )
    both += (
        '[body.third]\nmaterial = "hard"\nshape = { disc = { centre = [1, 1], radius = 0.05 } }\n'
    )
    assert load_case(write(tmp_path, both)).output.picture == "von_mises"
    path = write(tmp_path, FLUID.replace("8 ms", "0.5 ms"))
    done = mpm3dpp("run", path, "--out", "out", "--threads", 1, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    (tmp_path / "out" / "manifest.json").unlink()
    with open_results(tmp_path / "out") as results:
        assert default_colour(results) == "pressure"
