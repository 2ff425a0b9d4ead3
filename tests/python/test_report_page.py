# SPDX-License-Identifier: BSD-3-Clause
"""`mpm3dpp report`: one page of HTML of a run, whatever became of it."""

from __future__ import annotations

import errno
import json
import os
import re
import shutil
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mpm3dpp
from commands import CASE, interrupted, one_sentence, write
from commands import mpm3dpp as run_command
from mpm3dpp import Case, CaseError, RunError, open_results, run_case
from mpm3dpp.base.markup import Html
from mpm3dpp.io import read_history, read_manifest
from mpm3dpp.io.folders import only_run_in
from mpm3dpp.reports import figures
from mpm3dpp.reports.case_text import toml_of

VOID = {"meta", "img", "br", "hr", "link", "input"}
HOSTILE = "<b>&\"'</b> \N{GREEK SMALL LETTER MU}"
GRAINS = """\
title = "Discs fall"
[grid]
dimension = 2
cell_size = "10 mm"
[run]
end_time = "30 ms"
gravity = [0, "-9.81 m/s^2"]
[output]
frames = 3
[contact]
friction = 0.3
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "0.2 MPa", nu = 0.3 } }
[material.steel]
density = "7800 kg/m^3"
strength = { rigid = {} }
[body.floor]
material = "steel"
shape = { box = { lower = ["0 mm", "-20 mm"], upper = ["200 mm", "0 mm"] } }
motion = "fixed"
[grains.discs]
material = "soft"
lattice = { lower = [0, 0], count = [10, 2], radius = "10 mm" }
velocity = [0, "-0.5 m/s"]
"""
SOLID = """\
[grid]
dimension = 3
cell_size = "10 mm"
box = { lower = [0, 0, 0], upper = ["40 mm", "40 mm", "40 mm"], walls = { z_min = "slip" } }
[run]
end_time = "2 ms"
gravity = [0, 0, "-9.81 m/s^2"]
[material.soft]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
[body.block]
material = "soft"
shape = { box = { lower = [0, 0, 0], upper = ["20 mm", "20 mm", "20 mm"] } }
[load.press]
body = "block"
side = "z_max"
pressure = "1 kPa"
[probe.middle]
point = ["10 mm", "10 mm", "10 mm"]
every = "0.2 ms"
fields = ["velocity"]
"""


class Page(HTMLParser):
    """A page: its text, links, sources, names, and tables by the section that they are in."""

    def __init__(self, text: str) -> None:
        super().__init__(convert_charrefs=True)
        self.open: list[str] = []
        self.ids: list[str] = []
        self.links: list[str] = []
        self.sources: list[str] = []
        self.tables: dict[str, list[list[list[str]]]] = {}
        self.texts: dict[str, str] = {}
        self.section = ""
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        names = [name for name, _ in attrs]
        assert len(names) == len(set(names)), (tag, names)
        found = dict(attrs)
        self.ids += [str(found["id"])] if "id" in found else []
        self.links += [str(found["href"])] if "href" in found else []
        self.sources += [str(found["src"])] if "src" in found else []
        if tag == "section":
            self.section = str(found["id"])
            self.tables[self.section] = []
        if tag == "table":
            self.tables[self.section].append([])
        if tag == "tr":
            self.tables[self.section][-1].append([])
        if tag in ("td", "th"):
            self.tables[self.section][-1][-1].append("")
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag, (tag, self.getpos())

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.handle_starttag(tag, attrs)
        if tag not in VOID:
            self.open.pop()

    def handle_data(self, data: str) -> None:
        if "style" in self.open or "svg" in self.open:
            return
        self.texts[self.section] = self.texts.get(self.section, "") + data
        if {"td", "th"} & set(self.open):
            self.tables[self.section][-1][-1][-1] += data

    def column(self, section: str, title: str, number: int = 0) -> dict[str, str]:
        """Return a column of a table by the first."""
        head, *rows = self.tables[section][number]
        return {row[0]: row[head.index(title)] for row in rows}

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.texts.values()).split())


def page_of(folder: Path) -> Page:
    return Page(mpm3dpp.report(folder).read_text())


@pytest.fixture
def no_curves(monkeypatch: pytest.MonkeyPatch) -> None:
    """Leave out the curves, which take a second or two to draw."""
    monkeypatch.setattr(figures, "inline_svg", lambda *_: Html("<svg></svg>"))


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run with contact, its pictures drawn, and an animation that is none."""
    folder = tmp_path_factory.mktemp("report")
    case = write(folder, CASE.replace("[grid]", "# <b>5 < 6 & 7</b>\n[grid]", 1))
    done = run_command("run", case, "--out", "out", "--threads", 1, cwd=folder, pictures=True)
    assert done.returncode == 0, done.stderr
    (folder / "out" / "my film.mp4").write_bytes(b"none")
    done = run_command("report", "out", cwd=folder)
    assert (done.returncode, done.stdout) == (0, "out/report.html\n"), done.stderr
    return folder / "out"


@pytest.fixture(scope="module")
def page(finished: Path) -> Page:
    return Page((finished / "report.html").read_text())


def test_a_page_is_whole_and_needs_no_other_file(finished: Path, page: Page) -> None:
    assert page.sources and all(s.startswith("data:image/png;base64,") for s in page.sources)
    assert len(page.ids) == len(set(page.ids))
    inner = [link.removeprefix("#") for link in page.links if link.startswith("#")]
    assert set(inner) <= set(page.ids)
    assert [link for link in page.links if not link.startswith("#")] == ["my%20film.mp4"]
    text = (finished / "report.html").read_text()
    assert "<script" not in text and "@import" not in text and "url(http" not in text
    assert "http" not in re.sub(r"<pre>.*?</pre>", "", text, flags=re.S)
    assert "prefers-color-scheme: dark" in text and "viewport" in text and "@media print" in text


def test_the_contents_name_every_section(page: Page) -> None:
    names = ["happened", "case", "pictures", "energies", "bodies", "contacts", "time-step"]
    names += ["stages", "manifest"]
    assert list(page.tables) == names
    assert [f"#{name}" for name in names] == [link for link in page.links if link[1:] in names]


def test_numbers_are_those_of_the_results(finished: Path, page: Page) -> None:
    history, manifest = read_history(finished), read_manifest(finished)
    end = page.column("energies", "end [J/m]")
    for name in ("kinetic", "internal", "numerical", "residual"):
        assert float(end[name]) == pytest.approx(history[name][-1], rel=1e-5), name
    size = float(re.findall(r"Largest residual of the ledger: (\S+) J/m", page.text)[0])
    assert size == pytest.approx(np.abs(history["residual"]).max(), rel=1e-2)
    velocity = page.column("bodies", "velocity, end [m/s]")
    for name in ("left", "right"):
        last = manifest["bodies"][name]["final"]
        shown = [float(part) for part in velocity[name].split(",")]
        assert shown == pytest.approx([last["velocity_x"], last["velocity_y"]], rel=1e-4)
        assert float(page.column("bodies", "mass [kg/m]")[name]) == pytest.approx(last["mass"])
    [pair] = manifest["contact"]["pairs"]
    shown = page.column("contacts", "first touch [s]")["left \N{EN DASH} right"]
    assert float(shown) == pytest.approx(pair["first_time"], rel=1e-5)
    stages = page.column("stages", "ns per particle-step")
    for name, value in stages.items():
        assert float(value) == pytest.approx(manifest["stages"][name], rel=1e-3)
    record = page.column("manifest", "value")
    assert record["result hash"] == manifest["result_hash"]
    assert record["command"].startswith("mpm3dpp run ") and record["processor"]
    limiter = manifest["limiter"]
    assert f"particle {limiter['particle']:,} of {limiter['body']}" in page.text
    assert "Finished at t = 8 ms" in page.text and "5 < 6 & 7" in page.texts["case"]


@pytest.mark.usefixtures("no_curves")
def test_text_and_names_are_escaped(tmp_path: Path) -> None:
    name = HOSTILE + " $a"
    text = CASE.replace('"Two blocks"', json.dumps(HOSTILE, ensure_ascii=False))
    text = text.replace("body.left", f"body.{json.dumps(name, ensure_ascii=False)}")
    case = Case.from_text(text.replace('"8 ms"', '"2 ms"'))
    run_case(case, tmp_path, threads=1, pictures=False)
    found = page_of(tmp_path)
    assert HOSTILE in found.texts[""] and case.text in found.texts["case"]
    assert name in found.column("bodies", "kind")
    assert f"{name} \N{EN DASH} right" in found.column("contacts", "pairs")
    assert "There are none" in found.texts["pictures"]


def test_a_case_that_was_changed_is_written_as_a_case_file(tmp_path: Path) -> None:
    case = Case.from_text(SOLID).with_({"run.end_time": "1 ms"})
    assert case.text == ""
    again = Case.from_text(toml_of(case.table()))
    assert again.case_hash == case.case_hash
    for text in (GRAINS, CASE):
        case = Case.from_text(text)
        assert Case.from_text(toml_of(case.table())).case_hash == case.case_hash


def test_a_run_in_3d_with_loads_walls_and_probes(tmp_path: Path) -> None:
    run_case(Case.from_text(SOLID), tmp_path, threads=1, pictures=False)
    found, manifest = page_of(tmp_path), read_manifest(tmp_path)
    assert list(found.tables)[-1] == "manifest" and "probes" in found.tables
    shown = found.column("actions", "force, end [N]")["press"]
    assert [float(v) for v in shown.split(",")] == pytest.approx(
        manifest["loads"]["press"]["force"], rel=1e-4, abs=1e-12
    )
    wall = found.column("actions", "pressure, end [Pa]", 1)["z_min"]
    assert float(wall) == pytest.approx(manifest["walls"]["z_min"]["pressure"], rel=1e-5)
    assert found.column("bodies", "mass [kg]")["block"] == "0.008"
    assert "probes/middle.csv" in found.texts["probes"]


@pytest.mark.usefixtures("no_curves")
def test_grains_are_one_row_and_have_a_coordination_number(tmp_path: Path) -> None:
    run_case(Case.from_text(GRAINS), tmp_path, threads=1, pictures=False)
    found = page_of(tmp_path)
    assert set(found.column("bodies", "kind").items()) == {
        ("floor", "moves as prescribed"),
        ("discs", "grains, deforms"),
    }
    with open_results(tmp_path) as results:
        mean = results.coordination_number()
    assert f"discs: 20 grains, coordination number {mean:.4g} " in found.text


@pytest.mark.usefixtures("no_curves")
def test_a_run_that_was_stopped_and_went_on(tmp_path: Path, monkeypatch: Any) -> None:
    case = Case.from_text(CASE)
    interrupted(case, tmp_path, 20, monkeypatch)
    stopped = page_of(tmp_path)
    assert "Stopped before its end" in stopped.texts[""] and "of 8 ms" in stopped.texts[""]
    run_case(case, tmp_path, threads=1, pictures=False, resume=True)
    found = page_of(tmp_path)
    step = read_manifest(tmp_path)["resumed_step"]
    assert f"went on from step {step:,}" in found.text and "Finished" in found.texts[""]
    assert "Note: going on from step" in found.text


@pytest.mark.usefixtures("no_curves")
def test_a_run_that_failed(tmp_path: Path) -> None:
    text = CASE.replace("cfl = 0.3", 'cfl = 0.5\nscheme = "usl"')
    text = text.replace('cell_size = "10 mm"', 'cell_size = "10 mm"\nbasis = "linear"')
    with pytest.raises(RunError):
        run_case(Case.from_text(text), tmp_path, threads=1, pictures=False)
    found = page_of(tmp_path)
    assert f"Failed: {read_manifest(tmp_path)['reason']}" in found.texts[""]


@pytest.mark.usefixtures("no_curves")
def test_a_run_that_goes_on_or_was_killed(finished: Path, tmp_path: Path) -> None:
    shutil.copytree(finished, tmp_path / "out")
    (tmp_path / "out" / "manifest.json").unlink()
    with only_run_in(tmp_path / "out"):
        found = page_of(tmp_path / "out")
    assert "Still going on: it has reached 8 ms" in found.texts[""]
    velocity = found.column("bodies", "velocity, end [m/s]")
    history = read_history(finished)
    last = history["body_left_velocity_x"][~np.isnan(history["body_left_mass"])][-1]
    assert float(velocity["left"].split(",")[0]) == pytest.approx(last, rel=1e-4)
    found = page_of(tmp_path / "out")
    assert "Unfinished" in found.texts[""] and "it was killed" in found.texts[""]
    for name in ("history.csv", "checkpoint.zip", "checkpoint_previous.zip"):
        (tmp_path / "out" / name).unlink(missing_ok=True)
    page_of(tmp_path / "out")


@pytest.mark.usefixtures("no_curves")
def test_a_manifest_of_an_earlier_version(finished: Path, tmp_path: Path) -> None:
    shutil.copytree(finished, tmp_path / "out")
    data = read_manifest(finished)
    for name in ("notes", "command", "processor", "device", "left", "walls"):
        del data[name]
    (tmp_path / "out" / "manifest.json").write_text(json.dumps(data))
    assert "Finished" in page_of(tmp_path / "out").texts[""]


def cut(path: Path) -> None:
    path.write_text(path.read_text()[: path.stat().st_size // 2].replace(",dt", ",td", 1))


DAMAGE: dict[str, tuple[str, Callable[[Path], Any], str]] = {
    "history": ("history.csv", cut, "is not a history table of mpm3dpp, or damaged"),
    "manifest": ("manifest.json", cut, "is not a manifest of mpm3dpp"),
    "other": ("manifest.json", lambda path: path.write_text("{}"), "is not a manifest of mpm3dpp"),
    "frames": ("results.vtkhdf", lambda p: p.write_bytes(b"0" * 99), "is not a results file"),
}


@pytest.mark.usefixtures("no_curves")
@pytest.mark.parametrize("name", DAMAGE)
def test_of_damaged_files_the_rest_is_told(finished: Path, tmp_path: Path, name: str) -> None:
    out = tmp_path / "out"
    shutil.copytree(finished, out)
    (out / "report.html").unlink()
    file, damage, words = DAMAGE[name]
    damage(out / file)
    with pytest.raises(CaseError, match=words) as error:
        mpm3dpp.report(out)
    assert str(error.value).endswith(f"; the rest is in '{out / 'report.html'}'")
    assert words in Page((out / "report.html").read_text()).texts["happened"]


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (["none"], "none: there is no such folder; give the --out of a run"),
        (["case.toml"], "case.toml: is not a folder; give the --out of a run"),
        (["empty"], "empty: has nothing of a run: none of manifest.json, history.csv, results"),
        (["out", "--output", "out/history.csv"], "out/history.csv must end in .html, which"),
        (
            ["out", "--output", "case.toml/report.html"],
            "cannot write 'case.toml': file exists; a file has this",
        ),
        (["out", "--output", "folder.html"], "folder.html is a folder; give the page another"),
    ],
)
def test_mistakes_are_one_sentence(
    finished: Path, tmp_path: Path, words: list[str], sentence: str
) -> None:
    write(tmp_path)
    (tmp_path / "empty").mkdir()
    (tmp_path / "folder.html").mkdir()
    (tmp_path / "out").symlink_to(finished)
    before = (finished / "history.csv").read_bytes()
    done = run_command("report", *words, cwd=tmp_path)
    assert done.returncode == 2 and sentence in one_sentence(done.stderr)
    assert (finished / "history.csv").read_bytes() == before


OLD = "<!DOCTYPE html>\nold, written by mpm3dpp"


@pytest.mark.usefixtures("no_curves")
def test_a_full_disk_leaves_the_old_page(
    finished: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page = tmp_path / "page.html"
    page.write_text(OLD)

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(CaseError, match="no space left on device; free some space"):
        mpm3dpp.report(finished, page)
    assert page.read_text() == OLD and [p.name for p in tmp_path.iterdir()] == ["page.html"]


@pytest.mark.usefixtures("no_curves")
def test_links_are_from_where_the_page_is(finished: Path, tmp_path: Path) -> None:
    found = Page(mpm3dpp.report(finished, tmp_path / "a" / "page.html").read_text())
    [link] = [link for link in found.links if not link.startswith("#")]
    assert (tmp_path / "a" / link.replace("%20", " ")).resolve() == finished / "my film.mp4"


def test_a_folder_with_a_history_of_something_else_gets_no_page(tmp_path: Path) -> None:
    (tmp_path / "history.csv").write_text("hi\n")
    with pytest.raises(CaseError, match=r"has a history\.csv that is of no run"):
        mpm3dpp.report(tmp_path)
    assert not (tmp_path / "report.html").exists()
