# SPDX-License-Identifier: BSD-3-Clause
"""Whatever lies in the user's folder under the name of a module: none of it is ever run."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from commands import CASE, command, write
from mpi_jobs import environment, has_module
from mpm3dpp.base import child, start

SHORT = CASE.replace("8 ms", "0.2 ms")
NAMES = (
    *("numpy", "mpi4py", "h5py", "scipy", "matplotlib", "pydantic", "pint", "typer", "pyvista"),
    *("json", "tempfile", "subprocess", "csv", "zipfile", "ctypes", "base", "signals"),
)
"""Of modules that we and our libraries import; not those that `python -m` does before us."""


def plant(folder: Path, *more: str) -> Path:
    """Put modules into a folder that tell when they are run; return what they tell by."""
    told = folder / "was run"
    for name in (*NAMES, *more):
        (folder / f"{name}.py").write_text(f"open({str(told)!r}, 'a').write({name!r})\n")
    return told


def run(folder: Path, *words: Any, env: dict[str, str] | None = None, **more: Any) -> str:
    done = subprocess.run(
        command(*words, **more), cwd=folder, env=env, capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    return done.stdout + done.stderr


LINES = {
    "a run with pictures": ("run", "case.toml", "--out", "out", "--threads", 1),
    "a sweep": ("sweep", "case.toml", "--out", "out", "--set", "contact.friction=0,0.1"),
    "a benchmark": ("bench", "elastic2d", "--size", 8, "--steps", 2),
}


@pytest.mark.parametrize("what", LINES)
def test_processes_run_nothing_of_the_folder(tmp_path: Path, what: str) -> None:
    write(tmp_path, SHORT)
    told = plant(tmp_path)
    run(tmp_path, *LINES[what], pictures=True)
    assert not told.exists(), told.read_text()
    if what == "a run with pictures":
        assert (tmp_path / "out" / "frame.png").stat().st_size > 1000


def test_ranks_run_nothing_of_the_folder(tmp_path: Path) -> None:
    way = "module" if has_module() else "mpi4py"
    write(tmp_path, SHORT)
    told = plant(tmp_path)
    run(tmp_path, "run", "case.toml", "--out", "out", "--ranks", 2, env=environment(way))
    assert not told.exists(), told.read_text()


def test_a_benchmark_of_ranks_runs_nothing_of_the_folder(tmp_path: Path) -> None:
    way = "module" if has_module() else "mpi4py"
    told = plant(tmp_path)
    words = ("bench", "elastic2d", "--size", 8, "--steps", 2, "--ranks", 2)
    run(tmp_path, *words, env=environment(way))
    assert not told.exists(), told.read_text()


@pytest.mark.parametrize("module", ["plots.probe_card", "ranks.which_mpi", "__main__"])
def test_a_process_runs_nothing_of_the_folder(tmp_path: Path, module: str) -> None:
    """Not even what Python itself looks for, nor another `mpm3dpp`."""
    pytest.importorskip(
        {"plots.probe_card": "pyvista", "ranks.which_mpi": "mpi4py"}.get(module, "os")
    )
    told = plant(
        tmp_path, "runpy", "importlib", "os", "site", "threading", "mpm3dpp", "collections"
    )
    subprocess.run(child.command(module, "--help"), cwd=tmp_path, capture_output=True, timeout=120)
    assert not told.exists(), told.read_text()


@pytest.mark.parametrize(
    "words",
    [
        ":{path}",
        *(pytest.param(w, marks=pytest.mark.slow) for w in ("{path}:", "{path}::/nowhere")),
    ],
)
def test_an_empty_word_in_pythonpath_is_not_the_folder(tmp_path: Path, words: str) -> None:
    """`PYTHONPATH=$PYTHONPATH:/lib` has one where there was nothing."""
    write(tmp_path, SHORT)
    told = plant(tmp_path)
    path = os.environ.get("PYTHONPATH", "") or os.path.dirname(os.path.dirname(start.__file__))
    about = {**os.environ, "PYTHONPATH": words.format(path=path)}
    run(tmp_path, "check", "case.toml", env=about)
    run(tmp_path, *LINES["a sweep"], env=about)
    assert not told.exists(), told.read_text()


def test_a_folder_that_pythonpath_names_is_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for named, left in ((str(tmp_path), True), ("", False), ("/nowhere", False)):
        monkeypatch.setenv("PYTHONPATH", named)
        monkeypatch.setattr(sys, "path", ["", str(tmp_path), "/elsewhere"])
        start.forget_folder()
        assert sys.path == [str(tmp_path), "/elsewhere"][not left :]
