# SPDX-License-Identifier: BSD-3-Clause
"""Material tests against closed forms, and the command `mpm3dpp material-test`."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from mpm3dpp.base.errors import CaseError
from mpm3dpp.case.case import Material
from mpm3dpp.cli.app import app
from mpm3dpp.material_test import Options, driver, hugoniot, main, run_test, subject
from mpm3dpp.material_test.curves import heated_flow, known_curves

E, NU = 117e9, 0.35
K, G, Y = E / (3 * (1 - 2 * NU)), E / (2 * (1 + NU)), 157e6
METAL = Material(density=8930, strength={"j2": {"E": E, "nu": NU, "Y0": Y}})
COPPER = Material(
    density=8930,
    strength={"fluid": {}},
    eos={"mie_gruneisen": {"c0": 3940, "s": 1.49, "gamma0": 1.96}},
)


def stress(material: Material, **chosen: object) -> dict[str, np.ndarray]:
    options = Options(**chosen).completed()  # type: ignore[arg-type]
    return driver.stress_test("any", material, options).columns


def test_uniaxial_strain_of_j2() -> None:
    """Slope K + 4G/3 up to Y (K + 4G/3) / 2G, then K.

    The strain of a step is taken to second order, (d strain)^3 / 3 is left out: 1e-9 here.
    """
    found = stress(METAL, test="uniaxial-strain", to=-0.01, steps=1000)
    strain, limit = found["strain"], Y / (2 * G)
    exact = np.where(
        strain > -limit, (K + 4 * G / 3) * strain, -(K + 4 * G / 3) * limit + K * (strain + limit)
    )
    assert found["stress_xx"] == pytest.approx(exact, rel=1e-8, abs=1.0)
    assert found["von_mises"].max() == pytest.approx(Y, rel=1e-12)
    assert found["pressure"] == pytest.approx(-K * strain, rel=1e-8)


def test_compression_and_release() -> None:
    """E = 117 GPa, nu = 0.35: 1.404667 GPa at 1 %, -0.1046667 GPa back at zero (closed form)."""
    found = stress(METAL, test="compression-release", to=-0.01, steps=2000)
    top = int(np.argmin(found["strain"]))
    assert -found["stress_xx"][top] == pytest.approx(K * 0.01 + 2 * Y / 3, rel=1e-8)
    assert found["strain"][-1] == 0.0
    assert found["stress_xx"][-1] == pytest.approx(2 * Y / 3, rel=1e-5)  # yielded again


def test_uniaxial_stress_of_elastic() -> None:
    """E x strain with a lateral strain of -nu x strain; the sides keep 1e-11 of the stiffness."""
    found = stress(
        Material(density=1000, strength={"elastic": {"E": 1e9, "nu": 0.3}}),
        test="uniaxial-stress",
        to=0.1,
        steps=1000,
    )
    assert found["stress_xx"] == pytest.approx(1e9 * found["strain"], rel=1e-7)  # (1e-4)^2 / 3
    assert found["lateral_strain"] == pytest.approx(-0.3 * found["strain"], rel=1e-7)
    assert np.abs(found["stress_yy"]).max() < 1e-10 * 1e9


JOHNSON_COOK = {"E": 124e9, "nu": 0.34, "A": 90e6, "B": 292e6, "n": 0.31, "C": 0.025, "m": 1.09}
JOHNSON_COOK |= {"T_melt": 1356, "cp": 383}


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("rate", [1.0, 1e4])
def test_uniaxial_stress_of_johnson_cook(rate: float, sign: float) -> None:
    """(A + B ep^n) (1 + C ln rate) at constant temperature, within 1e-4.

    The rate of the plastic strain is that of the whole strain but for d stress / E, 0.4 % at
    ep = 0.1, of which the factor C makes 1e-4, and less later.
    """
    cool = Material(density=8960, strength={"johnson_cook": {**JOHNSON_COOK, "chi": 0}})
    found = stress(cool, test="uniaxial-stress", rate=rate, to=0.5 * sign, steps=500)
    ep = found["plastic_strain"]
    late = ep > 0.1
    exact = (90e6 + 292e6 * ep[late] ** 0.31) * (1 + 0.025 * np.log(rate))
    assert sign * found["stress_xx"][late] == pytest.approx(exact, rel=1e-4)


def test_adiabatic_johnson_cook() -> None:
    """OFHC copper at 1e4/s: 388.331 MPa at ep = 0.5 (ordinary differential equation, 1e-8)."""
    material = Material(density=8960, strength={"johnson_cook": JOHNSON_COOK})
    found = stress(material, test="uniaxial-stress", rate=1e4, to=0.52, steps=1040)
    at_half = np.interp(0.5, found["plastic_strain"], found["stress_xx"])
    assert at_half == pytest.approx(388.331e6, rel=1e-4)
    law = heated_flow(material, 1e4, np.linspace(0, 1, 4001))
    assert law is not None
    assert law[0][-1] == pytest.approx(435.083e6, rel=1e-5)  # the curve that is drawn
    assert law[1][-1] == pytest.approx(395.323, rel=1e-5)


def test_hugoniot_of_copper() -> None:
    """Symmetric impact at 1000 m/s: Us 4685.0 m/s, 20.9185 GPa, 9996.9 kg/m^3.

    The jump in one step is exact; what is left is bisection (2^-60) and rounding.
    """
    found = hugoniot.state("copper", COPPER, 500.0)
    assert found["shock_velocity"] == pytest.approx(4685.0, rel=1e-12)
    assert found["pressure"] == pytest.approx(20.918525e9, rel=1e-12)
    assert found["density"] == pytest.approx(9996.905615292711, rel=1e-12)
    assert found["internal_energy"] == pytest.approx(8930 * 500.0**2 / 2, rel=1e-12)


def test_hugoniot_of_a_gas() -> None:
    """Strong shocks of an ideal gas: Us = b + sqrt(b^2 + c^2), b = (gamma + 1) up / 4."""
    air = run_test("air", Options(test="hugoniot", to=1000.0, steps=10)).columns
    up, c2 = air["particle_velocity"], 1.4 * 101325 / 1.225
    b = 2.4 * up / 4
    assert air["shock_velocity"] == pytest.approx(b + np.sqrt(b**2 + c2), rel=1e-10)


def test_hugoniot_of_air_to_five_kilometres_a_second() -> None:
    """The volume comes within 2 % of its limit (gamma - 1) / (gamma + 1), where the pressure has
    its pole; behind it a shock has no state."""
    air = run_test("air", Options(test="hugoniot", to=5000.0, steps=20)).columns
    up, c2 = air["particle_velocity"], 1.4 * 101325 / 1.225
    b = 2.4 * up / 4
    exact = b + np.sqrt(b**2 + c2)
    assert air["shock_velocity"] == pytest.approx(exact, rel=1e-10)
    assert air["pressure"] == pytest.approx(101325 + 1.225 * exact * up, rel=1e-10)
    assert air["volume"] == pytest.approx(1 - up / exact, rel=1e-10)
    assert 1 / 6 < air["volume"][-1] < 1.02 / 6


@pytest.mark.parametrize("up", [1e4, 1e5, 2e5])
def test_hugoniot_of_copper_up_to_its_end(up: float) -> None:
    """Us = c0 + s up ends at V = 1 - 1/s; the model holds it from Us = 100 c0 on."""
    found = hugoniot.state("copper", COPPER, up)
    # 1 - s eta is c0 / Us, down to 1/77: so often the rounding of V counts, twice.
    assert found["shock_velocity"] == pytest.approx(3940 + 1.49 * up, rel=1e-11)


def test_a_pressure_with_a_maximum_has_no_stronger_shock() -> None:
    """p = c1 mu - c2 mu^2 is largest at mu = c1 / 2 c2; beyond it there is no shock to find."""
    weak = {"polynomial": {"c1": 1e9, "c2": -5e9, "c3": 0.0, "c4": 0, "c5": 0, "c6": 0, "E0": 0}}
    soft = Material(density=1000, strength={"fluid": {}}, eos=weak)
    largest = (1e9 * 0.1 - 5e9 * 0.1**2) * (1 - 1 / 1.1) / 1000  # up^2 at the maximum of p
    assert hugoniot.state("soft", soft, 0.9 * largest**0.5)["volume"] > 1 / 1.1
    with pytest.raises(CaseError, match="has no shock of particle velocity"):
        hugoniot.state("soft", soft, 2 * largest**0.5)


def test_free_sides_take_one_step_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """Each root resumes from the state of the step before: the work grows with the steps alone."""
    steps = []
    whole = driver.drive_point

    def counted(*given: object, **more: object) -> object:
        steps.append(len(more["increments"]))  # type: ignore[arg-type]
        return whole(*given, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(driver, "drive_point", counted)
    found = stress(METAL, test="uniaxial-stress", to=0.02, steps=200)
    assert sum(steps) < 12 * 200
    assert np.abs(found["stress_yy"]).max() < 1e-10 * E


def test_the_line_of_a_hardening_metal_says_its_slope() -> None:
    options = Options(test="uniaxial-strain").completed()
    hard = Material(density=8930, strength={"j2": {"E": E, "nu": NU, "Y0": Y, "H": 1e9}})
    [perfect], [hardening] = known_curves(METAL, options), known_curves(hard, options)
    assert perfect.label == "slopes K + 4G/3, then K"
    assert hardening.label == "slopes K + 4G/3, then K + 4G/3 H / (3G + H)"


def test_known_curves_are_followed() -> None:
    """Every curve that a picture shows is met by the test that it is drawn with."""
    hard = Material(density=8930, strength={"j2": {"E": E, "nu": NU, "Y0": Y, "H": 1e9}})
    rubber = Material(density=1000, strength={"neo_hookean": {"K": 1e8, "G": 1e7}})
    elastic = Material(density=1000, strength={"elastic": {"E": 1e9, "nu": 0.3}})
    tests = [(hard, "uniaxial-strain"), (hard, "uniaxial-stress"), (rubber, "shear")]
    tests += [(elastic, "shear"), (elastic, "uniaxial-strain"), (elastic, "uniaxial-stress")]
    for material, test in tests:
        options = Options(test=test, to=-0.05 if test != "shear" else 0.5).completed()
        found = driver.stress_test("any", material, options).columns
        [curve] = known_curves(material, options)
        order = np.argsort(curve.x)
        wanted = np.interp(found["strain"], curve.x[order], curve.y[order])
        name = "stress_xy" if test == "shear" else "stress_xx"
        error = np.abs(found[name] - wanted).max()
        # A kink between two points of 400 to 500 steps, or a chord of 200 of a sine.
        assert error < 2e-3 * np.abs(wanted).max(), (material.strength.model, test)


def test_temperature_softens() -> None:
    cold = run_test("copper_ofhc", Options("uniaxial-stress", 1e3, 0.1, 50)).columns
    hot = run_test("copper_ofhc", Options("uniaxial-stress", 1e3, 0.1, 50, 600.0)).columns
    assert hot["temperature"][0] == 600.0
    assert hot["stress_xx"][-1] < 0.9 * cold["stress_xx"][-1]


@pytest.mark.parametrize(
    ("given", "options", "sentence"),
    [
        ("coper_ofhc", {}, 'did you mean "copper_ofhc"?'),
        ("steel_1006", {"test": "hugoniot"}, "has no equation of state"),
        ("tnt", {"test": "hugoniot"}, "is a high explosive"),
        ("tnt", {}, "is a high explosive"),
        ("water", {"test": "uniaxial-stress"}, "is a fluid"),
        ("lead", {"rate": -1.0}, "--rate = -1.0 must be > 0"),
        ("lead", {"rate": float("nan")}, "must be > 0"),
        ("lead", {"rate": float("inf")}, "--rate = Infinity must be > 0 and finite"),
        ("lead", {"rate": 1e-310}, "must lie between 1e-09 and 1e+12; it is in 1/s"),
        ("lead", {"rate": 1e308}, "must lie between 1e-09 and 1e+12; it is in 1/s"),
        ("lead", {"to": float("inf")}, "--to = Infinity must be finite"),
        ("lead", {"to": float("nan")}, "--to = NaN must be finite"),
        ("lead", {"to": 1e-300}, "must be at least 1e-09 in size"),
        ("lead", {"steps": float("nan")}, "--steps = NaN must be from 2"),
        ("lead", {"steps": 10.5}, "give a whole number"),
        ("copper_ofhc", {"temperature": float("inf")}, "must be > 0 and finite"),
        ("copper_ofhc", {"temperature": 1356.0}, "1356 K: molten metal has no strength"),
        ("copper_ofhc", {"temperature": 2000.0}, "--temperature = 2000.0 is not below the melting"),
        ("lead", {"to": 0.0}, "--to = 0.0 must not be zero"),
        ("lead", {"to": 50.0}, "must lie between -5 and 5"),
        ("lead", {"steps": 1}, "--steps = 1 must be from 2"),
        ("lead", {"test": "sheer"}, 'did you mean "shear"?'),
        ("lead", {"test": "hugoniot", "rate": 1.0}, "has no meaning for the test hugoniot"),
        ("lead", {"test": "hugoniot", "to": -5.0}, "--to = -5.0 must be > 0"),
        ("lead", {"test": "hugoniot", "to": 1e6}, "has no shock of particle velocity"),
        ("lead", {"temperature": 300.0}, "knows no temperature"),
        ("nowhere.toml:lead", {}, "there is no such file"),
    ],
)
def test_mistakes_are_one_sentence(
    given: str, options: dict[str, float | str], sentence: str
) -> None:
    with pytest.raises(CaseError) as caught:
        run_test(given, Options(**options))  # type: ignore[arg-type]
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


CASE = """
grid = { dimension = 3, cell_size = 1 }
run = { end_time = 1 }
material.hard = { library = "lead", density = 11000 }
material.soft = { density = 1000, strength.elastic = { E = "1 MPa", nu = 0.3 } }
material.punch = { density = 7800, strength.rigid = {} }
body.cube = { material = "soft", shape.box = { lower = [0, 0, 0], upper = [1, 1, 1] } }
"""


def test_material_of_a_case_file(tmp_path: Path) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE)
    assert run_test(f"{path}:hard", Options(steps=2)).material.density == 11000
    with pytest.raises(
        CaseError, match='"sof" is not a material of this case; did you mean "soft"'
    ):
        run_test(f"{path}:sof", Options(steps=2))
    with pytest.raises(CaseError, match="has several materials"):
        run_test(str(path), Options(steps=2))
    for test, word in (("shear", "has no stress"), ("hugoniot", "no shock runs through it")):
        with pytest.raises(CaseError, match=f'"punch" is rigid: .*{word}; test the other'):
            run_test(f"{path}:punch", Options(test=test))
    single = (line for line in CASE.splitlines() if "hard" not in line and "punch" not in line)
    path.write_text("\n".join(single))
    assert run_test(str(path), Options(steps=2)).name == "soft"


DECKS = Path(__file__).parents[1] / "verification" / "mpm"


def test_material_of_a_file_of_mpm3d(tmp_path: Path) -> None:
    """As run and check read it: units of the file, SI inside, and a word on what differs."""
    deck = DECKS / "TNT3D.mpm"
    name, material, notes = subject.find(f"{deck}:sjc_2")
    assert name == "sjc_2" and material.strength.model == "simplified_johnson_cook"
    assert any("units mm-g-N-ms" in note for note in notes)
    assert subject.find(str(DECKS / "elas125k.mpm")).name == "elas_1"
    text = main(f"{deck}:sjc_2", Options(test="shear", steps=20), tmp_path, json=False)
    assert "note: units mm-g-N-ms" in text
    with pytest.raises(CaseError, match='"sjc" is not a material of this case; did you mean'):
        subject.find(f"{deck}:sjc")
    with pytest.raises(CaseError, match='--units = "SI" is for files of MPM3D-F90'):
        subject.find("lead", "SI")


def test_command_writes_a_table_and_a_picture(tmp_path: Path) -> None:
    arguments = ["material-test", "copper_ofhc", "--test", "hugoniot", "--to", "1000"]
    done = CliRunner().invoke(app, [*arguments, "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert "shock_velocity" in done.output and "[GPa]" in done.output
    assert (tmp_path / "copper_ofhc_hugoniot.png").stat().st_size > 10_000
    head = (tmp_path / "copper_ofhc_hugoniot.csv").read_text().splitlines()[0]
    assert head.startswith("particle_velocity [m/s],shock_velocity [m/s],pressure [Pa]")
    done = CliRunner().invoke(app, [*arguments, "--out", str(tmp_path), "--json"])
    found = json.loads(done.output)
    assert found["columns"]["shock_velocity"][-1] == pytest.approx(3940 + 1489, rel=1e-9)
    assert found["table"]["density"] == 8960.0


def test_every_test_of_a_metal_draws(tmp_path: Path) -> None:
    for test in ("uniaxial-strain", "uniaxial-stress", "shear", "compression-release"):
        text = main("lead", Options(test=test, steps=20), tmp_path, json=False)
        assert "plastic_strain" in text
    assert len(list(tmp_path.glob("*.png"))) == 4
