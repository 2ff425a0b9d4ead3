# SPDX-License-Identifier: BSD-3-Clause
"""Results that somebody has sent, or changed: pipes, endless files, links to other files.

They are told in a sentence; nothing waits for ever, and no other file is read.
"""

from __future__ import annotations

import functools
import os
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from commands import CASE, mpm3dpp, one_sentence, write
from mpm3dpp import CaseError, load_case, open_results, run_case
from mpm3dpp.importers import import_file, load_any
from mpm3dpp.importers.write import write_case
from mpm3dpp.io import read_history, read_manifest
from mpm_text import edited

TEXT = CASE.replace("8 ms", "0.2 ms") + '[probe.tip]\npoint = ["25 mm", "25 mm"]\n'
TEXT += 'fields = ["velocity"]\n'
FRAME = "results.frames/000000.h5"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    run_case(load_case(write(folder, TEXT)), folder / "out", threads=1, pictures=False)
    return folder / "out"


@pytest.fixture
def out(tmp_path: Path, made: Path) -> Iterator[Path]:
    """The folder of a run, to be changed."""
    shutil.copytree(made, tmp_path / "out")
    yield tmp_path / "out"


def a_pipe(path: Path) -> None:
    os.mkfifo(path)


def an_endless_file(path: Path) -> None:
    path.symlink_to("/dev/zero")


FILES = ["results.vtkhdf", FRAME, "manifest.json", "history.csv", "probes/tip.csv"]
QUICK = (FRAME, "manifest.json", "checkpoint.zip")
LINES = {
    "plot": ("plot", "out"),
    "report": ("report", "out"),
    "export": ("export", "out", "--frame", "0"),
    "run": ("run", "case.toml", "--out", "out"),
    "resume": ("run", "case.toml", "--out", "out", "--resume"),
}


@pytest.mark.parametrize(
    "odd",
    [a_pipe, pytest.param(an_endless_file, marks=pytest.mark.slow)],
    ids=lambda odd: odd.__name__,
)
@pytest.mark.parametrize(
    "name",
    [
        *QUICK,
        *(pytest.param(name, marks=pytest.mark.slow) for name in FILES if name not in QUICK),
    ],
)
def test_a_pipe_or_an_endless_file_among_results(
    tmp_path: Path, out: Path, name: str, odd: Callable[[Path], None]
) -> None:
    """Each command ends, within the time that the tests give a command, and says what is wrong."""
    write(tmp_path, TEXT)
    (out / name).unlink()
    odd(out / name)
    for what, words in LINES.items():
        done = mpm3dpp(*words, cwd=tmp_path)
        assert "Traceback" not in done.stderr
        if done.returncode == 0:  # It has no need of that file.
            continue
        assert done.returncode in (1, 2) and Path(name).name in done.stderr, (what, done.stderr)
        one_sentence(done.stderr)


def test_from_python(out: Path) -> None:
    for name, use in (
        ("manifest.json", lambda: read_manifest(out)),
        ("history.csv", lambda: read_history(out)),
        (FRAME, lambda: open_results(out).arrays(0)),
        ("probes/tip.csv", lambda: open_results(out).probe("tip")),
    ):
        (out / name).unlink()
        a_pipe(out / name)
        with pytest.raises(CaseError, match="must be a file but is a pipe") as caught:
            use()
        assert str(out / name) in str(caught.value)


def to_a_link(file: h5py.File, name: str, other: Path) -> None:
    file[name] = h5py.ExternalLink(str(other), name)


def to_a_soft_link(file: h5py.File, name: str, other: Path) -> None:
    file[name] = h5py.SoftLink("/elsewhere")


def to_raw_data(file: h5py.File, name: str, other: Path, shape: Any, dtype: Any) -> None:
    file.create_dataset(name, shape, dtype, external=[(str(other), 0, h5py.h5f.UNLIMITED)])


def to_virtual_data(file: h5py.File, name: str, other: Path, shape: Any, dtype: Any) -> None:
    layout = h5py.VirtualLayout(shape, dtype)
    layout[...] = h5py.VirtualSource(str(other), name, shape, dtype)
    file.create_virtual_dataset(name, layout)


# Where data of a frame, a file of all frames or a table stand in other files.
PLACES = [
    *((FRAME, "arrays/velocity"), (FRAME, "arrays/position")),
    ("results.vtkhdf", "VTKHDF/Steps/Values"),
]
CHANGES = [to_a_link, to_a_soft_link, to_raw_data, to_virtual_data]


@pytest.mark.parametrize("change", CHANGES, ids=lambda change: change.__name__)
@pytest.mark.parametrize("place", PLACES, ids=lambda place: Path(place[1]).name)
@pytest.mark.parametrize("other", ["data", "pipe"])
def test_data_in_other_files(
    tmp_path: Path, out: Path, change: Callable[..., None], place: tuple[str, str], other: str
) -> None:
    """Though they are as they were: they might be anything that the user may read."""
    path, name = out / place[0], place[1]
    elsewhere = tmp_path / other
    with h5py.File(path, "r+") as file:
        values = file[name][()]
        del file[name]
        if other == "pipe":
            a_pipe(elsewhere)
        elif change is to_raw_data:
            elsewhere.write_bytes(values.tobytes())
        else:
            with h5py.File(elsewhere, "w") as found:
                found[name] = values
        if change in (to_raw_data, to_virtual_data):
            change = functools.partial(change, shape=values.shape, dtype=values.dtype)
        change(file, name, elsewhere)
    done = mpm3dpp("export", "out", "--frame", 0, cwd=tmp_path)
    assert done.returncode == 2
    sentence = one_sentence(done.stderr)
    assert path.name in sentence and ("damaged" in sentence or "not a results file" in sentence)


def test_data_of_one_file_in_another(tmp_path: Path) -> None:
    """Results of earlier versions have all frames in one file."""
    raw = tmp_path / "raw"
    raw.write_bytes(np.arange(6.0).tobytes())
    path = tmp_path / "results.vtkhdf"
    with h5py.File(path, "w") as file:
        root = file.create_group("VTKHDF")
        steps = root.create_group("Steps")
        steps.attrs["NSteps"] = 1
        for name in ("Values", "PartOffsets", "PointOffsets"):
            steps[name] = np.zeros(1, dtype=np.int64)
        steps.create_group("PointDataOffsets")
        root["NumberOfPoints"] = [2]
        root.create_group("PointData")
        root.create_group("FieldData")
        to_raw_data(file, "VTKHDF/Points", raw, (2, 3), float)
        file.create_group("mpm3dpp").attrs["run"] = (
            '{"title": "", "case_hash": "", "bodies": [], "materials": [], "dimension": 3, '
            '"cell_size": 1, "origin": [0, 0, 0], "units": {}}'
        )
    with open_results(path) as results, pytest.raises(CaseError, match="frame 0 is damaged"):
        results.arrays(0)


POINTS = """\
[grid]
dimension = 2
cell_size = "1 mm"
[run]
end_time = "1 us"
[material.steel]
density = "8000 kg/m^3"
strength = { elastic = { E = "200 GPa", nu = 0.3 } }
[body.rod]
material = "steel"
particles = "points.csv"
"""
GRAINS = POINTS.replace("[body.rod]", "[grains.sand]").replace("particles =", "file =")
TABLE = "x,y\n0.0005,0.0005\n0.0015,0.0005\n"
BALLS = "x,y,radius\n0.0005,0.0005,0.0005\n0.0025,0.0005,0.0005\n"


@pytest.mark.parametrize(("text", "table"), [(POINTS, TABLE), (GRAINS, BALLS)])
def test_a_table_that_ends_within_a_line(tmp_path: Path, text: str, table: str) -> None:
    """Wherever it was cut; a number that has lost digits is still a number."""
    case = write(tmp_path, text)
    (tmp_path / "points.csv").write_text(table)
    load_case(case)
    for cut in range(1, len(table)):
        (tmp_path / "points.csv").write_text(table[:cut])
        if table[:cut].endswith("\n") and table[:cut].count("\n") > 1:
            load_case(case)
            continue
        with pytest.raises(CaseError) as caught:
            load_case(case)
        if not table[:cut].endswith("\n"):
            number = table[:cut].count("\n") + 1
            assert f"ends in the midst of line {number}, which has no end" in str(caught.value)
    (tmp_path / "points.csv").write_text(table + "  # the end")  # Nothing is lost.
    load_case(case)
    (tmp_path / "points.csv").write_bytes(table.replace("\n", "\r\n").encode())
    load_case(case)


def test_an_import_that_cannot_be_written_leaves_what_was_there(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Neither half a case nor half a table: the disk is full, or the process is killed."""
    (tmp_path / "deck.mpm").write_text(edited((" 0.5 0 0 0", " 0.3 0 0 0")))  # It has a table.
    found = import_file(tmp_path / "deck.mpm")
    target = tmp_path / "case.toml"
    files = write_case(found, target)
    before = {file: file.read_bytes() for file in files}
    assert len(files) > 1

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(os, "fsync", full)
        with pytest.raises(CaseError, match="no space left on device"):
            write_case(found, target, force=True)
    assert {path: path.read_bytes() for path in tmp_path.iterdir() if path in before} == before
    assert not list(tmp_path.glob(".*"))
    assert load_any(target)
