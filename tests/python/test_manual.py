# SPDX-License-Identifier: BSD-3-Clause
"""What comes with the package to read and to try: `mpm3dpp docs` and `mpm3dpp examples`."""

from __future__ import annotations

from pathlib import Path

import pytest

from commands import mpm3dpp
from mpm3dpp import load_case
from mpm3dpp.base import shipped as home
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.shipped import shipped
from mpm3dpp.manual import examples
from mpm3dpp.manual.pages import look_up, page_list, places

# What an engineer asks, and the page that must be the first to be told.
ASKED = {
    "residual velocity": "how-to/shoot-through-a-plate",
    "angle of repose": "how-to/turn-a-drum",
    "contact network": "how-to/turn-a-drum",
    "several values in parallel": "how-to/sweep-a-case",
    "values along a line": "how-to/take-numbers-out",
    "another interval of frames": "how-to/stop-and-go-on",
    "geostatic": "how-to/begin-under-weight",
    "Taylor bar MPM3D": "coming-from/mpm3d",
    "*CONTACT": "coming-from/ls-dyna",
}


def test_what_is_installed_goes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside the modules; a checkout has it beside its folder python."""
    package = tmp_path / "python" / "mpm3dpp"
    monkeypatch.setattr(home, "__file__", str(package / "base" / "shipped.py"))
    assert shipped("examples") == tmp_path / "examples"
    (package / "examples").mkdir(parents=True)
    assert shipped("examples") == package / "examples"


def test_every_page_is_listed_and_can_be_read() -> None:
    listed = page_list()
    assert "  quick-start" in listed and "how-to/sweep-a-case" in listed
    assert look_up(["sweep-a-case"]) == (shipped("docs") / "how-to/sweep-a-case.md").read_text()
    assert look_up(["how-to/sweep-a-case.md"]) == look_up(["sweep-a-case"])


@pytest.mark.parametrize("words", ASKED)
def test_words_lead_to_the_page(words: str) -> None:
    found = places(words.lower().split())
    assert ASKED[words] in [section.page for section, _ in found[:3]]
    assert f"{ASKED[words]}: " in look_up(words.split())


def test_a_line_is_no_wider_than_a_screen() -> None:
    assert all(len(line) < 110 for line in look_up(["friction"]).splitlines()[1::2])


def test_words_that_no_page_has() -> None:
    with pytest.raises(CaseError, match="no page of the documentation has 'flux capacitor'"):
        look_up(["flux", "capacitor"])


@pytest.mark.parametrize("name", ["05_hopper", "05", "hopper"])
def test_names_of_an_example(name: str) -> None:
    assert examples.folder_of(name).name == "05_hopper"


def test_every_example_is_listed() -> None:
    assert [line.split()[0] for line in examples.listing().splitlines()] == examples.names()
    assert "05_hopper" in examples.names() and "case_small.toml" in examples.listing()


def test_a_copy_is_the_example(tmp_path: Path) -> None:
    for name in examples.names():
        made = examples.copy(name, tmp_path / "new" / name)
        source = examples.folder_of(name)
        assert load_case(made / "case.toml").case_hash == load_case(source / "case.toml").case_hash
    with pytest.raises(CaseError, match="there is one already; give another folder"):
        examples.copy("hopper", tmp_path / "new")


def test_the_commands(tmp_path: Path) -> None:
    done = mpm3dpp("examples", "copy", "rings", cwd=tmp_path)
    assert done.returncode == 2 and 'did you mean "two_rings"?' in done.stderr
    assert mpm3dpp("examples", "copy", "01", cwd=tmp_path).stdout == "01_two_rings/case.toml\n"
    words = ("two_rings", "--set", "grid.cell_size=5 mm", "--set", "run.end_time=10 us")
    done = mpm3dpp("examples", "run", *words, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "results" / "01_two_rings" / "manifest.json").is_file()
    done = mpm3dpp("examples", "run", "01", "--thread", "2", cwd=tmp_path)
    assert done.returncode == 2 and "No such option: --thread" in done.stderr
    assert "quick-start" in mpm3dpp("docs", cwd=tmp_path).stdout
    assert "Read one:" in mpm3dpp("docs", "friction", cwd=tmp_path).stdout
