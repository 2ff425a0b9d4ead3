# SPDX-License-Identifier: BSD-3-Clause
"""Strains of a frame, against motions whose strain is known."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import pyvista
from scipy.linalg import expm

from mpm3dpp import Case, open_results, run_case
from mpm3dpp.io.export import export
from mpm3dpp.io.strain import hencky_strain

PLACES = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))


def lattice(D: int, cells: int = 5) -> np.ndarray:
    return np.stack(np.meshgrid(*[np.arange(cells) + 0.5] * D), axis=-1).reshape(-1, D)


@pytest.mark.parametrize("D", [2, 3])
def test_a_linear_motion_has_its_strain(D: int) -> None:
    """F = V R with V = exp(e): the strain is e, however the body has turned, to rounding."""
    random = np.random.default_rng(1)
    e, w = random.normal(0, 0.3, (2, D, D))
    e = 0.5 * (e + e.T)
    F = expm(e) @ expm(3.0 * (w - w.T))
    start = lattice(D) + random.uniform(-0.2, 0.2, (5**D, D))
    found = hencky_strain(start, start @ F.T + 7.0, np.ones(5**D), np.zeros(5**D, dtype=int))
    tensor = np.zeros((3, 3))
    tensor[:D, :D] = e
    expected = [tensor[place] for place in PLACES]
    np.testing.assert_allclose(found, np.tile(expected, (5**D, 1)), atol=1e-12)


def test_each_body_has_its_own_and_few_particles_none() -> None:
    """Two squares that part and turn are not strained; a row of particles has no strain."""
    square, row = lattice(2), np.stack([np.arange(5.0), np.zeros(5)], axis=1)
    start = np.concatenate([square, square + np.array([5, 0]), row + np.array([0, 9])])
    body = np.repeat([1, 0, 2], [25, 25, 5])
    turn = np.array([[0.0, -1.0], [1.0, 0.0]])
    present = start.copy()
    present[25:50] = start[25:50] @ turn.T + [3, 3]
    found = hencky_strain(start, present, np.ones(55), body)
    np.testing.assert_allclose(found[:50], 0.0, atol=1e-13)
    assert np.isnan(found[50:]).all()
    assert hencky_strain(start[:0], present[:0], np.ones(0), body[:0]).shape == (0, 6)


GRAINS = """
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "10 ms"
[material.glass]
density = 2500
strength = { elastic = { E = "1 MPa", nu = 0.2 } }
[grains.sand]
material = "glass"
lattice = { lower = [0, 0], count = [2, 1], radius = "3 mm", spacing = "6.2 mm" }
angular_velocity = "100 rad/s"
[contact]
enabled = false
"""


def test_grains_of_an_entry_are_bodies_of_their_own(tmp_path: Path) -> None:
    """Two that turn by a radian beside each other, closer than the reach of a neighbour.

    To 2 %: each is thrown outwards a little, E = 1 MPa, rho w^2 R^2 / E = 2e-4, and rings.
    """
    run_case(Case.from_text(GRAINS), tmp_path, quiet=True, pictures=False)
    with open_results(tmp_path) as results:
        assert np.abs(results.strain()).max() < 0.02


def test_what_has_left_is_no_neighbour(tmp_path: Path) -> None:
    """Grains that fly out of the outflow box rigidly: what stays is not strained."""
    text = GRAINS.replace(
        'cell_size = "1 mm"',
        """cell_size = "1 mm"
outflow_box = { lower = ["-20 mm", "-20 mm"], upper = ["13 mm", "20 mm"] }""",
    )
    text = text.replace('angular_velocity = "100 rad/s"', "velocity = [0.4, 0]")
    run_case(Case.from_text(text), tmp_path, quiet=True, pictures=False)
    with open_results(tmp_path) as results:
        strain, gone = results.strain(), results.arrays(-1)["failed"] >= 3
    assert 0 < gone.sum() < len(gone)
    assert np.isnan(strain[gone]).all()
    assert np.nanmax(np.abs(strain[~gone])) < 0.02


def test_a_run(tmp_path: Path) -> None:
    """Particles that fly apart, v = k x: F = 1 + k t.

    To 2e-3 within: the body has nearly no stress, and a velocity field is linear but for the
    particles at its edge, which are left out.
    """
    case = Case.from_text("""
[grid]
dimension = 2
cell_size = 0.1
[run]
end_time = 0.3
time_step = 0.001
[material.dust]
density = 1000
strength = { elastic = { E = 1, nu = 0 } }
[body.square]
material = "dust"
shape = { box = { lower = [-0.5, -0.5], upper = [0.5, 0.5] } }
velocity = [{ expression = "x" }, 0]
""")
    run_case(case, tmp_path, quiet=True)
    with open_results(tmp_path) as results:
        strain = results.strain(-1)
        within = (np.abs(results.arrays(0)["position"][:, :2]) < 0.35).all(axis=1)
        time = results.times[-1]
        for kind in ("csv", "vtu"):
            export(results, -1, tmp_path / f"last.{kind}", kind, strain=True)
        some = export(results, -1, tmp_path / "some.csv", "csv", "strain_xx > 0.1", strain=True)
    assert np.abs(strain[within, 0] - np.log(1 + time)).max() < 2e-3
    assert np.abs(strain[within, 1:]).max() < 2e-3
    table = np.genfromtxt(tmp_path / "last.csv", delimiter=",", names=True)
    for k, place in enumerate(("xx", "yy", "zz", "yz", "xz", "xy")):
        np.testing.assert_allclose(table[f"strain_{place}"], strain[:, k], rtol=1e-8, atol=1e-12)
    cloud = pyvista.read(tmp_path / "last.vtu").point_data["strain"]
    np.testing.assert_array_equal(cloud[:, 3], strain[:, 5])  # VTK has xy there
    kept = np.genfromtxt(some, delimiter=",", names=True)
    assert len(kept) == (strain[:, 0] > 0.1).sum() > within.sum() / 2
