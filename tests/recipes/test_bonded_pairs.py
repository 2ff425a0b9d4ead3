# SPDX-License-Identifier: BSD-3-Clause
"""Bonded pairs: single bodies that stick together among others that do not."""

from __future__ import annotations

from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from cases import CELL, HUNG, cut_block, each_numerics, in_free_fall, three_blocks
from mpm3dpp import Case, CaseError, Contact, ContactPair, Simulation, run_case
from worlds import World, largest_differences

RESPONSES = ("springs", "impulses")


def parts_and_whole(
    dimension: int, scheme: str, basis: str, response: str, **run: Any
) -> tuple[Simulation, Simulation]:
    """Return a block cut into three bonded parts, and the uncut one, after a hundred steps."""
    made = []
    for bodies in cut_block(dimension):
        pairs = [ContactPair(bodies=[a, b], bonded=True) for a, b in combinations(bodies, 2)]
        contact = Contact(response=response, pair=pairs)
        case = in_free_fall(dimension, scheme, basis, contact, bodies, **run)
        made.append(Simulation(case, threads=1))
        made[-1].advance(100)
    return made[1], made[0]


def check_alike(parts: Simulation, whole: Simulation) -> None:
    for column, scale in (("velocity", 0.1), ("position", CELL), ("stress", 1e4)):
        bonded = np.concatenate([parts.column(name, column) for name in parts.bodies])
        error = np.abs(bonded - whole.column("all", column)).max()
        assert error < 1e-9 * scale  # some 1e5 roundings, amplified where mass is small


@each_numerics
@pytest.mark.parametrize("response", RESPONSES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_parts_move_like_the_whole(dimension: int, scheme: str, basis: str, response: str) -> None:
    """A block cut into three bonded parts is the uncut block, to rounding (a pull opens no cut)."""
    parts, whole = parts_and_whole(dimension, scheme, basis, response)
    check_alike(parts, whole)
    history = parts.history()
    assert np.abs(history["residual"]).max() < 1e-12 * np.abs(history["kinetic"]).max()
    assert not history["friction"].any()  # they do not slip


@pytest.mark.parametrize("transfer", ["flip", "apic", {"aflip": 0.9}])
def test_parts_move_like_the_whole_with_other_transfers(transfer: Any) -> None:
    check_alike(*parts_and_whole(2, "usf", "quadratic_bspline", "impulses", transfer=transfer))


@pytest.mark.parametrize("response", RESPONSES)
def test_what_hangs_pulls_with_its_weight(response: str) -> None:
    """A block that is bonded to a fixed one hangs: the force between them is its weight, 32 N/m.

    Within 1 %: what is left of its swing after 0.4 s of damping is 0.2 %.
    """
    text = HUNG.replace("friction", f'response = "{response}"\nfriction', 1)
    hung = Simulation(Case.from_text(text))
    hung.advance(10**6)
    (pair,) = hung.core.contact_pairs()
    assert pair.bodies == (0, 1)
    assert pair.force == pytest.approx((0.0, -32.0, 0.0), abs=0.32)  # on the roof
    sunk = -hung.column("lamp", "position")[:, 1].max()
    assert 0.0 < sunk < 0.0026  # half a particle and next to nothing: it has not let go


def test_a_bond_is_no_first_contact(tmp_path: Path) -> None:
    """None of the pictures is that of a plane between the two."""
    run_case(Case.from_text(HUNG.replace("0.4 s", "1 ms")), tmp_path, threads=1)
    names = [path.name for path in tmp_path.glob("*.png")]
    assert "frame.png" in names and "first_contact.png" not in names


def bonded_blocks(dimension: int, response: str) -> Case:
    """Three blocks that meet at a node, of which two stick together."""
    case = three_blocks(dimension, scheme="usf", grid={"basis": "quadratic_bspline"})
    case.contact.pair.append(ContactPair(bodies=["left", "bottom"], bonded=True))
    case.contact.response = response
    return case


@pytest.mark.parametrize("response", RESPONSES)
@pytest.mark.parametrize("dimension", [2, 3])
def test_another_world_is_the_same_to_rounding(dimension: int, response: str) -> None:
    """Bonds beside contacts: mirrored, turned and numbered anew at once.

    To the rounding of sums, 1e-16, and what 150 steps of contacts with friction make of it.
    """
    here = Simulation(bonded_blocks(dimension, response), threads=2)
    axes = {2: ((1, 1), (0, -1)), 3: ((1, 1), (2, -1), (0, 1))}[dimension]
    world = World(axes, reversed_bodies=True, shuffled=True)
    there = Simulation(world.case(here.case, here), threads=1)
    here.advance(150)
    there.advance(150)
    assert len(here.core.contact_pairs()) == 3  # all have met
    assert max(largest_differences(here, there, world).values()) < 1e-9


@pytest.mark.parametrize("response", RESPONSES)
def test_a_run_goes_on_with_the_same_bits(tmp_path: Path, response: str) -> None:
    case = bonded_blocks(3, response)
    whole, first, second = (Simulation(case, threads=n) for n in (1, 2, 2))
    whole.advance(80)
    first.advance(40)
    first.save(tmp_path / "state")
    second.restore(tmp_path / "state")
    second.advance(40)
    for name in whole.bodies:
        for column in ("position", "velocity", "stress"):
            assert np.array_equal(whole.column(name, column), second.column(name, column))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("bonded = true", "bonded = true\nfriction = 0.1", "bonded, which goes without friction"),
        ("bonded = true", "", "must have friction, restitution or bonded = true"),
        ('damping = { mass = "30 1/s" }', 'motion = "fixed"', "bonded, and neither deforms"),
    ],
)
def test_a_mistake_is_told(old: str, new: str, words: str) -> None:
    with pytest.raises(CaseError, match=rf"contact\.pair\[0\].* {words}"):
        Case.from_text(HUNG.replace(old, new, 1))
