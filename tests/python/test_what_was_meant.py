# SPDX-License-Identifier: BSD-3-Clause
"""Mistakes of whom other programs have taught: messages lead to what is meant here."""

from __future__ import annotations

import pytest

from mpm3dpp import Case, CaseError
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
