# SPDX-License-Identifier: BSD-3-Clause
"""The page of the verification: its summary first, then a table for each problem."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

from .numerics import MATERIAL, UPDATED
from .runs import RUNS

ABOUT = Path(__file__).parent / "about.md"
HEAD = "| problem | resolution | figure | ours | answer | tolerance | |\n" + "| --- " * 7 + "|\n"
# What each problem is about, in the order of the summary.
SUBJECTS = {
    "E1": "vibration of a bar",
    "E2": "wave between two bars",
    "E2b": "bars of two lengths",
    "rod": "two rods, head-on",
    "E3": "flight, fall and spin",
    "E4": "stress in simple shear",
    "E11": "column under its weight",
    "E5": "two discs collide",
    "E6": "two rings collide",
    "E7": "moment of first touch",
    "E9b": "several bodies at once",
    "E10": "spheres, off-centre",
    "C1": "Hertz's contact",
    "C2": "five spheres in a row",
    "E8": "friction: sliding, sticking",
    "oblique": "oblique impact, friction",
    "E9": "rolling on an incline",
    "C5": "disc on turning discs",
    "C6": "wave in a column of discs",
    "C3": "Janssen's silo",
    "C7": "run-out of 240 discs",
    "H1": "hopper, Beverloo's law",
    "C4": "soil on a slope",
    "G1": "sand column, experiment",
    "W1": "dam break, experiment",
    "S1": "shock, copper on copper",
    "S2": "shock, aluminium on copper",
    "S3": "gases, Sod's tube",
    "S4": "detonation of TNT",
    "S5": "spall",
    "Taylor": "Taylor bar, experiment",
}
Rows = list[tuple[str, list[str]]]
Counts = Counter[tuple[str, str, str, str, bool]]  # problem, basis, scheme, dimension, passed


def page(rows: Rows) -> str:
    """Return the whole page of rows (problem, lines): summary, what is to be known, tables."""
    head, _, about = ABOUT.read_text().partition("\n\n")
    text = [head, "\n\n", summary(rows), "\n## How to read it\n", about]
    for problem in sorted({name for name, _ in rows}, key=_order):
        text.append(f"\n## {problem}\n\n{HEAD}")
        text += [line for name, lines in rows if name == problem for line in lines]
    return "".join(text)


def rows_of(text: str) -> Rows:
    """Return the rows of a page that was written before."""
    sections = re.split(r"^## (.*)\n", text, flags=re.M)[1:]
    found = dict(zip(sections[::2], sections[1::2], strict=True))
    known = {run.problem for run in RUNS}
    tables = {name: found[name].partition(HEAD)[2] for name in found if name in known}
    return [(name, (table.rstrip() + "\n").splitlines(True)) for name, table in tables.items()]


def updated(rows: Rows, again: Rows) -> Rows:
    """Return rows in which those of runs that were made again have taken the place of the old."""
    found = {name: list(lines) for name, lines in rows}
    for name, lines in again:
        table = found.setdefault(name, [])
        kind = _run_of(lines[0])
        at = next((k for k, line in enumerate(table) if _run_of(line) == kind), len(table))
        found[name] = [line for line in table if _run_of(line) != kind]
        found[name][at:at] = lines
    return list(found.items())


def _run_of(line: str) -> list[str]:
    return line.split(" | ", 2)[:2]


def summary(rows: Rows) -> str:
    """Return how many figures pass: a row for each problem, a column for each basis and scheme."""
    counts = _counts(rows)
    kinds = {(basis, scheme) for _, basis, scheme, _, _ in counts}
    first = {MATERIAL: 0, UPDATED: 1, f"{UPDATED}~impulses": 2, "-": 4}
    columns = sorted(kinds, key=lambda kind: (first.get(kind[0], 3), kind))
    names = [f"{basis}, {scheme}" if basis != "-" else "no grid" for basis, scheme in columns]
    silent = Counter({key: n for key, n in counts.items() if _is_default(key, counts)})
    right, of = (sum(n for key, n in silent.items() if key[4] or every) for every in (0, 1))
    passed, judged = (sum(n for key, n in counts.items() if key[4] or every) for every in (0, 1))
    text = (
        f"{passed} of {judged} figures with a tolerance are within it, {right} of {of} of what a "
        "case gets that says nothing: those of the material frame, and of problems that have none "
        "there, those of the updated one. The numbers are those, by basis and scheme, in 2D and in "
        "3D; an empty cell was not run.\n\n"
        f"| what is verified | {' | '.join(names)} |\n{'| --- ' * (len(names) + 1)}|\n"
    )
    for problem in [p for p in SUBJECTS if p in {name for name, _ in rows}]:
        cells = [_cell(counts, column, problem) for column in columns]
        link = f"[{problem}](#{problem.lower()})"
        text += f"| {link} {SUBJECTS[problem]} | {' | '.join(cells)} |\n"
    cells = [_cell(counts, column) for column in columns]
    return text + f"| all | {' | '.join(cells)} |\n"


def _counts(rows: Rows) -> Counts:
    """Count the figures with a tolerance by problem, basis, scheme, dimension and verdict."""
    counts: Counts = Counter()
    for problem, lines in rows:
        for line in lines:
            said = re.match(r"\| \S+ \S+ (\S+) (\dD) (\S+) \|.*\| (pass|\*\*FAIL\*\*) \|", line)
            if said:
                scheme, dimension, basis, verdict = said.groups()
                counts[problem, basis, scheme, dimension, verdict == "pass"] += 1
    return counts


def _is_default(key: tuple[str, str, str, str, bool], counts: Counts) -> bool:
    """Return whether a case gets these numerics that says nothing, of this problem."""
    problem, basis = key[:2]
    solid = any(name == problem and other == MATERIAL for name, other, *_ in counts)
    return basis == (MATERIAL if solid else UPDATED)


def _cell(counts: Counts, kind: tuple[str, str], problem: str = "") -> str:
    """Return what passed of what was judged, in each dimension."""
    parts = []
    for dimension in ("2D", "3D"):
        own = Counter[bool]()
        for (name, basis, scheme, d, good), number in counts.items():
            if (basis, scheme, d) == (*kind, dimension) and problem in ("", name):
                own[good] += number
        if own.total():
            parts.append(f"{dimension} {own[True]}/{own.total()}")
    return ", ".join(parts)


def _order(problem: str) -> tuple[int, str]:
    digits = "".join(c for c in problem if c.isdigit())
    return (int(digits) if digits else 99, problem)
