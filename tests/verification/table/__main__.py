# SPDX-License-Identifier: BSD-3-Clause
"""Run the table: rows that its file has are not run again."""

from __future__ import annotations

import argparse
import csv
import itertools
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path

from . import report
from .benchmark_rows import MORE
from .measures import Measured, timed
from .problems import PROBLEMS

PAIRS = (
    "linear", "gimp", "gimp+xpic=4", "quadratic_bspline", "quadratic_bspline+apic",
    "quadratic_bspline+aflip=0.97", "quadratic_bspline+xpic=4",
)  # fmt: skip
SCHEMES, FACTORS = ("musl", "usf", "usl"), ("0.25", "0.5", "0.8")
KEY = ("problem", "pair", "scheme", "factor")
Key = tuple[str, ...]


def measure(key: Key) -> tuple[Key, Measured]:
    """Run one row."""
    problem, pair, scheme, factor = key
    name = pair if factor == report.OWN else f"{pair}@{factor}"
    return key, timed((PROBLEMS | MORE)[problem], name, scheme)


def rows(chosen: argparse.Namespace) -> Iterator[Key]:
    """What is asked for, problem by problem."""
    some = [
        words.split(",") if words else every
        for words, every in (
            (chosen.problems, tuple(PROBLEMS)),
            (chosen.pairs, PAIRS),
            (chosen.schemes, SCHEMES),
            (chosen.factors, FACTORS),
        )
    ]
    yield from itertools.product(*some)


def done(file: Path) -> set[Key]:
    """Rows that a file has; of a line that a kill has cut short, none."""
    if not file.exists():
        return set()
    with file.open(newline="") as open_file:
        return {
            tuple(row[k] for k in KEY)
            for row in csv.DictReader(open_file)
            if row["stopped"] is not None
        }


def main() -> None:
    """Run what is missing; print each row as it comes."""
    parser = argparse.ArgumentParser(prog="python -m verification.table", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("table.csv"))
    for name, of in (("problems", PROBLEMS | MORE), ("pairs", PAIRS), ("schemes", SCHEMES),
                     ("factors", FACTORS)):  # fmt: skip
        parser.add_argument(f"--{name}", help=f"separated by commas, of {', '.join(of)}")
    parser.add_argument("--workers", type=int, default=2, help="runs at a time, each on one core")
    parser.add_argument("--report", type=Path, help="write tables here, a picture beside them")
    chosen = parser.parse_args()
    if chosen.report:
        found = report.read(chosen.out)
        chosen.report.write_text(report.page(found))
        report.picture(found, chosen.report.with_suffix(".png"))
        return
    missing = sorted(set(rows(chosen)) - done(chosen.out), key=list(rows(chosen)).index)
    columns = [*KEY, *Measured().row()]
    new = not chosen.out.exists()
    with chosen.out.open("a", newline="") as out, ProcessPoolExecutor(chosen.workers) as pool:
        writer = csv.DictWriter(out, columns, lineterminator="\n")
        if new:
            writer.writeheader()
        for k, job in enumerate(as_completed(pool.submit(measure, key) for key in missing), 1):
            key, found = job.result()
            figures = {n: f"{v:.6g}" if isinstance(v, float) else v for n, v in found.row().items()}
            writer.writerow(dict(zip(KEY, key, strict=True)) | figures)
            out.flush()
            print(f"{k} of {len(missing)}:", *key, figures, flush=True)


if __name__ == "__main__":
    main()
