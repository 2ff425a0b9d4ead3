# SPDX-License-Identifier: BSD-3-Clause
"""The blocks of code in the pages for users do what the pages say.

Cases are checked, parts of cases have keys that there are, commands are parsed, and Python is run
with results of short runs. The slow tests make pages from their first block to their last.
"""

from __future__ import annotations

import contextlib
import functools
import io
import re
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import mpm3dpp
from command_server import run
from commands import CASE
from doc_pages import SHELL, Block, blocks, commands, every, pages, unknown_keys
from mpm3dpp import Case, run_case
from mpm3dpp.fill.build import build
from mpm3dpp.run.summary import echo

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

PROBE = '[probe.gauge]\npoint = ["60 mm", "20 mm"]\nevery = "20 us"\n'
TWO_BLOCKS = CASE + PROBE
BY_INTERVAL = TWO_BLOCKS.replace("frames = 4", 'interval = "0.1 ms"')
OF_PAGE = {"docs/how-to/stop-and-go-on.md": BY_INTERVAL}
"""For pages with keys of a case alone: one that has such keys, where it matters."""
# What stands before the Python of a page: its own case with shorter times, or another one, and the
# folder of its results if it opens any.
PREPARED: dict[str, tuple[tuple[str, ...] | str, str]] = {
    "README.md": ("", ""),
    "docs/tutorial.md": (('"0.1 s"', '"0.5 ms"'), "block"),
    "docs/how-to/begin-under-weight.md": (('"0.2 s"', '"20 ms"'), "layer"),
    "docs/how-to/bring-mpm3d-files.md": ("", ""),
    "docs/how-to/draw-pictures.md": (TWO_BLOCKS, "out"),
    "docs/how-to/many-grains.md": (('"4 ms"', '"1 ms"'), "out"),
    "docs/how-to/open-results-in-paraview.md": (TWO_BLOCKS, "results/01_two_rings"),
    "docs/how-to/run-a-case.md": (('"2 ms"', '"20 us"'), ""),
    "docs/how-to/run-on-several-ranks.md": (TWO_BLOCKS, ""),
    "docs/how-to/sweep-a-case.md": (('"60 ms"', '"0.2 ms"'), ""),
    "docs/how-to/take-numbers-out.md": (TWO_BLOCKS, "out"),
    "docs/how-to/turn-a-drum.md": (('"0.8 s"', '"0.5 ms"', '"50 ms"', '"0.1 ms"'), "drum"),
    "docs/how-to/use-probes.md": (('"0.16 ms"', '"2 us"'), "results/bar"),
    "docs/coming-from/mpm3d.md": (('"80 us"', '"0.5 us"'), "mine"),
}
SHORTER = {
    "README.md": ('end_time="3.5 ms"', 'end_time="0.02 ms"'),
    "docs/how-to/many-grains.md": ("advance(1000)", "advance(20)"),
}
# Those that the slow test makes as they stand, on a case of ours if they have none.
WHOLE = (
    "docs/quick-start.md",
    "docs/tutorial.md",
    "docs/how-to/choose-frame.md",
    "docs/how-to/shoot-through-a-plate.md",
    "docs/how-to/begin-under-weight.md",
    "docs/how-to/stop-and-go-on.md",
    "docs/how-to/sweep-a-case.md",
    "docs/how-to/take-numbers-out.md",
    "docs/coming-from/mpm3d.md",
)


def test_blocks_that_are_not_run() -> None:
    """Each has a reason in the page; another one is a decision, and changes this table."""
    assert Counter(block.page for block in every(*SHELL, "toml", "python", run=False)) == {
        "README.md": 2,
        "docs/quick-start.md": 1,
        "docs/how-to/reproduce-the-paper.md": 1,
        "docs/how-to/run-on-a-gpu.md": 2,
        "docs/how-to/measure-speed.md": 1,
        "docs/how-to/run-on-several-ranks.md": 2,
    }


@pytest.mark.parametrize("block", every("toml"), ids=str)
def test_toml(block: Block) -> None:
    if block.is_case:
        case = Case.from_text(block.text)
        assert echo(case, build(case))
    else:
        assert unknown_keys(Case.json_schema(), tomllib.loads(block.text)) == []


def test_unknown_keys_are_found() -> None:
    text = """\
        shapes = 1
        run = { stop = { speed = 1 }, endtime = 2 }
        body.ball = { shape = { disc = { radius = 1 } }, fil = "lattice" }
        contact.pair = [{ friction = 0, name = "a" }]
    """
    wrong = unknown_keys(Case.json_schema(), tomllib.loads(text))
    assert wrong == [
        "shapes",
        "run.stop.speed",
        "run.endtime",
        "body.ball.fil",
        "contact.pair.name",
    ]


@pytest.mark.parametrize("block", every(*SHELL), ids=str)
def test_commands_have_their_options(block: Block) -> None:
    for words in commands(block.text):
        if words[0] == "mpiexec":
            words = words[words.index("mpm3dpp") :]
        assert words[0] == "mpm3dpp", f"not run: {words}"
        parsed(words[1:])


def test_options_are_parsed() -> None:
    with pytest.raises(Exception, match="No such option: --thread"):
        parsed(["run", "case.toml", "--thread", "2"])


def parsed(words: list[str]) -> None:
    """Parse a command of mpm3dpp; raises what its options are refused with."""
    import typer.main

    from mpm3dpp.cli.app import app

    group: Any = typer.main.get_command(app)
    group.commands[words[0]].make_context(words[0], words[1:])


@pytest.mark.parametrize("page", sorted({block.page for block in every("python")}))
def test_python(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    plain = functools.partial(run_case, pictures=False)  # They take seconds.
    monkeypatch.setattr(mpm3dpp, "run_case", plain, raising=False)
    prepare(page)
    names: dict[str, Any] = {"velocities": np.zeros((256, 3))}  # Of how-to/bring-mpm3d-files.md.
    if page.endswith("paraview.md"):
        pyvista = pytest.importorskip("pyvista")
        monkeypatch.setattr(pyvista.PolyData, "plot", lambda *_, **__: None)  # Opens a window.
    for block in blocks(page):
        if block.language == "python" and not block.reason:
            execute(block, names)


def prepare(page: str) -> None:
    """Write the case of a page, shortened, and run it if the page opens its results."""
    change, folder = PREPARED[page]
    if isinstance(change, str):
        text = change
    else:
        text = [block.text for block in blocks(page) if block.is_case][-1]
        for old, new in zip(change[::2], change[1::2], strict=True):
            assert old in text
            text = text.replace(old, new)
    Path("case.toml").write_text(text)
    if folder:
        run_case("case.toml", folder, threads=1, pictures=False)
    for block in blocks(page):
        if block.text.startswith("mpm3d ***"):
            Path("ring.mpm").write_text(block.text)


def execute(block: Block, names: dict[str, Any]) -> str:
    """Run Python with the line numbers of its page; return what it prints."""
    text = block.text.replace(*SHORTER.get(block.page, ("", "")))
    code = compile("\n" * (block.line - 1) + text, block.page, "exec")
    with contextlib.redirect_stdout(io.StringIO()) as said:
        exec(code, names)
    return said.getvalue()


@pytest.mark.slow
@pytest.mark.parametrize("page", WHOLE)
def test_whole_page(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Every block in turn; what Python prints is what stands below it, numbers to 2 %."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    names: dict[str, Any] = {}
    said: list[str] = []
    cases = [block.text for block in blocks(page) if block.is_case]
    Path("case.toml").write_text([*cases, OF_PAGE.get(page, TWO_BLOCKS)][0])
    for block in blocks(page):
        if block.reason:
            continue
        if block.is_case:
            Path("case.toml").write_text(block.text)
        elif block.text.startswith("mpm3d ***"):
            Path("bar.mpm").write_text(block.text)
        elif block.language in SHELL:
            said = []
            for words in commands(block.text):
                done = run(words[1:], tmp_path, timeout=300)
                assert done.returncode == 0, f"{block}: {done.stderr}"
                said += done.stdout.splitlines()
        elif block.language == "python":
            said = execute(block, names).splitlines()
        elif block.language == "text":
            for line in block.text.splitlines():
                assert any(alike(line, other) for other in said), f"{block}: {line}\n{said}"


def alike(page: str, said: str) -> bool:
    """Whether a line of a page is one that was printed: cut off at `...`, and numbers to 2 %.

    Times of the clock and energies that rounding makes are cut off in the pages.
    """
    start, cut, _ = page.rpartition("...") if page.endswith("...") else (page, "", "")
    number = re.compile(r"(?<![\w.])-?\d[\d,]*(?:\.\d+)?(?:e[-+]\d+)?")
    theirs, ours = number.sub("#", said), number.sub("#", start)
    if not (theirs.startswith(ours.rstrip()) if cut else theirs == ours):
        return False
    pairs = zip(number.findall(start), number.findall(said), strict=False)
    values = [[float(text.replace(",", "")) for text in pair] for pair in pairs]
    return all(a == pytest.approx(b, rel=0.02) for a, b in values)


def test_lines_that_are_alike() -> None:
    assert alike("ball: 1,000 -> 2.5 m/s, ...", "ball: 1,010 -> 2.49 m/s, 3 left")
    assert not alike("ball: 1,000 m/s", "ball: 1,000 m/s, 3 left")
    assert not alike("ball: 1,000 m/s", "ball: 1,100 m/s")
    assert alike("...", "anything")


def test_pages_are_there() -> None:
    assert set(WHOLE) | set(PREPARED) <= set(pages())
