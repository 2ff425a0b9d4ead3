# SPDX-License-Identifier: BSD-3-Clause
"""Input files of MPM3D-F90: the language, the mapping to a case, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from commands import mpm3dpp
from mpm3dpp import Case, CaseError, Simulation, load_case, run_case
from mpm3dpp.fill.build import build
from mpm3dpp.importers import import_file, load_any
from mpm3dpp.importers.mpm3d.lexer import Reader, split
from mpm3dpp.importers.mpm3d.particles import points_of
from mpm3dpp.importers.mpm3d.statements import read_deck
from mpm3dpp.importers.mpm3d.to_case import Imported
from mpm3dpp.importers.mpm3d.units import SYSTEMS
from mpm3dpp.importers.write import write_case
from mpm3dpp.shapes import Box
from mpm_text import GOOD, MATE, PART, SEOS, TWO, edited, of, with_part


def test_a_case_in_si_units() -> None:
    found = of(GOOD)
    case = found.case
    assert case.title == "a test"
    assert (case.grid.cell_size, case.grid.basis, case.grid.dimension) == (1e-3, "linear", 3)
    assert case.grid.box is not None
    assert case.grid.box.lower == (-0.002, -0.002, 0.0)
    assert case.grid.walls == ("free", "free", "free", "free", "slip", "fixed")
    assert (case.run.end_time, case.output.interval) == (1e-6, 2e-7)
    assert (case.run.scheme, case.run.cfl) == ("musl", 0.5)
    assert case.run.viscosity is not None
    assert (case.run.viscosity.quadratic, case.run.viscosity.linear) == (1.5, 0.06)
    assert case.material["elas_1"].density == 7800.0
    assert case.material["elas_1"].strength.parameters == {"E": 210e9, "nu": 0.3}
    assert case.body["body_1"].velocity == (0.0, 0.0, -100.0)
    assert case.body["body_1"].shape == Box(lower=(0, 0, 0), upper=(0.002,) * 3)
    [body] = build(case)
    assert body.mass == pytest.approx(7800 * 8e-9, rel=1e-12)
    assert found.notes == [
        'units mm-g-N-ms, as --units is not given; the file says "Unit: mm g N ms MPa"'
    ]


# The language: (name, edits that change nothing).
SAME: list[tuple[str, list[tuple[str, str]]]] = [
    ("commas", [("spx -2 2", "spx,-2,2")]),
    ("tabs", [("spx -2 2", "spx\t-2\t2")]),
    ("comments", [("dcell 1.0", "dcell 1.0! not 2.0\n!dcell 3.0")]),
    ("values on following lines", [("spx -2 2", "spx\n-2\n\n ! here\n 2")]),
    ("several statements a line", [("spx -2 2\nspy -2 2\n", "spx -2 2 spy -2 2 ")]),
    ("long and short keywords", [("dtscale", "DTSC"), ("endtime", "endt"), ("fixed", "Fixe")]),
    ("exponents", [("1.0d-3", "10.0E-4"), ("210.0d3", "2.1D5")]),
    ("one grid statement", [("spx -2 2\nspy -2 2\nspz 0 4", "grid -2 2 -2 2 0 4")]),
    ("defaults", [("nbco 1\n", ""), ("bulk 1.5 0.06\n", ""), ("musl on\n", ""), ("jaum on\n", "")]),
    ("another order", [("dcell 1.0\n", ""), ("endv\n", "endv dcell 1.0\n")]),
    ("gravity of nought", [("velo\n", "load grav 1 0 0 0 endl\nvelo\n")]),
]


@pytest.mark.parametrize(("edits"), [e for _, e in SAME], ids=[name for name, _ in SAME])
def test_the_same_case(edits: list[tuple[str, str]]) -> None:
    assert of(edited(*edits)).case.case_hash == of(GOOD).case.case_hash


def test_line_ends_and_encodings(tmp_path: Path) -> None:
    path = tmp_path / "x.mpm"
    path.write_bytes(GOOD.replace("\n", "\r\n").encode() + "! 平应变".encode("gbk"))
    assert import_file(path).case.case_hash == of(GOOD).case.case_hash


@pytest.mark.parametrize(
    ("edit", "part"),
    [
        (("0.3\n", "+.3\n"), '"+.3" is read as a number'),
        (("spx -2 2", "spx -2 .2e1"), '".2e1" is read as a number'),
        (("7.8d-3 210", "0.0000000000000000000078d18 210"), "more than 20 characters"),
        (("spx -2 2", "spx -2 2" + " " * 300 + "bulk 1.5 0.06"), "more than 256 characters"),
        (("nmat 1\nspx -2 2\nspy -2 2\nspz 0 4\ndcell 1.0\ndtscale 0.5\nendtime 1.0d-3\n",
          "nmat 1 spx -2 2 spy -2 2 spz 0 4 dcell 1.0 dtscale 0.5 endtime 1.0d-3\n"),
         "more than 15 words"),
    ],
)  # fmt: skip
def test_what_the_other_program_would_lose_is_a_note(edit: tuple[str, str], part: str) -> None:
    found = of(edited(edit))
    assert found.case.case_hash == of(GOOD).case.case_hash
    assert [part in note for note in found.notes[1:]] == [True]


# Statements that are accepted, with (a part of) what is said about them.
NOTED = [
    ("tecp\n", "TecPlot"),
    ("para\n", "vtu"),
    ("rptt 0.1\n", "progress line"),
    ("pt2d 0 1 0 1 0 1\n", "all particles are written"),
    ("curv pres 12\n", "curves of single particles"),
    ("curv engk\n", "kinetic energies are in history.csv"),
    ("curx velx 1 1 1\n", "curves of single particles"),
    ("outr epef\n", "no material of this case stores plastic_strain"),
    ("outr damg\n", "always 0"),
    ("outr disx\n", "positions of two frames"),
    ("jaum off\n", "no effect"),
    ("UVFp\n", "always so here"),
    ("smooth\n", "smooths the pressure of the output only"),
    ("Damp 0.0\n", "Damp 0 has no effect"),
    ("nbco 2\n", "stick together (contact.bonded), as in MPM3D-F90"),
    ("nbco 3\n", "stick together (contact.bonded), as in MPM3D-F90"),
    ("spx -2 2.3\n", "moved to a whole number of cells, from 2.3 to 2"),
]


@pytest.mark.parametrize(("statement", "part"), NOTED)
def test_noted(statement: str, part: str) -> None:
    found = of(edited(("endi\n", statement + "endi\n")))
    assert any(part in note for note in found.notes[1:])
    assert found.case.case_hash == of(GOOD).case.case_hash


# What cannot be: (statement put before endi, or an edit; part of the sentence; words of its line).
REFUSED: list[tuple[str | tuple[str, str], str]] = [
    *[(f"{word}\n", f"{word} asks for") for word in ("bimp", "sgmp", "TLmp", "drda")],
    ("Damp -0.1\n", "Damp is -0.1 but must be >= 0"),
    ("QuLo 0\n", "QuLo is 0 but must be > 0"),
    ("dtsc 1.5\n", "dtsc is 1.5 but a factor here must obey 0 < f <= 1"),
    ("load part 65 0 0 1 endl\n", "names particle 65 but there are 64"),
    ("load body 1 0 0 1 part 2 0 0 1 endl\n", "gives particle 2 a force, and its body 1 one"),
    ("load node 1 0 0 1 endl\n", "at this load MPM3D-F90 itself stops"),
    ("load push 1 0 0 1 endl\n", 'has the unknown load "push"'),
    ("load grav 2 0 0 1 endl\n", "names body 2 but nbbo is 1"),
    ("velo node 1 0 0 1 endv\n", 'has "node": velocities of single particles'),
    *[(f"velo {w} 1 endv\n", f'has "{w[:4]}": this velocity') for w in ("ksin 1", "nuli")],
    ("velo all 1 0 0 endv\n", 'has the unknown velocity "all"'),
    ("usf on\n", "several schemes on: musl, usf"),
    ("cont lagr 0.1 0\n", "asks for contact but nbco is 1"),
    ("cont lagr 0.1 3\n", "the normal 0, 1 or 2"),
    ("cont penalty\n", 'the unknown kind "penalty"'),
    ("numthread 2\n", "numthread is not a keyword"),
    ("12 spx 0 1\n", "12 is not a keyword"),
    ("outr none\n", 'the unknown variable "none"'),
    ("fixe 0 0 0 0 0 3\n", "codes are 0 free"),
    ("spx 2 -2\n", "lower bound first"),
    ("spx 0 0.3\n", "less than half a cell"),
    ("dcell 0\n", "must be > 0"),
    ("outtime 0\n", "must be > 0"),
    ("endtime 0\n", "missing or not > 0"),
    ("bulk -1 0\n", "both must be >= 0"),
    ("seos 2 1 0 0 0 0 0 0 0 0\n", "for material 2, which is not given"),
    ("seos 1 5 0\n", "the unknown type 5"),
    ("dcell E70\n", 'has "E70" where the cell size must be'),
    ("nbbo 1.5\n", "has 1.5 for a number"),
    ("musl maybe\n", "on or off"),
    (("endi\n", ""), "ends before endi"),
    (("endi\n", "bulk 1.5"), "bulk ends before the linear factor"),
    (("spx -2 2\n", ""), "spx is missing"),
    (("dcell 1.0\n", ""), "dcel is missing"),
    (("nmat 1\n", ""), "stands before nmat"),
    (("nmat 1\n", "nmat 2\n"), 'has "particle" where the number of a material must be'),
    ((" 1 elas", " 2 elas"), "has material 2 but nmat is 1"),
    ((MATE, MATE + MATE.replace(" 1 elas", " 2 elas")), "mate has material 2 but nmat is 1"),
    (("elas", "wood"), 'the unknown material type "wood"'),
    ((MATE, " 1 elas 7.8d-3 210.0d3 0.7\n"), "material.elas_1.strength.elastic.nu = 0.7"),
    ((MATE, " 1 pla2 7.8d-3 210.0d3 0.3 300 3d5\n"), "Et >= E"),
    ((MATE, " 1 sjc 7.8d-3 210.0d3 0.3 90 292 0.3 0.02 1d-3\n"), "no seos follows"),
    (("nbbo 1\n", "nbbo 2\n"), "is 2 but there are 1 part statements"),
    (("nbmp 64\n", "nbmp 63\n"), "at least 64 particles"),
    ((PART, ""), "part is missing"),
    (("block 1\n 1 7", "block 1\n 3 7"), "names material 3"),
    ((PART, "part point 1 3\n 1 1 1 0 0 0\n"), "has 3 particles but only"),
    ((" 0 0 0 4 4 4", " 5 0 0 4 4 4"), "lies outside the grid: body 1 is beyond its x bounds"),
    ((" 0 0 0 4 4 4", " 0 0 -3 4 4 4"), "lies outside the grid: body 1 is beyond its z"),
    ((PART, "part point 1 2\n 1 1 1 1 1 5\n 1 1 1 1 1 -1\n"), "lies wholly beyond a wall"),
    (("block 1\n", "brick 1\n"), 'the unknown kind "brick"'),
    (("4 4 4", "4 4 0"), "has nz = 0"),
    ((" 0.5 0 0 0", " 0 0 0 0"), "has dp = 0"),
    ((PART, "part point 1 0\n"), "has 0 particles"),
    ((PART, "part point 1 1\n 1 1 -2 0 0 0\n"), "not > 0"),
    (("! Unit: mm g N ms MPa", "! Unit: m kg N s Pa"), 'says "Unit: m kg N s Pa"'),
]


@pytest.mark.parametrize(("change", "part"), REFUSED, ids=[str(k) for k in range(len(REFUSED))])
def test_refused(change: str | tuple[str, str], part: str) -> None:
    edit = ("endi\n", change + "endi\n") if isinstance(change, str) else change
    with pytest.raises(CaseError) as caught:
        of(edited(edit))
    sentence = str(caught.value)
    assert part in sentence and "\n" not in sentence
    place = sentence.split(": ")[0]
    assert place.startswith("case.mpm")
    if isinstance(change, str) and " is " not in part:
        assert place == "case.mpm:25"


STEEL = "7.8d-3 210.0d3 0.3"
COOK = {"A": 90e6, "B": 292e6, "n": 0.31, "C": 0.025}
HEAT = {"m": 1.09, "T_room": 20.0, "T_melt": 1083.0, "T0": 293.0, "cp": 385.0, "chi": 1.0}
ELASTIC = {"E": 210e9, "nu": 0.3}
MIE = ("mie_gruneisen", {"c0": 3940.0, "s": 1.49, "gamma0": 1.96, "E0": 0.0, "spall_strength": 0.0})
POLYNOMIAL = dict.fromkeys(("c0", "c2", "c3", "c4", "c5", "c6", "E0"), 0.0)
# Material, its seos, then the strength and the equation of state that are wanted.
MATERIALS: list[tuple[str, str, str, dict[str, float], Any]] = [
    (f"pla1 {STEEL} 300", "", "j2", {**ELASTIC, "Y0": 300e6, "H": 0.0}, None),
    (f"pla2 {STEEL} 300 2.1d3", "", "j2",
     {**ELASTIC, "Y0": 300e6, "H": 210e9 * 2.1e9 / 207.9e9}, None),
    (f"john {STEEL} 90 292 0.31 0.025 1.09 20 1083 385 1d-3", "", "johnson_cook",
     {**ELASTIC, **COOK, **HEAT, "rate0": 1.0}, None),
    (f"sjc {STEEL} 90 292 0.31 0.025 1d-3", SEOS, "simplified_johnson_cook",
     {**ELASTIC, **COOK, "rate0": 1.0}, MIE),
    (f"sjcf {STEEL} 90 292 0.31 0.025 1d-3 0.8", SEOS, "simplified_johnson_cook",
     {**ELASTIC, **COOK, "rate0": 1.0}, MIE),
    (f"jcf {STEEL} 90 292 0.31 0.025 1.09 20 1083 385 1d-3 0.8", SEOS, "johnson_cook",
     {**ELASTIC, **COOK, **HEAT, "rate0": 1.0}, MIE),
    ("hiex 1.63d-3 6930", "seos 1 3 3.712d5 3.21d3 4.15 0.95 0.3 6993\n", "high_explosive",
     {"D": 6930.0}, ("jwl", {"A": 371.2e9, "B": 3.21e9, "R1": 4.15, "R2": 0.95, "omega": 0.3,
                             "E0": 6.993e9})),
    ("null 1d-3 2250 1d-9", "seos 1 4 50\n", "fluid", {"viscosity": 1e-6},
     ("linear", {"K": 2.25e9})),
    ("null 1d-3 2250 0", "seos 1 1 0 2250 0 0 0 0 0 0\n", "fluid", {"viscosity": 0.0},
     ("polynomial", {**POLYNOMIAL, "c1": 2.25e9})),
    (f"sjc {STEEL} 90 292 0.31 0.025 1d-3", "seos 1 4 1000\n", "simplified_johnson_cook",
     {**ELASTIC, **COOK, "rate0": 1.0}, ("linear", {"K": 7.8e9})),
    (f"dpm {STEEL} 0.3545 9.74d-3 0.1 27.48d-3", "", "drucker_prager",
     {**ELASTIC, "q_phi": 0.3545, "k_phi": 9740.0, "q_psi": 0.1, "tension": 27480.0}, None),
    (f"neoh {STEEL}", "", "neo_hookean", {"K": 175e9, "G": 210e9 / 2.6}, None),
]  # fmt: skip


@pytest.mark.parametrize(
    ("record", "seos", "model", "parameters", "eos"), MATERIALS, ids=[m[0][:4] for m in MATERIALS]
)
def test_materials(record: str, seos: str, model: str, parameters: Any, eos: Any) -> None:
    part = PART.replace("7.8d-3", record.split()[1])
    text = edited((MATE, f" 1 {record}\n{seos}"), (PART, part))
    case = of(text).case
    [material] = case.material.values()
    assert material.strength.model == model
    assert material.strength.parameters == pytest.approx(parameters, rel=1e-14)
    if eos is None:
        assert material.eos is None
    else:
        assert material.eos is not None
        assert (material.eos.model, material.eos.parameters) == (eos[0], pytest.approx(eos[1]))
    fails = [(f.model, f.parameters, f.action) for f in material.failure]
    wanted = [("plastic_strain", {"limit": 0.8}, "no_tension")] if "f " in record[:5] else []
    assert fails == wanted
    Simulation(case, threads=1).advance(1)


def test_an_eos_that_has_no_effect_is_a_note() -> None:
    found = of(edited((MATE, MATE + SEOS)))
    assert found.case.case_hash == of(GOOD).case.case_hash
    assert any("seos for material 1 (elas) is left out" in note for note in found.notes)


def test_the_linear_viscosity_acts_where_it_does_there() -> None:
    """In MPM3D-F90 only elas, neoh and null have the linear term of `bulk`."""
    two = edited(("nmat 1", "nmat 2"), (MATE, f"{MATE} 2 pla1 {STEEL} 300\n"))
    case = of(two).case
    assert case.viscosity_of("elas_1") == (1.5, 0.06)
    assert case.viscosity_of("pla1_2") == (1.5, 0.0)
    assert case.material["elas_1"].artificial_viscosity is None
    none = of(two.replace("bulk 1.5 0.06", "bulk 1.5 0")).case
    assert none.material["pla1_2"].artificial_viscosity is None
    off = of(two.replace("bulk 1.5 0.06", "bulk 0 0")).case
    assert off.viscosity_of("elas_1") == off.viscosity_of("pla1_2") == (0.0, 0.0)


EXPLOSIVE = " 1 hiex 1.63d-3 6930\nseos 1 3 3.712d5 3.21d3 4.15 0.95 0.3 6993\n"
AIR = " 1 null 1.225d-6 0.1 0\nseos 1 1 0 0 0 0 0.4 0.4 0 0.2534\n"


@pytest.mark.parametrize("records", [EXPLOSIVE, AIR])
@pytest.mark.parametrize(("bulk", "wanted"), [("bulk 0 0", (0.0, 0.0)), ("bulk 1.5 0", (1.5, 0.0))])
def test_a_gas_has_the_viscosity_of_its_file_and_not_the_default(
    records: str, bulk: str, wanted: tuple[float, float]
) -> None:
    part = PART.replace("7.8d-3", records.split()[2])
    case = of(edited((MATE, records), (PART, part), ("bulk 1.5 0.06", bulk))).case
    (name,) = case.material
    assert case.material[name].matter() == "gas"
    assert case.viscosity_of(name) == wanted


# Kind, numbers after density and dp; the points that the language gives, in its order.
def brute(kind: str, n: list[float], dp: float) -> list[tuple[float, ...]]:
    if kind in ("block", "blod"):
        ox, oy, oz, nx, ny, nz, *hole = n
        points = [
            (ox + (i + 0.5) * dp, oy + (j + 0.5) * dp, oz + (k + 0.5) * dp)
            for k in range(int(nz)) for j in range(int(ny)) for i in range(int(nx))
        ]  # fmt: skip
        if not hole:
            return points
        far = [((x - hole[0]) ** 2 + (y - hole[1]) ** 2) ** 0.5 >= hole[3] * dp
               for x, y, _ in points]  # fmt: skip
        return [p for p, keep in zip(points, far, strict=True) if keep]
    cx, cy, cz, nr = n
    reach = range(-int(nr), int(nr))
    deep = reach if kind == "sphere" else [0]
    return [
        (cx + (i + 0.5) * dp, cy + (j + 0.5) * dp, cz + (k + 0.5) * dp)
        for i in reach for j in reach for k in deep
        if ((i + 0.5) ** 2 + (j + 0.5) ** 2 + (kind == "sphere") * (k + 0.5) ** 2) < nr**2
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("kind", "numbers"),
    [
        ("block", [0.1, 0.2, 0.3, 2, 3, 4]),
        ("sphere", [0.1, 0, 2, 3]),
        ("blod", [-1, -1, 0, 4, 4, 2, 0, 0, 9, 1]),
        ("cicl", [0, 0, 1, 3]),
    ],
)
def test_points_of_a_part(kind: str, numbers: list[float]) -> None:
    words = " ".join(map(str, numbers))
    text = edited((PART, f"part {kind} 1\n 1 7.8d-3 0.4 {words}\n"))
    found = of(text)
    expected = np.array(brute(kind, numbers, 0.4))
    [part] = read_deck(split(text)).parts
    assert np.allclose(points_of(part), expected, rtol=0, atol=1e-14)
    particles = found.case.body["body_1"].particles
    assert particles is not None and particles.volumes is not None
    assert np.allclose(particles.positions, 1e-3 * expected, rtol=0, atol=1e-17)
    assert np.allclose(particles.volumes, 6.4e-11, rtol=1e-14)


def test_a_block_on_the_lattice_is_a_box_with_the_same_points() -> None:
    for offset in (0.0, -1.5, 0.25):
        numbers = [offset, 0.5, 1.0, 2, 3, 4]
        words = " ".join(map(str, numbers))
        case = with_part(f"part block 1\n 1 7.8d-3 0.5 {words}\n").case
        assert (case.body["body_1"].shape is None) == (offset == 0.25)
        x = build(case)[0].positions
        expected = 1e-3 * np.array(brute("block", numbers, 0.5))
        assert np.allclose(x[np.lexsort(x.T)], expected[np.lexsort(expected.T)], atol=1e-17)


def test_masses_of_points_and_of_another_density() -> None:
    text = "part point 1 2\n 1 1 1.0d-3 0 0 1\n 2 1 2.0d-3 0.5 0 1\n"
    [body] = build(with_part(text).case)
    assert body.mass == pytest.approx(3e-6, rel=1e-14)
    assert body.volumes.tolist() == pytest.approx([1e-6 / 7800, 2e-6 / 7800], rel=1e-14)
    found = with_part("part block 1\n 1 15.6d-3 0.5 0 0 0 2 2 2\n")
    [body] = build(found.case)
    assert body.mass == pytest.approx(8 * 15.6e-6 * 0.125, rel=1e-14)
    assert any("(+100.0%)" in note for note in found.notes)


def test_gimp_needs_particles_of_half_a_cell() -> None:
    assert of(edited(("endi\n", "gimp\nendi\n"))).case.grid.basis == "gimp"
    with pytest.raises(CaseError, match="gimp takes every particle as half a cell wide"):
        of(edited(("endi\n", "gimp\nendi\n"), (" 0.5 0 0 0", " 0.25 0 0 0")))


def two(component: int, *statements: str) -> Imported:
    more = (("nbco 1", f"nbco {max(component, 2)}"), ("endi\n", "\n".join(statements) + "\nendi\n"))
    return with_part(TWO[0], TWO[1].format(component), more=more)


def test_bodies_of_one_grid_are_bonded() -> None:
    assert with_part(TWO[0], TWO[1].format(1)).case.contact.bonded
    assert two(1).case.contact.bonded
    found = two(2)  # Without cont MPM3D-F90 never asks for the component.
    assert found.case.case_hash == two(1).case.case_hash
    assert any("stick together" in note for note in found.notes)
    assert with_part(TWO[0], TWO[1].format(7)).case.case_hash == found.case.case_hash


@pytest.mark.parametrize(("whose", "rule"), [(0, "pair"), (1, "first"), (2, "second")])
def test_contact_of_two_components(whose: int, rule: str) -> None:
    contact = two(2, f"contact lagr 0.3 {whose}").case.contact
    assert contact.enabled
    assert (contact.detection, contact.normal, contact.friction) == ("velocity", rule, 0.3)
    others = two(2, "contact others 0.3 0")  # Grids of their own, and no contact between them.
    assert not others.case.contact.enabled and "do not see each other" in others.notes[-1]
    assert two(1, "contact others").case.contact.bonded


def test_bodies_stand_in_the_order_of_their_components() -> None:
    swapped = [text.replace("block 1", "block 2") for text in TWO[:1]] + [TWO[1].format(1)]
    more = (("nbco 1", "nbco 2"), ("endi\n", "contact lagr 0 1\nendi\n"))
    assert list(with_part(*swapped, more=more).case.body) == ["body_2", "body_1"]


def test_bodies_of_one_component_are_one_body() -> None:
    third = "particle block 2\n 1 7.8d-3 0.25 1 0 1 4 4 2\n"
    cont = ("endi\n", "contact lagr 0 1\nendi\n")
    more = (("nbco 1", "nbco 2"), cont)
    found = with_part(TWO[0], TWO[1].format(2), third, more=more)
    first, second = build(found.case)
    assert (first.name, second.name) == ("body_1", "body_2")
    assert (len(first.positions), len(second.positions)) == (8, 8 + 32)
    assert second.mass == pytest.approx(7.8e-6 * (1 + 32 / 64), rel=1e-12)
    assert any("bodies 2, 3 share the grid of component 2" in note for note in found.notes)
    fast = (more[0], ("endi\n", "velo body 3 1 0 0 endv\ncontact lagr 0 1\nendi\n"))
    with pytest.raises(CaseError, match="different velocities in component 2"):
        with_part(TWO[0], TWO[1].format(2), third, more=fast)
    two = (("nmat 1", "nmat 2"), (MATE, f"{MATE} 2 pla1 {STEEL} 300\n"))
    with pytest.raises(CaseError, match="different materials in component 2"):
        with_part(TWO[0], TWO[1].format(2), third.replace("\n 1", "\n 2"), more=(*more, *two))


def test_components_are_those_of_nbco() -> None:
    cont = ("endi\n", "contact lagr 0 1\nendi\n")
    with pytest.raises(CaseError, match="is in component 3 but nbco is 2"):
        with_part(TWO[0], TWO[1].format(3), more=(("nbco 1", "nbco 2"), cont))
    with pytest.raises(CaseError, match="contact of components 1 and 2 only"):
        with_part(TWO[0], TWO[1].format(3), more=(("nbco 1", "nbco 3"), cont))


def test_gravity_must_be_that_of_all_bodies() -> None:
    both = ("endi\n", "load grav 1 0 0 -9.8d-3 grav 2 0 0 -9.8d-3 endl\nendi\n")
    case = with_part(TWO[0], TWO[1].format(1), more=(both,)).case
    assert case.run.gravity == (0.0, 0.0, -9.8)
    one = ("endi\n", "load grav 1 0 0 -9.8d-3 endl\nendi\n")
    with pytest.raises(CaseError, match="different gravity"):
        with_part(TWO[0], TWO[1].format(1), more=(one,))


def test_variables_become_fields() -> None:
    text = edited(
        (MATE, f" 1 sjcf {STEEL} 90 292 0.31 0.025 1d-3 0.8\n{SEOS}"),
        ("endi\n", "outr epef outr seqv outr volu outr engi outr fail curv epef 3\nendi\n"),
    )
    wanted = ["plastic_strain", "volume", "internal_energy", "failed"]
    assert of(text).case.output.fields == wanted


def test_detonation_points() -> None:
    record = "hiex 1.63d-3 6930\nseos 1 3 3.712d5 3.21d3 4.15 0.95 0.3 6993\ndeto 1 0 2\n"
    case = of(edited((MATE, f" 1 {record}"), (PART, PART.replace("7.8d", "1.63d")))).case
    assert [d.point for d in case.detonation] == [(0.001, 0.0, 0.002)]


def test_unit_systems() -> None:
    kinds = ("length", "mass", "time", "stress", "density", "velocity", "acceleration")
    wanted = {
        "mm-g-N-ms": (1e-3, 1e-3, 1e-3, 1e6, 1e6, 1.0, 1e3),
        "SI": (1.0,) * 7,
        "cm-g-us": (1e-2, 1e-3, 1e-6, 1e11, 1e3, 1e4, 1e10),
    }
    assert set(SYSTEMS) == set(wanted)
    for name, factors in wanted.items():
        assert tuple(float(SYSTEMS[name].factor(kind)) for kind in kinds) == factors
    assert SYSTEMS["mm-g-N-ms"].si(0.38, "length") == 0.00038
    assert of(edited(("! Unit: mm g N ms MPa", "! Unit: m kg s")), "SI").case.grid.cell_size == 1.0
    with pytest.raises(CaseError, match="not a known unit system"):
        of(GOOD, "si-units")


def test_mistakes_of_the_case_name_the_line_of_the_file() -> None:
    case = of(GOOD).case
    case.grid.box.upper = (0.001, 0.002, 0.004)
    with pytest.raises(CaseError, match=r"^case.mpm:20: body.body_1.shape reaches out"):
        build(case)


def test_a_word_reader_gives_lines() -> None:
    reader = Reader(split("spx 1\n 2,3 ! 4\n\n5"))
    assert [(w.text, w.line) for w in reader.source.words] == [
        ("spx", 1), ("1", 1), ("2", 2), ("3", 2), ("5", 4),
    ]  # fmt: skip


@pytest.mark.parametrize("kind", ["box", "particles"])
def test_a_written_case_is_the_same(tmp_path: Path, kind: str) -> None:
    text = GOOD if kind == "box" else edited((" 0.5 0 0 0", " 0.3 0 0 0"))
    found = of(text.replace("a test", 'a "test" \\ with\tall'))
    files = write_case(found, tmp_path / "new" / "case.toml")
    assert [file.name for file in files] == [
        "case.toml", *(["case_body_1.csv"] if kind == "particles" else []),
    ]  # fmt: skip
    loaded = load_case(files[0])
    assert loaded.case_hash == found.case.case_hash
    assert loaded.title == found.case.title
    assert loaded.text.startswith("# From case.mpm, an input file of MPM3D-F90")
    same = (np.array_equal(a.positions, b.positions)
            for a, b in zip(build(loaded), build(found.case), strict=True))  # fmt: skip
    assert all(same)
    assert Case.from_text(loaded.text, str(files[0])).case_hash == loaded.case_hash


def test_it_runs(tmp_path: Path) -> None:
    (tmp_path / "x.mpm").write_text(GOOD)
    case, notes = load_any(tmp_path / "x.mpm")
    assert case.file_path == str(tmp_path / "x.mpm")
    manifest = run_case(case, tmp_path / "out", threads=1, pictures=False)
    assert manifest.status == "completed" and len(notes) == 1


def test_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "x.mpm").write_text(edited((" 0.5 0 0 0", " 0.3 0 0 0")))
    done = mpm3dpp("import", "x.mpm", "-o", "y.toml", cwd=tmp_path)
    assert (done.returncode, done.stdout.split()) == (0, ["y.toml", "y_body_1.csv"])
    assert done.stderr.startswith("note: units mm-g-N-ms")
    for name in ("x.mpm", "y.toml"):
        done = mpm3dpp("check", name, cwd=tmp_path)
        assert done.returncode == 0 and "64 particles" in done.stdout
    csv, kept = (tmp_path / "y_body_1.csv"), "my own"
    csv.write_text(kept)
    for name in ("y.toml", "y_body_1.csv"):
        done = mpm3dpp("import", "x.mpm", "-o", "y.toml", cwd=tmp_path)
        assert done.stderr.startswith(f"mpm3dpp: error: {name} is there already; give another name")
        assert (done.returncode, csv.read_text()) == (2, kept)
        (tmp_path / "y.toml").unlink(missing_ok=True)
    done = mpm3dpp("import", "x.mpm", "-o", "y.toml", "--force", cwd=tmp_path)
    assert (done.returncode, csv.read_text().count("my own")) == (0, 0)
    (tmp_path / "z.mpm").write_text(GOOD.replace("endi\n", "bimp\nendi\n"))
    for words in (("check", "z.mpm"), ("run", "z.mpm"), ("import", "z.mpm"), ("run", "no.mpm"),
                  ("import", "y.toml"), ("check", "y.toml", "--units", "SI")):  # fmt: skip
        done = mpm3dpp(*words, cwd=tmp_path)
        assert done.returncode == 2 and "Traceback" not in done.stderr
        assert done.stderr.count("mpm3dpp: error: ") == 1
    done = mpm3dpp("import", "y.toml", cwd=tmp_path)
    assert (
        "y.toml is a case file, but import wants an input file of MPM3D-F90 (.mpm)" in done.stderr
    )


def test_the_file_of_the_how_to_page(tmp_path: Path) -> None:
    """It runs as it stands there."""
    page = (Path(__file__).parents[2] / "docs/how-to/bring-mpm3d-files.md").read_text()
    text = page.split("Such a file", 1)[1].split("```\n")[1]
    (tmp_path / "two.mpm").write_text(text)
    case = load_any(tmp_path / "two.mpm")[0]
    assert list(case.body) == ["body_1", "body_2"] and case.title == "two blocks"
    assert Simulation(case, threads=1).advance(10) == 10
