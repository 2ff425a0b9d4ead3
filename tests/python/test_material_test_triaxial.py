# SPDX-License-Identifier: BSD-3-Clause
"""The triaxial compression of `mpm3dpp material-test`, against the soils' closed forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from mpm3dpp.base.errors import CaseError
from mpm3dpp.material_test import Options, main, run_test

SOIL = {"E": "10 MPa", "nu": 0.3}
MODELS = {
    # phi = 30 degrees, c = 10 kPa, without dilation; the cone is the outer one.
    "drucker_prager": {"q_phi": 0.6928203230275509, "k_phi": "12 kPa", "q_psi": 0.0},
    "mohr_coulomb": {"friction_angle": "30 deg", "cohesion": "10 kPa", "dilation_angle": 0.0},
}


def case_file(folder: Path, model: str, constants: dict[str, object]) -> str:
    """Write a case with one soil and return what names it."""
    table = ", ".join(f"{k} = {v!r}".replace("'", '"') for k, v in (SOIL | constants).items())
    text = f"""
[grid]
dimension = 2
cell_size = "1 m"
[run]
end_time = "1 s"
[material.soil]
density = "1800 kg/m^3"
strength = {{ {model} = {{ {table} }} }}
[body.block]
material = "soil"
shape = {{ box = {{ lower = [0, 0], upper = [1, 1] }} }}
"""
    path = folder / "soil.toml"
    path.write_text(text)
    return f"{path}:soil"


@pytest.mark.parametrize("model", list(MODELS))
def test_it_fails_where_the_closed_form_says(tmp_path: Path, model: str) -> None:
    """N p + 2 c sqrt(N) = 334.641 kPa for phi = 30 degrees, c = 10 kPa, p = 100 kPa; to 1e-6."""
    subject = case_file(tmp_path, model, MODELS[model])
    result = run_test(subject, Options(test="triaxial", to=-0.06, steps=60))
    axial, side = result.columns["stress_xx"], result.columns["stress_yy"]
    assert axial[0] == pytest.approx(-100e3, rel=1e-8)
    assert side == pytest.approx(np.full(61, -100e3), rel=1e-6)
    assert -axial[-1] == pytest.approx(334_641.016, rel=1e-6)
    # Elastic until then: the deviator rises by E times the strain.
    assert result.columns["deviator"][1] == pytest.approx(10e6 * 0.001, rel=1e-3)
    printed = main(subject, Options(test="triaxial", to=-0.06, steps=60), tmp_path, False)
    assert "fails at a deviator of 234.641 kPa (axial pressure 334.641 kPa" in printed
    assert (tmp_path / "soil_triaxial.png").stat().st_size > 10_000


def test_another_cell_pressure(tmp_path: Path) -> None:
    """With c = 0 the deviator at failure is proportional to the pressure, 2 p at 30 degrees."""
    sand = MODELS["mohr_coulomb"] | {"cohesion": 0.0}
    subject = case_file(tmp_path, "mohr_coulomb", sand)
    for pressure in (50e3, 400e3):
        result = run_test(subject, Options(test="triaxial", to=-0.1, steps=100, pressure=pressure))
        assert result.columns["deviator"].max() == pytest.approx(2 * pressure, rel=1e-6)


def test_a_test_that_ends_before_failure_says_so(tmp_path: Path) -> None:
    subject = case_file(tmp_path, "mohr_coulomb", MODELS["mohr_coulomb"])
    printed = main(subject, Options(test="triaxial", to=-0.01, steps=20), tmp_path, False)
    assert "has not failed: the deviator still grows at the end" in printed


def test_a_metal_fails_at_its_yield_stress_at_any_pressure(tmp_path: Path) -> None:
    subject = case_file(tmp_path, "j2", {"Y0": "20 kPa"})
    printed = main(subject, Options(test="triaxial", to=-0.01, steps=20), tmp_path, False)
    assert "fails at a deviator of 20 kPa" in printed


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (Options(test="triaxial", to=0.1), "--to"),
        (Options(test="triaxial", pressure=-1.0), "--pressure"),
        (Options(test="shear", pressure=1e5), "has no meaning for the test shear"),
    ],
)
def test_what_makes_no_sense_is_refused(options: Options, words: str) -> None:
    with pytest.raises(CaseError) as error:
        options.completed()
    assert words in str(error.value)


def test_sand_that_is_free_on_all_sides_bears_nothing(tmp_path: Path) -> None:
    sand = MODELS["mohr_coulomb"] | {"cohesion": 0.0}
    subject = case_file(tmp_path, "mohr_coulomb", sand)
    with pytest.raises(CaseError) as error:
        run_test(subject, Options(test="uniaxial-stress", to=-0.1, steps=20))
    assert "has no cohesion" in str(error.value)
    assert "triaxial" in str(error.value)
