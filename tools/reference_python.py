# SPDX-License-Identifier: BSD-3-Clause
"""The page docs/reference/python.md, from the docstrings of what users call from Python."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from itertools import takewhile
from typing import Any

import mpm3dpp
from mpm3dpp.base.model import CaseModel
from mpm3dpp.importers import import_file
from mpm3dpp.io import Results, read_history, read_manifest
from mpm3dpp.plots import plot_results
from mpm3dpp.reproduce import reproduce
from mpm3dpp.run.record import Recorded

# Heading, then what stands under it: functions and classes, a class with the names of its methods.
PARTS: tuple[tuple[str, tuple[tuple[str, Any, tuple[str, ...]], ...]], ...] = (
    (
        "Run a case",
        (
            ("mpm3dpp.load_case", mpm3dpp.load_case, ()),
            ("mpm3dpp.run_case", mpm3dpp.run_case, ()),
            (
                "mpm3dpp.Case",
                mpm3dpp.Case,
                ("from_file", "from_text", "with_", "frame_times", "table", "json_schema"),
            ),
        ),
    ),
    (
        "Step it yourself",
        (
            ("mpm3dpp.Simulation", mpm3dpp.Simulation, ("*",)),
            ("mpm3dpp.record", mpm3dpp.record, ()),
            ("mpm3dpp.run.record.Recorded", Recorded, ("*",)),
        ),
    ),
    (
        "Read results",
        (
            ("mpm3dpp.open_results", mpm3dpp.open_results, ()),
            ("mpm3dpp.io.Results", Results, ("*",)),
            ("mpm3dpp.io.read_history", read_history, ()),
            ("mpm3dpp.io.read_manifest", read_manifest, ()),
            ("mpm3dpp.plots.plot_results", plot_results, ()),
        ),
    ),
    (
        "Data in place of files",
        (
            ("mpm3dpp.Particles", mpm3dpp.Particles, ()),
            ("mpm3dpp.GrainCentres", mpm3dpp.GrainCentres, ()),
            ("mpm3dpp.TimeFunction", mpm3dpp.TimeFunction, ()),
        ),
    ),
    (
        "Other programs, and the paper",
        (
            ("mpm3dpp.importers.import_file", import_file, ()),
            ("mpm3dpp.reproduce.reproduce", reproduce, ()),
        ),
    ),
    (
        "Errors",
        (
            ("mpm3dpp.CaseError", mpm3dpp.CaseError, ()),
            ("mpm3dpp.RunError", mpm3dpp.RunError, ()),
        ),
    ),
)
SECTIONS = ("Args", "Attributes", "Returns", "Raises", "Yields")
ENTRY = re.compile(r"^    (\*{0,2}\w[\w.]*(?:, \w+)*): (.*(?:\n {8}.*)*)", re.M)


def python_page(note: str, tables: dict[str, type]) -> str:
    """Return the page; `tables` are the case file's, by the headings of their reference."""
    lines = [
        "# Python",
        f"*{note}*",
        "",
        "The functions and classes of a program that makes a case, runs it and reads its results.",
        "Arrays are NumPy's, in SI units. The command line does no more than these.",
    ]
    for heading, entries in PARTS:
        lines += ["", f"## {heading}"]
        for name, thing, methods in entries:
            lines += ["", f"### {name}", *described(name.rpartition(".")[2], thing)]
            for method, member in members(thing, methods):
                lines += ["", f"#### {method}", *described(method, member)]
    return "\n".join([*lines, *case_classes(tables)]) + "\n"


def members(thing: Any, wanted: tuple[str, ...]) -> Iterator[tuple[str, Any]]:
    """Yield the public methods and properties of a class that are wanted; "*" for its own all."""
    for name in dir(thing) if wanted == ("*",) else wanted:
        member = inspect.getattr_static(thing, name)
        kinds = (property, classmethod, staticmethod)
        if not name.startswith("_") and (inspect.isfunction(member) or isinstance(member, kinds)):
            yield name, member


def described(name: str, thing: Any) -> list[str]:
    """Return the signature and the docstring of something as Markdown."""
    if isinstance(thing, (classmethod, staticmethod)):
        thing = thing.__func__
    lines = markdown(inspect.getdoc(thing) or "")
    if isinstance(thing, property) or (inspect.isclass(thing) and issubclass(thing, BaseException)):
        return lines
    if inspect.isclass(thing) and (issubclass(thing, CaseModel) or thing in (Results, Recorded)):
        return lines  # Made from a file, or by a function.
    return [*signature(name, thing), "", *lines]


def signature(name: str, thing: Callable[..., Any]) -> list[str]:
    """Return the call with its defaults."""
    parts = []
    for parameter in inspect.signature(thing).parameters.values():
        if parameter.name in ("self", "cls"):
            continue
        text = parameter.name
        if parameter.default is not inspect.Parameter.empty:
            text += f"={parameter.default!r}"
        parts.append(text)
    return ["```text", f"{name}({', '.join(parts)})", "```"]


def markdown(text: str) -> list[str]:
    """Return a docstring in Google's style as Markdown: lists of its entries, examples fenced."""
    lines: list[str] = []
    for block in re.split(r"\n\n+", text):
        head, _, rest = block.partition("\n")
        title = head.removesuffix(":")
        if head.endswith(":") and title in SECTIONS:
            lines += ["", f"*{title}*", "", *entries(rest)]
        elif block.startswith(">>>"):
            code = [line[4:] for line in block.splitlines()]
            lines += ["", "```text", *(f">>> {line}" for line in code), "```"]
        else:
            lines += ["", *block.splitlines()]
    return lines[1:]


def entries(text: str) -> list[str]:
    """Return the entries of a section as a list, or its text where it has none."""
    found = ENTRY.findall(text)
    if not found:
        return [" ".join(text.split())]
    before = list(takewhile(lambda line: not ENTRY.match(line), text.splitlines()))
    said = [" ".join(" ".join(before).split())] if before else []
    return said + [f"- `{names}`: {' '.join(meaning.split())}" for names, meaning in found]


def case_classes(tables: dict[str, type]) -> list[str]:
    """Return a table of the classes that are tables of a case file."""
    lines = [
        "",
        "## Tables of a case",
        "They take the keys of the case file as arguments, plain numbers in SI units. Shapes are",
        "in `mpm3dpp.shapes`: `shapes.Box(lower=[0, 0], upper=[0.1, 0.1])`.",
        "",
        "| class | table of the case file |",
        "| --- | --- |",
    ]
    for heading, model in tables.items():
        if getattr(mpm3dpp, model.__name__, None) is model:
            anchor = heading.lower().replace(".", "")
            lines.append(f"| `mpm3dpp.{model.__name__}` | [{heading}](case.md#{anchor}) |")
    return lines
