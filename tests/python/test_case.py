# SPDX-License-Identifier: BSD-3-Clause
"""The case: SI values, defaults, both doors (file and Python), hash, and what build makes of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import mpm3dpp
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.machine import thread_count
from mpm3dpp.case.body import Body
from mpm3dpp.case.box import GridBox
from mpm3dpp.case.case import Case, Material, load_case
from mpm3dpp.case.file import locate_keys, parse
from mpm3dpp.case.grid import Grid
from mpm3dpp.case.pairs import laws_of
from mpm3dpp.case.parts import Contact, ContactPair, Output, Run
from mpm3dpp.fill.build import build, warnings
from mpm3dpp.io.folders import default_folder
from mpm3dpp.materials import Failure, Strength, catalogue, listing
from mpm3dpp.run.summary import echo, occupied_cells, time_step
from mpm3dpp.shapes import Box, Disc, Sphere

RINGS = """\
title = "Rings"
[grid]
dimension = 2
cell_size = "2 mm"
box.lower = ["0 mm", "0 mm"]
box.upper = ["200 mm", "100 mm"]
box.walls = { x_min = "symmetry" }
[run]
end_time = "3.5 ms"
viscosity = {}
[[contact.pair]]
materials = ["rubber", "rubber"]
friction = 0.2
[[contact.pair]]
bodies = ["right", "left"]
friction = 0.3
[material.rubber]
density = "1010 kg/m^3"
strength = { neo_hookean = { K = "121.7 MPa", G = "26.1 MPa" } }
[body.left]
material = "rubber"
shape.ring = { centre = ["50 mm", "50 mm"], inner_radius = "30 mm", outer_radius = "40 mm" }
velocity = ["30 m/s", 0]
[body.right]
material = "rubber"
shape.ring = { centre = ["150 mm", "50 mm"], inner_radius = "30 mm", outer_radius = "40 mm" }
velocity = ["-30 m/s", 0]
angular_velocity = "2 rad/s"
[body.third]
material = "rubber"
shape = { disc = { centre = ["100 mm", "10 mm"], radius = "6 mm" } }
"""


def cube(**keys: object) -> Case:
    parts: dict[str, object] = {
        "grid": Grid(dimension=3, cell_size=0.1),
        "run": Run(end_time="1 s"),
        "material": {"any": Material(density=2000, strength={"elastic": {"E": 1e6, "nu": 0.25}})},
        "body": {"cube": Body(material="any", shape=Box(lower=(0, 0, 0), upper=(1, 1, 1)))},
    }
    return Case(**(parts | keys))


def test_si_values_and_defaults() -> None:
    case = Case.from_text(RINGS)
    assert case.grid.cell_size == 0.002
    assert case.grid.origin == case.grid.lower == (0.0, 0.0)
    assert case.grid.box_cells == (100, 50)
    assert case.grid.walls == ("slip", "free", "free", "free", "free", "free")
    assert (case.run.scheme, case.run.cfl, case.run.end_time) == ("usf", 0.4, 0.0035)
    assert case.run.gravity == (0.0, 0.0)
    assert case.run.viscosity is not None
    assert (case.run.viscosity.quadratic, case.run.viscosity.linear) == (1.5, 0.06)
    assert (case.output.frames, case.output.history_every) == (50, 1)
    assert (case.contact.detection, case.contact.normal) == ("gap", "plane")
    assert case.material["rubber"].strength.model == "neo_hookean"
    assert case.material["rubber"].strength.parameters == {"K": 121.7e6, "G": 26.1e6}
    left = case.body["left"]
    assert (left.velocity, left.angular_velocity, left.particles_per_cell) == (
        (30.0, 0.0),
        (0.0,),
        None,
    )
    assert case.text == RINGS


def test_laws_of_pairs() -> None:
    # left-right by name; the others by material, though that entry stands first.
    assert laws_of(Case.from_text(RINGS)) == [
        (0, 1, 0.3, 1.0),
        (0, 2, 0.2, 1.0),
        (1, 2, 0.2, 1.0),
    ]


def test_frame_times() -> None:
    case = Case.from_text(RINGS)
    times = case.frame_times()
    assert (times[0], times[-1], len(times)) == (0.0, 0.0035, 51)
    case.output = Output(interval="1 ms")
    assert case.frame_times() == [0.0, 0.001, 0.002, 0.003, 0.0035]
    case.output = Output(interval="0.5 ms")
    assert len(case.frame_times()) == 8  # The last multiple of the interval is the end itself.


def test_hash_does_not_depend_on_spelling() -> None:
    case = Case.from_text(RINGS)
    spelled = RINGS.replace('"3.5 ms"', "0.0035   # s").replace('"40 mm"', '"4 cm"')
    spelled = spelled.replace('"1010 kg/m^3"', '"1.01 g/cm^3"')
    assert Case.from_text(spelled).case_hash == case.case_hash
    assert Case.model_validate(case.table()).case_hash == case.case_hash
    assert Case.from_text(RINGS.replace('"3.5 ms"', '"3.6 ms"')).case_hash != case.case_hash


def test_hash_does_not_depend_on_the_last_digits() -> None:
    assert 0.1 + 0.2 != 0.3
    assert cube(run=Run(end_time=0.1 + 0.2)).case_hash == cube(run=Run(end_time=0.3)).case_hash


def test_python_objects_make_the_same_case() -> None:
    text = """
    grid = { dimension = 3, cell_size = "100 mm" }
    run = { end_time = 1 }
    material.any = { density = 2000, strength.elastic = { E = "1 MPa", nu = 0.25 } }
    body.cube = { material = "any", shape.box = { lower = [0, 0, 0], upper = [1, 1, 1] } }
    """
    assert Case.from_text(text).case_hash == cube().case_hash


def test_assignments_are_checked() -> None:
    case = cube()
    case.run.end_time = "2 ms"
    assert case.run.end_time == 0.002
    with pytest.raises(CaseError, match=r"run.end_time = -1 must be > 0"):
        case.run.end_time = -1
    assert case.run.end_time == 0.002
    case.body["cube"].material = "steel"
    with pytest.raises(CaseError, match=r'body.cube.material = "steel" is not a material'):
        build(case)


def test_build_of_a_cube() -> None:
    [body] = build(cube())
    assert body.positions.shape == (8000, 3)
    assert body.velocities.shape == (1, 3)
    assert body.volumes.shape == (8000,)
    assert body.mass == pytest.approx(2000, rel=1e-12)  # 8000 terms, one multiplication
    assert body.mass_error == pytest.approx(0, abs=1e-12)
    assert body.volume_is_exact


def test_spin_is_about_the_mass_centre() -> None:
    case = Case.from_text(RINGS)
    right = build(case)[1]
    arm = right.positions - np.array([0.15, 0.05])
    wanted = np.array([-30, 0]) + 2 * np.column_stack([-arm[:, 1], arm[:, 0]])
    assert right.velocities == pytest.approx(wanted, rel=1e-12, abs=1e-12)
    turned = cube(
        body={"cube": cube().body["cube"].model_copy(update={"angular_velocity": (1.0, 2.0, 3.0)})}
    )
    [body] = build(turned)
    arm = body.positions - 0.5
    assert body.velocities == pytest.approx(np.cross([1, 2, 3], arm), abs=1e-12)


def test_coarse_filling_warns() -> None:
    shape = Disc(centre=(0.05, 0.05), radius=0.09)
    case = cube(
        grid=Grid(dimension=2, cell_size=0.1),
        body={"disc": Body(material="any", shape=shape, fill="lattice")},
    )
    bodies = build(case)
    assert abs(bodies[0].mass_error) > 0.05
    [sentence] = warnings(bodies)
    assert "body.disc" in sentence
    assert f"warning: {sentence}" in echo(case, bodies)


def test_echo_names_time_step_and_cells() -> None:
    case = cube()
    bodies = build(case)
    # E = 1e6, nu = 0.25: M = 1.2e6 Pa, c = sqrt(600) m/s; 1e-6 of strain, so 1e-5 of c.
    assert case.material["any"].sound_speed() == pytest.approx(600**0.5, rel=1e-5)
    assert time_step(case, bodies) == pytest.approx(0.04 / 600**0.5, rel=1e-5)
    assert occupied_cells(case, bodies) == 1000
    assert "8,000 particles" in echo(case, bodies)


def test_lines_of_keys() -> None:
    toml = (
        "# comment [a]\n"  # 1
        'a = """x = 1\n'  # 2
        '[no.table]\n"""\n'  # 3 and 4
        "b.c = [1, [2,\n"  # 5
        " 3], { d = 4 }]   # ]\n"  # 6
        "[e.'f g'.\"h\"]\n"  # 7
        "i = 1979-05-27T07:32:00Z\n"  # 8
        "[[j]]\n"  # 9
        "k = { l.m = -1.5e3, n = 'it' }\n"  # 10
        "[[j]]\n"  # 11
        "[j.o]\n"  # 12
        'p = "\\"q = 1"\n'  # 13
    )
    tables = parse(toml, "case.toml")
    lines = locate_keys(toml)
    assert lines["a",] == 2
    assert lines["b", "c"] == 5
    assert lines["b", "c", 1, 0] == 5
    assert lines["b", "c", 1, 1] == 6
    assert lines["b", "c", 2, "d"] == 6
    assert lines["e", "f g", "h", "i"] == 8
    assert lines["j", 0, "k", "l", "m"] == 10
    assert lines["j", 1, "o", "p"] == 13
    assert lines["j", 1] == 11

    def paths(value: object, path: tuple[str | int, ...] = ()) -> set[tuple[str | int, ...]]:
        below = value.items() if isinstance(value, dict) else ()
        below = enumerate(value) if isinstance(value, list) else below
        return {path}.union(*(paths(item, (*path, key)) for key, item in below))

    assert paths(tables) - set(lines) <= {()}


def test_strength_from_the_catalogue() -> None:
    assert Strength(model="elastic", parameters={"E": "1 MPa", "nu": 0.2}).parameters["E"] == 1e6
    with pytest.raises(CaseError, match=r"strength.nu is missing"):
        Strength(model="elastic", parameters={"E": 1})
    for name, model in catalogue().items():
        assert f"  {name} " in listing()
        assert f"{name} (strength model)" in listing(name)
        assert all(f" {p.name} " in listing(name) for p in model.parameters)


def test_contact_needs_two_bodies() -> None:
    assert not cube().contact_enabled
    assert Case.from_text(RINGS).contact_enabled
    assert not Case.from_text(
        RINGS.replace("[[contact", "[contact]\nenabled = false\n[[contact", 1)
    ).contact_enabled


def test_a_box_in_python() -> None:
    box = GridBox(lower=(0, 0, 0), upper=(1, 1, 1), walls="fixed")
    grid = Grid(dimension=3, cell_size=0.1, box=box)
    assert grid.walls == ("fixed",) * 6
    assert grid.box_cells == (10, 10, 10)
    ball = Body(material="any", shape=Sphere(centre=(0.5, 0.5, 0.95), radius=0.2))
    with pytest.raises(CaseError, match=r"body.ball.shape reaches out of grid.box: .* z > 1 m"):
        build(cube(grid=grid, body={"ball": ball}))


def test_contact_pair_in_python() -> None:
    pair = ContactPair(bodies=["cube", "other"], friction=0.1)
    with pytest.raises(CaseError, match=r'contact.pair\[0\].bodies\[1\] = "other" is not a body'):
        cube(contact=Contact(pair=[pair]))


def test_json_schema_lists_every_shape() -> None:
    schema = Case.json_schema()
    assert "ring" in schema["$defs"]["shape"]["properties"]
    assert schema["additionalProperties"] is False


def test_names_of_the_package() -> None:
    assert mpm3dpp.load_case is load_case
    assert mpm3dpp.shapes.Disc is Disc
    assert mpm3dpp.__version__
    with pytest.raises(AttributeError):
        _ = mpm3dpp.nothing


def test_the_path_of_the_file_is_that_of_one_that_was_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("case.toml").write_text(RINGS)
    (tmp_path / "elsewhere").mkdir()
    case = load_case("case.toml")
    monkeypatch.chdir("elsewhere")
    assert case.file_path == str(tmp_path / "case.toml")
    assert Case.from_text(RINGS).file_path == Case.from_text(RINGS, "rings.toml").file_path == ""
    assert Case(**case.table()).file_path == ""


def test_default_folder_and_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    folder = Path("examples/01_two_rings")
    assert default_folder(folder / "case.toml") == Path("results/01_two_rings")
    assert default_folder(folder / "case_velocity.toml") == Path("results/01_two_rings_velocity")
    assert default_folder(folder / "rings.toml") == Path("results/rings")
    monkeypatch.setenv("OMP_NUM_THREADS", "3,1")
    assert thread_count(None) == 3
    assert thread_count(2) == 2
    for wrong in ("many", "0", "-1", "2.5", "4097", "9" * 5000):
        monkeypatch.setenv("OMP_NUM_THREADS", wrong)
        sentence = r"OMP_NUM_THREADS = \S+ must be a whole number from 1 to 4096; unset it"
        with pytest.raises(CaseError, match=sentence):
            thread_count(None)


@pytest.mark.parametrize(
    ("material", "reason"),
    [
        ({"density": 1000, "strength": {"fluid": {}}}, "give the material an eos"),
        (
            {
                "density": 8960,
                "strength": {
                    "johnson_cook": {
                        "E": 1e11, "nu": 0.3, "A": 9e7, "B": 3e8, "n": 0.3, "C": 0.02, "m": 1.0,
                        "T_melt": 298.0, "cp": 383.0,
                    }
                },
            },
            r"johnson_cook.T_melt = 298.0 must be > T_room \(T_room = 298\)",
        ),
        (
            {
                "density": 1000,
                "strength": {"neo_hookean": {"K": 1e7, "G": 1e6}},
                "eos": {"linear": {"K": 1e9}},
            },
            "takes no eos",
        ),
        (
            {
                "density": 1000,
                "strength": {"elastic": {"E": 1e7, "nu": 0.3}},
                "failure": {"plastic_strain": {"limit": 1.0}},
            },
            "needs a plastic strain",
        ),
        *[
            (
                {
                    "density": 1000,
                    "strength": strength,
                    "eos": {"jwl": dict.fromkeys("AB", 26e6) | {
                        "R1": 0.3, "R2": 0.3, "omega": 0.3, "E0": 26e6,
                    }},
                },
                "eos.jwl has no stiffness at the start",
            )
            for strength in ({"fluid": {}}, {"high_explosive": {"D": 6930.0}})
        ],
    ],
)  # fmt: skip
def test_models_that_do_not_go_together_are_refused(material: dict, reason: str) -> None:
    with pytest.raises(CaseError, match=reason) as error:
        Case(
            grid={"dimension": 2, "cell_size": 0.1},
            run={"end_time": 1.0},
            material={"any": material},
            body={"one": {"material": "any", "shape": {"box": {"lower": [0, 0], "upper": [1, 1]}}}},
        )
    assert "material.any" in str(error.value)


def test_the_same_failure_model_twice_is_refused() -> None:
    """A table of a case file cannot hold it twice; a list in Python could, and the echo not."""
    strength = Strength(model="j2", parameters={"E": 1e9, "nu": 0.3, "Y0": 1e6})
    low, high = (Failure(model="plastic_strain", parameters={"limit": x}) for x in (0.5, 1.0))
    other = Failure(model="principal_stress", parameters={"limit": 1e6})
    material = Material(density=1000, strength=strength, failure=[low, other])
    assert set(material.table()["failure"]) == {"plastic_strain", "principal_stress"}
    with pytest.raises(CaseError) as error:
        Material(density=1000, strength=strength, failure=[low, other, high])
    assert str(error.value) == (
        "material.failure.plastic_strain stands here twice, and a material has each failure model "
        "once; leave one of them out"
    )


def test_one_body_must_deform() -> None:
    rigid = {"density": 1000, "strength": {"rigid": {}}}
    body = {"material": "tool", "shape": {"box": {"lower": [0, 0], "upper": [1, 1]}}}
    with pytest.raises(CaseError, match=r"body holds rigid bodies only.*one must deform; give"):
        Case(
            grid={"dimension": 2, "cell_size": 0.1},
            run={"end_time": 1.0},
            material={"tool": rigid},
            body={"one": body},
        )
