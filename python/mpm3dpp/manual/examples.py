# SPDX-License-Identifier: BSD-3-Clause
"""The examples: a list of them, their files, and copies to change."""

from __future__ import annotations

import shutil
from pathlib import Path

from mpm3dpp.base.errors import CaseError, nearest
from mpm3dpp.base.shipped import shipped
from mpm3dpp.case.case import load_case

CASE = "case.toml"


def names() -> list[str]:
    """Return the names of all examples."""
    return sorted(path.parent.name for path in shipped("examples").glob(f"*/{CASE}"))


def listing() -> str:
    """Return a line per example: name, title, and its other cases."""
    lines, width = [], max(map(len, names()))
    for name in names():
        folder = shipped("examples") / name
        others = sorted(path.name for path in folder.glob("*.toml") if path.name != CASE)
        also = f" (also {', '.join(others)})" if others else ""
        lines.append(f"{name:{width}}  {load_case(folder / CASE).title}{also}")
    return "\n".join(lines)


def folder_of(name: str) -> Path:
    """Return the folder of an example.

    Args:
        name: of the example, its number or its words alone: "05_hopper", "05" or "hopper".

    Raises:
        CaseError: there is no such example.
    """
    found = [each for each in names() if name in (each, *each.split("_", 1))]
    if not found:
        words = [each.split("_", 1)[1] for each in names()]
        rule = "is no example"
        raise CaseError(rule, nearest(name, words), key="NAME", value=name)
    return shipped("examples") / found[0]


def copy(name: str, target: Path | None = None) -> Path:
    """Copy the case files of an example.

    Args:
        name: see `folder_of`.          target: new folder; default the example's name, here.

    Raises:
        CaseError: there is no such example, or the folder is there.
    """
    source = folder_of(name)
    target = target if target is not None else Path(source.name)
    if target.exists():
        raise CaseError("there is one already", "give another folder", place=str(target))
    files = [path for path in sorted(source.iterdir()) if path.suffix in (".toml", ".csv")]
    target.mkdir(parents=True)
    for path in files:
        shutil.copyfile(path, target / path.name)
    return target
