# SPDX-License-Identifier: BSD-3-Clause
"""Notes: what is allowed in a case but perhaps not meant is said by check and by run."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

from mpm3dpp import Case, CaseError, Simulation, load_case
from mpm3dpp.cli.app import app
from mpm3dpp.fill.advisories import notes
from mpm3dpp.fill.build import build
from mpm3dpp.importers.mpm3d.lexer import split
from mpm3dpp.importers.mpm3d.to_case import import_source
from mpm3dpp.run.summary import steps_in_words

CASE = """\
[grid]
dimension = 2
cell_size = "1 mm"
[run]
viscosity = {}
end_time = "1 us"
[material.tnt]
library = "tnt"
[material.steel]
density = 7800
strength = { elastic = { E = "200 GPa", nu = 0.3 } }
[body.charge]
material = "tnt"
shape = { box = { lower = [0, 0], upper = ["4 mm", "4 mm"] } }
[body.plate]
material = "steel"
shape = { box = { lower = ["6 mm", 0], upper = ["9 mm", "4 mm"] } }
"""
STIFF = "[material.stiff]\ndensity = 7800\nstrength = { rigid = {} }\n[body.plate]"
LIT = '[[detonation]]\npoint = ["0.25 mm", "0.25 mm"]\n'
# D is 6930 m/s: from 10 mm away it takes 1.44 us, longer than the run.
FAR = '[[detonation]]\npoint = ["-9.75 mm", "0.25 mm"]\n'


def notes_of(text: str) -> list[str]:
    case = Case.from_text(text)
    return notes(case, build(case))


def test_an_explosive_that_nothing_lights() -> None:
    assert notes_of(CASE + LIT) == []
    [note] = notes_of(CASE)
    assert "body.charge" in note and "add [[detonation]]" in note


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("7800", "7.8", ["material.steel.density = 7.8 kg/m^3 is little for a solid", "waves in"]),
        ("7800", "7.8e6", ["material.steel.density = 7.8e+06 kg/m^3 is more than any solid has"]),
        ("200 GPa", "200 TPa", ["waves in material.steel run at"]),
        ("7800", "500", ["waves in material.steel run at 2.32"]),
        ("7800", "1000", []),
    ],
)
def test_numbers_that_no_material_has(old: str, new: str, told: list[str]) -> None:
    found = notes_of(CASE.replace(old, new) + LIT)
    assert len(found) == len(told)
    assert all(part in note for part, note in zip(told, found, strict=True))


def test_a_gas_may_be_light() -> None:
    eos = "eos = { ideal_gas = { gamma = 1.4, E0 = 1e5 } }"
    gas = f"density = 1.2\nstrength = {{ fluid = {{}} }}\n{eos}"
    text = CASE.replace('density = 7800\nstrength = { elastic = { E = "200 GPa", nu = 0.3 } }', gas)
    assert "ideal_gas" in text
    assert notes_of(text + LIT) == []


def test_a_detonation_that_comes_too_late() -> None:
    [note] = notes_of(CASE + FAR)
    assert "detonation[0] lights nothing" in note and "1.443e-06 s" in note
    [note] = notes_of(CASE + LIT + LIT + 'time = "1.1 us"\n')
    assert "detonation[1]" in note
    assert notes_of(CASE.replace('"1 us"', '"2 us"') + FAR) == []


def test_a_detonation_without_an_explosive() -> None:
    text = CASE.replace('"tnt"\nshape', '"steel"\nshape') + LIT
    with pytest.raises(CaseError) as caught:
        Case.from_text(text)
    line = text[: text.index("[[deto")].count("\n") + 1
    assert str(caught.value).startswith(f"case.toml:{line}: detonation[0] has nothing to light")


STEEL = 'strength = { elastic = { E = "200 GPa", nu = 0.3 } }'
JWL = '{ A = "371 GPa", B = "3.2 GPa", R1 = 4.15, R2 = 0.95, omega = 0.3, E0 = "7 GPa" }'
PLASTIC = 'strength = { j2 = { E = "200 GPa", nu = 0.3, Y0 = "1 GPa" } }'
DAMAGE = PLASTIC + "\nfailure.johnson_cook_damage = { D1 = 0.05, D2 = 3.44, D3 = SIGN2.12 }"
SOIL = "strength.drucker_prager = { E = 1e11, nu = 0.3, q_phi = FRICTION, k_phi = 1e3 }"


@pytest.mark.parametrize(
    ("material", "note"),
    [
        (DAMAGE.replace("SIGN", ""), "material.steel.failure.johnson_cook_damage.D3 = 2.12 is > 0"),
        (DAMAGE.replace("SIGN", "-"), ""),
        (
            SOIL.replace("FRICTION", "30"),
            "material.steel.strength.drucker_prager.q_phi = 30 is more",
        ),
        (SOIL.replace("FRICTION", "1.7"), ""),
        (
            f"strength = {{ fluid = {{}} }}\neos.jwl = {JWL}",
            "material.steel.eos.jwl is of the prod",
        ),
        (f"strength = {{ high_explosive = {{ D = 6930 }} }}\neos.jwl = {JWL}", ""),
    ],
)
def test_numbers_of_another_convention(material: str, note: str) -> None:
    text = CASE.replace(STEEL, material) + LIT
    assert text != CASE + LIT
    found = notes_of(text)
    assert [line.startswith(note) for line in found] == ([True] if note else [])


DECK = """\
mpm3
nbbo 1
nmat 1
grid 0 4 0 4 0 4
dcel 1
dtsc 0.5
endt 1d-3
mate
 1 MATERIAL
seos 1 3 3.712d5 3.21d3 4.15 0.95 0.3 6993
part block 1
 1 1.63d-3 0.5 0 0 0 8 8 8
deto 100 0 0
endi
"""


def test_the_same_of_a_file_of_mpm3d() -> None:
    case = import_source(split(DECK.replace("MATERIAL", "hiex 1.63d-3 6930"))).case
    [note] = notes(case, build(case))
    assert "lights nothing before the end" in note
    with pytest.raises(CaseError, match=r"mpm:13: detonation\[0\] has nothing to light"):
        import_source(split(DECK.replace("MATERIAL", "elas 7.8d-3 210d3 0.3")))


@pytest.mark.parametrize(
    ("body", "note"),
    [
        ('material = "steel"\nvelocity = ["58 km/s", 0]', ""),
        (
            'material = "steel"\nvelocity = ["60 km/s", 0]',
            "6e+04 m/s, 10.2 times the speed of sound",
        ),
        (
            'material = "steel"\nangular_velocity = 1e8',
            "times the speed of sound in its material (58",
        ),
        ('material = "stiff"\nvelocity = ["3e4 km/s", 0]', "of sound in the other materials (5875"),
        ('material = "steel"\nmotion = { velocity = ["60 km/s", 0] }', "in the other materials"),
    ],
)
def test_bodies_that_are_too_fast(body: str, note: str) -> None:
    """Waves in this steel run at 5,875 m/s."""
    solid = CASE.replace('"tnt"\nshape', '"steel"\nshape').replace("[body.plate]", STIFF)
    found = notes_of(solid.replace('material = "steel"\nshape', f"{body}\nshape", 1))
    assert [line.startswith("body.charge moves at ") and note in line for line in found] == (
        [True] if note else []
    )


def test_check_and_run_print_them(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    [note] = notes_of(CASE)
    done = CliRunner().invoke(app, ["check", str(path)])
    assert f"\nnote: {note}\n" in done.output
    assert Simulation(Case.from_text(CASE), threads=1).notes == [note]
    done = CliRunner().invoke(app, ["run", str(path), "--threads", "1", "--out", str(tmp_path)])
    assert f"note: {note}\n" in done.output


def test_steps_are_a_lower_bound_where_the_time_step_may_fall() -> None:
    def words(text: str) -> str:
        case = Case.from_text(text)
        return steps_in_words(case, build(case))

    solid = CASE.replace('"tnt"\nshape', '"steel"\nshape')
    assert words(solid).startswith("at least ")  # Steps are shorter as bodies meet, by contact.
    solid = solid.replace("shape", 'frame = "updated"\nshape')
    assert words(solid).startswith("about ")
    assert words(solid.replace('"1 us"', '"1 us"\ngravity = [0, -9.81]')).startswith("at least ")
    assert words(CASE + LIT).startswith("at least ")


def test_the_lower_bound_holds_in_a_shock_tube() -> None:
    """The shock heats the gas behind it, and waves are faster there."""
    case = load_case(Path(__file__).parents[2] / "examples" / "13_sod_tube" / "case.toml")
    case.run.end_time = 0.02
    least = int(steps_in_words(case, build(case)).split()[2])
    simulation = Simulation(case, threads=1)
    assert simulation.advance(100 * least) > least
    assert simulation.time == 0.02


def test_rubber_locks_without_volume_averaging() -> None:
    text = CASE.replace("nu = 0.3", "nu = 0.49").replace("200 GPa", "20 GPa") + LIT
    note = next(note for note in notes_of(text) if "nu = " in note)
    assert "material.steel has nu = 0.49" in note and "volume_averaging = true" in note
    averaged = text.replace("density = 7800", "density = 7800\nvolume_averaging = true")
    assert notes_of(averaged) == []


def test_springs_want_two_particles_a_cell() -> None:
    text = CASE.replace('material = "steel"', 'material = "steel"\nspacing = "1 mm"') + LIT
    [note] = notes_of(text)
    assert "body.plate has particles of 1 cells" in note and 'response = "impulses"' in note
    assert notes_of(text + '[contact]\nresponse = "impulses"\n') == []


def test_springs_between_unequal_particles() -> None:
    text = CASE.replace('material = "steel"', 'material = "steel"\nspacing = "0.1 mm"') + LIT
    [note] = notes_of(text)
    assert "body.charge has particles 5 times as large as body.plate" in note


def test_springs_reach_no_further_than_an_edge() -> None:
    [note] = notes_of(CASE + LIT + '[contact]\ngap_distance = "0.45 mm"\n')
    assert "contact.gap_distance = 0.00045 m" in note


def test_bodies_that_overlap_at_the_start() -> None:
    box = 'shape = { box = { lower = ["6 mm", 0], upper = ["9 mm", "4 mm"] } }'
    assert Simulation(Case.from_text(CASE + LIT)).notes == []
    disc = 'shape = { disc = { centre = ["5.8 mm", "2 mm"], radius = "2 mm" } }'
    [note] = Simulation(Case.from_text(CASE.replace(box, disc) + LIT)).notes
    assert "is drawn 0.0002 m into body.charge" in note and "one of them flows" in note


def test_a_body_of_few_cells() -> None:
    thin = CASE.replace('upper = ["9 mm", "4 mm"]', 'upper = ["8 mm", "4 mm"]') + LIT
    [note] = notes_of(thin)
    assert "body.plate is 2 cells wide" in note
    # A strip that walls hold on both sides has no width of its own.
    walls = 'walls = { x_min = "slip", x_max = "slip" }'
    box = f'box = {{ lower = [0, 0], upper = ["10 mm", "4 mm"], {walls} }}'
    assert notes_of(thin.replace("[run]", f"{box}\n[run]")) == []


def test_check_refuses_a_time_step_that_cannot_run(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(CASE.replace('"1 us"', '"1 us"\ntime_step = "1 ms"') + LIT)
    result = CliRunner().invoke(app, ["check", str(tmp_path / "case.toml")])
    assert result.exit_code != 0


BONDED = """
[grid]
dimension = 2
cell_size = "5 mm"
[run]
end_time = "1 ms"
[material.rubber]
density = 1000
strength = { neo_hookean = { K = "0.8333 MPa", G = "0.3846 MPa" } }
[material.s]
density = 7800
strength = { rigid = {} }
[[contact.pair]]
PAIR
bonded = true
[body.strip]
material = "rubber"
frame = "updated"
shape = { box = { lower = [0, 0], upper = ["50 mm", "20 mm"] } }
[body.left]
material = "WHAT"
motion = "fixed"
shape = { box = { lower = ["-15 mm", 0], upper = [0, "20 mm"] } }
[body.right]
material = "s"
shape = { box = { lower = ["50 mm", 0], upper = ["65 mm", "20 mm"] } }
"""


@pytest.mark.parametrize(
    ("pair", "what", "named"),
    [
        ('bodies = ["strip", "left"]', "s", "left, which does"),
        ('bodies = ["strip", "left"]', "rubber", "left, which does"),  # Driven, of the same.
        ('bodies = ["right", "strip"]', "s", "right, which does"),  # Free to move.
        ('materials = ["rubber", "s"]', "s", "left and right, which do"),
    ],
)
def test_bonds_of_bodies_that_do_not_deform_let_go(pair: str, what: str, named: str) -> None:
    case = Case.from_text(BONDED.replace("PAIR", pair).replace("WHAT", what))
    *free, said = [note for note in notes(case, build(case)) if "bonded" in note]
    # The left one is fixed, the right one rigid and free.
    assert bool(free) == ("right" in named)
    assert all("rigid and free" in note and 'run.transfer = "flip"' in note for note in free)
    assert said.startswith(f"strip is bonded to {named} not deform: such a bond (contact.pair")
    assert "grid.box.walls" in said
    soft = BONDED.replace("PAIR", 'bodies = ["strip", "right"]').replace("WHAT", "s")
    soft = soft.replace('"s"\nshape', '"rubber"\nshape')
    case = Case.from_text(soft)
    assert not [note for note in notes(case, build(case)) if "bonded" in note]


CROWD = """
[grid]
dimension = 3
cell_size = "1 mm"
[run]
end_time = "1 us"
[material.soft]
density = 1000
strength = {{ elastic = {{ E = "1 MPa", nu = 0.3 }} }}
[contact]
response = "{response}"
[grains.all]
material = "soft"
lattice = {{ lower = [0, 0, 0], count = [{n}, {n}, {n}], radius = "{radius} mm" }}
"""


@pytest.mark.parametrize(
    ("response", "n", "radius", "is_said"),
    [
        ("impulses", 3, 1.0, True),
        ("impulses", 2, 1.0, False),
        ("impulses", 3, 1.6, False),
        ("springs", 3, 1.0, False),
    ],
)
def test_impulses_of_crowds_of_small_grains(
    response: str, n: int, radius: float, is_said: bool
) -> None:
    case = Case.from_text(CROWD.format(response=response, n=n, radius=radius))
    said = [note for note in notes(case, build(case)) if "sweeps" in note]
    assert bool(said) == is_said
    if said:
        assert said[0].startswith("grains.all has 27 grains of 2 cells: where they lie close")
        assert 'give contact.response = "springs", or smaller cells' in said[0]
