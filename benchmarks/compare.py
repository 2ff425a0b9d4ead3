# SPDX-License-Identifier: BSD-3-Clause
"""Compare the speed of two installed builds, in the order A B A B ..., so that drift cancels.

    python benchmarks/compare.py old/.venv/bin/python new/.venv/bin/python elastic3d --threads 2

The ratio is the median over the rounds of B / A: below 1 means that B is faster. The range of the
ratios says how far to trust it.
"""

from __future__ import annotations

import argparse
import statistics
from typing import Any

from record import measured


def ratios(a: list[dict[str, Any]], b: list[dict[str, Any]], key: str) -> list[float]:
    """Return B / A of each round: of the step for key "", else of a stage that both have."""

    def value(result: dict[str, Any]) -> float:
        return float(result["stages"][key] if key else result["ns_per_particle_step"])

    return [value(y) / value(x) for x, y in zip(a, b, strict=True) if value(x) > 0]


def table(a: list[dict[str, Any]], b: list[dict[str, Any]]) -> list[str]:
    """Return the lines of the comparison: each stage, the step, the memory."""
    lines = [f"{'':22}{'A ns':>9}{'B ns':>9}{'B / A':>9}   range"]
    shared = [stage for stage in a[0]["stages"] if stage in b[0]["stages"]]
    for key in [*shared, ""]:
        pick = [
            statistics.median(r["stages"][key] if key else r["ns_per_particle_step"] for r in s)
            for s in (a, b)
        ]
        found = ratios(a, b, key)
        if max(pick) < 0.05 or not found:
            continue  # A stage that does nothing in this benchmark.
        lines.append(
            f"{key or 'step':22}{pick[0]:9.2f}{pick[1]:9.2f}{statistics.median(found):9.3f}   "
            f"{min(found):.3f} to {max(found):.3f}"
        )
    memory = [statistics.median(r["bytes_per_particle"]["total"] for r in s) for s in (a, b)]
    lines.append(
        f"{'bytes per particle':22}{memory[0]:9.1f}{memory[1]:9.1f}{memory[1] / memory[0]:9.3f}"
    )
    only = [s for r, o in ((a, b), (b, a)) for s in r[0]["stages"] if s not in o[0]["stages"]]
    if only:
        lines.append(f"stages that only one of them has: {', '.join(only)}")
    return lines


def main() -> None:
    """Compare what the command line names."""
    parser = argparse.ArgumentParser(description="Compare two installed builds, A B A B ...")
    parser.add_argument("a", help="Python interpreter of the environment with build A")
    parser.add_argument("b", help="the same for build B")
    parser.add_argument("name", help="benchmark: elastic3d, two_cubes, ...")
    parser.add_argument("--rounds", type=int, default=5)
    given, options = parser.parse_known_args()  # What is left over goes to `mpm3dpp bench`.
    results: dict[str, list[dict[str, Any]]] = {"A": [], "B": []}
    for number in range(given.rounds):
        for name, python in (("A", given.a), ("B", given.b)):
            result = measured(python, given.name, options)
            results[name].append(result)
            ns = result["ns_per_particle_step"]
            print(f"round {number + 1} {name}: {ns:.2f} ns per particle-step", flush=True)
    print("\n".join(table(results["A"], results["B"])))


if __name__ == "__main__":
    main()
