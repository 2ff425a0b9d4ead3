# SPDX-License-Identifier: BSD-3-Clause
"""`check` tells every mistake of a case that does not hide behind another, each in a sentence."""

from __future__ import annotations

from pathlib import Path

import pytest

from commands import CASE, mpm3dpp, write
from mpm3dpp import Case, CaseError, Grid, GridBox, shapes
from mpm3dpp.case.case import load_case
from mpm3dpp.fill.build import build

# Ten mistakes: keys and values of tables that have nothing to do with each other.
VALUES = """\
[grid]
dimension = 2
cell_size = "10 kg"
box = { lower = ["0 mm", "0 m/s"], upper = ["x", "1 m"] }
[run]
end_time = "8 ms"
shceme = "usl"
cfl = 2
[output]
frames = 0
[material.soft]
densty = "1000 kg/m^3"
strength = { elastic = { E = "-1 MPa", nu = 0.7 } }
[body.left]
material = "soft"
shape = { union = [{ disc = { centre = [0, 0], radius = 0 } }, { disk = {} }] }
"""
TOLD = [
    (3, "grid.cell_size", "a mass"),
    (4, "grid.box.lower[1]", "a velocity"),
    (4, "grid.box.upper[0]", "must be a length"),
    (7, "run.shceme", 'did you mean "scheme"'),
    (8, "run.cfl", "0 < f <= 1"),
    (10, "output.frames", ">= 1"),
    (12, "material.soft.densty", 'did you mean "density"'),
    (13, "material.soft.strength.elastic.E", "> 0"),
    (13, "material.soft.strength.elastic.nu", "0.5"),
    (16, "body.left.shape.union[0].disc.radius", "> 0"),
    (16, "body.left.shape.union[1].disk", 'did you mean "disc"'),
]


def told(path: Path) -> list[str]:
    with pytest.raises(CaseError) as caught:
        build(load_case(path))
    return [str(error) for error in (caught.value, *caught.value.others)]


def test_values_and_keys(tmp_path: Path) -> None:
    path = write(tmp_path, VALUES)
    sentences = told(path)
    assert len(sentences) == len(TOLD), "\n".join(sentences)
    for sentence, (line, key, part) in zip(sentences, TOLD, strict=True):
        assert sentence.startswith(f"{path}:{line}: {key} "), sentence
        assert part in sentence and "\n" not in sentence


@pytest.mark.parametrize("what", ["check", "run"])
def test_the_command_lists_and_counts_them(tmp_path: Path, what: str) -> None:
    write(tmp_path, VALUES)
    done = mpm3dpp(what, "case.toml", cwd=tmp_path)
    *lines, last = done.stderr.splitlines()
    assert done.returncode == 2 and done.stdout == ""
    assert len(lines) == len(TOLD) and last == f"mpm3dpp: {len(TOLD)} mistakes"
    assert all(line.startswith("mpm3dpp: error: case.toml:") for line in lines)
    assert not (tmp_path / "results").exists()


def test_names_and_numbers_of_components(tmp_path: Path) -> None:
    text = CASE.replace('material = "soft"\n', 'material = "sfot"\n')
    text = text.replace('velocity = ["5 m/s", "0 m/s"]', "velocity = [5, 0, 0]")
    text += '[[contact.pair]]\nbodies = ["lefft", "right"]\nfriction = 0.1\n'
    found = [sentence.split(": ")[1].split(" ")[0] for sentence in told(write(tmp_path, text))]
    assert sorted(found) == [
        "body.left.material",
        "body.left.velocity",
        "body.right.material",
        "contact.pair[0].bodies[0]",
    ]


def test_loads_pairs_and_output_together(tmp_path: Path) -> None:
    text = CASE.replace("frames = 4", 'fields = ["volum", "mas"]\npicture = "sped"')
    text += (
        '[load.a]\nbody = "lefft"\nside = "x_min"\npressure = 1\n'
        '[load.b]\nbody = "right"\nside = "outer"\ntraction = [1, 2, 3]\n'
    )
    found = {sentence.split(": ")[1].split(" ")[0] for sentence in told(write(tmp_path, text))}
    assert found == {
        "output.fields[0]",
        "output.fields[1]",
        "output.picture",
        "load.a.body",
        "load.b.side",
        "load.b.traction",
    }


def test_places_of_bodies(tmp_path: Path) -> None:
    text = CASE.replace("[run]", "box = { lower = [0, 0], upper = [0.1, 0.05] }\n[run]")
    text = text.replace('lower = ["60 mm", "10 mm"]', 'lower = ["40 mm", "10 mm"]')
    found = told(write(tmp_path, text))
    assert len(found) == 3
    assert "are at x > 0.1 m" in found[0] and "are at y > 0.05 m" in found[1]
    assert "body.right.shape overlaps body.left" in found[2]


def test_bodies_that_cannot_be_filled(tmp_path: Path) -> None:
    text = CASE.replace('"50 mm", "50 mm"]', '"1 mm", "50 mm"]').replace(
        '["110 mm", "60 mm"]', '["61 mm", "60 mm"]'
    )
    found = told(write(tmp_path, text))
    assert [sentence.split(": ")[1].split(" ")[0] for sentence in found] == [
        "body.left.shape",
        "body.right.shape",
    ]


def test_of_many_grains_one_speaks_for_all(tmp_path: Path) -> None:
    text = CASE.replace("[run]", "box = { lower = [0, 0], upper = [1, 1] }\n[run]")
    text += (
        '[grains.sand]\nmaterial = "soft"\nlattice = { lower = ["0.1 m", "0.5 m"], '
        'count = [20, 20], radius = "20 mm" }\n'
    )
    found = told(write(tmp_path, text))
    assert len(found) < 4 and any("grains.sand.lattice" in sentence for sentence in found)


def test_objects_of_python_have_the_others_too() -> None:
    with pytest.raises(CaseError) as caught:
        Grid(dimension=2, cell_size=-1, basis="cubic", foo=3)
    every = [caught.value, *caught.value.others]
    assert sorted(error.key for error in every) == ["grid.basis", "grid.cell_size", "grid.foo"]
    with pytest.raises(CaseError) as caught:
        Grid(dimension=2, cell_size=0.1, box=GridBox(lower=(0, 0), upper=(0.25, -1)))
    assert [e.key for e in (caught.value, *caught.value.others)] == [
        "grid.box.upper[0]",
        "grid.box.upper[1]",
    ]
    with pytest.raises(CaseError) as caught:
        shapes.Disc(centre=("a", "b"), radius=0)
    assert len(caught.value.others) == 2


def test_a_mistake_that_follows_from_another_is_not_told(tmp_path: Path) -> None:
    [sentence] = told(write(tmp_path, CASE.replace("density =", "densty =")))
    assert "densty" in sentence and 'did you mean "density"' in sentence


def test_a_great_many_are_counted(tmp_path: Path) -> None:
    wrong = "".join(f"[load.n{k}]\nbody = 1\nside = 2\n" for k in range(60))
    done = mpm3dpp("check", write(tmp_path, CASE + wrong), cwd=tmp_path)
    lines = done.stderr.splitlines()
    assert len(lines) == 51
    assert lines[-1] == "mpm3dpp: 120 mistakes, the first 50 of which are listed"


def test_a_case_of_python_is_a_case() -> None:
    tables = Case.from_text(CASE).table()
    assert Case(**tables).case_hash == Case.from_text(CASE).case_hash
