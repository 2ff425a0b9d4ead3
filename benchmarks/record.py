# SPDX-License-Identifier: BSD-3-Clause
"""Measure benchmarks with the installed mpm3dpp and append a row for each to history.csv.

    python benchmarks/record.py elastic3d two_cubes --threads 1 --note "idle machine"

Numerics are those of a case that says nothing of them; `--preset paper` and its like as in `mpm3dpp
bench`. Record on an idle machine, with what is measured committed; a row of a changed tree says so.
"""

from __future__ import annotations

import argparse
import csv
import datetime
import json
import subprocess
import sys
from pathlib import Path
from typing import Any

NUMERICS = ("basis", "transfer", "scheme", "preset", "frame")
HISTORY = Path(__file__).with_name("history.csv")


def commit(root: Path) -> str:
    """Return the commit of the tree, with `+` if tracked files have been changed since."""

    def git(*words: str) -> str:
        command = ["git", "-C", str(root), *words]
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()

    changed = git("status", "--porcelain", "--untracked-files=no")
    return git("rev-parse", "--short=10", "HEAD") + ("+" if changed else "")


def measured(python: str, name: str, options: list[str]) -> dict[str, Any]:
    """Return what `mpm3dpp bench NAME --json` of an interpreter's environment prints.

    Raises:
        SystemExit: the benchmark failed; its own sentence has been printed.
    """
    command = [python, "-m", "mpm3dpp", "bench", name, "--json", *options]
    done = subprocess.run(command, stdout=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(done.returncode)
    result: dict[str, Any] = json.loads(done.stdout)
    return result


def row(result: dict[str, Any], commit_name: str, note: str) -> dict[str, Any]:
    """Return a result as a row of the history."""
    if result["preset"]:
        note = f"preset {result['preset']}; {note}".rstrip("; ")
    if result["frame"] != "updated":
        note = f"{result['frame']} frame; {note}".rstrip("; ")
    if "contact_ratio" in result:
        note = f"{result['contact_ratio']:.3f} of no contact; {note}".rstrip("; ")
    return {
        "date": datetime.date.today().isoformat(),
        "version": result["version"],
        "commit": commit_name,
        "machine": f"{result['machine']} {result['isa']}",
        **{
            key: result[key]
            for key in ("bench", "basis", "transfer", "threads", "scheme", "particles")
        },
        "ns_per_particle_step": f"{result['ns_per_particle_step']:.1f}",
        "bytes_per_particle": f"{result['bytes_per_particle']['total']:.1f}",
        "bandwidth_GBps": f"{result['bandwidth_GBps']:.1f}",
        "note": note,
    }


def append(path: Path, entry: dict[str, Any]) -> None:
    """Append a row to the history; its first line says which columns there are."""
    with path.open(newline="") as file:
        columns = next(csv.reader(file))
    with path.open("a", newline="") as file:
        csv.DictWriter(file, columns, lineterminator="\n").writerow(entry)


def main() -> None:
    """Measure what the command line names."""
    parser = argparse.ArgumentParser(description="Measure benchmarks and append to history.csv.")
    parser.add_argument("names", nargs="+", metavar="NAME", help="elastic3d, two_cubes, ...")
    parser.add_argument("--note", default="", help="conditions, for example what else was running")
    parser.add_argument("--size", help="cells along an edge")
    parser.add_argument("--steps", help="steps that are timed")
    parser.add_argument("--threads", default="1")
    for name in NUMERICS:
        parser.add_argument(f"--{name}", help="as `mpm3dpp bench` has it")
    given = parser.parse_args()
    options = ["--threads", given.threads]
    for name in ("size", "steps", *NUMERICS):
        value = getattr(given, name)
        options += [f"--{name}", value] if value else []
    commit_name = commit(HISTORY.parent)
    for name in given.names:
        entry = row(measured(sys.executable, name, options), commit_name, given.note)
        append(HISTORY, entry)
        print(",".join(str(value) for value in entry.values()), flush=True)


if __name__ == "__main__":
    main()
