# SPDX-License-Identifier: BSD-3-Clause
"""Each style check of tools/ finds what it is for, and leaves good text alone."""

import importlib
import sys
from pathlib import Path

import pytest

TOOLS = Path(__file__).parents[2] / "tools"
UNFINISHED = "TO" + "DO"  # in two parts, so that the check does not find it here


@pytest.fixture
def tool(monkeypatch):
    """Import a script of tools/ by name."""
    monkeypatch.syspath_prepend(TOOLS)
    yield importlib.import_module
    for name in (
        "check_classes",
        "check_imports",
        "check_layers",
        "check_sizes",
        "check_words",
        "files",
    ):
        sys.modules.pop(name, None)


@pytest.mark.parametrize(
    ("file", "include", "why"),
    [
        ("math/a.hpp", '"mpm/grid/tile.hpp"', "not lower"),
        ("grid/a.hpp", '"mpm/materials/model.hpp"', "not lower"),
        ("grid/a.hpp", '"../step/scheme.hpp"', "not lower"),
        ("grid/a.hpp", '"mpm/utils/x.hpp"', "has no layer"),
        ("run/a.cpp", "<nanobind/nanobind.h>", "must not know Python"),
        ("utils/a.hpp", "<vector>", "has no layer"),
        ("step/a.hpp", '"mpm/domain.hpp"', None),
        ("materials/strength/a.hpp", '"mpm/materials/model.hpp"', None),
    ],
)
def test_layers(tool, tmp_path, file, include, why):
    source = tmp_path / "cpp" / "mpm" / file
    source.parent.mkdir(parents=True)
    source.write_text(f"#include {include}\n")
    found = tool("check_layers").check(tmp_path)
    assert [why in text for text in found] == [True] if why else found == []


@pytest.mark.parametrize(
    ("file", "line", "why"),
    [
        ("base/a.py", "from mpm3dpp.case import Case", "not lower"),
        ("shapes/a.py", "from mpm3dpp.materials import catalogue", "not lower"),
        ("io/a.py", "def f():\n    from ..run.stepping import f", "not lower"),
        ("tools/a.py", "import os", "has no layer"),
        ("run/a.py", "from mpm3dpp.case import Case\nfrom .b import c", None),
        ("base/a.py", "from mpm3dpp import _core", None),
        ("base/a.py", "from .b import f", "import each other: base.a -> base.b -> base.a"),
        (
            "base/a.py",
            "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from .b import f",
            None,
        ),
    ],
)
def test_imports(tool, tmp_path, file, line, why):
    package = tmp_path / "python" / "mpm3dpp"
    (package / "base").mkdir(parents=True)
    (package / "base" / "b.py").write_text("from .a import f\n")
    source = package / file
    source.parent.mkdir(exist_ok=True)
    source.write_text(f"{line}\n")
    found = tool("check_imports").check(tmp_path)
    assert [why in text for text in found] == [True] if why else found == []


@pytest.mark.parametrize(("lines", "errors", "warnings"), [(300, 0, 0), (301, 0, 1), (501, 1, 0)])
def test_sizes(tool, tmp_path, lines, errors, warnings):
    names = [Path("long.cpp"), Path("a.py"), Path("b.py")]
    for name in names:
        (tmp_path / name).write_text("x\n" * (lines if name.stem == "long" else 3))
    found = tool("check_sizes").check(tmp_path, names)
    assert [len(each) for each in found] == [errors, warnings]


@pytest.mark.parametrize(
    ("members", "sources", "errors"), [(20, 1, 0), (21, 1, 1), (20, 2, 1), (21, 2, 2)]
)
def test_classes(tool, tmp_path, members, sources, errors):
    inline = [f"  int f{k}(int x = g(1)) const {{ return x; }}" for k in range(members - 2)]
    data = ["  int a = f(), b[2] = {};", "  A(const A&) = delete;", "  void g();", "  void h();"]
    (tmp_path / "a.hpp").write_text("\n".join(["struct A : B<int> {", *data, *inline, "};"]))
    names = [Path("a.hpp")]
    for name, member in list({"a.cpp": "g", "b.cpp": "h"}.items())[:sources]:
        (tmp_path / name).write_text(f"void A::{member}() {{ call(A::{member}(0)); }}\n")
        names.append(Path(name))
    assert len(tool("check_classes").check(tmp_path, names)) == errors


@pytest.mark.parametrize(
    ("suffix", "line", "bad"),
    [
        (".cpp", f"// {UNFINISHED}: later", True),
        (".cpp", f"// {UNFINISHED}(#12): later", False),
        (".py", 'path = "' + "/".join(["", "home", "me", "case.toml"]), True),
        (".cpp", "  // mass += p.m;", True),
        (".cpp", "  // if (x) {", True),
        (".cpp", "  // sum the blocks in tile order; the result must not depend on threads", False),
        (".py", "# mass = total(p)", True),
        (".py", "# mass of the particle", False),
    ],
)
def test_words(tool, suffix, line, bad):
    assert bool(tool("check_words").problem(line, suffix)) is bad
