# SPDX-License-Identifier: BSD-3-Clause
"""Mistakes of whom other programs have taught: messages lead to what is meant here."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from commands import mpm3dpp
from mpm3dpp import Case, CaseError
from mpm3dpp.base.units import to_si
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build

BLOCK = """\
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 us"
gravity = [0, -9.81]
[material.m]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.a]
material = "m"
frame = "material"
shape = { box = { lower = [0, 0], upper = ["4 mm", "4 mm"] } }
[body.b]
material = "m"
frame = "material"
shape = { box = { lower = [0, "5 mm"], upper = ["4 mm", "9 mm"] } }
"""
SHAPE = 'shape = { box = { lower = [0, 0], upper = ["4 mm", "4 mm"] } }'


@pytest.mark.parametrize(
    ("old", "new", "meant"),
    [
        ('"1 MPa"', '"1 Mpa"', 'did you mean "1 MPa"?'),
        ('"1 MPa"', '"1 mpa"', 'did you mean "1 MPa"?'),
        ("[0, -9.81]", "-9.81", 'give a list such as [0, "-9.81 m/s^2"]'),
        ('elastic = { E = "1 MPa", nu = 0.3 }', "newtonian = {}", 'did you mean "fluid"?'),
        ('elastic = { E = "1 MPa", nu = 0.3 }', "von_mises = {}", 'did you mean "j2"?'),
        ("[body.b]", "restitution = 0.5\n[body.b]", "give contact.restitution, or one of its own"),
        ("[body.b]", "friction = 0.5\n[body.b]", "give contact.friction, or one of its own"),
        ("[grid]", '[grid]\nframe = "material"', "body.NAME.frame, grains.NAME.frame"),
        ("density = 1000", 'density = 1000\nframe = "material"', "body.NAME.frame"),
        ("[body.b]", "[contact]\nmu = 0.5\n[body.b]", 'did you mean "friction"?'),
        (SHAPE, f"shape = {{ rotate = {{ angle = 20, {SHAPE} }} }}", 'write its unit, "30 deg"'),
    ],
)
def test_mistakes(old: str, new: str, meant: str) -> None:
    with pytest.raises(CaseError) as caught:
        Case.from_text(BLOCK.replace(old, new))
    assert meant in str(caught.value)


def told(text: str) -> list[str]:
    with pytest.raises(CaseError) as caught:
        Case.from_text(text)
    return [str(error) for error in (caught.value, *caught.value.others)]


def test_keys_for_contact_at_nodes_are_told_at_once_each_where_it_stands() -> None:
    keys = {"detection": "velocity", "normal": "pair", "gap_distance": 1e-4, "response": "impulses"}
    lines = "\n".join(f"{key} = {value!r}" for key, value in keys.items())
    found = told(f"{BLOCK}[contact]\n{lines}\n")
    assert len(found) == len(keys)
    for key, sentence in zip(keys, found, strict=True):
        assert f"contact.{key} = " in sentence and "is for contact at nodes" in sentence


def test_a_mistake_of_the_case_is_told_of_one_body() -> None:
    [sentence] = told(BLOCK + '[contact]\ninterference = "pressed"\n')
    assert "body.a.frame" in sentence and "settle" not in sentence


def test_a_transfer_that_does_nothing() -> None:
    def of(text: str) -> list[str]:
        case = Case.from_text(text)
        return notes(case, build(case))

    assert of(BLOCK) == []
    with_transfer = BLOCK.replace("gravity", 'transfer = "apic"\ngravity')
    [note] = of(with_transfer)
    assert "run.transfer does nothing here" in note
    assert of(with_transfer.replace('frame = "material"\n', "")) == []


@pytest.mark.parametrize(
    ("material", "what", "remedy"),
    [
        (
            'library = "copper_ofhc"',
            "spalls by the spall_strength of its equation of state",
            "give material.m.eos.mie_gruneisen.spall_strength = 0",
        ),
        (
            "density = 1000\nstrength = { fluid = {} }\neos = { tait = { c0 = 100 } }",
            "flows by its strength fluid",
            'give frame = "updated"',
        ),
    ],
)
def test_what_breaks_a_material_is_named(material: str, what: str, remedy: str) -> None:
    elastic = 'density = 1000\nstrength = { elastic = { E = "1 MPa", nu = 0.3 } }'
    sentence = told(BLOCK.replace(elastic, material))[0]
    assert f"which {what}" in sentence and remedy in sentence


def test_a_change_on_the_command_line_mends_the_file(tmp_path: Path) -> None:
    """As the remedy of a mistake says; other mistakes are told of the changed case."""
    (tmp_path / "case.toml").write_text(BLOCK + '[contact]\ninterference = "pressed"\n')
    assert mpm3dpp("check", "case.toml", cwd=tmp_path).returncode == 2
    line = ["check", "case.toml", "--set", "contact.interference=set_back"]
    assert mpm3dpp(*line, cwd=tmp_path).returncode == 0
    still = mpm3dpp("check", "case.toml", "--set", "run.cfl=0.4", cwd=tmp_path)
    assert still.returncode == 2 and "pressed" in still.stderr


@pytest.mark.parametrize(
    ("text", "pascals"), [("5 N/mm2", 5e6), ("5 N/m2", 5.0), ("3 kN/cm2", 3e7)]
)
def test_powers_without_a_caret(text: str, pascals: float) -> None:
    assert to_si(text, "Pa") == pytest.approx(pascals, rel=1e-15)


@pytest.mark.parametrize("dimension", [2, 3])
def test_a_part_of_a_ball_has_as_many_particles_in_a_cell_as_the_whole(dimension: int) -> None:
    """A quarter and an eighth between planes of symmetry, of 4 cells a radius."""

    def count(cut: bool) -> int:
        kind = "sphere" if dimension == 3 else "disc"
        low = 0.0 if cut else -0.02
        body: dict[str, Any] = {
            "material": "m",
            "frame": "material",
            "cut_at_box": cut,
            "shape": {kind: {"centre": [0.0] * dimension, "radius": 0.004}},
        }
        box = {"lower": [low] * dimension, "upper": [0.02] * dimension, "walls": "slip"}
        case = Case.model_validate(
            {
                "grid": {"dimension": dimension, "cell_size": 1e-3, "box": box},
                "run": {"end_time": 1.0},
                "material": {"m": {"density": 1e3, "strength": {"elastic": {"E": 1e6, "nu": 0.3}}}},
                "body": {"ball": body},
            }
        )
        return build(case).parts["ball"].count

    assert count(True) * 2**dimension == pytest.approx(count(False), rel=0.02)
