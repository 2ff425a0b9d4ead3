# SPDX-License-Identifier: BSD-3-Clause
"""Where and by what a material fails in a material test."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from mpm3dpp.case.case import Material
from mpm3dpp.material_test import Options, Result, driver, main, run_test

E, Y = 100e9, 200e6
CASE = """
grid = {{ dimension = 3, cell_size = 1 }}
run = {{ end_time = 1 }}
[material.bar]
density = 8000
strength.j2 = {{ E = "100 GPa", nu = 0.3, Y0 = "200 MPa" }}
{failure}
[body.cube]
material = "bar"
shape.box = {{ lower = [0, 0, 0], upper = [1, 1, 1] }}
"""


def case(folder: Path, *failure: str) -> str:
    """Return a case file with a bar that fails so."""
    path = folder / "case.toml"
    path.write_text(CASE.format(failure="\n".join(f"failure.{line}" for line in failure)))
    return str(path)


def pulled(folder: Path, *failure: str) -> Result:
    return run_test(case(folder, *failure), Options("uniaxial-stress", to=0.2, steps=200))


def test_the_strain_of_failure(tmp_path: Path) -> None:
    """A bar of yield stress Y fails at the strain limit + Y / E, here between two rows."""
    found = pulled(tmp_path, "plastic_strain = { limit = 0.1005 }")
    failed = found.failed
    assert failed is not None
    assert failed.before < 0.1005 + Y / E <= failed.strain
    assert failed.strain - failed.before == pytest.approx(1e-3)
    assert failed.stress == pytest.approx(Y, rel=1e-9)
    assert failed.sentence() == (
        "fails between strain 0.102 and 0.103, at a stress xx of 200 MPa, "
        "by plastic_strain (limit = 0.1005); action no_tension"
    )
    assert not found.columns["failed"][: failed.row].any()
    assert found.columns["failed"][failed.row :].all()
    assert not found.columns["stress_xx"][failed.row :].any()


def test_the_model_that_fails_first_is_named(tmp_path: Path) -> None:
    late, early = "plastic_strain = { limit = 0.1 }", "principal_stress = { limit = '150 MPa' }"
    found = pulled(tmp_path, late, early)
    assert found.failed is not None
    assert [model.model for model in found.failed.models] == ["principal_stress"]
    assert found.failed.stress == pytest.approx(1e-3 * E, rel=1e-6)  # the step before 150 MPa
    both = pulled(tmp_path, late, "principal_strain = { limit = 0.1 }").failed
    assert both is not None
    assert [model.model for model in both.models] == ["principal_strain"]  # not Y / E later


def test_failures_with_other_actions_are_told_apart(tmp_path: Path) -> None:
    """Eroding keeps another column than the other actions; the models are still told apart."""
    eroding = "maximum_shear = { limit = '50 MPa', action = 'erode' }"
    failed = pulled(tmp_path, eroding, "plastic_strain = { limit = 0.1 }").failed
    assert failed is not None
    assert "by maximum_shear (limit = 5e+07); action erode" in failed.sentence()


def test_failure_is_reported_and_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The table and CSV have the columns, the deviation counts to the failure, the picture a mark.

    `off by` is the corner of two straight lines within one step of the strain.
    """
    from matplotlib.axes import Axes

    labels = []
    plot = Axes.plot

    def noted(self: Axes, *given: object, **more: object) -> object:
        labels.append(more.get("label"))
        return plot(self, *given, **more)  # type: ignore[arg-type]

    monkeypatch.setattr(Axes, "plot", noted)
    bar = case(tmp_path, "johnson_cook_damage = { D1 = 0.05, D2 = 0, D3 = 0 }")
    options = Options("uniaxial-stress", to=0.2, steps=200)
    text = main(bar, options, tmp_path, json=False)
    assert "by johnson_cook_damage; action no_tension" in text
    assert "before it fails" in text
    off = float(text.partition("off by ")[2].partition(" ")[0])
    assert off < 1e-3
    assert "fails: johnson_cook_damage" in labels
    head = text.splitlines()[2].split()
    assert head[-2:] == ["damage", "failed"]
    csv = (tmp_path / "bar_uniaxial_stress.csv").read_text().splitlines()[0]
    assert "failed [1]" in csv and "damage [1]" in csv
    told = json.loads(main(bar, options, tmp_path, json=True))["failed"]
    assert told["models"] == ["johnson_cook_damage"]
    assert np.diff(told["strain"]) == pytest.approx([1e-3])


def test_what_does_not_fail_says_so(tmp_path: Path) -> None:
    """The damage is the plastic strain over a strain at fracture of 1: 0.1 - Y / E."""
    bar = case(tmp_path, "johnson_cook_damage = { D1 = 1, D2 = 0, D3 = 0 }")
    text = main(bar, Options("uniaxial-stress", to=0.1, steps=50), tmp_path, json=False)
    assert "does not fail by johnson_cook_damage; damage 0.098 at the end" in text
    assert " fail" not in main("lead", Options(steps=4), tmp_path, json=False)


def test_shear_reports_its_own_stress() -> None:
    strength = {"j2": {"E": E, "nu": 0.3, "Y0": Y}}
    bar = Material(density=8000, strength=strength, failure={"plastic_strain": {"limit": 0.1}})
    failed = driver.stress_test("bar", bar, Options("shear").completed()).failed
    assert failed is not None and failed.column == "stress_xy"
    # Jaumann's rate turns the stress: at yield sigma_xy = (Y / sqrt(3)) to the order of Y / G.
    assert failed.stress == pytest.approx(Y / np.sqrt(3), rel=1e-2)
