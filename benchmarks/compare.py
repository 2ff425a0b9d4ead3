# SPDX-License-Identifier: BSD-3-Clause
"""Compare the speed of two builds: two processes that live side by side take steps in turns.

    python benchmarks/compare.py old/.venv/bin/python build/release/python elastic3d:40 jc:40

Numerics are those of a case that says nothing of them, but where an option is given. A build before
bench had them knows the linear basis and FLIP alone, and needs a scheme: compare it with another by
`--preset paper --scheme musl`.

Each process makes two steps, then the other does: the drift of the machine meets both. A
round has two fresh processes, which lie elsewhere in memory; the ratio is the median of its turns,
B / A: below 1 means that B is faster. The range over the rounds says how far to trust it.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

STEPS, WARM_UP = "2", "5"
NUMERICS = ("basis", "transfer", "preset", "frame")


class Build:
    """A benchmark of one build, in a process of its own (`mpm3dpp.bench.worker`).

    Args:
        where: the Python interpreter of an environment, or a folder with the package.
        words: name, size, threads and scheme.
        numerics: words such as "basis=gimp".
    """

    def __init__(self, where: str, words: list[str], numerics: Sequence[str]) -> None:
        folder = Path(where).is_dir()
        python = sys.executable if folder else where
        environment = {**os.environ, "PYTHONPATH": str(Path(where).absolute())} if folder else None
        self._process = subprocess.Popen(
            [python, "-m", "mpm3dpp.bench.worker", *words, WARM_UP, "cpu", *numerics],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )
        self.blocks: list[dict[str, float]] = []  # of each turn, ns per particle-step by stage
        self._answer()

    def _answer(self) -> dict[str, Any]:
        assert self._process.stdout is not None
        content = json.loads(
            self._process.stdout.readline() or '{"error": "its process has ended"}'
        )
        if "error" in content:
            sys.exit(str(content["error"]))
        return dict(content)

    def step(self) -> None:
        """Make some steps, and note what they took; "step" is the whole."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"block {STEPS}\n")
        self._process.stdin.flush()
        content = self._answer()
        self.blocks.append({**content["stages"], "step": content["ns"]})

    def end(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()


def one_round(
    places: list[str], words: list[str], turns: int, numerics: Sequence[str] = ()
) -> list[list[dict[str, float]]]:
    """Return the blocks of each build; who begins changes from turn to turn."""
    builds = [Build(where, words, numerics) for where in places]
    for turn in range(turns):
        for build in builds if turn % 2 else reversed(builds):
            build.step()
    for build in builds:
        build.end()
    return [build.blocks for build in builds]


def table(rounds: list[list[list[dict[str, float]]]]) -> list[str]:
    """Return the lines of the comparison: each stage, and the step."""
    lines = [f"{'':30}{'A ns':>9}{'B ns':>9}{'B / A':>9}   rounds"]
    for key in rounds[0][0][0]:
        both = [
            [[block.get(key, 0.0) for block in blocks] for blocks in builds] for builds in rounds
        ]
        a, b = (statistics.median(x for builds in both for x in builds[k]) for k in (0, 1))
        if min(a, b) < 0.05:
            continue  # A stage that does nothing in this benchmark, or that one of them has not.
        ratios = [statistics.median(y / x for x, y in zip(*builds, strict=True)) for builds in both]
        lines.append(
            f"{key:30}{a:9.2f}{b:9.2f}{statistics.median(ratios):9.3f}   "
            f"{min(ratios):.3f} to {max(ratios):.3f}"
        )
    return lines


def main() -> None:
    """Compare what the command line names."""
    parser = argparse.ArgumentParser(description="Compare the speed of two builds, in turns.")
    where = "Python interpreter of an environment, or folder that holds the package mpm3dpp"
    parser.add_argument("a", help=f"build A: {where}")
    parser.add_argument("b", help="build B, likewise")
    parser.add_argument("names", nargs="+", metavar="NAME[:SIZE]", help="elastic3d:40, spheres:300")
    parser.add_argument("--threads", default="1")
    parser.add_argument("--scheme", default="-", help='default "-": that of a case')
    for name in NUMERICS:
        parser.add_argument(f"--{name}", help="as `mpm3dpp bench` has it")
    parser.add_argument("--rounds", type=int, default=4)
    parser.add_argument("--turns", type=int, default=12, help="in a round")
    given = parser.parse_args()
    said = {name: getattr(given, name) for name in NUMERICS}
    numerics = [f"{name}={value}" for name, value in said.items() if value]
    for name in given.names:
        bench, _, size = name.partition(":")
        words = [bench, size or "40", given.threads, given.scheme]
        print(f"{bench}, size {words[1]}, {given.threads} threads, {given.scheme}", *numerics)
        places = [given.a, given.b]
        rounds = [one_round(places, words, given.turns, numerics) for _ in range(given.rounds)]
        print("\n".join(table(rounds)), flush=True)


if __name__ == "__main__":
    main()
