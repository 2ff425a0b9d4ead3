# SPDX-License-Identifier: BSD-3-Clause
"""The page and the picture of the table: which basis, transfer, scheme and step to choose."""

from __future__ import annotations

import csv
import math
from collections.abc import Collection, Iterator
from pathlib import Path

import matplotlib

from .benchmark_rows import MORE
from .problems import PROBLEMS

OWN = "its own"
"""The factor of a pair that has one, such as "auto"."""
Rows = dict[tuple[str, ...], dict[str, str]]
LEAST, MOST = 1e-3, 1.0  # errors below and above count as these in a mean
MARKERS = {"musl": "o", "usf": "s", "usl": "^"}


def read(file: Path) -> Rows:
    """Rows of the file by problem, pair, scheme and factor."""
    with file.open(newline="") as text:
        return {
            (r["problem"], r["pair"], r["scheme"], r["factor"]): r for r in csv.DictReader(text)
        }


def error(row: dict[str, str]) -> float:
    """Size of the error; what has stopped is as wrong as can be."""
    found = abs(float(row["error"]))
    return MOST if row["stopped"] or math.isnan(found) else min(max(found, LEAST), MOST)


def means(
    rows: Rows, problems: Collection[str] = PROBLEMS
) -> dict[tuple[str, ...], tuple[float, float, int]]:
    """By pair, scheme and factor: geometric mean of the errors, seconds, how many stopped."""
    found: dict[tuple[str, ...], list[dict[str, str]]] = {}
    for key, row in rows.items():
        if key[0] in problems:
            found.setdefault(key[1:], []).append(row)
    return {
        key: (
            math.exp(sum(math.log(error(r)) for r in some) / len(some)),
            sum(float(r["seconds"]) for r in some),
            sum(bool(r["stopped"]) for r in some),
        )
        for key, some in found.items()
        if len(some) == len(problems)
    }


def page(rows: Rows, factor: str = "0.5") -> str:
    """Return the tables: errors of each problem at one factor, and means over all problems."""
    names = list(PROBLEMS)
    text = [f"| `cfl` {factor} | {' | '.join(names)} |\n", "| --- " * (len(names) + 1) + "|\n"]
    for pair, scheme in dict.fromkeys(key[1:3] for key in rows if key[3] == factor):
        cells = []
        for name in names:
            row = rows.get((name, pair, scheme, factor))
            stops = row is None or row["stopped"]
            cells.append("stops" if stops else f"{float(row['error']):.2g}")  # type: ignore[index]
        text.append(f"| {pair}, {scheme} | {' | '.join(cells)} |\n")
    text.append(
        "\n| pair, scheme, `cfl` | mean error | seconds | stopped |\n| --- | --- | --- | --- |\n"
    )
    for key, (mean, seconds, stopped) in sorted(means(rows).items(), key=lambda item: item[1]):
        text.append(f"| {', '.join(key)} | {mean:.4f} | {seconds:.1f} | {stopped} |\n")
    return "".join([*text, *_frames(rows)])


def _frames(rows: Rows) -> Iterator[str]:
    """Yield the table of the frames: what a case gets that says nothing, beside nodes in space."""
    every = PROBLEMS | MORE
    pairs = [key for key in means(rows, every) if key[2] == OWN]
    yield f"\n| problem | {' | '.join(pair for pair, *_ in pairs)} |\n"
    yield "| --- " * (len(pairs) + 1) + "|\n"
    for name in every:
        errors = (float(rows[(name, *pair)]["error"]) for pair in pairs)
        yield f"| {name} | {' | '.join(f'{one:.2g}' for one in errors)} |\n"
    for what, some in (("thirteen", PROBLEMS), ("all", every)):
        of_some = means(rows, some)
        yield f"| mean of {what} | {' | '.join(f'{of_some[p][0]:.4f}' for p in pairs)} |\n"
        yield f"| seconds of {what} | {' | '.join(f'{of_some[p][1]:.0f}' for p in pairs)} |\n"


def picture(rows: Rows, file: Path) -> None:
    """Draw mean error over seconds, a line from the smallest factor to the largest."""
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    found, figure = (
        {k: v for k, v in means(rows).items() if k[2] != OWN},
        plt.figure(figsize=(9, 4.5), layout="constrained"),
    )
    axes = figure.subplots()
    pairs = list(dict.fromkeys(key[0] for key in found))
    for pair, scheme in dict.fromkeys(key[:2] for key in found):
        of_pair = [found[key] for key in sorted(found) if key[:2] == (pair, scheme)]
        points = [p for p in of_pair if not p[2]]  # what stops takes no time
        axes.loglog(
            [p[1] for p in points], [p[0] for p in points], MARKERS[scheme] + "-",
            color=f"C{pairs.index(pair)}", label=f"{pair}, {scheme}",
        )  # fmt: skip
    axes.set_xlabel("processor time of all problems [s]")
    axes.set_ylabel("geometric mean of the errors")
    figure.legend(fontsize=7, loc="outside right center")
    figure.savefig(file, dpi=120)
