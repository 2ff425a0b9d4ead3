# SPDX-License-Identifier: BSD-3-Clause
"""Fields of a frame that a case asks for: density, speed of sound, displacement; and numbers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from commands import CASE, write
from mpm3dpp import Case, open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import Results

FIELDS = 'fields = ["density", "sound_speed", "displacement", "volume"]'
ASKED = CASE.replace("frames = 4", f"frames = 4\n{FIELDS}")
K, G, DENSITY = 1e6 / (3 * 0.4), 1e6 / 2.6, 1000.0


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Results]:
    folder = tmp_path_factory.mktemp("fields")
    run_case(write(folder, ASKED), folder / "out", threads=1, pictures=False)
    with open_results(folder / "out") as results:
        yield results


def test_density_is_mass_over_volume(results: Results) -> None:
    first, last = results.arrays(0), results.arrays(-1)
    np.testing.assert_allclose(first["density"], DENSITY, rtol=1e-6)
    mass = DENSITY * first["volume"]
    np.testing.assert_allclose(last["density"], mass / last["volume"], rtol=1e-6)
    assert np.ptp(last["density"]) > 1.0


def test_the_speed_of_sound_is_that_of_plane_waves(results: Results) -> None:
    """sqrt((K + 4 G / 3) / rho) of an elastic solid at the start."""
    speed = results.arrays(0)["sound_speed"]
    np.testing.assert_allclose(speed, np.sqrt((K + 4 * G / 3) / DENSITY), rtol=1e-6)


def test_displacements_lead_from_the_first_frame(results: Results) -> None:
    """To the rounding of places as floats; with zeros behind the dimension."""
    start = results.arrays(0)
    assert not start["displacement"].any()
    for k in range(1, len(results)):
        frame = results.arrays(k)
        assert frame["displacement"].shape == frame["position"].shape
        way = frame["position"].astype(float) - start["position"]
        np.testing.assert_allclose(frame["displacement"], way, atol=2e-7)
    assert results.units["displacement"] == "m" and results.units["density"] == "kg/m^3"


def test_particles_have_numbers(results: Results) -> None:
    for k in (0, len(results) - 1):
        number = results.arrays(k, ["id"])["id"]
        np.testing.assert_array_equal(number, np.arange(len(number)))


def test_a_run_that_goes_on_has_the_same_displacements(tmp_path: Path, results: Results) -> None:
    path, out = write(tmp_path, ASKED), tmp_path / "out"
    run_case(path, out, threads=1, pictures=False, every="3 ms", call=lambda _: False)
    run_case(path, out, threads=1, pictures=False, resume=True)
    with open_results(tmp_path / "out") as other:
        for name in ("displacement", "sound_speed", "density"):
            np.testing.assert_array_equal(other.arrays(-1)[name], results.arrays(-1)[name])


def test_a_probe_sees_them_too(tmp_path: Path) -> None:
    """A body in free flight."""
    probe = """
[probe.nose]
body = "left"
fields = ["displacement", "density"]
"""
    text = CASE.partition("[body.right]")[0] + probe
    run_case(write(tmp_path, text), tmp_path / "out", threads=1, pictures=False)
    with open_results(tmp_path / "out") as results:
        seen = results.probe("nose")
        np.testing.assert_allclose(
            seen["displacement_x"], 5.0 * np.asarray(seen["time"]), atol=1e-9
        )
        np.testing.assert_allclose(seen["density"], DENSITY, rtol=1e-9)


def test_a_name_that_there_is_not(tmp_path: Path) -> None:
    with pytest.raises(CaseError, match='did you mean "density"'):
        Case.from_text(ASKED.replace('"density"', '"densty"'))
