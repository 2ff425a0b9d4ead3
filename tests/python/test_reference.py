# SPDX-License-Identifier: BSD-3-Clause
"""The committed reference pages are those that the code gives."""

import importlib
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture
def tool(monkeypatch):
    """tools/make_reference.py as a module."""
    monkeypatch.syspath_prepend(ROOT / "tools")
    yield importlib.import_module("make_reference")
    sys.modules.pop("make_reference", None)


@pytest.mark.parametrize("name", ["case.md", "library.md", "materials.md"])
def test_page_is_up_to_date(tool, name):
    committed = (ROOT / "docs" / "reference" / name).read_text()
    assert committed == tool.pages()[name], "run  python tools/make_reference.py"


def test_headings_are_english(tool):
    assert "\n# Equations of state: `eos`\n" in tool.materials_page()
    assert "\n# Failure models: `failure`\n" in tool.materials_page()


def test_no_other_pages(tool):
    assert {page.name for page in (ROOT / "docs" / "reference").iterdir()} == set(tool.pages())


def test_every_table_of_a_case_is_described(tool):
    from mpm3dpp.model import CaseModel

    described = {model for _, model, _ in tool.TABLES}
    for module in (tool.case, tool.case_parts):
        for value in vars(module).values():
            own = isinstance(value, type) and issubclass(value, CaseModel)
            if own and value.__module__ == module.__name__ and value.__name__ != "Case":
                assert value in described


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
