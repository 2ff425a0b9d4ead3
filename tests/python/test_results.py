# SPDX-License-Identifier: BSD-3-Clause
"""Results on disk: what is written reads back exactly, and nothing written is ever lost."""

from __future__ import annotations

import json
import math
import shutil
import signal
import subprocess
import sys
import textwrap
from pathlib import Path
from unittest.mock import Mock

import numpy as np
import pytest

from fake_core import COLUMNS, SIZE, FakeSimulation, pressure, von_mises
from mpm3dpp.base.errors import CaseError
from mpm3dpp.io import (
    HistoryWriter,
    ResultsWriter,
    build_manifest,
    frame_of,
    open_results,
    read_history,
    read_manifest,
    result_hash,
)
from mpm3dpp.plots.energies import draw_energies
from mpm3dpp.run.progress import Progress

TO_VTK = [0, 1, 2, 5, 3, 4]  # xx yy zz xy yz xz from xx yy zz yz xz xy


def writer(path: Path, dimension: int = 2, **more) -> ResultsWriter:
    return ResultsWriter(
        path / "results.vtkhdf",
        bodies=["left", "right"],
        materials=["steel", "rubber"],
        dimension=dimension,
        cell_size=2 * SIZE,
        **more,
    )


def arrays_of(simulation: FakeSimulation) -> dict[str, np.ndarray]:
    """What a frame must hold of a simulation, in doubles."""
    damage = [np.full((simulation.body_particle_count(0), 1), np.nan)]
    damage.append(simulation.column(1, "damage"))
    stress, position, velocity = (
        np.concatenate([simulation.column(b, name) for b in range(2)])
        for name in ("stress", "position", "velocity")
    )
    empty = np.zeros((len(stress), 3 - simulation.dimension))
    numbers = np.repeat([0, 1], [simulation.body_particle_count(b) for b in range(2)])
    return {
        "position": np.hstack([position, empty]),
        "velocity": np.hstack([velocity, empty]),
        "stress": stress,
        "pressure": pressure(stress),
        "von_mises": von_mises(stress),
        "body": numbers,
        "material": numbers,
        "damage": np.concatenate(damage)[:, 0],
    }


def run(path: Path, dimension: int = 2, compression: int = 0) -> list[dict[str, np.ndarray]]:
    """Write five frames; returns what was handed to the writer."""
    simulation, frames = FakeSimulation(dimension), []
    with writer(path, dimension, fields=["damage"], compression=compression) as results:
        for _ in range(5):
            frames.append(arrays_of(simulation))
            results.write(simulation)
            simulation.advance(4)
    return frames


def test_von_mises_of_simple_states() -> None:
    tension = np.array([[3.0, 0, 0, 0, 0, 0], [7.0, 7.0, 7.0, 0, 0, 0], [0, 0, 0, 0, 0, 2.0]])
    assert von_mises(tension) == pytest.approx([3.0, 0.0, 2.0 * math.sqrt(3.0)])


@pytest.mark.parametrize("dimension", [2, 3])
def test_every_array_and_time_reads_back(tmp_path: Path, dimension: int) -> None:
    frames = run(tmp_path, dimension)
    results = open_results(tmp_path)
    assert len(results) == 5
    assert results.steps.tolist() == [0, 4, 8, 12, 16]
    assert results.times[1] == 4e-5
    assert results.bodies == ["left", "right"]
    assert results.units["stress"] == "Pa"
    for k, frame in enumerate(frames):
        arrays = results.arrays(k)
        assert set(arrays) == {*frame, "size", "id"}
        for name, values in frame.items():
            kind = np.int32 if name in ("body", "material") else np.float32
            assert arrays[name].dtype == kind
            np.testing.assert_array_equal(arrays[name], values.astype(kind))
        np.testing.assert_allclose(arrays["size"], SIZE, rtol=1e-6)
    assert np.isnan(results.arrays(0)["damage"][0])  # the first body has no such column
    assert not np.isnan(results.arrays(0)["damage"][-1])
    with pytest.raises(IndexError, match="5 frames"):
        results.arrays(5)


@pytest.mark.parametrize("compression", [0, 1])
def test_vtk_reads_every_frame(tmp_path: Path, compression: int) -> None:
    """ParaView's own reader gives the same arrays, tensors in its order of components."""
    import vtkmodules.vtkIOHDF as vtk_hdf
    from vtkmodules.util.numpy_support import vtk_to_numpy

    frames = run(tmp_path, compression=compression)
    reader = vtk_hdf.vtkHDFReader()
    reader.SetFileName(str(tmp_path / "results.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == len(frames)
    for k, frame in enumerate(frames):
        reader.SetStep(k)
        reader.Update()
        assert reader.GetTimeValue() == open_results(tmp_path).times[k]
        cloud = reader.GetOutputDataObject(0)
        count = len(frame["body"])
        assert (cloud.GetNumberOfPoints(), cloud.GetNumberOfVerts()) == (count, count)
        points = vtk_to_numpy(cloud.GetPoints().GetData())
        np.testing.assert_array_equal(points, frame["position"].astype(np.float32))
        names = cloud.GetFieldData().GetAbstractArray("body_names")
        assert [names.GetValue(i) for i in range(names.GetNumberOfValues())] == ["left", "right"]
        assert cloud.GetFieldData().GetArray("step").GetValue(0) == open_results(tmp_path).steps[k]
        for name in set(frame) - {"position"}:
            expected = frame[name][:, TO_VTK] if name == "stress" else frame[name]
            array = vtk_to_numpy(cloud.GetPointData().GetArray(name))
            np.testing.assert_array_equal(array, expected.astype(array.dtype))


def test_vtk_reads_frames_with_changing_counts(tmp_path: Path) -> None:
    import vtkmodules.vtkIOHDF as vtk_hdf
    from vtkmodules.util.numpy_support import vtk_to_numpy

    counts = [7, 7, 5, 1, 7]
    with writer(tmp_path) as results:
        for k, count in enumerate(counts):
            arrays = {"position": np.full((count, 3), float(k)), "p": np.arange(count) + 10.0 * k}
            results.append(float(k), k, arrays)
    reader = vtk_hdf.vtkHDFReader()
    reader.SetFileName(str(tmp_path / "results.vtkhdf"))
    reader.UpdateInformation()
    for k, count in enumerate(counts):
        reader.SetStep(k)
        reader.Update()
        cloud = reader.GetOutputDataObject(0)
        assert cloud.GetNumberOfVerts() == count
        values = vtk_to_numpy(cloud.GetPointData().GetArray("p"))
        np.testing.assert_array_equal(values, np.arange(count) + 10.0 * k)


def test_vtk_reads_while_a_run_goes_on(tmp_path: Path) -> None:
    """A reader keeps what it has opened; one that opens the file again sees more."""
    import vtkmodules.vtkIOHDF as vtk_hdf
    from vtkmodules.util.numpy_support import vtk_to_numpy

    def opened() -> vtk_hdf.vtkHDFReader:
        reader = vtk_hdf.vtkHDFReader()
        reader.SetFileName(str(tmp_path / "results.vtkhdf"))
        reader.UpdateInformation()
        return reader

    def last(reader: vtk_hdf.vtkHDFReader) -> float:
        reader.SetStep(reader.GetNumberOfSteps() - 1)
        reader.Update()
        return float(vtk_to_numpy(reader.GetOutputDataObject(0).GetPoints().GetData())[0, 0])

    with writer(tmp_path) as results:
        for k in range(5):
            results.append(float(k), k, {"position": np.full((4, 3), float(k))})
            if k == 1:
                first = opened()
            assert last(opened()) == k
        assert first.GetNumberOfSteps() == 2 and last(first) == 1.0
    assert last(opened()) == 4.0


def test_frames_as_pyvista(tmp_path: Path) -> None:
    import pyvista

    frames = run(tmp_path)
    cloud = open_results(tmp_path)[-1]
    assert isinstance(cloud, pyvista.PolyData)
    np.testing.assert_array_equal(
        cloud.point_data["stress"], frames[-1]["stress"][:, TO_VTK].astype(np.float32)
    )
    assert cloud.field_data["time"][0] == pytest.approx(16e-5)


def test_compressed_frames_take_less_room(tmp_path: Path) -> None:
    """Of the writer's test data, a tenth at least (whole frames as chunks, however small)."""
    run(tmp_path, 3)
    last = tmp_path / "results.frames" / "000004.h5"
    plain = last.stat().st_size
    run(tmp_path, 3, compression=1)
    assert last.stat().st_size < 0.9 * plain


def test_constant_arrays_are_stored_once(tmp_path: Path) -> None:
    import h5py

    frames = run(tmp_path)
    with h5py.File(tmp_path / "results.vtkhdf") as file:
        count = len(frames[0]["body"])
        assert file["VTKHDF/PointData/body"].shape == (count,)
        assert file["VTKHDF/PointData/velocity"].shape == (5 * count, 3)
        assert list(file["VTKHDF"].attrs["Version"]) == [2, 0]
    for k in range(5):
        with h5py.File(tmp_path / "results.frames" / f"00000{k}.h5") as file:
            stored = {"position", "velocity", "stress", "pressure", "von_mises", "damage"}
            constant = {"id", "body", "material", "size"} if k == 0 else set()
            assert set(file["arrays"]) == stored | constant


_ENDLESS = """
    import sys
    import numpy as np
    from mpm3dpp.io import ResultsWriter
    n = 5000
    w = ResultsWriter(
        sys.argv[1], bodies=["a"], materials=["m"], dimension=2, cell_size=1.0,
        compression={compression},
    )
    {limit}
    print("ready", flush=True)
    for k in range(10**9):
        n += {growth}
        v = np.full(n, float(k))
        w.append(float(k), k, {{"position": np.full((n, 3), float(k)), "p": v}})
"""


def whole_frames(path: Path) -> int:
    """Check that every frame that the file counts is complete; returns how many."""
    with open_results(path) as results:
        for k in range(len(results)):
            arrays = results.arrays(k)
            assert results.times[k] == results.steps[k] == k
            assert (arrays["position"] == k).all()
            assert (arrays["p"] == k).all()
        return len(results)


@pytest.mark.parametrize("compression", [0, 1])
@pytest.mark.parametrize("wait", [0.05, 0.17, 0.31])
def test_killed_run_keeps_its_frames(tmp_path: Path, wait: float, compression: int) -> None:
    path = tmp_path / "results.vtkhdf"
    code = textwrap.dedent(_ENDLESS.format(limit="", growth=0, compression=compression))
    with subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE) as run:
        assert run.stdout is not None
        run.stdout.readline()
        with pytest.raises(subprocess.TimeoutExpired):
            run.wait(timeout=wait)
        run.send_signal(signal.SIGKILL)
    assert whole_frames(path) >= 0


def test_full_disk_is_one_sentence_and_keeps_the_frames(tmp_path: Path) -> None:
    """A limit on the file's size stands for the full disk: both fail in the same call."""
    path = tmp_path / "results.vtkhdf"
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (500_000,) * 2)"
    code = textwrap.dedent(_ENDLESS.format(limit=limit, growth=1000, compression=0))
    run = subprocess.run(
        [sys.executable, "-c", code, str(path)], capture_output=True, text=True, check=False
    )
    last = run.stderr.strip().splitlines()[-1]
    assert "CaseError" in last
    assert "results.frames/0000" in last
    assert "file too large" in last
    assert not list(tmp_path.rglob(".*"))
    assert whole_frames(path) >= 3


def test_unwritable_and_missing_files(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("")
    with pytest.raises(CaseError, match="--out"):
        writer(blocked)
    with pytest.raises(CaseError, match="--out"):
        HistoryWriter(blocked / "history.csv", columns=COLUMNS, bodies=["a"])
    with pytest.raises(CaseError, match="output folder"):
        open_results(tmp_path)
    with pytest.raises(CaseError, match="not a results file"):
        open_results(blocked)
    with pytest.raises(CaseError, match="output folder"):
        read_history(tmp_path)
    table = tmp_path / "table.csv"
    table.write_text("x\n1\n")
    with pytest.raises(CaseError, match="no column time"):
        read_history(table)
    with pytest.raises(CaseError, match="damage"):
        frame_of(FakeSimulation(), ["damge"])


def test_results_of_earlier_versions(tmp_path: Path) -> None:
    """All frames were in one file then, with the same layout."""
    import h5py

    frames = run(tmp_path)
    with h5py.File(tmp_path / "results.vtkhdf") as linked:
        meta = json.loads(linked["mpm3dpp"].attrs["run"])
        with h5py.File(tmp_path / "one.vtkhdf", "w") as one:

            def copy(name: str, item: h5py.Dataset | h5py.Group) -> None:
                if isinstance(item, h5py.Dataset):
                    one[name] = item[()]
                else:
                    one.require_group(name).attrs.update(item.attrs)

            linked.visititems(copy)
            del meta["frames"]
            one["mpm3dpp"].attrs["run"] = json.dumps(meta)
    shutil.rmtree(tmp_path / "results.frames")
    with open_results(tmp_path / "one.vtkhdf") as results:
        assert len(results) == 5 and results.steps.tolist() == [0, 4, 8, 12, 16]
        for k, frame in enumerate(frames):
            for name, values in frame.items():
                found = results.arrays(k)[name]
                np.testing.assert_array_equal(found, values.astype(found.dtype))


def test_a_folder_can_be_moved(tmp_path: Path) -> None:
    """Paths in the file are relative to it, wherever the reader was started."""
    import h5py

    (tmp_path / "before").mkdir()
    frames = run(tmp_path / "before")
    (tmp_path / "before").rename(tmp_path / "after")
    count = len(frames[0]["body"])
    with h5py.File(tmp_path / "after" / "results.vtkhdf") as file:
        points = file["VTKHDF/Points"][2 * count : 3 * count]
    np.testing.assert_array_equal(points, frames[2]["position"].astype(np.float32))
    assert len(open_results(tmp_path / "after").arrays(4)) == len(frames[0]) + 2


def test_a_missing_frame_is_no_frame_of_zeros(tmp_path: Path) -> None:
    import h5py

    frames = run(tmp_path)
    folder, count = tmp_path / "results.frames", len(frames[0]["body"])
    (folder / "000002.h5").unlink()
    with h5py.File(tmp_path / "results.vtkhdf") as file:
        assert np.isnan(file["VTKHDF/Points"][2 * count : 3 * count]).all()
    data = (folder / "000003.h5").read_bytes()
    at = data.index(frames[3]["velocity"].astype(np.float32).tobytes())
    (folder / "000003.h5").write_bytes(data[:at] + b"\x01" + data[at + 1 :])
    (folder / "000004.h5").write_bytes(data[:500])
    with open_results(tmp_path) as results:
        assert len(results) == 5 and len(results.arrays(1)) == len(frames[1]) + 2
        with pytest.raises(CaseError, match=r"frame 2 is missing: there is no file .*000002\.h5"):
            results.arrays(2)
        for k in (3, 4):
            with pytest.raises(CaseError, match=f"frame {k} is damaged: .*00000{k}.h5"):
                results.arrays(k)


def test_frames_that_the_file_does_not_tell_of_yet(tmp_path: Path) -> None:
    """It is written anew at every frame, later at every 32nd part of them; a reader finds all."""
    arrays = {"position": np.zeros((3, 3)), "p": np.zeros(3)}
    with writer(tmp_path) as results:
        written = []
        for k in range(200):
            before = (tmp_path / "results.vtkhdf").stat().st_ino
            results.append(float(k), k, arrays)
            written.append((tmp_path / "results.vtkhdf").stat().st_ino != before)
            if k % 50 == 49:
                found = open_results(tmp_path)
                assert found.times.tolist() == found.steps.tolist() == list(range(k + 1))
                assert set(found.arrays(-1)) == {"position", "p"}
        assert all(written[:33]) and 70 < sum(written) < 110


def test_closed_results(tmp_path: Path) -> None:
    run(tmp_path)
    results = open_results(tmp_path)
    assert results.fields[0] == "position"
    results.close()
    for use in (
        lambda: results.fields,
        lambda: results.arrays(0),
        lambda: results[0],
        lambda: [*results],
    ):
        with pytest.raises(CaseError, match="has been closed; open it again with open_results"):
            use()
    assert len(results) == 5 and results.times[1] == 4e-5


def test_frames_of_a_run_before_are_nobodys(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """They are gone before the new file tells of a run: a kill in between leaves none of them."""
    run(tmp_path)
    with monkeypatch.context() as patch, pytest.raises(KeyboardInterrupt):
        patch.setattr("mpm3dpp.io.vtkhdf.write_master", Mock(side_effect=KeyboardInterrupt))
        writer(tmp_path, title="another")
    assert not list((tmp_path / "results.frames").glob("*.h5"))
    with pytest.raises(CaseError):
        open_results(tmp_path)


def test_arrays_that_a_frame_cannot_hold(tmp_path: Path) -> None:
    places = np.zeros((4, 2))
    with writer(tmp_path) as results:
        for wrong, sentence in (
            ({"position": places, "mass": np.ones(3)}, "'mass' has 3 rows, and 'position' has 4"),
            ({"mass": np.ones(3)}, "needs the array 'position'"),
            ({}, "needs the array 'position'"),
        ):
            with pytest.raises(CaseError, match=sentence):
                results.append(0.0, 0, wrong)
        results.append(0.0, 0, {"position": places})
    assert len(open_results(tmp_path)) == 1


def test_a_first_frame_that_failed_does_not_take_the_constants_with_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = FakeSimulation()
    with writer(tmp_path) as results:
        with monkeypatch.context() as patch, pytest.raises(OSError):
            patch.setattr("mpm3dpp.io.frames_writer.write_frame", Mock(side_effect=OSError()))
            results.write(simulation)
        results.write(simulation)
    assert {"body", "material", "size"} <= open_results(tmp_path).arrays(0).keys()


def test_other_arrays_than_those_of_the_first_frame(tmp_path: Path) -> None:
    with writer(tmp_path) as results:
        results.append(0.0, 0, {"position": np.zeros((3, 3))})
        with pytest.raises(CaseError, match="must have the arrays of the first one"):
            results.append(1.0, 1, {"position": np.zeros((3, 3)), "p": np.zeros(3)})


def test_a_damaged_history(tmp_path: Path) -> None:
    """A bit of its header, or of its first row, is another one."""
    write_history(tmp_path)
    path = tmp_path / "history.csv"
    data = path.read_bytes()
    for at in [*range(0, 600, 29), data.index(b"_y,") + 1]:
        for bit in (1, 128):
            path.write_bytes(data[:at] + bytes([data[at] ^ bit]) + data[at + 1 :])
            try:
                draw_energies(read_history(path))  # A digit, or a name that nothing needs.
            except CaseError as error:
                assert "\n" not in str(error)


def write_history(path: Path, every: int = 1) -> HistoryWriter:
    simulation = FakeSimulation()
    bodies = ["left", "right"]
    with HistoryWriter(
        path / "history.csv", columns=COLUMNS, bodies=bodies, every=every
    ) as history:
        for _ in range(6):
            simulation.advance(4)
            history.append(simulation.history(), simulation.contact_pairs())
    return history


def test_history_has_the_agreed_columns(tmp_path: Path) -> None:
    history = write_history(tmp_path)
    header = (tmp_path / "history.csv").read_text().splitlines()[0].split(",")
    n = len(COLUMNS)
    assert tuple(header[:n]) == COLUMNS
    assert header[n : n + 3] == [f"contact_force_left_right_{x}" for x in "xyz"]
    assert header[n + 3 :] == [f"contact_impulse_left_right_{x}" for x in "xyz"]
    table = read_history(tmp_path)
    assert table["step"].tolist() == list(range(1, 25))
    assert table["time"][-1] == sum([1e-5] * 24)  # to the last bit
    force = table["contact_force_left_right_x"]
    assert np.isnan(force[0])  # only the last row of a block knows the force
    assert (force[3], force[-1]) == (0.0, -5.0)
    summary = history.summary()
    assert summary["initial"]["kinetic"] == 4.0
    assert summary["kinetic_min"] == 3.0
    assert summary["numerical_max"] == 1e-3


def test_history_thinned_and_broken_off(tmp_path: Path) -> None:
    write_history(tmp_path, every=4)
    path = tmp_path / "history.csv"
    assert read_history(path)["step"].tolist() == [4, 8, 12, 16, 20, 24]
    path.write_text(path.read_text()[:-5])  # killed in the middle of a row
    assert read_history(path)["step"].tolist() == [4, 8, 12, 16, 20]


def test_many_bodies_get_a_table_of_their_own(tmp_path: Path) -> None:
    simulation = FakeSimulation()
    simulation.advance(20)
    names = [f"grain{k}" for k in range(20)]
    with HistoryWriter(tmp_path / "history.csv", columns=COLUMNS, bodies=names) as history:
        history.append(simulation.history(), simulation.contact_pairs())
    assert len(read_history(tmp_path)) == len(COLUMNS)
    lines = (tmp_path / "contact_pairs.csv").read_text().splitlines()
    assert lines[0].startswith("step,time,body_a,body_b,contact_force_x")
    assert lines[1].split(",")[2:5] == ["grain0", "grain1", "-5.0"]


def manifest_of(simulation: FakeSimulation, **more):
    return build_manifest(
        simulation,
        version="0.1.0",
        case={"grid": {"cell_size": 2e-3}, "bad": float("nan")},
        case_text="[grid]",
        bodies=["left", "right"],
        cell_size=2e-3,
        threads=2,
        wall_time=1.5,
        status="completed",
        **more,
    )


def test_manifest_has_the_agreed_keys(tmp_path: Path) -> None:
    simulation = FakeSimulation()
    simulation.advance(5)
    path = manifest_of(simulation).write(tmp_path)

    def refuse(text: str) -> None:
        raise AssertionError(f"{text} is not JSON")

    data = json.loads(path.read_text(), parse_constant=refuse)
    agreed = "version case_hash mass cell_size particles threads steps wall_time result_hash"
    agreed += " ns_per_particle_step stages peak_memory_bytes bytes contact"
    assert set(agreed.split()) <= set(data)
    assert set(data["bytes"]) == {"particles", "grid", "contact", "other"}
    pair = data["contact"]["pairs"][0]
    assert set(pair) == {
        *("bodies", "pairs", "first_time", "first_gap", "first_normal", "first_node"),
        *("impulse", "friction_work"),
    }
    assert pair["bodies"] == ["left", "right"]
    assert pair["first_time"] is None  # never touched: NaN is not JSON
    assert data["case"]["bad"] is None
    steps = 5 * simulation.particle_count
    assert data["stages"]["map momentum"] == pytest.approx(2e6 / steps)
    assert data["ns_per_particle_step"] == pytest.approx(3e6 / steps)
    assert data["limiter"]["body"] == "right"
    assert [p.name for p in tmp_path.iterdir()] == ["manifest.json"]  # no temporary file left
    assert read_manifest(tmp_path) == data


def test_result_hash_sees_the_last_bit() -> None:
    first, second = FakeSimulation(), FakeSimulation()
    assert result_hash(first) == result_hash(second)
    second._start[1][3, 0] = np.nextafter(second._start[1][3, 0], 1.0)
    assert result_hash(first) != result_hash(second)


def test_progress_without_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with Progress(1e-3) as progress:
        for k in range(101):
            progress.update(1e-5 * k, k, 1e-5, 2.0, 1.0, (7, "nodes"))
    lines = capsys.readouterr().err.splitlines()
    assert 1 <= len(lines) <= 11
    assert "100%" in lines[-1]
    assert "t 1 ms" in lines[-1]
    assert "contact 7 nodes" in lines[-1]
    assert "\x1b" not in "".join(lines)
    with Progress(1e-3, quiet=True) as progress:
        progress.update(1e-3, 1, 1e-5, 2.0, 1.0)
        progress.note("interrupted")
    assert capsys.readouterr().err == ""
