# SPDX-License-Identifier: BSD-3-Clause
"""How time and contact memory grow with the number of grains: the benchmark `spheres`, drawn.

    python benchmarks/growth.py 100 1000 8000 --out docs/images/growth.png

Left: time per particle-step. Right: bytes of the contact over overlapped nodes, with the straight
line of proportion through the last.
"""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from record import measured


def rows(grains: list[int], threads: int, steps: int, preset: str) -> list[dict[str, Any]]:
    """Measure each number of grains and print its row."""
    found = []
    for count in grains:
        options = ["--size", str(count), "--threads", str(threads), "--steps", str(steps)]
        options += ["--preset", preset] if preset else []
        one = measured(sys.executable, "spheres", options)
        contact = one["bytes_per_particle"]["contact"] * one["particles"]
        found.append({"grains": count, "bytes": contact, **one})
        print(
            f"{count:6} grains  {one['ns_per_particle_step']:7.1f} ns, {one['contact_ratio']:.2f} "
            f"of no contact; {one['overlapped_nodes']:,} nodes, {contact / 2**20:.2f} MiB of "
            f"contact, {one['bytes_per_particle']['total']:.0f} bytes a particle",
            flush=True,
        )
    return found


def draw(found: list[dict[str, Any]], path: Path) -> None:
    """Write the picture."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(7.6, 3.0), layout="constrained")
    left.semilogx([r["grains"] for r in found], [r["ns_per_particle_step"] for r in found], "o-")
    left.set_xlabel("grains")
    left.set_ylabel("ns per particle-step")
    left.set_ylim(0, 1.1 * max(r["ns_per_particle_step"] for r in found))
    nodes, kib = [r["overlapped_nodes"] for r in found], [r["bytes"] / 2**10 for r in found]
    right.loglog(nodes, kib, "o")
    share = kib[-1] / nodes[-1]
    right.loglog(nodes, [share * n for n in nodes], "--", lw=1, color="black")
    right.set_xlabel("overlapped nodes")
    right.set_ylabel("contact [KiB]")
    for axes in (left, right):
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(path, dpi=130)
    plt.close(figure)
    print(path)


def main() -> None:
    """Measure and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("grains", nargs="+", type=int, help="numbers of grains, such as 100 1000")
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--steps", type=int, default=10, help="of a block that is timed")
    parser.add_argument("--preset", default="", help="as `mpm3dpp bench` has it, such as paper")
    parser.add_argument("--out", type=Path, default=Path("growth.png"), help="the picture")
    options = parser.parse_args()
    draw(rows(options.grains, options.threads, options.steps, options.preset), options.out)


if __name__ == "__main__":
    main()
