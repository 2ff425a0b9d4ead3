# SPDX-License-Identifier: BSD-3-Clause
"""Frames of which each rank writes a slice: readers see no difference."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

import mpi_jobs
from commands import CASE, mpm3dpp, one_sentence, write
from mpi_jobs import PROGRAMS, job, mpiexec, run
from mpm3dpp import open_results

TEXT = CASE.replace("[output]", '[output]\nfiles = "rank"\nfields = ["volume"]')
way = mpi_jobs.way
PLAIN = ("case.toml", "--no-pictures", "--threads", 1)


def parts(folder: Path, frame: int) -> list[str]:
    return sorted(path.name for path in (folder / "results.frames").glob(f"{frame:06d}*.h5"))


def by(ranks: int, way: str, folder: Path, *words: str) -> subprocess.CompletedProcess[str]:
    if ranks == 1:
        return mpm3dpp("run", *PLAIN, *words, cwd=folder)
    return run(way, folder, *PLAIN, *words, "--ranks", ranks)


def same_frames(some: Path, others: Path) -> None:
    a, b = open_results(some), open_results(others)
    assert len(a) == len(b) > 2 and a.fields == b.fields
    for k in range(len(a)):
        found, expected = a.arrays(k), b.arrays(k)
        for name, values in expected.items():
            np.testing.assert_array_equal(found[name], values, err_msg=f"{k} {name}")


def test_readers_see_no_difference(tmp_path: Path, way: str) -> None:
    """Ours, and VTK's, which reads the file that tells where the frames are."""
    pytest.importorskip("vtkmodules")
    write(tmp_path, TEXT)
    assert by(1, way, tmp_path, "--out", "one").returncode == 0
    done = by(3, way, tmp_path, "--out", "three")
    assert done.returncode == 0, done.stderr
    one, three = tmp_path / "one", tmp_path / "three"
    assert parts(one, 1) == ["000001.h5"]
    assert parts(three, 1) == ["000001.1.h5", "000001.2.h5", "000001.h5"]
    same_frames(one, three)
    for k in range(len(open_results(one))):
        a, b = seen_by_vtk(one, k), seen_by_vtk(three, k)
        assert a.keys() == b.keys() and len(a["vertices"]) == len(a["points"]) > 0
        for name, values in a.items():
            np.testing.assert_array_equal(b[name], values, err_msg=f"{k} {name}")


def seen_by_vtk(folder: Path, frame: int) -> dict[str, np.ndarray]:
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    reader.SetFileName(str(folder / "results.vtkhdf"))
    reader.UpdateInformation()
    reader.SetStep(frame)
    reader.Update()
    cloud = reader.GetOutputDataObject(0)
    points, about = cloud.GetPoints().GetData(), cloud.GetPointData()
    vertices = cloud.GetVerts().GetConnectivityArray()
    found = {"points": points, "vertices": vertices}
    arrays = [about.GetArray(k) for k in range(about.GetNumberOfArrays())]
    found |= {array.GetName(): array for array in arrays}
    return {name: vtk_to_numpy(array).copy() for name, array in found.items()}


def test_one_file_of_a_machine(tmp_path: Path, way: str) -> None:
    write(tmp_path)
    assert run(way, tmp_path, *PLAIN, "--out", "out", "--ranks", 3).returncode == 0
    assert parts(tmp_path / "out", 1) == ["000001.h5"]


def test_any_number_of_ranks_goes_on_with_the_frames(tmp_path: Path, way: str) -> None:
    """Also where the frames of the run before have other parts; one that is damaged is told."""
    text = TEXT.replace("frames = 4", 'interval = "1 ms"')
    ways = {"one": (1, 1), "out": (3, 2)}
    write(tmp_path, text.replace('"8 ms"', '"4 ms"'))
    for name, (ranks, _) in ways.items():
        assert by(ranks, way, tmp_path, "--out", name).returncode == 0
    write(tmp_path, text)
    part = tmp_path / "out" / "results.frames" / "000001.2.h5"
    whole = part.read_bytes()
    on = (*PLAIN, "--out", "out", "--resume")
    part.write_bytes(whole[:-1])
    done = mpm3dpp("run", *on, cwd=tmp_path)
    assert done.returncode == 2 and "frame 1 is damaged" in one_sentence(done.stderr)
    part.unlink()
    done = mpm3dpp("run", *on, cwd=tmp_path)
    assert done.returncode == 2 and "frame 1 is missing" in one_sentence(done.stderr)
    part.write_bytes(whole)
    for name, (_, ranks) in ways.items():
        done = by(ranks, way, tmp_path, "--out", name, "--resume")
        assert done.returncode == 0, done.stderr
    assert [len(parts(tmp_path / "out", k)) for k in (1, 6)] == [3, 2]
    same_frames(tmp_path / "one", tmp_path / "out")


@pytest.mark.parametrize("rank", [pytest.param(0, marks=pytest.mark.slow), 2])
def test_a_full_disk_of_one_rank(tmp_path: Path, way: str, rank: int) -> None:
    """A sentence, and the frames before it stay."""
    write(tmp_path, TEXT)
    words = ("run", *PLAIN, "--out", "out", "--quiet")
    done = job(way, tmp_path, mpiexec(3, PROGRAMS / "full_disk.py", rank, 2, *words))
    file = "000002.2.h5" if rank else "000002.h5"
    assert done.returncode == 1 and "Traceback" not in done.stderr
    told = [line for line in done.stderr.splitlines() if line.startswith("mpm3dpp: error")]
    assert len(told) == 1 and re.search(f"cannot write '.*{file}'.*no space left", told[0])
    assert len(open_results(tmp_path / "out")) == 2
    assert mpm3dpp("plot", "out", cwd=tmp_path).returncode == 0
