# SPDX-License-Identifier: BSD-3-Clause
"""A package with several builds of the core loads the one for the processor."""

from __future__ import annotations

import importlib.machinery
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import mpm3dpp
from mpm3dpp import CaseError, _core
from mpm3dpp.base.processor import LEVELS, CoreFinder, choose, processor_flags

ALL = list(LEVELS)
ZEN4 = LEVELS["x86-64-v4"] | {"sse4_2"}
HASWELL = LEVELS["x86-64-v3"]


@pytest.mark.parametrize(
    ("flags", "level"),
    [(ZEN4, "x86-64-v4"), (HASWELL, "x86-64-v3"), (HASWELL - {"fma"}, "x86-64"), ({}, "x86-64")],
)
def test_the_fastest_that_the_processor_knows(flags, level: str) -> None:
    assert choose(ALL, flags) == level
    assert choose(["x86-64"], flags) == "x86-64"


def test_a_wish_may_only_be_lower() -> None:
    assert choose(ALL, ZEN4, "x86-64-v3") == "x86-64-v3"
    with pytest.raises(CaseError, match=r"MPM3DPP_ISA = \"x86-64-v4\" is more than this processor"):
        choose(ALL, HASWELL, "x86-64-v4")
    with pytest.raises(CaseError, match=r'MPM3DPP_ISA = "avx2" is not in this build; .*x86-64'):
        choose(ALL, ZEN4, "avx2")
    with pytest.raises(CaseError, match="from source"):
        choose(["x86-64-v3"], {})


def test_flags_of_this_processor_are_those_the_core_was_built_for() -> None:
    """This core runs here, so the processor has what its instructions need."""
    lanes = _core.build_info()["lanes"]
    if lanes == 2 or not Path("/proc/cpuinfo").is_file():
        pytest.skip("a core for SSE2 or NEON tells nothing of the processor, or it is not Linux")
    least = LEVELS["x86-64-v4"] if lanes == 8 else {"avx"}
    assert least <= processor_flags()


def test_other_modules_are_not_looked_for(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.delenv("MPM3DPP_ISA", raising=False)
    assert CoreFinder().find_spec("mpm3dpp._other", [str(tmp_path)]) is None
    assert CoreFinder().find_spec("mpm3dpp._core", [str(tmp_path)]) is None  # nothing is there
    assert CoreFinder().find_spec("mpm3dpp._core") is None
    monkeypatch.setenv("MPM3DPP_ISA", "x86-64-v3")
    with pytest.raises(CaseError, match="one core for the processor it was built on"):
        CoreFinder().find_spec("mpm3dpp._core", [str(tmp_path)])


def test_a_package_with_levels_loads_one(tmp_path: Path) -> None:
    """The core of this build stands for all levels: what is loaded is seen by its file."""
    here = Path(mpm3dpp.__file__).parent
    shutil.copytree(
        here, tmp_path / "mpm3dpp", ignore=shutil.ignore_patterns("_core*", "_testing*")
    )
    suffix = importlib.machinery.EXTENSION_SUFFIXES[0]
    for level in LEVELS:
        name = level.replace("-", "_")
        shutil.copy(_core.__file__, tmp_path / "mpm3dpp" / f"_core_{name}{suffix}")

    def loaded(wish: str) -> subprocess.CompletedProcess[str]:
        code = "from mpm3dpp import _core; print(_core.__file__, _core.build_info()['lanes'])"
        return subprocess.run(
            [sys.executable, "-c", code],
            env={"PYTHONPATH": str(tmp_path), "MPM3DPP_ISA": wish},
            cwd=tmp_path,
            capture_output=True,
            text=True,
            check=False,
        )

    fastest = choose(ALL, processor_flags()).replace("-", "_")
    assert f"_core_{fastest}{suffix} {_core.build_info()['lanes']}" in loaded("").stdout
    assert f"_core_x86_64{suffix}" in loaded("x86-64").stdout
    assert 'MPM3DPP_ISA = "x86" is not in this build' in loaded("x86").stderr
