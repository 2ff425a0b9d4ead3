# SPDX-License-Identifier: BSD-3-Clause
"""Every example runs the default numerics, or its page names the key that it sets and says why."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from mpm3dpp.case.file import parse, read_text

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
CASES = sorted(
    path for path in EXAMPLES.glob("*/case*.toml") if not path.stem.startswith("case_paper")
)
NUMERICS = {
    "grid": {"basis"},
    "run": {"scheme", "cfl", "transfer", "viscosity"},
    "contact": {"detection", "response", "normal", "normal_refresh_distance"},
    "material": {"volume_averaging"},
    "body": {"fill", "particles_per_cell"},
    "grains": {"fill", "align", "particles_per_cell"},
}
"""Keys that choose how a case is computed, not what it is, by their table."""
OF_ENTRIES = ("material", "body", "grains")


def chosen(case: dict[str, Any]) -> Iterator[str]:
    """Yield the keys of a case's file that choose its numerics."""
    if "preset" in case:
        yield "preset"
    for name, keys in NUMERICS.items():
        table = case.get(name, {})
        for entry in table.values() if name in OF_ENTRIES else [table]:
            yield from sorted(keys & entry.keys())


@pytest.mark.parametrize("path", CASES, ids=lambda path: f"{path.parent.name}/{path.stem}")
def test_what_is_not_the_default_is_explained(path: Path) -> None:
    """The key stands in the page as code: `fill` or `fill = "lattice"`, maybe after its table."""
    page = (path.parent / "README.md").read_text()
    for key in chosen(parse(read_text(path), str(path))):
        assert any(f"`{before}{key}" in page for before in ("", "run.", "grid.", "contact.")), key


def test_no_example_but_a_twin_has_the_paper_s_choices() -> None:
    presets = [path for path in EXAMPLES.glob("*/*.toml") if "preset" in path.read_text()]
    assert presets and all(path.stem.startswith("case_paper") for path in presets)


def test_the_keys_are_those_of_a_case() -> None:
    """So that one which gets another name does not drop out of the check without a word."""
    keys = (EXAMPLES.parent / "docs" / "reference" / "case.md").read_text()
    assert all(f"`{key}`" in keys for row in NUMERICS.values() for key in row)
