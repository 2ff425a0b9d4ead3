# SPDX-License-Identifier: BSD-3-Clause
"""Whatever a name stands for, pipe, device, folder or far too large a file: a sentence at once."""

from __future__ import annotations

import os
import re
import resource
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from unittest.mock import Mock

import pytest

from commands import CASE, command, mpm3dpp, one_sentence, write
from mpm3dpp import CaseError, Simulation, load_case, shapes
from mpm3dpp.base.machine import group_limits
from mpm3dpp.base.reading import open_file
from mpm3dpp.case.file import MOST_BYTES
from mpm3dpp.fill.build import build
from mpm3dpp.importers import load_any
from mpm3dpp.plots import preview

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
particles = "odd.csv"
"""
GRAINS = POINTS.replace("[body.rod]", "[grains.sand]").replace("particles =", "file =")
AT_ONCE = 20.0  # Seconds, the start of Python on a busy machine included.


def a_pipe(path: Path) -> None:
    os.mkfifo(path)


def a_device(path: Path) -> None:
    path.symlink_to("/dev/zero")


def a_socket(path: Path) -> None:
    here = os.getcwd()
    os.chdir(path.parent)  # The name of a socket may have a hundred characters only.
    with socket.socket(socket.AF_UNIX) as made:
        made.bind(path.name)
    os.chdir(here)


def a_folder(path: Path) -> None:
    path.mkdir()


def a_large_file(path: Path) -> None:
    with open(path, "wb") as file:
        file.truncate(100 << 20)


def a_loop(path: Path) -> None:
    path.symlink_to(path)


ODD = [a_pipe, a_device, a_socket, a_folder, a_large_file, a_loop]


@pytest.mark.parametrize("odd", ODD, ids=lambda odd: odd.__name__)
@pytest.mark.parametrize("name", ["case.toml", "case.mpm"])
def test_as_a_case(tmp_path: Path, odd: Callable[[Path], None], name: str) -> None:
    odd(tmp_path / name)
    with pytest.raises(CaseError) as caught:
        load_any(tmp_path / name)
    sentence = str(caught.value)
    assert sentence.startswith(f"{tmp_path / name}: ") and "\n" not in sentence
    if odd is a_large_file:
        most = MOST_BYTES if name == "case.toml" else 64 << 20
        assert f"has 100.0 MiB, and {most >> 20} MiB is the most" in sentence


@pytest.mark.parametrize("odd", ODD, ids=lambda odd: odd.__name__)
@pytest.mark.parametrize("text", [POINTS, GRAINS], ids=["particles", "grains"])
def test_as_a_file_of_points(tmp_path: Path, odd: Callable[[Path], None], text: str) -> None:
    odd(tmp_path / "odd.csv")
    with pytest.raises(CaseError) as caught:
        load_case(write(tmp_path, text))
    sentence = str(caught.value)
    assert f"{tmp_path / 'case.toml'}:11: " in sentence and '= "odd.csv" ' in sentence


@pytest.mark.parametrize("what", ["run", "import"])
def test_commands_do_not_wait_for_a_pipe(tmp_path: Path, what: str) -> None:
    name = "case.mpm" if what == "import" else "case.toml"
    a_pipe(tmp_path / name)
    line = command(what, name)
    done = subprocess.run(line, cwd=tmp_path, capture_output=True, text=True, timeout=AT_ONCE)
    assert done.returncode == 2
    assert one_sentence(done.stderr).endswith("must be a file but is a pipe; check the path")


def test_a_pipe_beside_a_name_that_is_missing(tmp_path: Path) -> None:
    a_pipe(tmp_path / "case1.toml")
    write(tmp_path).rename(tmp_path / "case22.toml")
    with pytest.raises(CaseError, match=r'did you mean ".*case22.toml"'):
        load_any(tmp_path / "case.toml")


@pytest.mark.parametrize("name", ["a\0b.toml", "n" * 300 + ".toml", "a\0b.mpm"])
def test_names_that_no_file_has(tmp_path: Path, name: str) -> None:
    with pytest.raises(CaseError):
        load_any(tmp_path / name)
    with pytest.raises(CaseError):
        load_case(str(tmp_path / name))


def test_a_file_of_points_that_the_memory_does_not_hold(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    lines = "x,y\n" + "".join(f"{0.0005 * k!r},0.0005\n" for k in range(2000))
    (tmp_path / "odd.csv").write_text(lines)
    path = write(tmp_path, POINTS)
    assert len(build(load_case(path))[0].positions) == 2000
    monkeypatch.setattr("mpm3dpp.base.csv_points.MEMORY", 2000 * 150 * 0.9)
    with pytest.raises(CaseError, match=r"has some 2.0e\+03 lines, a particle each, which need"):
        load_case(path)


def test_a_line_without_end(tmp_path: Path) -> None:
    (tmp_path / "odd.csv").write_text("x,y\n1,2\n" + "1," * 10_000 + "\n")
    with pytest.raises(CaseError, match="more than 10,000 characters in line 3"):
        load_case(write(tmp_path, POINTS))


FULL = {
    "output": (">/dev/full", 1, "cannot write to standard output: no space left on device"),
    "errors": ("2>/dev/full", 0, ""),
    "no errors": ("2>&-", 0, ""),
    "nothing at all": ("<&- >&- 2>&-", 0, ""),
}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="needs /dev/full")
@pytest.mark.parametrize(
    ("what", "how"),
    [
        ("check", "output"),
        ("check", "no errors"),
        ("run", "output"),
        ("run", "errors"),
        ("run", "nothing at all"),
    ],
)
def test_streams_that_are_full_or_closed(tmp_path: Path, what: str, how: str) -> None:
    redirection, code, sentence = FULL[how]
    case = write(tmp_path, CASE.replace("8 ms", "0.5 ms"))
    more = [] if what == "check" else ["--no-pictures", "--out", tmp_path / "out"]
    line = " ".join(command(what, case, *more)) + " " + redirection
    done = subprocess.run(["bash", "-c", line], capture_output=True, text=True, timeout=60)
    assert done.returncode == code
    assert "Traceback" not in done.stderr + done.stdout
    assert "Exception ignored" not in done.stderr + done.stdout
    if sentence:
        assert done.stderr.endswith(f"mpm3dpp: error: {sentence}\n")
    if what == "run":  # What was computed is there, and nothing that was printed is in it.
        from mpm3dpp import open_results

        with open_results(tmp_path / "out") as results:
            assert len(results) == 5
        assert (tmp_path / "out" / "history.csv").read_text().startswith("step")


@pytest.mark.parametrize(
    ("name", "rule"),
    [
        ("x.exe", 'has the ending ".exe", which is of no picture; valid here: '),
        ("pipe.png", "is no file"),
        ("/dev/null", "cannot write '/dev/null'"),
        ("a\0b.png", "must be the path of a file or folder"),
    ],
)
def test_pictures_that_cannot_be(tmp_path: Path, name: str, rule: str) -> None:
    a_pipe(tmp_path / "pipe.png")
    with pytest.raises(CaseError, match=re.escape(rule)):
        preview(load_case(write(tmp_path)), tmp_path / name)


def test_a_matplotlib_backend_that_is_not_there(tmp_path: Path) -> None:
    case = write(tmp_path)
    done = subprocess.run(
        command("preview", case, "--out", tmp_path / "x.png"),
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "MPLBACKEND": "no_such_backend"},
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert (tmp_path / "x.png").exists()


def test_a_title_that_the_terminal_does_not_know(tmp_path: Path) -> None:
    case = write(tmp_path, CASE.replace("Two blocks", "Zwei Blöcke µ"))
    line = command("check", case)
    environment = {**os.environ, "PYTHONIOENCODING": "iso8859-5"}  # Cyrillic.
    done = subprocess.run(line, capture_output=True, timeout=60, env=environment)
    assert (done.returncode, done.stderr) == (0, b"")
    assert done.stdout.startswith(rb"Zwei Bl\xf6cke \xb5")


# Text of the case of two blocks, what replaces it, what is told.
TOO_MUCH = {
    "grains beyond the memory": (
        CASE[CASE.index("[body.left]") :],
        '[grains.g]\nmaterial = "soft"\nlattice = { lower = [0, 0], count = [10000000, 1000], '
        'radius = "20 mm" }\n',
        "would be more than 10,000,000 grains",
    ),
    "grains beyond the box": (
        'cell_size = "10 mm"',
        'cell_size = "10 mm"\nbox = { lower = [0, 0], upper = [1, 1] }\n[grains.g]\nmaterial = '
        '"soft"\nlattice = { lower = [0, 0], count = [1000, 100], radius = "20 mm" }',
        "reaches out of grid.box: centres stand from x = 0.02 m to 39.98 m",
    ),
    "a ball beyond the memory": (
        'upper = ["110 mm", "60 mm"]',
        'upper = ["110 km", "60 km"]',
        "of memory, and there are",
    ),
    "a ball beyond the box": (
        'cell_size = "10 mm"',
        'cell_size = "10 mm"\nbox = { lower = [0, 0], upper = [1, 1] }\n[body.ball]\nmaterial = '
        '"soft"\nshape = { disc = { centre = [15, 15], radius = "15 m" } }',
        "reaches out of grid.box: it measures 30 x 30 m",
    ),
    "a box of 1e9 m": (
        'cell_size = "10 mm"',
        'cell_size = "10 mm"\nbox = { lower = [0, 0], upper = [1e9, 1] }',
        "is 1.0e+11 cells from lower",
    ),
    "far from the origin": (
        'lower = ["60 mm", "10 mm"], upper = ["110 mm", "60 mm"]',
        'lower = ["60000 km", "10 mm"], upper = ["60000.0001 km", "60 mm"]',
        "cells from the grid's origin",
    ),
    "doublings": (
        'cell_size = "10 mm"',
        'cell_size = "10 mm"\ndoubling = { tiles = 10, times = 100000000000 }',
        "must be <= 30",
    ),
    "digits": ("dimension = 2", f"dimension = {'2' * 5000}", "more digits than are read"),
    "hexadecimal digits": ("dimension = 2", f"dimension = 0x{'2' * 5000}", "of 6020 digits"),
    "brackets": ('title = "Two blocks"', f"title = {'[' * 5000}{']' * 5000}", "too deeply"),
    "dots": ('title = "Two blocks"', f"title{'.a' * 20000} = 1", "too deeply"),
    "a unit to work out": ('"1 MPa"', '"1 MPa**9**9**9"', "which is not known"),
    "a material as a list": (
        'density = "1000 kg/m^3"',
        "library = [1]",
        "is not a material of the library",
    ),
    "a name with a NUL": ("[body.left]", '[body."le\\u0000ft"]', "cannot be shown"),
}


@pytest.mark.parametrize("what", TOO_MUCH)
def test_what_is_far_too_much_is_told_before_it_is_made(tmp_path: Path, what: str) -> None:
    old, new, part = TOO_MUCH[what]
    path = write(tmp_path, CASE.replace(old, new, 1))
    before = resource.getrusage(resource.RUSAGE_SELF)
    with pytest.raises(CaseError) as caught:
        build(load_case(path))
    after = resource.getrusage(resource.RUSAGE_SELF)
    assert part in str(caught.value)
    assert "\n" not in str(caught.value)
    assert after.ru_utime - before.ru_utime < 5.0  # Seconds of this process.
    assert after.ru_maxrss - before.ru_maxrss < 300_000  # KiB.


def test_a_list_of_shapes_by_position() -> None:
    a = shapes.Disc(centre=(0, 0), radius=1)
    b = shapes.Disc(centre=(1, 0), radius=1)
    for kind in (shapes.Intersection, shapes.Union, shapes.Difference):
        assert kind([a, b]) == kind(a, b) == kind(shapes=[a, b])
    with pytest.raises(CaseError, match=r"takes its values by name; write Disc\(centre=\.\.\., "):
        shapes.Disc((0, 0), 1)


def test_a_limit_of_memory_counts(tmp_path: Path) -> None:
    code = (
        "import resource; resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30));"
        "from mpm3dpp.base.machine import MEMORY; assert MEMORY <= 3 << 30"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


def test_limits_of_control_groups() -> None:
    """Of the process's group and those around it: a batch job's is not at the top."""
    root = "/sys/fs/cgroup"
    two = [str(path) for path in group_limits("0::/user/job_7\n")]
    assert two == [f"{root}{group}/memory.max" for group in ("/user/job_7", "/user", "")]
    one = [str(path) for path in group_limits("4:cpu,memory:/job\n3:cpuset:/x\n")]
    assert one == [f"{root}/memory{group}/memory.limit_in_bytes" for group in ("/job", "")]
    assert list(group_limits("3:cpuset:/x\n")) == []


def test_a_file_that_becomes_another_kind_is_closed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def opened() -> int:
        return len(list(Path("/proc/self/fd").iterdir()))

    (tmp_path / "case.toml").touch()
    looks = Mock(side_effect=[None, CaseError("is a folder")])
    monkeypatch.setattr("mpm3dpp.base.reading._refuse_other_kinds", looks)
    before = opened()
    with pytest.raises(CaseError, match="is a folder"):
        open_file(tmp_path / "case.toml")
    assert opened() == before


def test_a_body_beyond_what_the_core_can_list(tmp_path: Path) -> None:
    """`check` says it, with the key."""
    for cells, fine in ((2**19 - 10, True), (2**19 + 10, False)):
        low = round(cells * 10e-3, 2)
        corners = f"lower = [{low}, 0], upper = [{low + 0.05}, 0.05]"
        text = CASE.replace('lower = ["60 mm", "10 mm"], upper = ["110 mm", "60 mm"]', corners)
        done = mpm3dpp("check", write(tmp_path, text), cwd=tmp_path)
        assert (done.returncode == 0) == fine, done.stderr
        if fine:
            assert Simulation(load_case(tmp_path / "case.toml"), threads=1).advance(1) == 1
        else:
            assert "body.right.shape" in done.stderr and "524,288 is the most" in done.stderr


def test_numbers_of_steps_that_no_loop_ends(tmp_path: Path) -> None:
    simulation = Simulation(load_case(write(tmp_path)), threads=1)
    assert simulation.advance(10**30) > 0
