# SPDX-License-Identifier: BSD-3-Clause
"""Tables of grains and contacts in each frame, and what is measured of a heap."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from commands import CASE, mpm3dpp, write
from mpm3dpp import Case, Simulation, open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import Results
from worlds import World

GRAVITY, RADIUS, DENSITY = 981.0, 5e-3, 1000.0
STACK = f"""
[grid]
dimension = 2
cell_size = "1 mm"
box = {{ lower = ["-20 mm", 0], upper = ["20 mm", "40 mm"], walls = "slip" }}
[run]
end_time = "60 ms"
gravity = [0, {-GRAVITY}]
[output]
frames = 2
[material.soft]
density = {DENSITY}
strength = {{ elastic = {{ E = "2 MPa", nu = 0.3 }} }}
[grains.disc]
material = "soft"
frame = "updated"
damping = {{ mass = 400 }}
lattice = {{ lower = ["-5 mm", 0], count = [1, 3], radius = {RADIUS} }}
"""
WEIGHT = DENSITY * GRAVITY * np.pi * RADIUS**2


@pytest.fixture(scope="module")
def stack(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Results]:
    folder = tmp_path_factory.mktemp("stack")
    run_case(write(folder, STACK), folder / "out", threads=1, pictures=False)
    with open_results(folder / "out") as results:
        yield results


def test_a_stack_carries_its_weight(stack: Results) -> None:
    """The contact below the k-th disc has the weight of those above it; 2 % are left of swinging.

    Where it acts is between the centres, to a tenth of a cell, and along the line through them.
    """
    grains, contacts = stack.grains(-1), stack.contacts(-1)
    assert [*grains["name"]] == ["disc"] * 3 and [*grains["grain"]] == [0, 1, 2]
    assert [*contacts["a"]] == [0, 1] and [*contacts["b"]] == [1, 2]
    for k, above in ((0, 2), (1, 1)):
        assert contacts["force_y"][k] == pytest.approx(-above * WEIGHT, rel=0.02)
        assert abs(contacts["force_x"][k]) < 1e-3 * WEIGHT
        normal = [contacts[f"normal_{a}"][k] for a in "xyz"]
        assert normal == pytest.approx([0.0, 1.0, 0.0], abs=1e-3)
        middle = 0.5 * (grains["centre_y"][k] + grains["centre_y"][k + 1])
        assert contacts["point_y"][k] == pytest.approx(middle, abs=1e-4)
        assert contacts["point_x"][k] == pytest.approx(0.0, abs=1e-4)
    assert [*grains["contacts"]] == [1, 2, 1]
    assert grains["force_y"][1] == pytest.approx(WEIGHT, rel=0.02)
    assert np.sum(grains["force_y"]) == pytest.approx(0.0, abs=1e-9 * WEIGHT)
    assert stack.coordination_number() == pytest.approx(4.0 / 3.0)
    assert stack.coordination_number(body="disc") == stack.coordination_number()


def test_the_table_agrees_with_the_particles_of_the_frame(stack: Results) -> None:
    grains, arrays = stack.grains(1), stack.arrays(1)
    for k in range(3):
        mine = arrays["grain"] == k
        assert grains["mass"][k] == pytest.approx(DENSITY * np.pi * RADIUS**2)
        for name, column in (("position", "centre"), ("velocity", "velocity")):
            mean = arrays[name][mine].mean(axis=0)
            found = [grains[f"{column}_{a}"][k] for a in "xyz"]
            assert found == pytest.approx(mean, rel=1e-5, abs=1e-6)


def test_before_the_first_step_nothing_acts(stack: Results) -> None:
    assert stack.tables(0) == ["contacts", "grains"]
    assert len(stack.contacts(0)["a"]) == 0
    assert [*stack.grains(0)["contacts"]] == [0, 0, 0]


def test_the_share_of_a_box_that_is_filled(stack: Results) -> None:
    """A disc in the square around it, and half of one; the shells of its particles leave 1 %."""
    full = stack.solid_fraction(("-5 mm", 0), ("5 mm", "10 mm"), frame=0)
    assert full == pytest.approx(np.pi / 4.0, rel=0.01)
    assert stack.solid_fraction((0, 0), ("5 mm", "10 mm"), 0) == pytest.approx(full, rel=0.01)
    assert stack.solid_fraction(("6 mm", 0), ("7 mm", "10 mm"), 0) == 0.0
    with pytest.raises(CaseError, match="upper must be above lower on every axis"):
        stack.solid_fraction((0, 0), (1, 0))
    with pytest.raises(CaseError, match=r"lower = .* must have 2 numbers"):
        stack.solid_fraction((0, 0, 0), (1, 1))


SLIDER = """
[grid]
dimension = 2
cell_size = "1 mm"
basis = "gimp"
[run]
end_time = "1 ms"
gravity = [0, -2000]
[output]
frames = 5
[contact]
friction = 0.3
[material.soft]
density = 1000
strength = { elastic = { E = "10 MPa", nu = 0.0 } }
[body.block]
material = "soft"
shape = { box = { lower = ["20 mm", 0], upper = ["40 mm", "5 mm"] } }
velocity = ["4 m/s", 0]
damping = { mass = 500 }
[body.table]
material = "soft"
shape = { box = { lower = [0, "-3 mm"], upper = ["80 mm", 0] } }
motion = { velocity = [0, 0] }
"""


def test_slip_and_friction_of_a_block_that_slides(tmp_path: Path) -> None:
    """Coulomb's law holds for the sums, and slip is the speed of the block's lower face.

    To 3 %: at the nodes of the block's ends normals are not upright. Slip to 10 %: the lower
    face lags behind the mass centre as the block is sheared.
    """
    run_case(write(tmp_path, SLIDER), tmp_path / "out", threads=1, pictures=False)
    with open_results(tmp_path / "out") as results:
        assert results.bodies == ["block", "table"]
        speeds = []
        for k in (3, 4, 5):
            contacts, grains = results.contacts(k), results.grains(k)
            assert [*contacts["a"]] == [0] and [*contacts["b"]] == [1]
            ratio = contacts["force_x"][0] / contacts["force_y"][0]
            assert ratio == pytest.approx(-0.3, rel=0.03)
            speeds.append((contacts["slip"][0], grains["velocity_x"][0]))
        slip, speed = np.mean(speeds, axis=0)
        assert slip == pytest.approx(speed, rel=0.1)
        with pytest.raises(CaseError, match="there are no grains in these results"):
            results.coordination_number()


WEDGE = """
[grid]
dimension = 2
cell_size = "2 mm"
[run]
end_time = "1 us"
[output]
frames = 1
[material.soft]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.heap]
material = "soft"
shape = { polygon = { points = [["-100 mm", 0], ["100 mm", 0], [0, "50 mm"]] } }
"""


def test_the_surface_of_grains_is_not_that_of_what_holds_them(tmp_path: Path) -> None:
    lid = """
[body.lid]
material = "soft"
shape = { box = { lower = ["-29 mm", "52 mm"], upper = ["29 mm", "57 mm"] } }
motion = "fixed"
"""
    text = PILE.replace("20 ms", "1 ms") + lid
    run_case(write(tmp_path, text), tmp_path / "out", threads=1, pictures=False)
    with open_results(tmp_path / "out") as results:
        of_grains = results.surface()
        assert 0.0 < of_grains["y"].max() < 0.042
        np.testing.assert_array_equal(results.surface(body="sand")["y"], of_grains["y"])
        assert results.surface(body="lid")["y"].max() == pytest.approx(0.057, abs=1e-6)
        with pytest.raises(CaseError, match='did you mean "lid"'):
            results.surface(body="lad")


def test_the_slope_of_a_heap(tmp_path: Path) -> None:
    """Two flanks of atan(1/2); steps of particles are a quarter of a strip at most."""
    run_case(write(tmp_path, WEDGE), tmp_path / "out", threads=1, pictures=False)
    with open_results(tmp_path / "out") as results:
        angle = float(np.degrees(np.arctan(0.5)))
        left = results.angle_of_repose("-90 mm", "-10 mm")
        assert left == pytest.approx(angle, abs=0.5)
        right = results.angle_of_repose("10 mm", "90 mm", width="5 mm")
        assert right == pytest.approx(-angle, abs=0.5)
        surface = results.surface()
        assert surface["y"].max() == pytest.approx(0.05, abs=2e-3)
        np.testing.assert_allclose(np.diff(surface["x"]), 4e-3)
        assert results.tables() == []
        with pytest.raises(CaseError, match="only 2 strips between them have particles"):
            results.angle_of_repose(0, "8 mm")
        with pytest.raises(CaseError, match=r"lie far beyond the surface, .* is in metres"):
            results.angle_of_repose(-90, 90)
        with pytest.raises(CaseError, match="must be two of x, y"):
            results.surface(along="z")
        with pytest.raises(CaseError, match="has no table of grains"):
            results.grains()


PILE = """
[grid]
dimension = 2
cell_size = "1 mm"
box = { lower = ["-30 mm", 0], upper = ["30 mm", "60 mm"], walls = "slip" }
[run]
end_time = "20 ms"
gravity = [0, -200]
[output]
frames = 1
[contact]
friction = 0.5
[material.soft]
density = 1000
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[grains.sand]
material = "soft"
frame = "updated"
packing = { lower = ["-29 mm", 0], upper = ["29 mm", "40 mm"], radius = "4 mm", count = 24 }
"""


def rows_of(simulation: Simulation) -> tuple[np.ndarray, np.ndarray]:
    grains, contacts = simulation.core.grains_and_contacts()
    return grains, contacts


def test_any_number_of_threads_has_the_same_tables() -> None:
    found = []
    for threads in (1, 2):
        simulation = Simulation(Case.from_text(PILE), threads=threads)
        simulation.advance(300)
        found.append(rows_of(simulation))
    assert len(found[0][1]) > 10
    for one, other in zip(*found, strict=True):
        np.testing.assert_array_equal(one, other)


def test_a_mirrored_world_has_mirrored_tables() -> None:
    """Vectors along x and spins turn round, to the rounding of sums, which 600 steps of grains
    with friction let grow (`tests/recipes/test_relations.py`: 1e-10 of the largest; forces are
    differences of large numbers, and so a thousand times worse)."""
    case = Case.from_text(PILE)
    filled, here = Simulation(case), Simulation(case)
    here.advance(600)
    there = Simulation(World(((0, -1), (1, 1)), shuffled=True).case(case, filled))
    there.advance(600)
    for one, other, names in zip(rows_of(here), rows_of(there), _names(), strict=True):
        assert one.shape == other.shape
        for k, name in enumerate(names):
            sign = -1.0 if (name.endswith("_x") and name != "spin_x") or name == "spin_z" else 1.0
            size = np.abs(one[:, k]).max(initial=0.0) + 1e-12
            assert np.abs(sign * other[:, k] - one[:, k]).max() < 1e-7 * size, name


def _names() -> list[list[str]]:
    from mpm3dpp.io.frame_tables import CONTACT_COLUMNS, GRAIN_COLUMNS

    return [[*GRAIN_COLUMNS][2:], [*CONTACT_COLUMNS]]


def test_forces_between_grains_are_drawn(tmp_path: Path) -> None:
    run_case(write(tmp_path, PILE), tmp_path / "out", threads=1, pictures=False)
    said = mpm3dpp("plot", "out", "--no-animation", cwd=tmp_path)
    assert "force_network.png" in said.stdout
    assert (tmp_path / "out" / "force_network.png").stat().st_size > 10_000


def test_few_bodies_get_no_such_picture(tmp_path: Path) -> None:
    run_case(write(tmp_path, CASE), tmp_path / "out", threads=1, pictures=False)
    assert mpm3dpp("plot", "out", "--no-animation", cwd=tmp_path).returncode == 0
    assert not (tmp_path / "out" / "force_network.png").exists()


def test_a_damaged_table_is_told(tmp_path: Path) -> None:
    run_case(write(tmp_path, CASE), tmp_path / "out", threads=1, pictures=False)
    with open_results(tmp_path / "out") as results:
        mass = np.asarray(results.grains(1)["mass"])
        file = tmp_path / "out" / "results.frames" / "000001.h5"
        data = bytearray(file.read_bytes())
        at = data.find(mass[1:2].tobytes())
        assert at > 0
        data[at] ^= 1
        file.write_bytes(data)
        with pytest.raises(CaseError, match="frame 1 is damaged"):
            results.grains(1)
        with pytest.raises(CaseError, match='"lefft" is not a body'):
            results.grains(0, "lefft")
