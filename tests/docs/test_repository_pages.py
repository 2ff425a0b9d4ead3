# SPDX-License-Identifier: BSD-3-Clause
"""Links of the documentation site to pages outside docs/, and back."""

import importlib
import sys
from types import ModuleType

import pytest

from doc_pages import DOCS, ROOT


@pytest.fixture
def links(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """docs/_ext/repository_pages.py as a module."""
    monkeypatch.syspath_prepend(DOCS / "_ext")
    sys.modules.pop("repository_pages", None)
    return importlib.import_module("repository_pages")


@pytest.mark.parametrize(
    ("home", "folder", "link", "wanted"),
    [
        ("docs/how-to", "docs/how-to", "../../CONTRIBUTING.md", "../_repository/CONTRIBUTING.md"),
        ("docs", "docs", "../examples/12_spall", "_repository/examples/12_spall/README.md"),
        ("docs", "docs", "../examples/12_spall/case.toml", "../examples/12_spall/case.toml"),
        ("docs", "docs", "theory/step.md#one-step", "theory/step.md#one-step"),
        (".", "docs/_repository", "docs/decisions", "../decisions/index.md"),
        (".", "docs/_repository", "CHANGELOG.md", "CHANGELOG.md"),
        ("examples/12_spall", "docs/_repository/examples/12_spall", "../../docs/images/spall.png",
         "../../../images/spall.png"),
        ("docs", "docs", "https://example.org/a", "https://example.org/a"),
        ("docs", "docs", "missing.md", "missing.md"),
    ],
)  # fmt: skip
def test_links(links: ModuleType, home: str, folder: str, link: str, wanted: str) -> None:
    text = f"[a]({link}), `b`\n```\n[c](../CONTRIBUTING.md)\n```\n"
    found = links.relinked(text, ROOT / home, ROOT / folder)
    assert found == text.replace(f"[a]({link})", f"[a]({wanted})")


def test_every_link_of_a_page_leads_somewhere(links: ModuleType) -> None:
    """On GitHub too, where the files are read as they are."""
    pages = [page for page in DOCS.rglob("*.md") if "_repository" not in page.parts]
    for page in [*pages, *links.sources()]:
        for part in links.FENCE.split(page.read_text())[::2]:
            for link in links.LINK.finditer(part):
                target = page.parent / link[2]
                assert target.exists(), f"{page.relative_to(ROOT)}: {link[2]}"
