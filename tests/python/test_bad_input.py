# SPDX-License-Identifier: BSD-3-Clause
"""Every mistake of a user is one sentence with key, line, rule and remedy, and exit code 2."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from commands import mpm3dpp
from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.case import load_case
from mpm3dpp.fill.build import build
from mpm3dpp.importers import load_any

GOOD = """\
title = "Two discs"
[grid]
dimension = 2
cell_size = "1 mm"
box = { lower = ["0 mm", "0 mm"], upper = ["40 mm", "20 mm"], walls = "free" }
[run]
scheme = "musl"
end_time = "1 ms"
cfl = 0.5
gravity = ["0 m/s^2", "-9.81 m/s^2"]
[output]
frames = 10
[contact]
detection = "gap"
friction = 0.1
[[contact.pair]]
bodies = ["left", "right"]
friction = 0.3
[material.rubber]
density = "1010 kg/m^3"
strength = { elastic = { E = "10 MPa", nu = 0.3 } }
[body.left]
material = "rubber"
shape = { disc = { centre = ["10 mm", "10 mm"], radius = "5 mm" } }
particles_per_cell = 2
velocity = ["3 m/s", "0 m/s"]
[body.right]
material = "rubber"
shape = { ring = { centre = ["30 mm", "10 mm"], inner_radius = "3 mm", outer_radius = "6 mm" } }
velocity = ["-3 m/s", "0 m/s"]
"""
RUN = GOOD[GOOD.index("[run]") : GOOD.index("[output]")]
BODIES = GOOD[GOOD.index("[body.left]") :]
BOX = GOOD[GOOD.index("box = ") : GOOD.index("[run]")]
CELL, END, DENSITY = 'cell_size = "1 mm"', 'end_time = "1 ms"', 'density = "1010 kg/m^3"'
DISC = '{ disc = { centre = ["10 mm", "10 mm"], radius = "5 mm" } }'
RING = '{ ring = { centre = ["30 mm", "10 mm"], inner_radius = "3 mm", outer_radius = "6 mm" } }'
MODEL = '{ elastic = { E = "10 MPa", nu = 0.3 } }'
JOHNSON_COOK = (
    "{ johnson_cook = { E = 1e9, nu = 0.3, A = 1e6, B = 1e6, n = 0.3, C = 0, m = 1, cp = 400, "
    "T_melt = 280 } }"
)
LEFT, ELASTIC = "body.left.shape", "material.rubber.strength.elastic"

# What is wrong: (name, text of the good case, what replaces it, the key that is named, part of the
# rule, part of the remedy, and, unless it is the first line of the replacement, the line named).
# fmt: off
EDITS: list[tuple[str, ...]] = [
    ("unknown key", DENSITY, "densty = 1", "material.rubber.densty", "known key", '"density"'),
    ("unknown table", "[output]", "[outptu]", "outptu", "known key", '"output"'),
    ("unknown key of a shape", 'radius = "5 mm" }', "raduis = 1 }", f"{LEFT}.disc.raduis",
     "known key", '"radius"', "raduis"),
    ("unknown key in a list of tables", "friction = 0.3", "frction = 0.3",
     "contact.pair[0].frction", "known key", '"friction"'),
    ("missing key", DENSITY, "", "material.rubber.density", "is missing", "add",
     "[material.rubber]"),
    ("missing table", RUN, "", "run", "is missing", "add", "title"),
    ("unit of another dimension", CELL, 'cell_size = "1 kg"', "grid.cell_size",
     'unit "kg" (a mass) but must be a length', '"30 mm"'),
    ("unknown unit", CELL, 'cell_size = "1 milimetr"', "grid.cell_size", "not known", "give"),
    ("no unit in text", CELL, 'cell_size = "1"', "grid.cell_size", "has no unit", "give"),
    ("unit where none belongs", "friction = 0.1", 'friction = "0.1 m"', "contact.friction",
     "must be a plain number", "without a unit"),
    ("text for a number", CELL, 'cell_size = "fine"', "grid.cell_size", "a length", '"30 mm"'),
    ("truth for a number", CELL, "cell_size = true", "grid.cell_size", "a length", "give"),
    ("table for a number", CELL, "cell_size = {}", "grid.cell_size", "a length", "give"),
    ("number for a table", "[output]\nframes = 10", "[material]\noutput = 3", "material.output",
     "must be a table", "write it as", "output = 3"),
    ("number for text", 'title = "Two discs"', "title = 2", "title", "must be text", "give text"),
    ("half a particle", "particles_per_cell = 2", "particles_per_cell = 2.5",
     "body.left.particles_per_cell", "whole number", "give"),
    ("no particles per cell", "particles_per_cell = 2", "particles_per_cell = 0",
     "body.left.particles_per_cell", ">= 1", "give"),
    ("zero cell size", CELL, 'cell_size = "0 mm"', "grid.cell_size", "must be > 0", "give"),
    ("nan", CELL, "cell_size = nan", "grid.cell_size", "must be finite", "give"),
    ("inf", END, "end_time = inf", "run.end_time", "must be finite", "give"),
    ("nan with a unit", END, 'end_time = "nan s"', "run.end_time", "must be finite", "give"),
    ("absurd size", END, "end_time = 1e300", "run.end_time", "must be zero or between", "give"),
    ("zero end time", END, "end_time = 0", "run.end_time", "must be > 0", "give"),
    ("negative end time", END, 'end_time = "-1 ms"', "run.end_time", "must be > 0", "give"),
    ("time step factor above one", "cfl = 0.5", "cfl = 1.5",
     "run.cfl", "0 < f <= 1", "give"),
    ("unknown scheme", 'scheme = "musl"', 'scheme = "mussl"', "run.scheme", "known choice",
     '"musl"'),
    ("unknown wall", 'walls = "free"', 'walls = "fixd"', "grid.box.walls", "known choice",
     '"fixed"', "fixd"),
    ("unknown detection", 'detection = "gap"', 'detection = "gaps"', "contact.detection",
     "known choice", '"gap"'),
    ("unknown dimension", "dimension = 2", "dimension = 4", "grid.dimension", "<= 3", "at most 3"),
    ("wall of a third axis", 'walls = "free"', 'walls = { z_min = "fixed" }', "grid.box.walls",
     "2D", "remove", "z_min"),
    ("box of no whole cells", '"40 mm"', '"40.3 mm"', "grid.box.upper[0]",
     "whole number of cells", "0.04 m", "40.3"),
    ("box upside down", '"40 mm"', '"-40 mm"', "grid.box.upper[0]", "must be > lower", "swap",
     "-40"),
    ("origin off the box", CELL, CELL + "\norigin = [0.0003, 0]", "grid.origin[0]",
     "whole number of cells", "leave it out", "origin"),
    ("vector of three in 2D", '"-9.81 m/s^2"]', '"-9.81 m/s^2", 0]', "run.gravity",
     "must have 2 numbers", "give 2", "gravity"),
    ("vector of one", '["3 m/s", "0 m/s"]', "[3]", "body.left.velocity", "two numbers in 2D",
     "list such as", "velocity = [3]"),
    ("wrong unit in a vector", '"3 m/s"', '"3 m"', "body.left.velocity[0]", "a velocity", "give",
     '"3 m"'),
    ("spin of three in 2D", "particles_per_cell = 2", "angular_velocity = [0, 0, 1]",
     "body.left.angular_velocity", "must be one number", "10 rad/s"),
    ("sphere in 2D", "{ disc =", "{ sphere =", f"{LEFT}.sphere", "is a 3D shape", "use disc",
     "sphere"),
    ("nested sphere in 2D", DISC, f"{{ union = [{DISC}, {{ sphere = {{ centre = [0, 0, 0], "
     "radius = 1 } }] }", f"{LEFT}.union[1].sphere", "is a 3D shape", "use disc", "union"),
    ("centre of three in 2D", '["10 mm", "10 mm"]', "[0.01, 0.01, 0]", f"{LEFT}.disc.centre",
     "must have 2 numbers", "give 2", "0.01, 0.01, 0"),
    ("inner radius too large", 'inner_radius = "3 mm"', 'inner_radius = "6 mm"',
     "body.right.shape.ring.inner_radius", "must be < outer_radius", "radii", '= "6 mm", outer'),
    ("zero radius", 'radius = "5 mm" }', "radius = 0 }", f"{LEFT}.disc.radius", "must be > 0",
     "give", "radius = 0 }"),
    ("box without size", DISC, "{ box = { centre = [0.01, 0.01], size = [0.01, 0] } }",
     f"{LEFT}.box.size", "must be > 0 in every", "larger size", "box = { c"),
    ("box by three corners", DISC, "{ box = { centre = [0.01, 0.01], lower = [0, 0] } }",
     f"{LEFT}.box", "two of its four keys", "lower and upper", "box = { c"),
    ("unknown shape", "{ disc =", "{ disk =", f"{LEFT}.disk", "known shape", '"disc"', "disk"),
    ("two shapes", DISC, DISC[:-2] + ", " + RING[2:], LEFT, "exactly one shape", "write",
     "{ disc"),
    ("union of one", DISC, f"{{ union = [{DISC}] }}", f"{LEFT}.union", "at least two", "add",
     "union"),
    ("union of no list", DISC, "{ union = 3 }", f"{LEFT}.union", "list of shapes", "write",
     "union"),
    ("mistake deep in a shape", DISC, f"{{ translate = {{ by = [0, 0], shape = {{ union = [{DISC}, "
     "{ disc = { centre = [0, 0], radius = -1 } }] } } }",
     f"{LEFT}.translate.shape.union[1].disc.radius", "must be > 0", "give", "radius = -1"),
    ("negative density", DENSITY, 'density = "-5 kg/m^3"', "material.rubber.density",
     "must be > 0", '"1000 kg/m^3"'),
    ("incompressible", "nu = 0.3", "nu = 0.5", f"{ELASTIC}.nu", "0.5", "another number such as 0.3",
     "nu = 0.5"),
    ("limit below zero", DENSITY, DENSITY + "\nfailure = { plastic_strain = { limit = -0.3 } }",
     "material.rubber.failure.plastic_strain.limit", "must be > 0", "another number such as 0.3",
     "failure"),
    ("melting below room temperature", MODEL, JOHNSON_COOK,
     "material.rubber.strength.johnson_cook.T_melt",
     "= 280.0 must be > T_room (T_room = 298)", "change one of the two", "T_melt"),
    ("two equations of state", DENSITY, DENSITY + "\neos = { mie_gruneisen = {}, tait = {} }",
     "material.rubber.eos", "exactly one model but has 2", "keep mie_gruneisen or tait", "eos"),
    ("one bracket too few", "[output]", "[detonation]\npoint = [0, 0]\n[output]", "detonation",
     "must be a list of tables", "write [[detonation]]"),
    ("zero stiffness", 'E = "10 MPa"', "E = 0", f"{ELASTIC}.E", "> 0", "give", "E = 0"),
    ("negative stiffness", 'E = "10 MPa"', 'E = "-1 Pa"', f"{ELASTIC}.E", "> 0", "give", "-1 Pa"),
    ("missing parameter", ", nu = 0.3", "", f"{ELASTIC}.nu", "is missing", "Poisson", "elastic"),
    ("unknown parameter", "nu = 0.3", "mu = 0.3", f"{ELASTIC}.mu", "not a parameter", '"nu"',
     "mu = 0.3"),
    ("another model's parameter", "nu = 0.3", 'cohesion = "1 kPa"', f"{ELASTIC}.cohesion",
     "not a parameter", "it belongs to mohr_coulomb; valid here: E, nu"),
    ("unknown model", "{ elastic =", "{ elastc =", "material.rubber.strength.elastc",
     "known strength model", '"elastic"', "elastc"),
    ("two models", MODEL, MODEL[:-2] + ', neo_hookean = { K = "1 Pa", G = "1 Pa" } }',
     "material.rubber.strength", "exactly one model", "keep elastic or neo_hookean", "elastic"),
    ("no model", MODEL, "{}", "material.rubber.strength", "exactly one model", "write",
     "strength"),
    ("unknown material", 'material = "rubber"', 'material = "ruber"', "body.left.material",
     "not a material", '"rubber"'),
    ("columns of one name", "[body.right]", '[body.left_eroded]\nmaterial = "rubber"\nshape = '
     + RING + "\n[body.right]", "body.left_eroded", "has the column body_left_eroded_mass of "
     "history.csv, as left has", "another name"),
    ("no body", BODIES, "[body]", "body", "must not be empty", "[body.NAME]"),
    ("unknown body of a pair", '["left", "right"]', '["left", "rigth"]',
     "contact.pair[0].bodies[1]", "not a body", '"right"', "rigth"),
    ("a pair of one body", '["left", "right"]', '["left", "left"]', "contact.pair[0].bodies",
     "two different bodies", "itself", '["left", "left"]'),
    ("a pair of three", '["left", "right"]', '["left", "right", "left"]',
     "contact.pair[0].bodies", "two names", "give two", "bodies ="),
    ("negative friction", "friction = 0.1", "friction = -0.1", "contact.friction", ">= 0",
     "give"),
    ("two densities of particles", "particles_per_cell = 2",
     'particles_per_cell = 2\nspacing = "1 mm"', "body.left.spacing", "together", "keep one",
     "spacing"),
    ("frames and interval", "frames = 10", "frames = 10\ninterval = 1e-4", "output.interval",
     "together", "keep one", "interval"),
    ("too many frames", "frames = 10", 'interval = "1 ps"', "output.interval", "100000", "longer"),
    ("unknown column", "frames = 10", 'fields = ["volum"]', "output.fields[0]", "column",
     '"volume"'),
    ("unknown picture", "frames = 10", 'picture = "von_mieses"', "output.picture", "column",
     '"von_mises"'),
    ("animation in quotes", "frames = 10", 'animation = "yes"', "output.animation",
     "true or false", "such as true"),
    ("picture of a column not written", "frames = 10", 'picture = "volume"', "output.picture",
     "column", 'add it to output.fields: fields = ["volume"]'),
    ("duplicate key", END, END + "\n" + END, "end_time", "given twice", "keep one"),
    ("duplicate table", "[contact]", "[run]", "[run]", "given twice", "keep one"),
    ("text without quotes", END, "end_time = 1 ms", "end_time = 1 ms", "not valid TOML",
     "quotation marks"),
    ("unfinished text", END, 'end_time = "1 ms', 'end_time = "1 ms', "not valid TOML", "write"),
    ("no particles", 'radius = "5 mm" }', 'radius = "0.1 mm" }', LEFT, "holds no particle",
     "cell_size", '"0.1 mm" }'),
    ("far too coarse", DISC, "{ polygon = { points = [[0.0111, 0.01], [0.0107, 0.0111], "
     "[0.0103, 0.0114]] } }", LEFT, "too coarsely", "cell_size", "0.0103"),
    ("overlapping bodies", '["30 mm", "10 mm"]', '["17 mm", "10 mm"]', "body.right.shape",
     "overlaps body.left", "move one", "17 mm"),
    ("body outside the box", '["10 mm", "10 mm"]', '["4 mm", "10 mm"]', LEFT,
     "out of grid.box", "enlarge", '"4 mm"'),
    ("cell size a million times too small", CELL + "\n" + BOX, 'cell_size = "1 nm"\n', LEFT,
     "would need some", "larger grid.cell_size", "shape = { disc"),
]
# fmt: on
JARGON = re.compile(r"pydantic|validation|valueerror|traceback|input_type|nonetype|ctx", re.I)


def write(folder: Path, edit: tuple[str, ...]) -> tuple[Path, str]:
    """Write the case of a row; return the file and the place that must be named."""
    name, old, new, *_ = edit
    assert old in GOOD, name
    text = GOOD.replace(old, new, 1)
    path = folder / f"{re.sub('[^a-z]+', '_', name.lower())}.toml"
    path.write_text(text)
    mark = edit[6] if len(edit) > 6 else new.splitlines()[0]
    at = text.rindex(mark) if name.startswith("duplicate") else text.index(mark)
    return path, f"{path}:{text[:at].count(chr(10)) + 1}: "


def check_sentence(sentence: str, place: str, key: str, rule: str, remedy: str) -> None:
    assert sentence.startswith(f"{place}{key} "), sentence
    before, _, after = sentence.partition("; ")
    assert rule in before, sentence
    assert remedy in after, sentence
    assert "\n" not in sentence
    assert not JARGON.search(sentence.removeprefix(place)), sentence


def test_the_good_case_is_good(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(GOOD)
    assert len(build(load_case(path))) == 2
    done = mpm3dpp("check", path, cwd=path.parent)
    assert (done.returncode, done.stderr) == (0, "")
    assert "body left: " in done.stdout


@pytest.mark.parametrize("edit", EDITS, ids=lambda edit: edit[0])
def test_functions(edit: tuple[str, ...], tmp_path: Path) -> None:
    path, place = write(tmp_path, edit)
    with pytest.raises(CaseError) as caught:
        build(load_case(path))
    check_sentence(str(caught.value), place, *edit[3:6])


@pytest.mark.parametrize("edit", EDITS[::4], ids=lambda edit: edit[0])
def test_command(edit: tuple[str, ...], tmp_path: Path) -> None:
    """It tells what the functions say."""
    path, place = write(tmp_path, edit)
    done = mpm3dpp("check", path, cwd=tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    sentence = done.stderr.removesuffix("\n").removeprefix("mpm3dpp: error: ")
    check_sentence(sentence, place, *edit[3:6])


@pytest.mark.parametrize(
    ("content", "rule"),
    [(None, "no such file"), ("folder", "is a folder"), (b"title = '\xff'", "not UTF-8")],
    ids=["missing file", "folder", "binary file"],
)
def test_files_that_cannot_be_read(tmp_path: Path, content: str | bytes | None, rule: str) -> None:
    path = tmp_path / "case.toml"
    if content == "folder":
        path.mkdir()
    elif isinstance(content, bytes):
        path.write_bytes(content)
    done = mpm3dpp("check", path, cwd=path.parent)
    assert done.returncode == 2
    assert rule in done.stderr
    assert done.stderr.startswith(f"mpm3dpp: error: {path}: ")
    assert done.stderr.count("\n") == 1


def test_a_missing_file_suggests_case_files_only(tmp_path: Path) -> None:
    for name, text in {
        "pyproject.toml": "[project]\n", "rings.toml": GOOD, "slope.mpm": "mpm3d", "rung.toml": "["
    }.items():  # fmt: skip
        (tmp_path / name).write_text(text)
    for word, remedy in {
        "project.toml": "check the path",
        "case.toml": "check the path",
        "ring.toml": f'did you mean "{tmp_path / "rings.toml"}"?',
        "slopes.mpm": f'did you mean "{tmp_path / "slope.mpm"}"?',
    }.items():
        with pytest.raises(CaseError) as caught:
            load_any(tmp_path / word)
        assert str(caught.value) == f"{tmp_path / word}: there is no such file; {remedy}"
    with pytest.raises(CaseError, match="there is no such file; check the path"):
        load_any(tmp_path / "nowhere" / "case.toml")


def test_unwritable_folder(tmp_path: Path) -> None:
    path, file = tmp_path / "case.toml", tmp_path / "file"
    path.write_text(GOOD)
    file.write_text("")
    done = mpm3dpp("run", path, "--out", file / "results", cwd=tmp_path)
    assert done.returncode == 2
    assert "cannot write" in done.stderr
    assert "--out" in done.stderr
    assert done.stderr.count("\n") == 1


@pytest.mark.parametrize(
    "arguments",
    [
        ["run"],
        ["chek", "case.toml"],
        ["run", "case.toml", "--threads", "0"],
        ["materials", "steel"],
    ],
    ids=["no case", "unknown command", "no threads", "unknown model"],
)
def test_command_line_mistakes(arguments: list[str], tmp_path: Path) -> None:
    done = mpm3dpp(*arguments, cwd=tmp_path)
    assert done.returncode == 2
    assert "Traceback" not in done.stderr
