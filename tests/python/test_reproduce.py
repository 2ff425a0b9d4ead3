# SPDX-License-Identifier: BSD-3-Clause
"""`mpm3dpp reproduce`, with examples that are cut down to a few particles and steps."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from mpm3dpp import Case, RunError, reproduce
from mpm3dpp.base.errors import CaseError
from mpm3dpp.base.shipped import shipped
from mpm3dpp.case.changes import with_changes
from mpm3dpp.cli.app import app
from mpm3dpp.plots import space
from mpm3dpp.reproduce import examples, paper
from mpm3dpp.reproduce.examples import EXAMPLES, change_lines, fewer_spheres, load
from mpm3dpp.reproduce.page import as_html
from mpm3dpp.reproduce.runs import Done, Measured
from mpm3dpp.reproduce.tables import comparison
from mpm3dpp.reproduce.timing import TURNS

RUBBER = """
[material.rubber]
density = "1000 kg/m^3"
strength = { elastic = { E = "1 MPa", nu = 0.3 } }
"""
PENETRATION = f"""
title = "A block meets a plate"
[grid]
dimension = 3
cell_size = "1 mm"
basis = "linear"
box = {{ lower = [0, 0, 0], upper = ["8 mm", "8 mm", "8 mm"] }}
[run]
end_time = "0.1 ms"
{RUBBER}
[body.rod]
material = "rubber"
shape = {{ box = {{ lower = ["2 mm", "2 mm", "4 mm"], upper = ["4 mm", "4 mm", "8 mm"] }} }}
velocity = [0, 0, "-3 m/s"]
[body.plate]
material = "rubber"
shape = {{ box = {{ lower = [0, 0, "2 mm"], upper = ["8 mm", "8 mm", "4 mm"] }} }}
"""
SPHERES = f"""
title = "Eight spheres under a slab"
[grid]
dimension = 3
cell_size = "1 mm"
basis = "linear"
box = {{ lower = [0, 0, 0], upper = ["8 mm", "8 mm", "10 mm"], walls = "slip" }}
[run]
end_time = "0.1 ms"
[output]
interval = "0.05 ms"
{RUBBER}
[grains.spheres]
material = "rubber"
lattice = {{ lower = [0, 0, 0], count = [4, 4, 4], radius = "1 mm" }}
[body.slab]
material = "rubber"
shape = {{ box = {{ lower = [0, 0, "8 mm"], upper = ["8 mm", "8 mm", "10 mm"] }} }}
[load.press]
body = "slab"
side = "z_max"
pressure = "1 kPa"
"""
GRAINS = f"""
title = "Discs fall"
[grid]
dimension = 2
cell_size = "1 mm"
box = {{ lower = [0, 0], upper = ["8 mm", "8 mm"], walls = "slip" }}
[run]
end_time = "1 ms"
gravity = [0, "-9.81 m/s^2"]
{RUBBER}
[grains.sand]
material = "rubber"
lattice = {{ lower = [0, 0], count = [2, 2], radius = "2 mm" }}
"""
RINGS = f"""
title = "Two blocks meet"
[grid]
dimension = 2
cell_size = "1 mm"
box = {{ lower = [0, 0], upper = ["20 mm", "10 mm"] }}
[run]
end_time = "1 ms"
[contact]
detection = "DETECTION"
{RUBBER}
[body.left]
material = "rubber"
shape = {{ box = {{ lower = ["1 mm", "2 mm"], upper = ["9 mm", "8 mm"] }} }}
velocity = ["2 m/s", 0]
[body.right]
material = "rubber"
shape = {{ box = {{ lower = ["11 mm", "2 mm"], upper = ["19 mm", "8 mm"] }} }}
velocity = ["-2 m/s", 0]
"""
CASES = {
    "02_penetration/case_paper.toml": PENETRATION,
    "03_thousand_spheres/case_paper.toml": SPHERES,
    "04_shaking_grains/case_paper.toml": GRAINS,
    "01_two_rings/case_paper.toml": RINGS.replace("DETECTION", "gap"),
    "01_two_rings/case_paper_velocity.toml": RINGS.replace("DETECTION", "velocity"),
}


@pytest.fixture(scope="module")
def cases(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of small cases in place of the examples."""
    folder = tmp_path_factory.mktemp("examples")
    for name, text in CASES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    return folder


@pytest.fixture(scope="module")
def made(cases: Path, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str, dict[str, Any]]:
    """The folder, the page and the numbers of all examples."""
    out = tmp_path_factory.mktemp("out")
    with pytest.MonkeyPatch.context() as patch:  # Coarse pictures, for speed.
        patch.setattr(space, "_pyvista_works", lambda: False)
        patch.setattr(space, "PIXELS", 200)
        reproduce.reproduce(out, size="paper", steps=6, threads=1, examples=cases)
    return (
        out,
        (out / "reproduce.md").read_text(),
        json.loads((out / "reproduce.json").read_text())["examples"],
    )


def column(page: str, table: int, number: int) -> dict[str, str]:
    """Return a column of one of the page's tables, by the words of its rows."""
    part = page.split(f"### Table {table}:")[1].split("\n\n")[1]
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in part.splitlines()[2:]]
    return {row[0]: row[number] for row in rows}


def test_the_page_has_every_table_and_figure(made: tuple[Path, str, dict[str, Any]]) -> None:
    out, page, _ = made
    for number, figure in paper.FIGURES.items():
        part = page.split(f"### Figure {number}: {figure.title}")[1].split("###")[0]
        assert figure.shows in part
        pictures = re.findall(r"\]\((figure_\d+[a-d]?\.png)\)", part)
        assert len(pictures) >= (4 if number in (12, 13) else 1)
        assert all((out / name).stat().st_size > 5000 for name in pictures)
        assert all(name.startswith(f"figure_{number}") for name in pictures)
    for table in (paper.PENETRATION, paper.SPHERES):
        assert f"### Table {table.number}: {table.title}" in page
    assert "## What differs" in page
    assert all(sentence in page for sentence in paper.NOT_GIVEN)
    assert "Not run" not in page


def test_the_html_is_the_same_page(made: tuple[Path, str, dict[str, Any]]) -> None:
    out, page, _ = made
    text = (out / "reproduce.html").read_text()
    assert text == as_html(page.replace("\n<!-- written by mpm3dpp -->\n", ""))
    assert sorted(re.findall(r'src="(.*?)"', text)) == sorted(re.findall(r"\]\((.*?)\)", page))
    assert text.count("<table>") == len(re.findall(r"^\| ---", page, re.M)) == 5
    assert as_html("a < b").count("a &lt; b") == 1


@pytest.mark.parametrize(("table", "name"), [(1, "penetration"), (2, "spheres")])
def test_the_tables_have_what_was_measured(
    made: tuple[Path, str, dict[str, Any]], table: int, name: str
) -> None:
    out, page, numbers = made
    ours = column(page, table, -1)
    timed = numbers[name]["timed"]
    manifest = json.loads((out / "runs" / name / "manifest.json").read_text())
    assert ours["particles"] == f"{timed['particles']:,}" == f"{manifest['particles']:,}"
    words = {"off": "without contact", "bonded": "bonded", "on": "with contact"}
    assert list(words) == list(TURNS)
    for turn, word in words.items():
        blocks, sizes = timed["blocks"][turn], timed["bytes"][turn]
        assert len(blocks) == 5
        middle = sorted(blocks)[2]
        assert ours[f"time of a step {word} [s]"] == f"{middle:.4g}"
        assert ours[f"memory {word}, core [MiB]"] == f"{sum(sizes.values()) / 2**20:.2f}"
        per = sum(sizes.values()) / timed["particles"]
        assert ours[f"memory per particle {word}, core [bytes]"] == f"{per:.0f}"
        if turn != "on":
            assert sizes["contact"] < timed["bytes"]["on"]["contact"]
            pairs = zip(blocks, timed["blocks"]["on"], strict=True)
            ratio = sorted(on / other for other, on in pairs)[2]
            assert ours[f"time with contact / {word}"] == f"{ratio:.3f}"
    mean = 1e-9 * manifest["ns_per_particle_step"] * manifest["particles"]
    assert ours["time of a step with contact, mean of the whole run [s]"] == f"{mean:.4g}"


def test_the_tables_have_the_paper_s_numbers(made: tuple[Path, str, dict[str, Any]]) -> None:
    _, page, _ = made
    theirs, before, second = column(page, 1, 2), column(page, 1, 1), column(page, 2, 1)
    assert (theirs["particles"], theirs["cells of the box"]) == ("200,864", "170,688")
    assert theirs["time of a step without contact [s]"] == "0.4064"
    assert theirs["time of a step with contact [s]"] == "0.4313"
    assert (
        theirs["memory without contact, program [MiB]"],
        before["memory with contact, program [MiB]"],
    ) == (
        "54.25",
        "109.36",
    )
    assert before["time of a step with contact [s]"] == "0.8146"
    assert theirs["cells in use at most"] == "13.13%"
    assert before["cells in use at most"] == theirs["time of a step bonded [s]"] == "-"
    assert (second["particles"], second["cells of the box"]) == ("652,000", "137,500")
    assert second["memory with contact, program [MiB]"] == "305.19"
    assert second["time with contact / without contact"] == "1.556"  # 2.2187 / 1.4263


def test_what_the_paper_counts_stands_beside_ours(made: tuple[Path, str, dict[str, Any]]) -> None:
    """Table 1's four ratios, the 810 contact surfaces of 4.2 and the 29,760 particles of 4.4."""
    out, page, _ = made
    theirs, before, ours = (column(page, 1, k) for k in (2, 1, 3))
    printed = {("time", "without"): "1.342", ("time", "with"): "1.888",
               ("memory", "without"): "1.349", ("memory", "with"): "1.988"}  # fmt: skip
    for (what, contact), ratio in printed.items():
        row = f"{what} {contact} contact, MPM3D / MPM3Dpp"
        assert (before[row], theirs[row], ours[row]) == ("-", ratio, "-")
    row = "contact surfaces; here pairs of bodies that have touched"
    assert (column(page, 2, 1)[row], column(page, 2, 2)[row]) == ("810", "0")  # Not yet here.
    manifest = json.loads((out / "runs" / "spheres" / "manifest.json").read_text())
    manifest["contact"]["pairs"] = [{"pairs": 1700}, {"pairs": 100}]
    done = Done("", Case.from_text(SPHERES), {}, out, manifest)
    rows = comparison(paper.SPHERES, Measured(EXAMPLES["spheres"], [done]), "paper")
    assert f"| {row} | 810 | 1,800 |" in rows
    assert row not in column(page, 1, 1)
    particles = json.loads((out / "runs" / "rings_gap" / "manifest.json").read_text())["particles"]
    assert f"| particles | 29,760 | {particles:,} |" in page


def test_used_cells_are_counted(made: tuple[Path, str, dict[str, Any]]) -> None:
    """The plate fills 8 x 8 x 2 of 8^3 cells and the rod 2 x 2 x 4, two more as it moves along z.

    At the start 128 + 16 of 512 cells; a face that leaves its layer adds at most 4 + 64 cells.
    """
    _, page, numbers = made
    assert 144 / 512 <= numbers["penetration"]["cells_held_most"] <= (144 + 4 + 64) / 512
    held = numbers["penetration"]["cells_held_most"]
    assert column(page, 1, -1)["cells in use at most"] == f"{held:.2%}"
    # In z the plate lies in one tile (2 to 4 mm), the rod in another: 4 + 1 of 8 tiles at least.
    assert numbers["penetration"]["cells_of_tiles_most"] >= 5 / 8


def test_the_residual_speed_is_the_rod_s(made: tuple[Path, str, dict[str, Any]]) -> None:
    _, page, numbers = made
    speed = numbers["penetration"]["residual_speed"]
    assert 0.0 < speed < 3.0  # The plate slows it.
    assert column(page, 1, -1)["residual speed [m/s]"] == f"{speed:.0f}"


def test_the_velocity_rule_acts_too_early(made: tuple[Path, str, dict[str, Any]]) -> None:
    """Blocks 2 cells apart share nodes of the GIMP basis at once; by distance they must touch."""
    _, page, numbers = made
    gaps = numbers["rings"]["first_gap_cells"]
    assert gaps["velocity"] > 1.0
    assert gaps["gap"] < 0.1
    for rule, gap in gaps.items():
        shown = f"{round(gap, 2) + 0.0:.2f}"
        assert f"{rule} rule: at the first contact the gap is {shown} cells" in page


def test_quick_sizes_are_smaller(cases: Path) -> None:
    for example in EXAMPLES.values():
        whole, _ = load(example, next(iter(example.files)), cases, "paper")
        assert whole.output.frames == example.frames
        assert whole.output.interval is None
    quick, changes = load(EXAMPLES["penetration"], "", cases, "quick")
    assert quick.grid.cell_size == pytest.approx(2e-3)
    assert "grid.cell_size = 0.002" in change_lines(changes)
    case = Case.from_text(SPHERES, "x.toml")
    few = with_changes(case, fewer_spheres(2)(case))
    assert few.grains["spheres"].count == 8
    assert few.grid.box is not None
    assert few.grid.box.upper == pytest.approx((4e-3, 4e-3, 6e-3))
    assert few.run.end_time == pytest.approx(0.05e-3)


@pytest.mark.parametrize("name", EXAMPLES)
@pytest.mark.parametrize("size", examples.SIZES)
def test_the_examples_of_the_package_load(name: str, size: str) -> None:
    folder, example = shipped("examples"), EXAMPLES[name]
    if not all((folder / file).is_file() for file in example.files.values()):
        pytest.skip("the example is not there")
    for label in example.files:
        load(example, label, folder, size)


def test_what_is_missing_is_said_or_refused(cases: Path, tmp_path: Path) -> None:
    few = tmp_path / "few"
    shutil.copytree(cases / "04_shaking_grains", few / "04_shaking_grains")
    there, missing = examples.chosen([], few)
    assert [e.name for e in there] == ["grains"]
    assert [e.name for e in missing] == ["penetration", "spheres", "rings"]
    with pytest.raises(CaseError, match=r"03_thousand_spheres.*--only spheres but is missing"):
        examples.chosen(["spheres"], few)
    with pytest.raises(CaseError, match="has none of the examples"):
        examples.chosen([], tmp_path / "nowhere")


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"size": "huge"}, '--size = "huge" is not a size'),
        ({"only": ["ring"]}, 'did you mean "rings"'),
        ({"steps": 0}, "--steps = 0 must be >= 1"),
    ],
)
def test_mistakes(cases: Path, tmp_path: Path, arguments: dict[str, Any], says: str) -> None:
    with pytest.raises(CaseError) as caught:
        reproduce.reproduce(tmp_path, examples=cases, **arguments)
    assert says in str(caught.value)


def test_a_case_that_has_no_quick_size(cases: Path, tmp_path: Path) -> None:
    path = tmp_path / "03_thousand_spheres" / "case_paper.toml"
    path.parent.mkdir()
    path.write_text(GRAINS)
    with pytest.raises(CaseError, match="has no quick size; give --size paper"):
        load(EXAMPLES["spheres"], "", tmp_path, "quick")


def test_a_run_that_fails_is_on_the_page(cases: Path, tmp_path: Path) -> None:
    folder = tmp_path / "cases"
    shutil.copytree(cases / "04_shaking_grains", folder / "04_shaking_grains")
    file = folder / "04_shaking_grains" / "case_paper.toml"
    heavy = GRAINS.replace("[run]", "[run]\nenergy_growth_limit = 1e-12\ntime_step_factor = 1.0")
    file.write_text(heavy.replace("-9.81 m/s^2", "-1e6 m/s^2"))
    with pytest.raises(RunError) as caught:
        reproduce.reproduce(tmp_path / "out", size="paper", steps=2, examples=folder)
    assert "reproduce.md" in str(caught.value)
    page = (tmp_path / "out" / "reproduce.md").read_text()
    assert "Not as it should be" in page
    assert "failed" in page
    assert "Not run, because the case files are not there: penetration (section 4.1)" in page


def test_the_command(cases: Path, tmp_path: Path) -> None:
    arguments = ["--only", "grains", "--size", "paper", "--examples", str(cases), "--threads", "1"]
    result = CliRunner().invoke(app, ["reproduce", *arguments, "--out", str(tmp_path)])
    assert result.exit_code == 0, result.output
    assert str(tmp_path / "reproduce.md") in result.output
    assert "[1/1] section 4.3: Shakes of grains" in result.output
