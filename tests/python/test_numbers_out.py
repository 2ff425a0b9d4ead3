# SPDX-License-Identifier: BSD-3-Clause
"""Numbers out of a run: tables of pandas, one particle over time."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from commands import CASE, mpm3dpp, one_sentence, write
from mpm3dpp import open_results, run_case
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import Results, read_history


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Results:
    folder = tmp_path_factory.mktemp("run")
    run_case(write(folder, CASE), folder / "out", threads=1, pictures=False)
    return open_results(folder / "out")


def test_a_frame_as_a_table(results: Results) -> None:
    pytest.importorskip("pandas")
    table, arrays = results.to_pandas(-1), results.arrays(-1)
    assert len(table) == len(arrays["position"])
    np.testing.assert_array_equal(table["velocity_y"], arrays["velocity"][:, 1])
    np.testing.assert_array_equal(table["stress_yz"], arrays["stress"][:, 3])
    np.testing.assert_array_equal(table["pressure"], arrays["pressure"])
    some = results.to_pandas(0, ["body"])
    assert [*some.columns] == ["position_x", "position_y", "position_z", "body"]
    left = some[some.body == results.bodies.index("left")]
    assert len(left) == np.sum(arrays["body"] == 0)


def test_the_history_as_a_table(results: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("pandas")
    table, expected = results.history(), read_history(results.path.parent)
    assert [*table.columns] == [*expected]
    np.testing.assert_array_equal(table["kinetic"], expected["kinetic"])
    monkeypatch.setattr("mpm3dpp.io.data_frames.has_pandas", lambda: False)
    plain = results.history()
    assert isinstance(plain, dict) and plain.keys() == expected.keys()


def test_the_history_of_a_body(results: Results) -> None:
    found, expected = results.history("right"), read_history(results.path.parent)
    told = ~np.isnan(expected["body_right_mass"])
    assert len(found["time"]) == told.sum() > len(results)
    for name in ("velocity_x", "spin_z", "internal", "contact_force_x"):
        np.testing.assert_array_equal(found[name], expected[f"body_right_{name}"][told])
    with pytest.raises(CaseError, match=r'"rigth" is not a body .* did you mean "right"'):
        results.history("rigth")
    with pytest.raises(CaseError, match="frames have a table of bodies if these are more than 12"):
        results.bodies_at(0)


BLOCK = """
[body.b{k:02}]
material = "soft"
shape = {{ box = {{ lower = ["{x} mm", 0], upper = ["{end} mm", "20 mm"] }} }}
velocity = ["{k} m/s", 0]
"""


def test_many_bodies_have_a_table_in_each_frame(tmp_path: Path) -> None:
    """In place of columns; with the same numbers as sums over the particles of the frame."""
    head = CASE.partition("[body.left]")[0]
    blocks = [BLOCK.format(k=k, x=60 * k, end=60 * k + 20) for k in range(14)]
    run_case(write(tmp_path, head + "".join(blocks)), tmp_path / "out", threads=1, pictures=False)
    with open_results(tmp_path / "out") as results:
        assert not any(name.startswith("body_") for name in results.history())
        table, frame = results.bodies_at(-1), results.arrays(-1)
        assert len(table["mass"]) == 14
        for k in range(14):
            mean = frame["velocity"][frame["body"] == k].mean(axis=0)
            assert table["velocity_x"][k] == pytest.approx(mean[0], rel=1e-6, abs=1e-6)
        found = results.history("b03")
        np.testing.assert_array_equal(found["time"], results.times)
        mass = np.asarray(found["mass"])
        assert found["velocity_x"][0] == pytest.approx(3.0) and mass.min() > 0.0
        file = tmp_path / "out" / "results.frames" / "000001.h5"
        data = bytearray(file.read_bytes())
        at = data.rfind(mass[1:2].tobytes())  # That of the grains has the same.
        data[at] ^= 1
        file.write_bytes(data)
        with pytest.raises(CaseError, match="frame 1 is damaged"):
            results.bodies_at(1)


def test_without_pandas(results: Results, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(CaseError, match="install it: pip install pandas"):
        results.to_pandas(0)


def test_one_particle_over_time(results: Results) -> None:
    track = results.track(7, ["velocity"])
    assert [*track] == ["time", "position", "velocity"]
    np.testing.assert_array_equal(track["time"], results.times)
    for k in range(len(results)):
        for name in ("position", "velocity"):
            np.testing.assert_array_equal(track[name][k], results.arrays(k)[name][7])
    count = int(np.sum(results.arrays(0)["body"] == 0))
    of_body, plain = results.track(-1, body="left"), results.track(count - 1)
    np.testing.assert_array_equal(of_body["stress"], plain["stress"])
    with pytest.raises(IndexError, match=f"body left: it has {count} particles"):
        results.track(count, body="left")
    with pytest.raises(IndexError, match=r"it has \d+ particles"):
        results.track(10**6)
    with pytest.raises(
        CaseError, match='"lift" is not a body of these results; did you mean "left"'
    ):
        results.track(0, body="lift")


def exported(results: Results, tmp_path: Path, *words: str) -> Path:
    out = tmp_path / "made" / "frame"
    done = mpm3dpp("export", results.path.parent, "--out", out, *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert done.stdout.strip() == str(out)
    return out


def test_a_frame_as_csv(results: Results, tmp_path: Path) -> None:
    out = exported(results, tmp_path, "--where", "body=left, velocity_x < 4 m/s, pressure > -1 MPa")
    rows = np.genfromtxt(out, delimiter=",", names=True)
    arrays = results.arrays(-1)
    keep = (arrays["body"] == 0) & (arrays["velocity"][:, 0] < 4.0) & (arrays["pressure"] > -1e6)
    assert 0 < keep.sum() < len(keep) and len(rows) == keep.sum()
    np.testing.assert_array_equal(np.float32(rows["position_x"]), arrays["position"][keep, 0])
    np.testing.assert_array_equal(np.float32(rows["stress_xy"]), arrays["stress"][keep, 5])


@pytest.mark.parametrize("kind", ["vtu", "vtp"])
@pytest.mark.parametrize("where", ["", "body=right"])
def test_a_frame_for_vtk(results: Results, tmp_path: Path, kind: str, where: str) -> None:
    pyvista = pytest.importorskip("pyvista")
    out = tmp_path / f"frame.{kind}"
    words = ("export", results.path.parent, "--format", kind, "--frame", 1, "--out", out)
    done = mpm3dpp(*words, "--where", where, cwd=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    found, arrays = pyvista.read(out), results.arrays(1)
    keep = arrays["body"] == 1 if where else np.ones(len(arrays["body"]), dtype=bool)
    np.testing.assert_array_equal(found.points, arrays["position"][keep])
    np.testing.assert_array_equal(found["von_mises"], arrays["von_mises"][keep])
    assert found.n_cells == keep.sum()


def test_all_frames(results: Results, tmp_path: Path) -> None:
    words = ("export", results.path.parent, "--all", "--out", tmp_path / "all")
    done = mpm3dpp(*words, cwd=tmp_path)
    names = [f"frame_{k:06d}.csv" for k in range(len(results))]
    assert [Path(line).name for line in done.stdout.split()] == names
    assert sorted(path.name for path in (tmp_path / "all").iterdir()) == names


@pytest.mark.parametrize(
    ("where", "sentence"),
    [
        ("body=lift", 'where = "lift" is no body of these results; did you mean "left"?'),
        ("presure>1", 'where = "presure" is no column; did you mean "pressure"?'),
        ("pressure>1 m", "where"),
        ("pressure", 'where = "pressure" is no condition; write such as body=plate'),
        ("pressure>1e99", "leaves no particle"),
    ],
)
def test_conditions_that_cannot_be(
    results: Results, tmp_path: Path, where: str, sentence: str
) -> None:
    done = mpm3dpp("export", results.path.parent, "--where", where, cwd=tmp_path)
    assert done.returncode == 2 and sentence in one_sentence(done.stderr)


def test_a_frame_that_there_is_not(tmp_path: Path) -> None:
    run_case(write(tmp_path), tmp_path / "out", threads=1, pictures=False)
    done = mpm3dpp("export", "out", "--frame", 99, cwd=tmp_path)
    assert done.returncode == 2
    assert "--frame = 99 is no frame: there are " in one_sentence(done.stderr)
