# SPDX-License-Identifier: BSD-3-Clause
"""The committed reference pages are those that the code gives."""

import importlib
import re
import sys
from itertools import combinations, product
from pathlib import Path

import pytest

from cases import three_blocks
from mpm3dpp import run_case
from mpm3dpp.io import read_history

ROOT = Path(__file__).parents[2]
PARTS = ("gallery", "markdown_tables", "material_pages", "reference_python")


@pytest.fixture
def tool(monkeypatch):
    """tools/make_reference.py as a module."""
    monkeypatch.syspath_prepend(ROOT / "tools")
    yield importlib.import_module("make_reference")
    for name in ("make_reference", *PARTS):
        sys.modules.pop(name, None)


PAGES = ["case.md", "history.md", "library.md", "materials.md", "python.md"]


@pytest.mark.parametrize("name", ["gallery.md", *(f"reference/{name}" for name in PAGES)])
def test_page_is_up_to_date(tool, name):
    committed = (ROOT / "docs" / name).read_text()
    assert committed == tool.pages()[name], "run  python tools/make_reference.py"


def test_headings_are_english(tool):
    assert "\n## Equations of state: `eos`\n" in tool.materials_page(tool.NOTE)
    assert "\n## Failure models: `failure`\n" in tool.materials_page(tool.NOTE)


def test_no_other_pages(tool):
    docs = ROOT / "docs"
    found = {page.relative_to(docs).as_posix() for page in (docs / "reference").iterdir()}
    assert found == set(tool.pages()) - {"gallery.md"}


def test_every_table_of_a_case_is_described(tool):
    from mpm3dpp.base.model import CaseModel

    described = {model for _, model, _ in tool.TABLES}
    for module in (tool.case, tool.parts):
        for value in vars(module).values():
            own = isinstance(value, type) and issubclass(value, CaseModel)
            if own and value.__module__ == module.__name__ and value.__name__ != "Case":
                assert value in described


@pytest.mark.parametrize("dimension", [2, 3])
def test_every_column_of_the_history_is_described(tool, tmp_path, dimension):
    case = three_blocks(dimension, run={"end_time": 1e-4})
    run_case(case, tmp_path, threads=1, pictures=False)
    written = list(read_history(tmp_path))
    for a, b in combinations(case.body, 2):
        for name, (unit, _) in tool.terms.PAIR_MEANINGS.items():
            assert unit and name.endswith("_A_B_x")
            for axis in "xyz":
                written.remove(name.replace("_A_B_x", f"_{a}_{b}_{axis}"))
    for name, column in product(case.body, tool.part_cells.PART_COLUMNS):
        written.remove(f"body_{name}_{column}")
    written += [f"body_A_{column}" for column in tool.part_cells.PART_COLUMNS]
    written += [f"wall_x_min_{column}" for column in tool.part_cells.WALL_COLUMNS]
    page = (ROOT / "docs" / "reference" / "history.md").read_text()
    described = re.findall(r"^\| `(\w+)` \| \S.* \| \S.* \|$", page, re.M)
    assert described == [*written, *tool.terms.PAIR_MEANINGS]


def test_attributes_of_a_docstring(tool):
    class Example:
        """Two lines
        about it.

        Attributes:
            first, second: what they
                are [m].
            third: another: with a colon.
        """

    about, found = tool.docstring(Example)
    assert about == "Two lines about it."
    assert found["first"] == found["second"] == "what they are [m]."
    assert found["third"] == "another: with a colon."
