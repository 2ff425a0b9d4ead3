# SPDX-License-Identifier: BSD-3-Clause
"""Input files of MPM3D-F90 do what they do there, or say everything that they cannot."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np
import pytest

from commands import mpm3dpp
from mpm3dpp import CaseError, Simulation, load_case
from mpm3dpp.base.time_functions import at
from mpm3dpp.fill.build import build
from mpm3dpp.importers import import_file
from mpm3dpp.importers.mpm3d.lexer import split
from mpm3dpp.importers.mpm3d.particles import points_of
from mpm3dpp.importers.mpm3d.statements import REFUSED, STATEMENTS, read_deck
from mpm3dpp.importers.write import write_case
from mpm_text import GOOD, MATE, PART, TWO, edited, of, with_part


def test_a_body_that_sticks_out_of_a_free_face_widens_the_box() -> None:
    text = edited((PART, PART.replace("0 0 0 4 4 4", "-2.5 0 0 11 4 4")), ("nbmp 64", "nbmp 176"))
    found = of(text)
    box = found.case.grid.box
    assert box is not None
    assert box.lower == (-0.003, -0.002, 0.0) and box.upper == (0.003, 0.002, 0.004)
    said = [note for note in found.notes if "reaches out of the grid" in note]
    assert ["x_min" in said[0], "x_max" in said[1], "by a cell" in said[0]] == [True] * 3
    [body] = build(found.case)
    assert len(body.positions) == 176 and body.positions[:, 0].min() == pytest.approx(-0.00225)


def test_what_lies_beyond_a_wall_is_left_out_and_the_wall_stays() -> None:
    text = edited((" 0.5 0 0 0", " 0.5 0 0 -1"))  # Two of four layers below the slip wall at z = 0.
    found = of(text)
    box = found.case.grid.box
    assert box is not None and (box.lower[2], box.upper[2]) == (0.0, 0.004)
    [body] = build(found.case)
    assert len(body.positions) == 32 and body.positions[:, 2].min() == pytest.approx(0.00025)
    assert any("32 of 64 particles lie beyond a wall" in note for note in found.notes)


def test_the_lead_plate_of_the_samples() -> None:
    """LeadHypervelocityImpact.mpm: nbco 2 without cont, and a plate wider than the grid."""
    plate = "part sphere 1\n1 7.8d-3 0.5 -1 0 2 1\npart block 2\n1 7.8d-3 0.5 0 -2 0 2 9 8\n"
    text = edited(
        (PART, plate), ("nbco 1", "nbco 2"), ("nbbo 1", "nbbo 2"), ("nbmp 64", "nbmp 999")
    )
    case = of(text.replace("fixed 0 0 0 0 2 1", "fixed 0 0 0 0 0 0")).case
    assert case.contact.bonded
    assert [len(body.positions) for body in build(case)] == [8, 144]


def test_forces_on_all_particles_of_a_body_are_gravity() -> None:
    mass = 7.8e-3 * 0.5**3
    force = f"load body 1 0 0 {-2 * mass:.12e} grav 1 1 0 0 endl\n"
    found = of(edited(("endi\n", force + "endi\n")))
    assert found.case.run.gravity == pytest.approx((1e3, 0.0, -2e3), rel=1e-11)
    assert any("is gravity here" in note for note in found.notes)
    uneven = "part point 1 2\n 1 1 1.0d-3 0 0 1\n 2 1 2.0d-3 0.5 0 1\n"
    load = ("endi\n", "load body 1 0 0 1\n endl\nendi\n")
    with pytest.raises(CaseError, match="they have different masses"):
        with_part(uneven, more=(load,))
    with pytest.raises(CaseError, match="gives the bodies different loads"):
        with_part(TWO[0], TWO[1].format(1), more=(load,))


def test_all_mistakes_come_at_once_by_their_lines() -> None:
    wrong = edited(
        ("endi\n", "bimp\nload node 1 0 0 1\n node 2 0 0 1\n endl\nQuLo 0\nDamp -1\n"
         "velo ksin 1 1 node 1 0 0 1 endv\nnumthread 2\nsgmp\ndcell E70\nendi\n"),
        ("fixed 0 0 0 0 2 1", "fixed 0 0 0 0 2 3"),
    )  # fmt: skip
    with pytest.raises(CaseError) as caught:
        of(wrong)
    lines = [error.sentence() for error in (caught.value, *caught.value.others)]
    parts = ["17: fixed has (0, 0, 0, 0, 2, 3)", "25: bimp asks", '26: load has "node"',
             "29: QuLo is 0", "30: Damp is -1", '31: velo has "ksin"', '31: velo has "node"',
             "32: numthread is not", "33: sgmp asks", '34: dcell has "E70"']  # fmt: skip
    assert [part in line for part, line in zip(parts, lines, strict=False)] == [True] * 10
    assert "(and so 1 times more)" in lines[2]
    assert len(lines) == 10


def test_mistakes_of_the_case_come_with_those_of_the_file() -> None:
    text = edited(
        ("endi\n", "bimp\noutr none\nendi\n"),
        ("dtscale 0.5", "dtscale 2.5"),
        ("spx -2 2", "spx -2 -1.9"),
        (MATE, " 1 sjc 7.8d-3 210.0d3 0.3 90 292 0.3 0.02 1d-3\n"),
    )
    with pytest.raises(CaseError) as caught:
        of(text)
    found = [error.place.rpartition(":")[2] for error in (caught.value, *caught.value.others)]
    assert found == ["7", "11", "19", "25"]  # spx, dtscale, the missing seos, bimp


NONSENSE = [
    (("7.8d-3 210", "-0 210"), "has rho = -0 of elas, which must be > 0"),
    (("7.8d-3 210", "0 210"), "has rho = 0 of elas"),
    (("7.8d-3 210", "nan 210"), 'has "nan" where rho of elas must be'),
    (("210.0d3", "inf"), 'has "inf" where E of elas'),
    (("210.0d3", "1e400"), 'has "1e400" for E of elas'),
    (("dcell 1.0", "dcell -0.0"), "is -0 but must be > 0"),
    (("dcell 1.0", "dcell nan"), 'has "nan" where the cell size'),
    ((" 0.5 0 0 0", " 0.5 1e400 0 0"), 'has "1e400"'),
    ((" 1 7.8d-3 0.5", " 1 -0 0.5"), "has density = -0"),
    ((" 0.5 0 0 0", " 1e-120 0 0 0"), "box.upper[0] = 4e-123 must be zero or between"),
    ((PART, "part sphere 1\n 1 7.8d-3 1e-120 0 0 2 2\n"), "must have a volume > 0"),
    ((MATE, " 1 neoh 7.8d-3 210 0.5\n"), "has nu = 0.5 in neoh"),
    ((MATE, " 1 neoh 7.8d-3 210 -1\n"), "has nu = -1 in neoh"),
    (("nmat 1\n", "nmat 1e50\n"), 'has "particle" where the number of a material'),
    ((PART, "part point 1 999999999\n"), "has 999999999 particles but only"),
    ((PART, "part sphere 1\n 1 7.8d-3 0.5 0 0 2 99\n"), "nbmp is 64 but"),
    (("nbmp 64\n" + GOOD[GOOD.index("nmat") : GOOD.index(PART)] + PART,
      GOOD[GOOD.index("nmat") : GOOD.index(PART)] + "part sphere 1\n 1 1 0.5 0 0 2 99999999\n"),
     "needs a lattice of some 8e+24 particles"),
]  # fmt: skip


@pytest.mark.parametrize(("edit", "part"), NONSENSE, ids=[part for _, part in NONSENSE])
def test_nonsense_is_a_sentence(edit: tuple[str, str], part: str) -> None:
    with pytest.raises(CaseError) as caught:
        build(of(edited(edit)).case)
    assert part in str(caught.value)


def test_numbers_as_fortran_writes_them() -> None:
    assert of(edited(("dcell 1.0", "dcell 1.d0"))).case.case_hash == of(GOOD).case.case_hash
    assert of(edited(("210.0d3", "2.1D+05"))).case.case_hash == of(GOOD).case.case_hash


def test_force_does_not_destroy_the_source(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    source = tmp_path / "in" / "a.mpm"
    source.write_text(GOOD)
    os.symlink(source, tmp_path / "link.toml")
    os.link(source, tmp_path / "hard.toml")
    names = ["a.mpm", "in/a.mpm", "in/../in/a.mpm", "A.MPM", str(source), "link.toml", "hard.toml"]
    for name in names:
        done = mpm3dpp("import", "in/a.mpm", "-o", name, "--force", cwd=tmp_path)
        assert done.returncode == 2 and "Traceback" not in done.stderr, name
        assert "give a" in done.stderr and done.stderr.count("mpm3dpp: error:") == 1
        assert source.read_text() == GOOD
    for file in (tmp_path / "link.toml", tmp_path / "hard.toml"):
        with pytest.raises(CaseError, match="is the file that is imported"):
            write_case(import_file(source), file, force=True)
    text = edited((" 0.5 0 0 0", " 0.3 0 0 0"))  # Its points go to a CSV file beside the case.
    (tmp_path / "b_body_1.csv").write_text(text)
    with pytest.raises(CaseError, match=r"b_body_1.csv is the file that is imported"):
        write_case(import_file(tmp_path / "b_body_1.csv"), tmp_path / "b.toml", force=True)
    assert (tmp_path / "b_body_1.csv").read_text() == text and not (tmp_path / "b.toml").exists()


def test_several_problems_on_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "x.mpm").write_text(GOOD.replace("endi\n", "bimp\ndrda\nendi\n"))
    for words in (("check", "x.mpm"), ("import", "x.mpm"), ("run", "x.mpm")):
        done = mpm3dpp(*words, cwd=tmp_path)
        assert done.returncode == 2
        lines = done.stderr.splitlines()
        assert lines[0].startswith("mpm3dpp: error: x.mpm:25: bimp asks for")
        assert lines[1].startswith("mpm3dpp: error: x.mpm:26: drda asks for")
        assert lines[2] == "mpm3dpp: 2 mistakes"
    assert not (tmp_path / "x.toml").exists()


def test_points_keep_their_order_when_some_are_left_out() -> None:
    points = "part point 1 3\n 1 1 1.0d-3 0 0 1\n 2 1 2.0d-3 0 0 -1\n 3 1 3.0d-3 0.5 0 1\n"
    [body] = build(with_part(points).case)
    assert np.allclose(body.volumes, np.array([1e-6, 3e-6]) / 7800, rtol=1e-14)


def test_the_page_names_every_keyword() -> None:
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "bring-mpm3d-files.md").read_text()
    table = page[page.index("All 43 keywords") : page.index("| material | strength")].lower()
    first = "".join(row.split("|")[1] for row in table.splitlines() if row.startswith("| `"))
    words = {*STATEMENTS, *REFUSED, "endi"}
    assert len(words) == 43
    assert {word for word in words if not re.search(rf"\b{word}\b", first)} == set()


WAVE = "velo body 1 0 2 0 vsin 3 endv\n"


def test_a_wave_of_velocities_is_a_formula_of_place() -> None:
    """`velo vsin v0` is vx = v0 sin(pi y / 6), the 6 in the file's unit of length: here mm."""
    found = of(edited(("velo\n body 1 0.0 0.0 -100.0\nendv\n", WAVE)))
    [body] = build(found.case)
    y = body.positions[:, 1]
    assert np.allclose(body.velocities[:, 0], 3.0 * np.sin(np.pi * y / 6e-3), rtol=1e-12, atol=0)
    assert np.all(body.velocities[:, 1:] == [2.0, 0.0])
    later = of(edited(("velo\n body 1 0.0 0.0 -100.0\nendv\n", "velo vsin 3 body 1 1 0 0 endv\n")))
    assert later.case.body["body_1"].velocity == (1.0, 0.0, 0.0)
    both = with_part(TWO[0], TWO[1].format(1), more=(("velo\n", "velo vsin 3\n"),))
    assert [float(np.ptp(b.velocities[:, 0])) > 0.0 for b in build(both.case)] == [False, True]


def test_damping_of_motions_is_that_of_every_body() -> None:
    """A body at 100 m/s with `Damp 5`, of 5 / ms, has exp(-5000 t) of it left."""
    text = edited(("endi\n", "Damp 5\nendi\n"), ("fixed 0 0 0 0 2 1", "fixed 0 0 0 0 0 0"))
    case = of(text.replace("endtime 1.0d-3", "endtime 0.1").replace("outtime 2.0d-4", "")).case
    sim = Simulation(case, threads=1)
    sim.advance(10**6, end_time=1e-4)
    # The velocity in the middle of the step: (1 - a dt / 2) / (1 + a dt / 2), of second order.
    speed = sim.column("body_1", "velocity")[:, 2]
    assert np.allclose(speed, -100.0 * np.exp(-5e3 * 1e-4), rtol=1e-4, atol=0)
    two = with_part(TWO[0], TWO[1].format(1), more=(("endi\n", "Damp 5\nendi\n"),)).case
    assert [two.body[name].damping.mass for name in two.body] == [5e3, 5e3]


STILL = ("velo\n body 1 0.0 0.0 -100.0\nendv\n", "")
FREE = ("fixed 0 0 0 0 2 1", "fixed 0 0 0 0 0 0")


@pytest.mark.parametrize("rise", ["", "QuLo 0.02\n"])
def test_forces_on_single_particles_push_their_body(rise: str) -> None:
    """p = F t; with QuLo F t / T from 0 to T, and F from there. F = 3 and -1 mN."""
    load = "load part 22 0 0 3.0d-3 part 43 0 0 -1.0d-3 endl\n"
    text = edited(STILL, FREE, ("endi\n", load + rise + "endi\n"))
    text = text.replace("endtime 1.0d-3", "endtime 0.04").replace("outtime 2.0d-4", "")
    found = of(text)
    points = points_of(read_deck(split(text)).parts[0])
    for number in (22, 43):
        assert found.case.load[f"particle_{number}"].point == tuple(1e-3 * points[number - 1])
    sim = Simulation(found.case, threads=1)
    sim.advance(10**6, end_time=4e-5)
    end = dict(zip(sim.core.history_columns, sim.core.history()[-1], strict=True))
    impulse = 2e-3 * (3e-5 if rise else 4e-5)
    assert end["momentum_z"] == pytest.approx(impulse, rel=1e-9)
    assert any("MPM3D-F90 goes on from there" in note for note in found.notes) == bool(rise)


def test_a_rising_force_on_all_particles_is_a_rising_gravity() -> None:
    """`load body` rises with QuLo, `load grav` does not."""
    mass = 7.8e-3 * 0.5**3
    load = f"load body 1 0 0 {-2 * mass:.12e} grav 1 1 0 4 endl\nQuLo 0.02\n"
    case = of(edited(("endi\n", load + "endi\n"))).case
    x, y, z = case.run.gravity
    assert (x, y) == (1e3, 0.0)
    assert [at(z, t) for t in (0.0, 1e-5, 2e-5, 1.0)] == pytest.approx([4e3, 3e3, 2e3, 2e3])


def test_what_is_carried_over_comes_back_from_the_case_file(tmp_path: Path) -> None:
    load = "load part 22 0 0 3.0d-3 endl\nQuLo 0.02\nDamp 5\n"
    text = edited((STILL[0], WAVE), FREE, ("endi\n", load + "endi\n"))
    (tmp_path / "a.mpm").write_text(text)
    found = import_file(tmp_path / "a.mpm")
    write_case(found, tmp_path / "a.toml")
    again = load_case(tmp_path / "a.toml")
    one, other = (build(case)[0] for case in (found.case, again))
    assert np.array_equal(one.velocities, other.velocities)
    assert again.load == found.case.load and again.body["body_1"].damping.mass == 5e3
